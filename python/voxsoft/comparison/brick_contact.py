"""Contact for an outside code: faces of voxels and rigid objects.

Outside codes are given pairs of surfaces. The body meets an object with all of its faces, and
itself where two of its walls face each other across a slit or a chamber of the unloaded body.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from voxsoft.design import History
from voxsoft.design.contact import FLOOR
from voxsoft.errors import SimulationError
from voxsoft.simulation.setup.contact import Touching
from voxsoft.simulation.setup.distance import Surface, overlap_of

if TYPE_CHECKING:
    from voxsoft.simulation import Setup

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Most pairs of walls of a body: a strut lattice has more, and each costs a search of its own.
_MOST_PAIRS: Final = 400


@dataclass(frozen=True, eq=False)
class RigidTool:
    """Rigid object that is held or moved.

    Attributes
    ----------
    name
        Name of the object.
    vertices, triangles
        Vertices of its surface in m, (n, 3), and its triangles, outward, (t, 3).
    way
        Displacement in m, (3,).
    friction
        Friction coefficient with the body.
    full, history
        Displacement in m without its history, (3,), and the factor on it over time.
    """

    name: str
    vertices: Floats = field(repr=False)
    triangles: NDArray[np.uint32] = field(repr=False)
    way: Floats
    friction: float
    full: Floats
    history: History | None = None


@dataclass(frozen=True, eq=False)
class BrickContact:
    """Surfaces in contact.

    Attributes
    ----------
    outer
        All faces of the body, rows (brick, face).
    walls
        Pairs of walls of the body that face each other, likewise.
    friction
        Friction coefficient of the body with itself.
    tools
        Objects that it touches.
    """

    outer: Ints = field(repr=False)
    walls: tuple[tuple[Ints, Ints], ...] = field(repr=False)
    friction: float
    tools: tuple[RigidTool, ...]


def floor_under(setup: Setup) -> tuple[RigidTool, ...]:
    """Return the floor of a design without other contact, which has no friction; none without."""
    if setup.design.floor is None:
        return ()
    surface = Touching(setup.design, setup.mesh).floor
    assert surface is not None  # the design has one
    return (_floor(surface, 0.0),)


def _floor(surface: Surface, friction: float) -> RigidTool:
    return RigidTool(FLOOR, surface.vertices, surface.triangles, np.zeros(3), friction, np.zeros(3))


def tools_of(touching: Touching) -> tuple[RigidTool, ...]:
    """List the objects that the body touches, the floor as the last of them."""
    found = []
    pairs = zip(touching.design.objects, touching.surfaces, strict=True)
    for index, (each, surface) in enumerate(pairs):
        friction = float(touching.friction[0, 1 + index])
        full, history = np.zeros(3), None
        if each.way is not None:
            history = each.way.history
            full = np.asarray(each.way.displacement, dtype=np.float64)
        way = full if history is None else history.factors[-1] * full
        if not np.isnan(friction):
            shape = surface.vertices, surface.triangles
            found.append(RigidTool(each.name, *shape, way, friction, full, history))
    if touching.floor is not None and not np.isnan(touching.friction[0, -1]):
        found.append(_floor(touching.floor, float(touching.friction[0, -1])))
    return tuple(found)


def facing_walls(cells: Ints) -> tuple[Ints, list[tuple[Ints, Ints]]]:
    """Return all faces of a body of voxels, and the pairs of its walls that face each other.

    A wall is a part of a plane in which faces of voxels are connected by their edges. Two face each
    other where a line across both meets nothing between them.

    Parameters
    ----------
    cells
        Cells of the voxels in their grid, (n, 3).

    Returns
    -------
    faces, walls
        Rows (voxel, axis, 1 if it looks along the axis); of all, and of both walls of each pair.

    Raises
    ------
    SimulationError
        Too many pairs for an outside code.

    Examples
    --------
    >>> slit = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 0, 1), (2, 0, 1)])
    >>> faces, walls = facing_walls(slit)
    >>> len(faces), [(a.tolist(), b.tolist()) for a, b in walls]
    (22, [([[3, 0, 1]], [[4, 0, 0]])])
    """
    number = np.full(cells.max(axis=0) + 3, -1)  # with an empty layer all around
    number[tuple(cells.T + 1)] = np.arange(len(cells))
    within_plane = ndimage.generate_binary_structure(3, 1)
    within_plane[[0, 2]] = False
    faces: list[Ints] = []
    walls: list[tuple[Ints, Ints]] = []
    for axis in range(3):
        lines = np.moveaxis(number, axis, 0)
        full = lines >= 0
        labels, rows = [], []
        for along in (0, 1):
            is_open = full & ~np.roll(full, -1 if along else 1, axis=0)
            labels.append(np.asarray(ndimage.label(is_open, within_plane)[0], dtype=np.int64))
            voxels = lines[is_open]
            rows.append(np.column_stack((voxels, np.full_like(voxels, axis), 0 * voxels + along)))
        down, up = (label[label > 0] for label in labels)  # the wall of each row
        for first, second in _seen(full, *labels):
            walls.append((rows[1][up == first], rows[0][down == second]))
        faces += rows
    if len(walls) > _MOST_PAIRS:
        raise SimulationError(
            "contact",
            f"has {len(walls)} pairs of walls of the body that look at each other, and an outside "
            f"code is given {_MOST_PAIRS} at most",
            'write pairs = [{ of = ["body", "body"], kind = "none" }], or larger voxels',
        )
    return np.concatenate(faces), walls


def _seen(full: NDArray[np.bool_], down: Ints, up: Ints) -> list[tuple[int, int]]:
    """Pair the labels of walls along the first axis with those of the walls across from them."""
    index = np.arange(len(full))[:, None, None]
    next_full = np.where(full, index, len(full))  # at a cell or after it
    next_full = np.minimum.accumulate(next_full[::-1])[::-1]
    x, y, z = np.nonzero(up)
    there = next_full[x + 1, y, z]
    met = there < len(full)
    pairs = np.column_stack((up[x, y, z][met], down[there[met], y[met], z[met]]))
    return [(int(a), int(b)) for a, b in np.unique(pairs, axis=0)]


def passed_through(setup: Setup, positions: Floats) -> str:
    """Describe the surfaces that passed through each other in an answer; empty if none did.

    Pairs of surfaces are chosen on the unloaded body. Other contact is found here, if anything is
    more than a quarter of a voxel deep.
    """
    touching = setup.touching
    if touching is None:
        return ""
    from voxsoft.simulation.checks.penetration import find_penetration

    allowed = 0.25 * touching.voxel_size
    if not np.isnan(touching.friction[0, 0]):
        found = find_penetration(setup.mesh, positions)
        if found.depth > allowed:
            return f"the body is {1e3 * found.depth:.2g} mm deep in itself"
    body = Surface(positions, setup.mesh.triangles.astype(np.uint32))
    for tool in tools_of(touching):
        if tool.name == FLOOR:
            continue  # a plane has no inside
        there = Surface(tool.vertices + tool.way, tool.triangles)
        depth = overlap_of(there, body, touching.voxel_size).depth
        if depth > allowed:
            return f'the body is {1e3 * depth:.2g} mm deep in "{tool.name}"'
    return ""
