"""Solids as functions that are negative inside, in the frame in which a mold stands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.shapes.sharpening import Evaluated

Floats = NDArray[np.float64]


class Field(Evaluated, Protocol):
    """Function of points that is negative inside a solid."""

    def evaluate(self, points: Floats) -> Floats:
        """Return its values [m] at points (n, 3) [m]."""


@dataclass(frozen=True, eq=False)
class Frame:
    """Axes in which a mold stands: z is the direction of draw, up.

    Attributes
    ----------
    rows : ndarray, shape (3, 3)
        Its axes in the frame of the design; each is one of the axes there, or opposite to one.
    """

    rows: Floats

    @classmethod
    def along(cls, axis: int, sign: int) -> Frame:
        """Return the frame whose z axis is an axis of the design, or opposite to one.

        Examples
        --------
        >>> Frame.along(0, -1).rows[2]
        array([-1.,  0.,  0.])
        """
        unit = np.eye(3)
        up = sign * unit[axis]
        right = unit[(axis + 1) % 3]
        return cls(np.stack([right, np.cross(up, right), up]) + 0.0)

    def local(self, points: Floats) -> Floats:
        """Return points of the design (n, 3) in this frame."""
        inside: Floats = points @ self.rows.T
        return inside

    def world(self, points: Floats) -> Floats:
        """Return points of this frame (n, 3) in that of the design."""
        outside: Floats = points @ self.rows
        return outside


@dataclass(frozen=True, eq=False)
class Parts:
    """Union of shapes of a design without others that have precedence.

    Attributes
    ----------
    shapes
        Shapes that are joined.
    without
        Shapes that are cut out.
    """

    shapes: Sequence[_core.Shape]
    without: Sequence[_core.Shape] = ()

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        points = np.ascontiguousarray(points)
        values = _least(self.shapes, points)
        if self.without:
            values = np.maximum(values, -_least(self.without, points))
        return values


def _least(shapes: Sequence[_core.Shape], points: Floats) -> Floats:
    values = [np.nan_to_num(each.evaluate(points), nan=1.0, posinf=1.0) for each in shapes]
    least: Floats = values[0] if len(values) == 1 else np.min(values, axis=0)
    return least


@dataclass(frozen=True, eq=False)
class Turned:
    """Solid of the design in another frame."""

    of: Field
    frame: Frame

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m] of the frame."""
        return self.of.evaluate(self.frame.world(points))


@dataclass(frozen=True)
class HalfSpace:
    """All points on one side of a plane across an axis.

    Attributes
    ----------
    axis
        The axis, 0 to 2.
    at
        Position of the plane [m].
    side
        1 for the points above, -1 for those below.
    """

    axis: int
    at: float
    side: int

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        values: Floats = self.side * (self.at - points[:, self.axis])
        return values


@dataclass(frozen=True)
class Box:
    """Block between two corners [m]."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        outside = np.maximum(np.array(self.low) - points, points - np.array(self.high))
        values: Floats = outside.max(axis=1)
        return values


@dataclass(frozen=True)
class Frustum:
    """Round bar along z whose radius changes evenly from its lower to its upper end.

    Attributes
    ----------
    center
        Its axis, x and y [m].
    low, high
        Heights of its ends [m].
    radius, top_radius
        Radii at these [m].
    """

    center: tuple[float, float]
    low: float
    high: float
    radius: float
    top_radius: float

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        share = np.clip((points[:, 2] - self.low) / (self.high - self.low), 0.0, 1.0)
        radius = self.radius + share * (self.top_radius - self.radius)
        aside = np.hypot(points[:, 0] - self.center[0], points[:, 1] - self.center[1]) - radius
        values: Floats = np.maximum(aside, self.low - points[:, 2])
        return np.maximum(values, points[:, 2] - self.high)

    def volume(self, low: float, high: float) -> float:
        """Return its volume [m³] between two heights [m] within its ends."""
        ends = (np.array([low, high]) - self.low) / (self.high - self.low)
        a, b = self.radius + ends * (self.top_radius - self.radius)
        return float(np.pi / 3.0 * (high - low) * (a * a + a * b + b * b))


@dataclass(frozen=True, eq=False)
class Joined:
    """Union of solids."""

    of: Sequence[Field]

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        values: Floats = np.min([each.evaluate(points) for each in self.of], axis=0)
        return values


@dataclass(frozen=True, eq=False)
class Common:
    """Intersection of solids."""

    of: Sequence[Field]

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        values: Floats = np.max([each.evaluate(points) for each in self.of], axis=0)
        return values


@dataclass(frozen=True, eq=False)
class Outside:
    """All points that are not in a solid."""

    of: Field

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        values: Floats = -self.of.evaluate(points)
        return values
