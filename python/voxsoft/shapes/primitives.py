"""Solids with a closed form; all are true distances but the ellipsoid (first order)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from voxsoft import _core
from voxsoft.errors import ShapeError
from voxsoft.shapes.base import Scope, Shape
from voxsoft.units import Length, NonNegativeLength, Point, PositiveLength
from voxsoft.units.axis import Axis, direction

__all__ = [
    "Box",
    "Capsule",
    "Cone",
    "Cylinder",
    "Ellipsoid",
    "HalfSpace",
    "Prism",
    "Revolve",
    "RoundedBox",
    "Sphere",
    "Torus",
    "Tube",
]

#: Three edges or half axes, each positive.
Size = tuple[PositiveLength, PositiveLength, PositiveLength]
#: Corners of a polygon in a plane.
Ring = Annotated[tuple[tuple[Length, Length], ...], Field(min_length=3)]

_ORIGIN = (0.0, 0.0, 0.0)


class _CornerOrCenter(Shape):
    """A box placed by its lowest corner or by its center."""

    size: Size = Field(description="Edges along x, y, z.")
    corner: Point | None = Field(None, description="Lowest corner; the origin by default.")
    center: Point | None = Field(None, description="Center, instead of the corner.")

    @model_validator(mode="after")
    def _has_one_place(self) -> _CornerOrCenter:
        if self.corner is not None and self.center is not None:
            hint = "leave one of them out"
            raise ShapeError("center", "both corner and center came; a box has one place", hint)
        return self

    @property
    def middle(self) -> tuple[float, float, float]:
        """Center of the box [m]."""
        if self.center is not None:
            return self.center
        (x, y, z), (a, b, c) = self.corner or _ORIGIN, self.size
        return (x + a / 2, y + b / 2, z + c / 2)


class Box(_CornerOrCenter):
    """A box with edges along the axes.

    Examples
    --------
    >>> Box(size=("100 mm", "10 mm", "10 mm")).bounds()
    ((0.0, 0.0, 0.0), (0.1, 0.01, 0.01))
    """

    kind: Literal["box"] = "box"

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return _core.Shape.cuboid(self.middle, self.size)


class RoundedBox(_CornerOrCenter):
    """A box with rounded edges and corners.

    Examples
    --------
    >>> RoundedBox(size=(0.02, 0.02, 0.02), radius=0.002).kind
    'rounded-box'
    """

    kind: Literal["rounded-box"] = "rounded-box"
    radius: PositiveLength = Field(
        description="Radius of the edges, at most half the shortest edge."
    )

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return _core.Shape.rounded_box(self.middle, self.size, self.radius)


class Sphere(Shape):
    """A ball.

    Examples
    --------
    >>> Sphere(radius="10 mm").evaluate([[0, 0, 0]])
    array([-0.01])
    >>> Sphere("10 mm") == Sphere(radius=0.01)
    True
    """

    kind: Literal["sphere"] = "sphere"
    radius: PositiveLength = Field(description="Radius.")
    center: Point = Field(_ORIGIN, description="Center; the origin by default.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return _core.Shape.sphere(self.center, self.radius)


class Ellipsoid(Shape):
    """An ellipsoid along the axes; a distance to first order near its surface.

    Examples
    --------
    >>> Ellipsoid(radii=(0.02, 0.01, 0.01)).bounds()
    ((-0.02, -0.01, -0.01), (0.02, 0.01, 0.01))
    """

    kind: Literal["ellipsoid"] = "ellipsoid"
    radii: Size = Field(description="Half axes along x, y, z.")
    center: Point = Field(_ORIGIN, description="Center; the origin by default.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return _core.Shape.ellipsoid(self.center, self.radii)


class _Upright(Shape):
    """A solid that stands on `base` and points along `axis`."""

    base: Point = Field(_ORIGIN, description="Center of the bottom; the origin by default.")
    axis: Axis = Field("z", description="Direction from the bottom up: x, y, z or three numbers.")


class Cylinder(_Upright):
    """A solid cylinder.

    Examples
    --------
    >>> Cylinder(radius="25 mm", height="35 mm").bounds()
    ((-0.025, -0.025, 0.0), (0.025, 0.025, 0.035))
    """

    kind: Literal["cylinder"] = "cylinder"
    radius: PositiveLength = Field(description="Radius.")
    height: PositiveLength = Field(description="Height from the base along the axis.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return _core.Shape.cylinder(self.base, direction(self.axis), self.radius, self.height)


class Tube(_Upright):
    """A cylinder with a hole along its axis, open at both ends.

    Examples
    --------
    >>> Tube(radius=0.01, wall=0.002, height=0.05).evaluate([[0, 0, 0.025]])
    array([0.008])
    """

    kind: Literal["tube"] = "tube"
    radius: PositiveLength = Field(description="Outer radius.")
    wall: PositiveLength = Field(description="Wall thickness, less than the radius.")
    height: PositiveLength = Field(description="Height from the base along the axis.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        axis = direction(self.axis)
        return _core.Shape.tube(self.base, axis, self.radius, self.wall, self.height)


class Cone(_Upright):
    """A cone, or a frustum where both radii are positive.

    Examples
    --------
    >>> Cone(radius=0.01, height=0.02).bounds()
    ((-0.01, -0.01, 0.0), (0.01, 0.01, 0.02))
    """

    kind: Literal["cone"] = "cone"
    radius: NonNegativeLength = Field(description="Radius at the base.")
    top_radius: NonNegativeLength = Field(0.0, description="Radius at the top; 0 by default.")
    height: PositiveLength = Field(description="Height from the base along the axis.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        axis = direction(self.axis)
        return _core.Shape.cone(self.base, axis, self.radius, self.top_radius, self.height)


class Capsule(Shape):
    """All points within a radius of a segment: a rod with round ends.

    Examples
    --------
    >>> Capsule(start=(0, 0, 0), end=(0.03, 0, 0), radius=0.005).evaluate([[0.015, 0, 0]])
    array([-0.005])
    """

    kind: Literal["capsule"] = "capsule"
    start: Point = Field(description="One end of the segment.")
    end: Point = Field(description="The other end.")
    radius: PositiveLength = Field(description="Radius.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return _core.Shape.capsule(self.start, self.end, self.radius)


class Torus(Shape):
    """A ring.

    Examples
    --------
    >>> Torus(radius=0.02, tube_radius=0.005).evaluate([[0.02, 0, 0]])
    array([-0.005])
    """

    kind: Literal["torus"] = "torus"
    radius: PositiveLength = Field(description="From the center to the middle of the tube.")
    tube_radius: PositiveLength = Field(description="Radius of the tube.")
    center: Point = Field(_ORIGIN, description="Center; the origin by default.")
    axis: Axis = Field("z", description="Axis of the ring: x, y, z or three numbers.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return _core.Shape.torus(self.center, direction(self.axis), self.radius, self.tube_radius)


class HalfSpace(Shape):
    """Everything on one side of a plane.

    Examples
    --------
    >>> HalfSpace(normal="z").bounds()
    ((-inf, -inf, -inf), (inf, inf, 0.0))
    """

    kind: Literal["half-space"] = "half-space"
    point: Point = Field(_ORIGIN, description="A point of the plane; the origin by default.")
    normal: Axis = Field("z", description="Direction out of the solid: x, y, z or three numbers.")

    @classmethod
    def _positional(cls) -> tuple[str, ...]:
        """Normal and point, which both have a default."""
        return ("normal", "point")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return _core.Shape.half_space(self.point, direction(self.normal))


class Prism(_Upright):
    """A polygon extruded along an axis.

    The polygon lies in the plane across the axis: its coordinates are x, y for the axis z, y, z
    for x, and z, x for y. Either orientation works; one that crosses itself is inside where a ray
    to infinity crosses an odd number of edges.

    Examples
    --------
    >>> Prism(points=[(0, 0), (0.02, 0), (0, 0.02)], height=0.01).bounds()
    ((0.0, 0.0, 0.0), (0.02, 0.02, 0.01))
    """

    kind: Literal["prism"] = "prism"
    points: Ring = Field(description="Corners of the polygon, at least three.")
    height: PositiveLength = Field(description="Height from the base along the axis.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        axis = direction(self.axis)
        return _core.Shape.prism(self.base, axis, list(self.points), self.height)


class Revolve(_Upright):
    """A profile turned once around an axis.

    Examples
    --------
    >>> Revolve(points=[(0, 0), (0.01, 0), (0, 0.01)]).evaluate([[0, 0, 0.002]])
    array([-0.002])
    """

    kind: Literal["revolve"] = "revolve"
    points: Ring = Field(description="Profile as (radius, height), at least three corners.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return _core.Shape.revolve(self.base, direction(self.axis), list(self.points))
