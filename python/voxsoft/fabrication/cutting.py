"""Plane that cuts a body in two castings, each of which is drawn along the normal of the plane.

A point below the plane z = c is caught, if something of the body is below it and something above
it but still below the plane. With the height n of the next point of the body above, this is so for
all c > n, so that one count over n gives the caught volume for every plane at once. The space above
the plane is treated alike, from below.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.fabrication.draw import SHALLOW
from voxsoft.fabrication.fields import Floats
from voxsoft.fabrication.sampled import Grid

#: Difference of areas, as a part, within which two seams count as equally small.
_EQUAL: Final = 0.1


@dataclass(frozen=True)
class Cut:
    """Plane across an axis that leaves two castings without undercuts.

    Attributes
    ----------
    axis
        The axis across it, 0 to 2.
    at
        Its position [m].
    seam
        Area in which both castings are bonded [m²].
    """

    axis: int
    at: float
    seam: float


@dataclass(frozen=True, eq=False)
class _Planes:
    """All planes across an axis: caught volume below and above, and area of the body in each."""

    heights: Floats = field(repr=False)
    caught: Floats = field(repr=False)
    areas: Floats = field(repr=False)


def best_cut(values: Floats, grid: Grid, ends: Floats, held: Floats, center: Floats) -> Cut | None:
    """Return the plane with the smallest seam, or None where every plane leaves an undercut.

    Seams within a tenth of the smallest count as equal. Among their planes one at an end of a
    chamber is taken, where one casting is a plate without a recess; of two ends the one farther
    from the clamps. Else it is the plane nearest to the middle, where both castings are alike.

    Parameters
    ----------
    values
        Samples of the body, negative inside, (nx, ny, nz) [m].
    grid
        Their positions.
    ends
        Lowest and highest corner of each chamber, (c, 2, 3) [m].
    held
        Middle of the clamps, (3,) [m]; NaN without any.
    center
        Middle of the body, (3,) [m].
    """
    found: list[tuple[float, bool, Cut]] = []
    for axis in range(3):
        planes = _planes(np.moveaxis(values, axis, 2), grid, axis)
        fit = (planes.caught <= 0.0) & (planes.areas > 0.0)
        if not fit.any():
            continue
        least = planes.areas[fit].min()
        small = fit & (planes.areas <= (1.0 + _EQUAL) * least)
        heights = planes.heights[small]
        # A chamber may be closed by another component: a plane at its end there cuts nothing off.
        within = planes.heights[planes.areas > 0.0]
        marks = np.unique(ends[:, :, axis])
        marks = marks[(marks > within[0] + grid.step) & (marks < within[-1] - grid.step)]
        middle = float(center[axis])
        flat = np.isin(np.arange(len(heights)), _beside(heights, marks, grid.step))
        away = heights - (held[axis] if np.isfinite(held[axis]) else middle)
        order = np.lexsort((np.where(flat, -np.abs(away), np.abs(heights - middle)), ~flat))
        at = float(heights[order[0]])
        # Samples miss exact places by less than a step.
        exact = np.append(marks, middle)
        nearest = float(exact[np.abs(exact - at).argmin()])
        at = nearest if abs(nearest - at) < grid.step else at
        area = float(planes.areas[small][order[0]])
        found.append((area, not flat[order[0]], Cut(axis, at, area)))
    return min(found, key=lambda each: each[:2])[2] if found else None


def least_caught(values: Floats, grid: Grid, axis: int) -> float:
    """Return the volume [m³] that the best plane across an axis leaves in undercuts."""
    planes = _planes(np.moveaxis(values, axis, 2), grid, axis)
    through = planes.areas > 0.0
    return float(planes.caught[through].min(initial=np.inf))


def _beside(heights: Floats, marks: Floats, step: float) -> NDArray[np.int64]:
    """Return the indices of heights less than a step from a mark."""
    if not len(marks):
        return np.zeros(0, np.int64)
    near = np.abs(heights[:, None] - marks).min(axis=1) < step
    return np.flatnonzero(near)


def _planes(values: Floats, grid: Grid, axis: int) -> _Planes:
    """Count caught volumes for all planes across the last axis of the array."""
    solid = values < -SHALLOW
    free = values > SHALLOW
    count = values.shape[2]
    below = np.maximum.accumulate(solid, axis=2)
    above = np.maximum.accumulate(solid[..., ::-1], axis=2)[..., ::-1]
    index = np.arange(count)
    following = np.minimum.accumulate(np.where(solid, index, count)[..., ::-1], axis=2)[..., ::-1]
    previous = np.maximum.accumulate(np.where(solid, index, -1), axis=2)
    # A plane lies between samples k and k + 1.
    lower = np.bincount(following[free & below & above], minlength=count + 1)[:count]
    upper = np.bincount(previous[free & below & above] + 1, minlength=count + 1)[1:]
    caught_below = np.cumsum(lower)
    caught_above = np.cumsum(upper[::-1])[::-1]
    caught_above = np.concatenate([caught_above[1:], [0]])
    inside = values < 0.0
    areas = np.minimum(inside[..., :-1], inside[..., 1:]).sum(axis=(0, 1))
    return _Planes(
        grid.along(axis)[:-1] + grid.step / 2,
        np.asarray((caught_below + caught_above)[:-1] * grid.step**3, dtype=np.float64),
        np.asarray(areas * grid.step**2, dtype=np.float64),
    )
