"""Pour hole and vents of a mold, and air that they leave in it.

A mold is filled from below. Air at a point leaves, if a way leads from there to an opening that
never goes below the point. So air is trapped under each highest place of the cavity that has no
opening: a connected set of points at one height with no point of the cavity above it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design.printer import Printer
from voxsoft.fabrication.fields import Frustum
from voxsoft.fabrication.sampled import Grid

Bools = NDArray[np.bool_]

#: Part of the distance to the wall that an opening takes.
_WIDEST: Final = 0.8


@dataclass(frozen=True)
class Opening:
    """Hole through the upper part, from a highest place of the cavity.

    Attributes
    ----------
    kind
        ``"pour"`` or ``"vent"``.
    bore
        Its space.
    column
        Sample at its lower end.
    level
        Height of the cavity's highest place there [m].
    """

    kind: str
    bore: Frustum
    column: tuple[int, int, int]
    level: float


def openings_of(cavity: Bools, grid: Grid, top: float, printer: Printer) -> tuple[Opening, ...]:
    """Return a pour hole at the largest of the highest places, and a vent at each other one.

    The largest place has a vent beside the pour hole, as far from it as possible: air leaves
    there while silicone enters. A place that has the casting above it gets none.

    Parameters
    ----------
    cavity
        True for samples in the casting, (nx, ny, nz).
    grid
        Their positions.
    top
        Height of the upper side of the mold [m].
    printer
        The printer.
    """
    from scipy import ndimage

    covered = np.maximum.accumulate(np.pad(cavity, ((0, 0), (0, 0), (0, 1)))[..., ::-1], axis=2)
    covered = covered[..., ::-1]
    spots: list[tuple[float, float, tuple[int, int, int]]] = []
    for level, place in _highest(cavity):
        if covered[:, :, level + 1][place].any():
            continue
        distance = ndimage.distance_transform_edt(np.pad(place, 1))[1:-1, 1:-1] * grid.step
        i, j = np.unravel_index(int(distance.argmax()), place.shape)
        spots.append((float(place.sum()), float(distance.max()), (int(i), int(j), level)))
    if not spots:
        return ()
    spots.sort(reverse=True)
    area, room, main = spots[0]
    level = main[2]
    taller = np.pad(covered[:, :, level + 1], 1)
    beside = (
        ndimage.distance_transform_edt(~taller)[1:-1, 1:-1][main[:2]] if taller.any() else np.inf
    )
    radius = min(printer.pour / 2, _WIDEST * room)
    # The funnel leaves a wall to a higher place beside it.
    wide = min(2.0 * radius, max(radius, (float(beside) - 0.5) * grid.step - printer.wall))
    found = [_opening("pour", main, radius, wide, grid, top)]
    place = _component(cavity[:, :, level], main[:2])
    distance = ndimage.distance_transform_edt(np.pad(place, 1))[1:-1, 1:-1]
    rows = np.argwhere(place & (distance >= 0.7 * distance.max()))
    aside = rows[np.linalg.norm(rows - np.array(main[:2]), axis=1).argmax()]
    other = (int(aside[0]), int(aside[1]), level)
    if np.hypot(aside[0] - main[0], aside[1] - main[1]) * grid.step > printer.pour:
        spots.insert(1, (area, float(distance[other[:2]]) * grid.step, other))
    for _, room, spot in spots[1:]:
        radius = min(printer.vent / 2, _WIDEST * room)
        found.append(_opening("vent", spot, radius, radius, grid, top))
    return tuple(found)


def trapped_air(cavity: Bools, grid: Grid, openings: tuple[Opening, ...]) -> float:
    """Return the volume [m³] of the cavity from which air cannot leave.

    Examples
    --------
    >>> bell = np.zeros((5, 3, 6), dtype=bool)
    >>> bell[0:5, 1, 1] = bell[0, 1, 1:5] = bell[4, 1, 1:4] = True
    >>> grid = Grid((0.0, 0.0, 0.0), 0.001, (5, 3, 6))
    >>> bore = Frustum((0.0, 0.001), 0.004, 0.006, 0.0005, 0.0005)
    >>> out = Opening("vent", bore, (0, 1, 4), 0.0045)
    >>> round(trapped_air(bell, grid, (out,)) * 1e9)
    2
    """
    from scipy import ndimage

    vented = np.zeros_like(cavity)
    for each in openings:
        vented[each.column] = cavity[each.column]
    if all(vented[:, :, level][place].any() for level, place in _highest(cavity)):
        return 0.0
    trapped = 0
    # A component of all that is not lower is free if an opening is in it.
    for level in np.flatnonzero(cavity.any(axis=(0, 1))):
        labels, count = ndimage.label(cavity[:, :, level:])
        free = np.zeros(count + 1, dtype=bool)
        free[np.unique(labels[vented[:, :, level:]])] = True
        trapped += int((cavity[:, :, level] & ~free[labels[:, :, 0]]).sum())
    return trapped * grid.step**3


def _highest(cavity: Bools) -> list[tuple[int, Bools]]:
    """Return connected sets of samples at one level with none of the cavity right above."""
    from scipy import ndimage

    found = []
    for level in np.flatnonzero(cavity.any(axis=(0, 1))):
        layer = cavity[:, :, level]
        above = cavity[:, :, level + 1] if level + 1 < cavity.shape[2] else np.zeros_like(layer)
        if (layer & ~above).any():
            labels, count = ndimage.label(layer)
            taken = np.unique(labels[layer & above])
            free = (k for k in range(1, count + 1) if k not in taken)
            found += [(int(level), labels == k) for k in free]
    return found


def _component(layer: Bools, at: tuple[int, int]) -> Bools:
    from scipy import ndimage

    labels, _ = ndimage.label(layer)
    same: Bools = labels == labels[at]
    return same


def _opening(
    kind: str, at: tuple[int, int, int], radius: float, wide: float, grid: Grid, top: float
) -> Opening:
    """Return an opening of a radius at the casting and another at the top of the mold [m]."""
    x, y, z = grid.points(np.array([at]))[0]
    # From a step inside the cavity.
    bore = Frustum((float(x), float(y)), float(z), top + grid.step, radius, wide)
    return Opening(kind, bore, at, float(z) + grid.step / 2)
