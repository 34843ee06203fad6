"""Draft: upright walls of a casting that lean, so that its mold leaves with less friction."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from voxsoft.fabrication.draw import ABOVE, BELOW, WITHIN, Draw
from voxsoft.fabrication.fields import Field, Floats
from voxsoft.fabrication.sampled import Grid, Sampled


@dataclass(frozen=True, eq=False)
class Drafted:
    """Casting whose upright sides lean by an angle, thicker toward the parting plane.

    A side of the upper part leaves the casting's shape by the tangent of the angle times the depth
    below the top; one of the lower part, by that times the height above the bottom. Both are
    largest at the parting plane, where a step as high as their difference is left. Sides that slope
    by themselves move by the sine of the angle between them and the level; level faces stay.

    Attributes
    ----------
    of
        The casting.
    draw
        Division between both parts of its mold.
    grid
        Positions of the samples of the division.
    slope
        Tangent of the angle.
    """

    of: Field
    draw: Draw = field(repr=False)
    grid: Grid = field(repr=False)
    slope: float

    @property
    def largest(self) -> float:
        """Largest distance [m] between its sides and those of the casting."""
        draw = self.draw
        if draw.is_open:
            return self.slope * (draw.top - draw.bottom)
        deeper = max(draw.top - draw.parting, draw.parting - draw.bottom)
        inner = draw.top - draw.bottom if draw.has_recess else 0.0
        return self.slope * max(deeper, inner)

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        draw, half = self.draw, self.grid.step / 2.0
        values = self.of.evaluate(points)
        up = np.array([0.0, 0.0, half])
        rise = (self.of.evaluate(points + up) - self.of.evaluate(points - up)) / (2.0 * half)
        height = points[:, 2]
        sides = draw.sides[self.grid.nearest(points)]
        plane = np.where(sides == WITHIN, draw.bottom, draw.parting)
        is_upper = (sides == ABOVE) | ((sides != BELOW) & (height > plane))
        away = np.where(is_upper, draw.top - height, height - draw.bottom)
        steep = np.sqrt(np.clip(1.0 - rise * rise, 0.0, 1.0))
        grown = values - self.slope * np.maximum(away, 0.0) * steep
        found: Floats = np.maximum(grown, np.maximum(height - draw.top, draw.bottom - height))
        return found


def drafted(casting: Sampled, draw: Draw, slope: float) -> Sampled:
    """Return a casting with draft, sampled anew near its surface.

    Parameters
    ----------
    casting
        The casting in the frame of its mold.
    draw
        Division between both parts.
    slope
        Tangent of the angle.

    Examples
    --------
    >>> from voxsoft.fabrication.draw import draw_along
    >>> from voxsoft.fabrication.fields import Box
    >>> box = Box((0.0, 0.0, 0.0), (0.01, 0.01, 0.005))
    >>> grid = Grid.around(np.zeros(3), np.array([0.01, 0.01, 0.005]), 0.0005, 0.002)
    >>> values = grid.values(box)
    >>> found = drafted(Sampled(box, grid, values), draw_along(values, grid, 0.005, 0.0), 0.1)
    >>> round(float(found.of.evaluate(np.array([[0.01, 0.005, 0.004]]))[0]), 6)
    -0.0004
    """
    grid = casting.grid
    leaning = Drafted(casting.of, draw, grid, slope)
    near = np.abs(casting.values) < leaning.largest + 4.0 * grid.step
    values = casting.values.copy()
    values[near] = leaning.evaluate(grid.points(np.argwhere(near)))
    return Sampled(leaning, grid, values)
