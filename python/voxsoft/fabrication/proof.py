"""Proofs of a mold from the triangles and samples of its parts, before anything is written."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.fabrication.draw import SHALLOW
from voxsoft.fabrication.fields import Floats
from voxsoft.fabrication.mold import Mold
from voxsoft.fabrication.sampled import Grid, Surface

Bools = NDArray[np.bool_]

#: Most points of a surface from which deviations are measured.
_MOST: Final = 10_000


def deviation(mold: Mold) -> float:
    """Return the largest distance [m] between the side of a casting and the mold around it.

    Both ways: from points of the casting's surface to the nearest triangle of the mold, openings
    aside, or to the brim of an open mold; and the depth to which the mold reaches into the casting.
    """
    import igl

    surface = mold.surface
    points = surface.vertices[surface.triangles].mean(axis=1)
    if len(points) > _MOST:
        points = points[:: len(points) // _MOST + 1]
    near = np.ones(len(points), dtype=bool)
    for opening in mold.openings:
        near &= opening.bore.evaluate(points) > mold.casting.grid.step
    vertices = np.concatenate([part.surface.vertices for part in mold.parts])
    starts = np.cumsum([0, *(len(part.surface.vertices) for part in mold.parts)])
    triangles = np.concatenate(
        [part.surface.triangles + start for part, start in zip(mold.parts, starts, strict=False)]
    )
    squares = igl.point_mesh_squared_distance(points[near], vertices, triangles)[0]
    away = np.sqrt(squares)
    if mold.is_open:
        away = np.minimum(away, np.abs(mold.draw.parting - points[near, 2]))
    outward = float(away.max(initial=0.0))
    into = float(-mold.casting.evaluate(vertices).min())
    return max(outward, into, 0.0)


def blocked(mold: Mold) -> tuple[float, Floats | None]:
    """Return the volume of the mold that meets something on its way out, and a place [m].

    Each part moves along its direction, sample by sample, past the casting and the other part.
    Contacts no deeper than 0.1 mm do not count.
    """
    grid = mold.casting.grid
    values = [part.values for part in mold.parts]
    casting = mold.casting.values < -SHALLOW
    total, place = 0, None
    for index, part in enumerate(mold.parts):
        moving = values[index] < -SHALLOW
        others = casting.copy()
        for other, each in enumerate(values):
            if other != index and part.direction > 0:
                others |= each < -SHALLOW  # the upper part leaves first, the lower one alone
        ahead = np.maximum.accumulate(others[..., :: -part.direction], axis=2)
        hit = moving & ahead[..., :: -part.direction]
        if hit.any():
            total += int(hit.sum())
            place = grid.points(np.argwhere(hit)).mean(axis=0)
    return total * grid.step**3, place


def thin_wall(mold: Mold, wall: float) -> tuple[str, Floats] | None:
    """Return a part and a place [m] where it is thinner than a printer's wall [m], or None.

    A cube of samples whose edge is the wall, rounded up, slides through the part. Places that it
    does not reach are thin, but for those within a wall of its way: edges and corners.
    """
    grid = mold.casting.grid
    count = int(np.ceil(wall / grid.step))
    for part in mold.parts:
        place = _thin(part.values < 0.0, count, grid)
        if place is not None:
            return part.name, place
    return None


def too_fine(mold: Mold) -> Floats | None:
    """Return a place [m] where the casting is less than two samples thick, or None.

    Its mold does not hold it there.
    """
    return _thin(mold.casting.values < 0.0, 2, mold.casting.grid)


def _thin(solid: Bools, count: int, grid: Grid) -> Floats | None:
    reached = _slid(_slid(solid, count, np.minimum), -count, np.maximum)
    # Edges and corners lie within a wall of these places.
    near = _slid(_slid(reached, count + 1, np.maximum), -count - 1, np.maximum)
    thin = solid & ~near
    if not thin.any():
        return None
    place: Floats = grid.points(np.argwhere(thin))[0]
    return place


def _slid(cells: Bools, count: int, of: np.ufunc) -> Bools:
    """Return the least or largest of `count` samples onward along each axis; backward if < 0."""
    found = cells
    for axis in range(3):
        row = np.moveaxis(found, axis, 0)
        row = row[::-1] if count < 0 else row
        made = row.copy()
        for k in range(1, abs(count)):
            made[:-k] = of(made[:-k], row[k:])
        made = made[::-1] if count < 0 else made
        found = np.moveaxis(made, 0, axis)
    return found


def unsound(surface: Surface) -> str | None:
    """Return the reason why a surface is no single closed part, or None."""
    if not surface.is_closed:
        return "its surface is open"
    if surface.components != 1:
        return f"it falls into {surface.components} components"
    return None
