"""Transforms of shapes: translation, rotation, scaling, mirror images and deformations."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from voxsoft import _core
from voxsoft.records import Name
from voxsoft.shapes.base import Scope, Shape, Triple
from voxsoft.units import Angle, Point, PositiveLength, UnitOf
from voxsoft.units.axis import Axis, direction

if TYPE_CHECKING:
    from voxsoft.shapes.catalog import AnyShape

__all__ = [
    "Bend",
    "Mirror",
    "Rotate",
    "Scale",
    "Taper",
    "Translate",
    "Twist",
]

_ORIGIN = (0.0, 0.0, 0.0)
_Factor = Annotated[float, UnitOf("number", positive=True)]


class _OfOne(Shape):
    """A shape made from one other."""

    of: Name | AnyShape = Field(description="Name of a shape, or a shape.")


class Translate(_OfOne):
    """A shape moved.

    Examples
    --------
    >>> from voxsoft.shapes import Sphere
    >>> Sphere(radius=0.01).translate((0.05, 0, 0)).bounds()
    ((0.04, -0.01, -0.01), (0.060000000000000005, 0.01, 0.01))
    """

    kind: Literal["translate"] = "translate"
    by: Point = Field(description="Distance along x, y, z.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return scope.build(self.of).translate(self.by)


class Rotate(_OfOne):
    """A shape turned around an axis, right-handed.

    Examples
    --------
    >>> from voxsoft.shapes import Box
    >>> Box(size=(0.03, 0.01, 0.01)).rotate("90 deg").bounds()
    ((-0.01, 0.0, 0.0), (0.0, 0.03, 0.01))
    """

    kind: Literal["rotate"] = "rotate"
    angle: Angle = Field(description="Angle; counterclockwise seen from the tip of the axis.")
    axis: Axis = Field("z", description="Axis: x, y, z or three numbers.")
    center: Point = Field(_ORIGIN, description="A point that stays; the origin by default.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        axis = direction(self.axis)
        return scope.build(self.of).rotate(axis, self.angle, self.center)


class Scale(_OfOne):
    """A shape enlarged or shrunk.

    Examples
    --------
    >>> from voxsoft.shapes import Sphere
    >>> Sphere(radius=0.01).scale((1, 1, 2)).bounds()
    ((-0.01, -0.01, -0.02), (0.01, 0.01, 0.02))
    """

    kind: Literal["scale"] = "scale"
    factor: _Factor | tuple[_Factor, _Factor, _Factor] = Field(
        description="One factor, or one for each axis; distances stay true with one factor only."
    )
    center: Point = Field(_ORIGIN, description="A point that stays; the origin by default.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        factor = self.factor
        factors: Triple = factor if isinstance(factor, tuple) else (factor, factor, factor)
        return scope.build(self.of).scale(factors, self.center)


class Mirror(_OfOne):
    """The mirror image of a shape, alone or together with the shape.

    Examples
    --------
    >>> from voxsoft.shapes import Box
    >>> Box(size=(0.01, 0.01, 0.01)).mirror("x", keep=True).bounds()
    ((-0.01, 0.0, 0.0), (0.01, 0.01, 0.01))
    """

    kind: Literal["mirror"] = "mirror"
    normal: Axis = Field(description="Direction across the mirror: x, y, z or three numbers.")
    point: Point = Field(_ORIGIN, description="A point of the mirror; the origin by default.")
    keep: bool = Field(False, description="Keep the shape as well as its image.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        shape = scope.build(self.of)
        image = shape.mirror(self.point, direction(self.normal))
        return _core.Shape.union([shape, image], 0.0) if self.keep else image


class Twist(_OfOne):
    """A shape twisted around an axis: its sections turn in proportion to their height.

    Distances are stretched; take a shell or offset before twisting.

    Examples
    --------
    >>> from voxsoft.shapes import Box
    >>> bar = Box(size=(0.02, 0.01, 0.1), center=(0, 0, 0.05))
    >>> Twist(of=bar, angle="90 deg", height="100 mm").evaluate([[0, 0.009, 0.1]]) < 0.001
    array([ True])
    """

    kind: Literal["twist"] = "twist"
    angle: Angle = Field(description="Angle by which the section at `height` is turned.")
    height: PositiveLength = Field(description="Height above the center with this angle.")
    axis: Axis = Field("z", description="Axis: x, y, z or three numbers.")
    center: Point = Field(_ORIGIN, description="Point that does not turn; the origin by default.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        rate = self.angle / self.height
        return scope.build(self.of).twist(rate, direction(self.axis), self.center)


class Bend(_OfOne):
    """A shape bent into an arc.

    Lines along `axis` become circles around a point at a distance `radius` from the center on the
    side of `toward`; the line through `center` keeps its length.

    Examples
    --------
    >>> from voxsoft.shapes import Box
    >>> bar = Box(size=(0.01, 0.01, 0.1), center=(0, 0, 0.05))
    >>> bent = Bend(of=bar, radius=0.1, axis="z", toward="x")
    >>> bool(bent.bounds()[1][0] > 0.04)
    True
    """

    kind: Literal["bend"] = "bend"
    radius: PositiveLength = Field(description="Radius of the line through the center.")
    axis: Axis = Field("z", description="Direction along which the shape is bent.")
    toward: Axis = Field("x", description="Side of the arc's center; not parallel to the axis.")
    center: Point = Field(_ORIGIN, description="Point that does not move; the origin by default.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        axis, toward = direction(self.axis), direction(self.toward)
        return scope.build(self.of).bend(1 / self.radius, axis, toward, self.center)


class Taper(_OfOne):
    """A shape whose sections shrink or grow along an axis.

    Examples
    --------
    >>> from voxsoft.shapes import Cylinder
    >>> finger = Taper(of=Cylinder(radius=0.01, height=0.1), factor=0.5, height=0.1)
    >>> finger.evaluate([[0.006, 0, 0.1], [0.006, 0, 0.01]]) < 0
    array([False,  True])
    """

    kind: Literal["taper"] = "taper"
    factor: _Factor = Field(description="Scale of the section at `height` and above.")
    height: PositiveLength = Field(description="Height above the center with this factor.")
    axis: Axis = Field("z", description="Axis: x, y, z or three numbers.")
    center: Point = Field(_ORIGIN, description="Point with factor 1; the origin by default.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        axis = direction(self.axis)
        return scope.build(self.of).taper(self.factor, self.height, axis, self.center)
