"""Operators on the function's value: they offset or thicken the surface, or mix two shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from pydantic import Field

from voxsoft import _core
from voxsoft.errors import ShapeError
from voxsoft.records import Name
from voxsoft.shapes.base import Scope, Shape
from voxsoft.shapes.expressions import ExpressionText
from voxsoft.shapes.periodic import Periodic
from voxsoft.units import Dimensionless, Length, PositiveLength

if TYPE_CHECKING:
    from voxsoft.shapes.catalog import AnyShape

__all__ = [
    "Blend",
    "Grade",
    "Offset",
    "Shell",
]


class Offset(Shape):
    """The shape grown on all sides, or shrunk by a negative distance.

    Examples
    --------
    >>> from voxsoft.shapes import Sphere
    >>> Sphere(radius=0.01).offset(0.002).evaluate([[0.012, 0, 0]])
    array([0.])
    """

    kind: Literal["offset"] = "offset"
    of: Name | AnyShape = Field(description="Name of a shape, or a shape.")
    distance: Length = Field(description="Distance by which the surface moves outward.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return scope.build(self.of).offset(self.distance)


class Shell(Shape):
    """A wall around the surface of a shape, |s| < thickness/2: Algorithm 1 of the paper.

    Examples
    --------
    >>> from voxsoft.shapes import Sphere
    >>> Sphere(radius=0.01).shell(0.002).evaluate([[0.01, 0, 0], [0, 0, 0]])
    array([-0.001,  0.009])
    """

    kind: Literal["shell"] = "shell"
    of: Name | AnyShape = Field(description="Name of a shape, or a shape.")
    thickness: PositiveLength = Field(description="Thickness, half of it on each side.")

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return scope.build(self.of).shell(self.thickness)


class Blend(Shape):
    """A shape between two: the weighted mean of their functions.

    Examples
    --------
    >>> from voxsoft.shapes import Sphere
    >>> between = Blend(of=(Sphere(radius=0.01), Sphere(radius=0.02)), weight=0.5)
    >>> between.evaluate([[0.015, 0, 0]]).round(12) + 0.0
    array([0.])
    """

    kind: Literal["blend"] = "blend"
    of: tuple[Name | AnyShape, Name | AnyShape] = Field(description="Two names or shapes.")
    weight: Dimensionless | ExpressionText = Field(
        0.5,
        description="0 gives the first shape, 1 the second; or an expression of x, y, z in m.",
        union_mode="left_to_right",
    )

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        first, second = scope.build_all(self.of)
        weight = self.weight
        field = _core.Shape.expression(weight) if isinstance(weight, str) else weight
        return first.blend(second, field)


class Grade(Shape):
    """A lattice, shell or offset whose numbers vary from place to place.

    Expressions of x, y, z (m) replace the period or thickness (m) of a periodic lattice, the
    thickness of a shell, or the distance of an offset. With a graded period p the phase at x is
    2πx/p(x, y, z), so cells keep their shape only where p changes slowly over one cell. Bounds of a
    graded shell or offset are those that a search finds.

    Examples
    --------
    >>> from voxsoft.shapes import Gyroid
    >>> graded = Grade(of=Gyroid(period=0.01, thickness=0.001), thickness="0.001 + 0.05*z")
    >>> graded.kind
    'grade'
    """

    kind: Literal["grade"] = "grade"
    of: Name | AnyShape = Field(
        description="A periodic lattice, a shell or an offset, or its name."
    )
    thickness: ExpressionText | None = Field(
        None, description="Thickness (distance of an offset) in m, as an expression of x, y, z."
    )
    period: ExpressionText | None = Field(
        None, description="Period in m, as an expression of x, y, z."
    )

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        if self.thickness is None and self.period is None:
            raise ShapeError("thickness", "is missing", "grade the thickness, the period, or both")
        thickness = None if self.thickness is None else _core.Shape.expression(self.thickness)
        period = None if self.period is None else _core.Shape.expression(self.period)
        lattice = scope.resolve(self.of)
        if isinstance(lattice, Periodic):
            return lattice.make_graded(period, thickness)
        if not isinstance(lattice, Shell | Offset):
            what = f"a {lattice.kind} has nothing to grade"
            raise ShapeError("of", what, "give a periodic lattice, a shell or an offset")
        if period is not None or thickness is None:
            hint = "leave it out and grade the thickness"
            raise ShapeError("period", f"a {lattice.kind} has no period", hint)
        body = scope.build(lattice.of)
        return body.shell(thickness) if isinstance(lattice, Shell) else body.offset(thickness)
