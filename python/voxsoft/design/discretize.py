"""From a design to voxels and a mesh."""

from __future__ import annotations

import numpy as np

from voxsoft.design.cut_voxels import CutVoxels
from voxsoft.design.model import Design
from voxsoft.design.require import require_design
from voxsoft.mesh import Mesh
from voxsoft.shapes import voxelize
from voxsoft.voxels import Voxels


def voxels_of(design: Design) -> Voxels:
    """Fill a grid with the parts of a design; the first part wins where parts overlap.

    With ``fill = "binary"`` a cell is of the part that holds its center; with ``"fraction"`` it
    counts if it is 30 % full, and is of the part with the largest share of it.

    Parameters
    ----------
    design
        The design; its part number ``p`` (from 0) gets the part id ``p + 1``.

    Raises
    ------
    ShapeError
        No cell's center lies inside a part, a shape has no end, or the grid would not fit in
        memory.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> voxels_of(families.beam()).count
    80
    """
    if require_design(design).fill == "fraction":
        return CutVoxels.of(design).voxels
    size = design.voxel_size
    grids = []
    for part in design.parts:
        shape = design.shapes[part.shape] if isinstance(part.shape, str) else part.shape
        grids.append(voxelize(shape, size, names=design.shapes))
    if len(grids) == 1:
        return grids[0]
    corners = [np.rint(np.asarray(grid.origin) / size).astype(int) for grid in grids]
    low = np.min(corners, axis=0)
    high = np.max([c + grid.shape for c, grid in zip(corners, grids, strict=True)], axis=0)
    cells = np.zeros(high - low, dtype=np.uint8)
    for index in range(len(grids) - 1, -1, -1):
        window = tuple(
            slice(start, start + count)
            for start, count in zip(corners[index] - low, grids[index].shape, strict=True)
        )
        cells[window][grids[index].array > 0] = index + 1
    return Voxels.from_array(cells, size, tuple((low * size).tolist()))


def mesh_of(design: Design, refine: int = 1) -> Mesh:
    """Mesh a design: five tetrahedra for each voxel, stitched.

    Parameters
    ----------
    design
        The design.
    refine
        Cut every voxel into this many along each axis first. With ``fill = "binary"`` the body
        stays the same, stairs and all; with ``"fraction"`` the smaller cells are filled anew.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> len(mesh_of(families.beam()).tets)
    400
    >>> len(mesh_of(families.beam(), refine=2).tets)
    3200
    """
    if require_design(design).fill == "fraction":
        return CutVoxels.of(design, refine).mesh()
    voxels = voxels_of(design)
    return (voxels.refine(refine) if refine > 1 else voxels).mesh()
