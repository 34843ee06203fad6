"""Reasons for a missing cavity: an opening, voxels that are too large, or no void at all."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.design.discretization.discretize import voxels_of
from voxsoft.errors import VoxSoftError
from voxsoft.mesh import Mesh
from voxsoft.simulation.diagnostic import near
from voxsoft.simulation.setup.volumes import GridRegions
from voxsoft.units import format_quantity
from voxsoft.voxels import Voxels

Marks = NDArray[np.bool_]

#: Smallest number of sides, of six along the axes, on which a hollow has material.
_SIDES: Final = 5
#: Smallest number of cells of a hollow; fewer are a groove.
_FEWEST: Final = 8
#: Largest number of voxels of half the size that are tried.
_AFFORDABLE: Final = 400_000


def why_no_cavity(design: Design, mesh: Mesh) -> tuple[str, str]:
    """Explain why a body has no cavity, and suggest a remedy.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> cup = vs.Cylinder(radius=0.02, height=0.02) - vs.Cylinder(radius=0.014, height=0.016)
    >>> design = families.beam().replace(shapes={"body": cup}, voxel_size=0.002)
    >>> why_no_cavity(design, vs.mesh_of(design))[0]  # doctest: +ELLIPSIS
    'the hollow of 9... mL is open: its opening is 28 mm wide, near (0, 0, 1) mm'
    """
    small = _on_small_voxels(design, mesh)
    if small is not None:
        size = format_quantity(float(f"{0.5 * design.voxel_size:.4g}"), "length")
        return small, f'set voxel_size = "{size}" or smaller, or make that larger'
    opening = _opening(mesh)
    if opening is not None:
        return opening, (
            "close the opening with a part, or with a layer that has seal = true; a chamber that "
            "an object or another body closes by contact is not known yet"
        )
    return (
        "the parts enclose no void",
        "subtract a shape from a part, so that material is left all around it",
    )


def _opening(mesh: Mesh) -> str | None:
    """Describe the opening of the largest hollow."""
    from scipy.ndimage import label

    found: tuple[int, str] | None = None
    for body in mesh.each_body:
        size = body.mesh.voxel_size
        if size is None:
            continue
        cells = GridRegions.of(body.mesh, size)
        filled = cells.parts > 0
        hollows, count = label(~filled & (_sides(filled) >= _SIDES))
        if not count:
            continue
        sizes = np.bincount(hollows.ravel())[1:]
        largest = int(sizes.argmax()) + 1
        if sizes[largest - 1] < max(_FEWEST, 0 if found is None else found[0] + 1):
            continue
        of, axis = _end(hollows == largest, ~filled & (hollows != largest))
        across = np.delete(np.ptp(of, axis=0) + 1, axis)
        x, y, z = body.placed((cells.origin + size * (of.mean(axis=0) + 0.5))[None])[0].tolist()
        volume = format_quantity(float(f"{sizes[largest - 1] * size**3:.3g}"), "volume")
        width = format_quantity(float(f"{across.min() * size:.3g}"), "length")
        words = f"the hollow of {volume} is open: its opening is {width} wide, {near((x, y, z))}"
        found = (int(sizes[largest - 1]), words)
    return None if found is None else found[1]


def _sides(filled: Marks) -> NDArray[np.int64]:
    """Count the sides, of six, on which each cell has material."""
    count = np.zeros(filled.shape, dtype=np.int64)
    for axis in range(3):
        count += np.maximum.accumulate(filled, axis=axis)
        count += np.flip(np.maximum.accumulate(np.flip(filled, axis), axis=axis), axis)
    return count


def _end(hollow: Marks, outside: Marks) -> tuple[NDArray[np.int64], int]:
    """Find the cells of a hollow that touch the outside most, along one axis, and that axis."""
    ends = []
    for axis in range(3):
        for step in (-1, 1):
            ends.append((np.argwhere(hollow & np.roll(outside, step, axis)), axis))
    cells, axis = max(ends, key=lambda end: len(end[0]))
    return cells, axis


def _on_small_voxels(design: Design, mesh: Mesh) -> str | None:
    """Describe the first cavity that voxels half as large have."""
    if 8 * len(mesh.tets) // 5 > _AFFORDABLE:
        return None
    for name in design.body_names or ("",):
        own = design.alone(name) if name else design
        size = own.voxel_size
        try:
            voxels: Voxels = voxels_of(own.replace(voxel_size=0.5 * size))
        except VoxSoftError:
            continue
        if not voxels.cavities:
            continue
        cavity, wall = voxels.cavities[0], voxels.cavity_walls[0]
        center = cavity.bounds.mean(axis=0).tolist()
        volume = format_quantity(float(f"{cavity.volume:.2g}"), "volume")
        thick = 0.5 * size * wall.thickness
        wide = float(np.ptp(cavity.bounds, axis=0).min())
        of, length = ("wall is {} thick", thick) if thick < wide else ("room is {} wide", wide)
        narrow = of.format(format_quantity(float(f"{length:.2g}"), "length"))
        voxel = format_quantity(float(f"{size:.4g}"), "length")
        at = near((center[0], center[1], center[2]))
        return f"voxels of {voxel} lose the chamber of some {volume} {at}: its {narrow}"
    return None
