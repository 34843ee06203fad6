"""Division of the space around a casting between two mold parts that are drawn apart.

Each point outside the casting goes with the part that can leave along its direction without the
casting in its way: up, if nothing of the casting is above it; down, if nothing is below it. Where
both are possible, which is beside the casting, a plane decides: the parting plane. A point that
can leave in neither direction is an undercut.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.fabrication.fields import Floats
from voxsoft.fabrication.sampled import Grid

Bools = NDArray[np.bool_]

#: Depth of an undercut [m] that counts as none: the noise of samples of a side along the draw, and
#: less than any printer keeps.
SHALLOW: Final = 0.1e-3
#: Sides that a point outside the casting belongs to.
BESIDE, ABOVE, BELOW, WITHIN = 0, 1, 2, 3


@dataclass(frozen=True, eq=False)
class Draw:
    """Division between an upper and a lower mold part, along z.

    Attributes
    ----------
    sides : ndarray of int8, shape (nx, ny, nz)
        Side of each sample: above, although it is below the parting plane; below, although it is
        above it; beside, where the plane decides; or within a hole that goes through. Samples in
        the casting have that of a neighbor, which is not "beside" if they have one.
    parting
        Height of the parting plane [m].
    top, bottom
        Height of the highest and the lowest point of the casting [m].
    undercut
        Volume that neither part can leave [m³].
    place
        Middle of the largest such region [m]; None without one.
    steps
        Mean height of vertical faces between both parts along the outline [m]: zero where the
        outline lies in the parting plane or on upright sides.
    has_recess
        True where the upper part reaches into the casting.
    is_level
        True where the top of the casting is flat: nothing between it and its highest point.
    """

    sides: NDArray[np.int8] = field(repr=False)
    parting: float
    top: float
    bottom: float
    undercut: float
    place: Floats | None
    steps: float
    has_recess: bool
    is_level: bool

    @property
    def is_open(self) -> bool:
        """True where the upper part is only a flat lid, which can be left out."""
        return self.is_level and self.parting >= self.top


def draw_along(values: Floats, grid: Grid, top: float, bottom: float) -> Draw:
    """Divide the space around a casting, whose samples are given, along z.

    Parameters
    ----------
    values
        Samples of the casting, negative inside, (nx, ny, nz) [m].
    grid
        Positions of the samples.
    top, bottom
        Exact heights of the highest and the lowest point of the casting [m].

    Examples
    --------
    >>> from voxsoft.fabrication.fields import Box
    >>> box = Box((0.0, 0.0, 0.0), (0.01, 0.01, 0.005))
    >>> grid = Grid.around(np.zeros(3), np.array([0.01, 0.01, 0.005]), 0.0005, 0.002)
    >>> found = draw_along(grid.values(box), grid, 0.005, 0.0)
    >>> found.undercut, found.is_open
    (0.0, True)
    """
    inside = values < 0.0
    solid = values < -SHALLOW
    over, under = _covered(solid[..., ::-1])[..., ::-1], _covered(solid)
    caught = (values > SHALLOW) & over & under
    outside = ~inside
    blocked_above = _covered(inside[..., ::-1])[..., ::-1]
    blocked_below = _covered(inside)
    columns: Bools = np.asarray(inside.any(axis=2))
    outer = _outer(~columns)
    # Ties within the depth that counts as none go with the nearer free side.
    sides = np.zeros(values.shape, np.int8)
    sides[outside & blocked_below] = ABOVE
    sides[outside & blocked_above & ~blocked_below] = BELOW
    both = outside & blocked_above & blocked_below
    sides[both & ~over] = ABOVE
    sides[both & over] = BELOW
    holes = ~columns & ~outer
    sides[holes] = WITHIN
    height, steps = _parting(inside, outer, grid, top, bottom)
    heights = grid.along(2)
    # Sides that the plane gives too are left to it: it is exact, and samples are not.
    sides[(sides == ABOVE) & (heights > height)] = BESIDE
    sides[(sides == BELOW) & (heights < height)] = BESIDE
    dips = (values > SHALLOW) & blocked_below & (heights < top - SHALLOW)
    recess = (sides == ABOVE) & (heights < height - grid.step)
    return Draw(
        sides=_filled(sides, inside),
        parting=height,
        top=top,
        bottom=bottom,
        undercut=float(caught.sum()) * grid.step**3,
        place=_largest(caught, grid),
        steps=steps,
        has_recess=bool(recess.any()),
        is_level=not dips.any(),
    )


def _covered(solid: Bools) -> Bools:
    """Return True for samples with the solid before them along the last axis."""
    covered: Bools = np.maximum.accumulate(solid, axis=2)
    return covered


def _outer(free: Bools) -> Bools:
    """Return the free columns that lead to the border of the grid."""
    from scipy import ndimage

    labels, _ = ndimage.label(free)
    outer: Bools = free & (labels == labels[0, 0])
    return outer


def _parting(
    inside: Bools, outer: Bools, grid: Grid, top: float, bottom: float
) -> tuple[float, float]:
    """Return the height of the parting plane [m], and the mean step at the outline [m].

    Along the outline a column of the casting stands beside a free one. Where the plane is above
    the column's top or below its bottom, both parts meet at an upright face between. The sum of
    these heights is a convex function of the plane's height, least between the two medians of all
    bottoms and tops. There the top of the casting is taken, which needs no lid, else its bottom,
    else the middle.
    """
    columns = inside.any(axis=2)
    beside = np.zeros_like(columns)
    beside[1:] |= outer[:-1]
    beside[:-1] |= outer[1:]
    beside[:, 1:] |= outer[:, :-1]
    beside[:, :-1] |= outer[:, 1:]
    outline = columns & beside
    rows = inside[outline]
    heights = grid.along(2)
    low = heights[rows.argmax(axis=1)] - grid.step / 2
    high = heights[rows.shape[1] - 1 - rows[:, ::-1].argmax(axis=1)] + grid.step / 2
    ends = np.sort(np.concatenate([low, high]))
    least, most = (float(each) for each in ends[len(ends) // 2 - 1 : len(ends) // 2 + 1])
    at = (least + most) / 2.0
    if top - most < grid.step:
        at = top
    elif least - bottom < grid.step:
        at = bottom
    steps = np.maximum(at - high, 0.0) + np.maximum(low - at, 0.0)
    # Half a step is the noise of the samples.
    return at, float(np.maximum(steps - grid.step, 0.0).mean())


def _largest(caught: Bools, grid: Grid) -> Floats | None:
    from scipy import ndimage

    if not caught.any():
        return None
    labels, _ = ndimage.label(caught)
    largest = np.bincount(labels.ravel())[1:].argmax() + 1
    middle: Floats = grid.points(np.argwhere(labels == largest)).mean(axis=0)
    return middle


def _filled(sides: NDArray[np.int8], inside: Bools) -> NDArray[np.int8]:
    """Spread the sides that no plane decides by two samples into the casting."""
    sides = sides.copy()
    for _ in range(2):
        before = sides.copy()
        for axis in range(3):
            for way in (1, -1):
                here: list[slice] = [slice(None)] * 3
                there: list[slice] = [slice(None)] * 3
                here[axis] = slice(1, None) if way > 0 else slice(None, -1)
                there[axis] = slice(None, -1) if way > 0 else slice(1, None)
                own, near = sides[tuple(here)], before[tuple(there)]
                new = inside[tuple(here)] & (own == BESIDE) & (near != BESIDE)
                own[new] = near[new]
    return sides
