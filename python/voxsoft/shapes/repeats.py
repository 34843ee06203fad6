"""Shapes repeated along the axes or around one."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from voxsoft import _core
from voxsoft.records import Name
from voxsoft.shapes.base import Scope, Shape
from voxsoft.units import Angle, Point
from voxsoft.units.axis import Axis, direction

if TYPE_CHECKING:
    from voxsoft.shapes.catalog import AnyShape

__all__ = [
    "Array",
    "PolarArray",
]

#: A number of copies; the core refuses more than this many in all.
Count = Annotated[int, Field(ge=1, le=4096)]


class Array(Shape):
    """Copies of a shape along the axes, at most 4096.

    Examples
    --------
    >>> from voxsoft.shapes import Sphere
    >>> row = Sphere(radius=0.002).array((5, 1, 1), (0.01, 0, 0))
    >>> row.evaluate([[0.04, 0, 0]])
    array([-0.002])
    """

    kind: Literal["array"] = "array"
    of: Name | AnyShape = Field(description="Name of a shape, or a shape.")
    count: tuple[Count, Count, Count] = Field(description="Copies along x, y, z.")
    spacing: Point = Field(description="From one copy to the next along x, y, z.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return scope.build(self.of).array(self.count, self.spacing)


class PolarArray(Shape):
    """Copies of a shape around an axis, at most 4096.

    A full turn spaces them evenly; a part of a turn puts copies at both of its ends.

    Examples
    --------
    >>> from voxsoft.shapes import Sphere
    >>> ring = Sphere(radius=0.002, center=(0.01, 0, 0)).polar_array(4)
    >>> ring.evaluate([[-0.01, 0, 0], [0, -0.01, 0]])
    array([-0.002, -0.002])
    """

    kind: Literal["polar-array"] = "polar-array"
    of: Name | AnyShape = Field(description="Name of a shape, or a shape.")
    count: Count = Field(description="Number of copies.")
    angle: Angle = Field(2 * math.pi, description="Angle over which they spread; a full turn.")
    axis: Axis = Field("z", description="Axis: x, y, z or three numbers.")
    center: Point = Field((0.0, 0.0, 0.0), description="A point of the axis; the origin.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        axis = direction(self.axis)
        return scope.build(self.of).polar_array(self.count, axis, self.angle, self.center)
