"""From a design to voxels and a mesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from voxsoft.design.discretization.cut_cells import cuts_cells
from voxsoft.design.discretization.cut_voxels import CutVoxels
from voxsoft.design.discretization.grid import grid_of
from voxsoft.design.discretization.joined import joined
from voxsoft.design.file_mesh import FileMesh, tets_of
from voxsoft.design.model import Design
from voxsoft.design.refinement import TIMES_AS_SMALL
from voxsoft.design.require import require_design
from voxsoft.errors import DesignError
from voxsoft.mesh import Mesh
from voxsoft.voxels import Voxels


def voxels_of(design: Design) -> Voxels:
    """Fill a grid with the parts of a design; the first part wins where parts overlap.

    With ``fill = "binary"`` a cell is of the part that holds its center; with ``"fraction"`` it
    counts if it is 22 % full, and is of the part with the largest share of it.

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
    if require_design(design).bodies:
        names = ", ".join(design.body_names)
        what = f"has several bodies, each with voxels of its own: {names}"
        raise DesignError("bodies", what, "take one of them by design.alone(name)")
    if design.mesh is not None:
        what = f"the body is the mesh {design.mesh.label}: it has no voxels"
        raise DesignError("mesh", what, "take its tetrahedra, by mesh_of")
    voxels = filled(design).voxels
    assert voxels is not None  # there is no mesh of a file
    return voxels


@dataclass(frozen=True)
class Filled:
    """A design on its grid, not meshed yet.

    Attributes
    ----------
    voxels
        Its cells; of full ones those before they are refined. Of several bodies those of the first.
        None where the body is the mesh of a file.
    count
        Number of voxels that the mesh will have; five tetrahedra of a file count as one.
    lost
        Volume of the material that found no voxel [m³].
    mesh
        Makes the mesh.
    bodies
        Each body for itself, by name, in its own frame; empty where there is only one.
    """

    voxels: Voxels | None
    count: int
    lost: float
    mesh: Callable[[], Mesh]
    bodies: Mapping[str, Filled] = field(default_factory=dict)

    @property
    def voxels_by_body(self) -> dict[str, Voxels]:
        """The voxels of each body by its name; none of the mesh of a file."""
        return {name: own.voxels for name, own in self.each.items() if own.voxels is not None}

    @property
    def each(self) -> Mapping[str, Filled]:
        """Each body for itself, by name; one without a name where there is only one."""
        return self.bodies or {"": self}


def filled(design: Design, refine: int = 1) -> Filled:
    """Fill a grid with a design, as its `fill` says; parameters as for :func:`mesh_of`.

    A body whose surface lies on faces of voxels has full ones.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> cells = filled(families.beam(), refine=2)
    >>> cells.voxels.count, cells.count, len(cells.mesh().tets)
    (80, 640, 3200)
    """
    require_design(design)
    if design.mesh is not None:
        return _filled_by_file(design, design.mesh, refine)
    if design.refine:
        refine *= TIMES_AS_SMALL
    if design.bodies:
        return _filled_bodies(design.assembled, refine)
    if design.has_cut_voxels and cuts_cells(design, design.voxel_size):
        cut = CutVoxels.of(design, refine)
        return Filled(cut.voxels, cut.voxels.count, cut.lost, cut.mesh)
    voxels = grid_of(design).voxels()
    mesh = (lambda: voxels.refine(refine).mesh()) if refine > 1 else voxels.mesh
    return Filled(voxels, voxels.count * refine**3, 0.0, mesh)


def _filled_by_file(design: Design, source: FileMesh, refine: int) -> Filled:
    if refine > 1:
        what = f"cuts voxels, and the body is the mesh {source.label}"
        raise DesignError("solver.refine", what, "leave it out; refine the mesh where it was made")
    mesh = tets_of(design, source)
    return Filled(None, len(mesh.tets) // 5, 0.0, lambda: mesh)


def _filled_bodies(design: Design, refine: int) -> Filled:
    """Fill a grid for each body."""
    own = {body.name: filled(design.alone(body.name), refine) for body in design.bodies}

    def mesh() -> Mesh:
        return joined(
            (body.name, own[body.name].mesh(), body.pose, _numbers(design, body.name))
            for body in design.bodies
        )

    first = next(iter(own.values()))
    count, lost = (sum(each.count for each in own.values()), sum(e.lost for e in own.values()))
    return Filled(first.voxels, count, lost, mesh, own)


def _numbers(design: Design, body: str) -> NDArray[np.uint8]:
    """Map the parts of a body, counted from 1, to their numbers among all."""
    own = [index + 1 for index, part in enumerate(design.parts) if part.body == body]
    return np.array([0, *own], dtype=np.uint8)


def mesh_of(design: Design, refine: int = 1) -> Mesh:
    """Mesh a design: five tetrahedra for each voxel, stitched.

    Parameters
    ----------
    design
        The design.
    refine
        Cut every voxel into this many along each axis first. With ``fill = "binary"`` the body
        stays the same, stairs and all; with ``"fraction"`` the smaller cells are filled anew.
        With local refinement (:class:`~voxsoft.design.Refinement`) the mesh has small voxels
        everywhere, and the solver joins those that stay large.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> len(mesh_of(families.beam()).tets)
    400
    >>> len(mesh_of(families.beam(), refine=2).tets)
    3200
    """
    return filled(design, refine).mesh()
