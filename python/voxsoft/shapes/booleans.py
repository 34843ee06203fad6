"""Union, intersection and difference, sharp or with filled and rounded edges."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from voxsoft import _core
from voxsoft.records import Name
from voxsoft.shapes.base import Scope, Shape
from voxsoft.units import NonNegativeLength

if TYPE_CHECKING:
    from voxsoft.shapes.catalog import AnyShape

__all__ = [
    "Difference",
    "Intersection",
    "Union",
]


class _Combination(Shape):
    """Several shapes made one."""

    of: Annotated[tuple[Name | AnyShape, ...], Field(min_length=1)] = Field(
        description="Names of shapes, or shapes."
    )

    def __init__(self, /, *shapes: Any, **data: Any) -> None:  # noqa: ANN401 - fields are typed
        if len(shapes) > 1 or (shapes and isinstance(shapes[0], (str, Shape))):
            shapes = (shapes,)
        super().__init__(*shapes, **data)

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]  # see Record

    smooth: NonNegativeLength = Field(
        0.0, description="Length over which edges between shapes are blended; 0 keeps them sharp."
    )


class Union(_Combination):
    """Everything that is in at least one of the shapes.

    Examples
    --------
    >>> from voxsoft.shapes import Box, Sphere
    >>> (Box(size=(0.01, 0.01, 0.01)) | Sphere(radius=0.002)).bounds()
    ((-0.002, -0.002, -0.002), (0.01, 0.01, 0.01))
    """

    kind: Literal["union"] = "union"

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return _core.Shape.union(scope.build_all(self.of), self.smooth)


class Intersection(_Combination):
    """Everything that is in all of the shapes.

    Examples
    --------
    >>> from voxsoft.shapes import Box, Gyroid
    >>> (Box(size=(0.02, 0.02, 0.02)) & Gyroid(period=0.01, thickness=0.001)).bounds()
    ((0.0, 0.0, 0.0), (0.02, 0.02, 0.02))
    """

    kind: Literal["intersection"] = "intersection"

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return _core.Shape.intersection(scope.build_all(self.of), self.smooth)


class Difference(_Combination):
    """The first shape without the others.

    Examples
    --------
    >>> from voxsoft.shapes import Cylinder
    >>> names = {
    ...     "outer": Cylinder(radius=0.025, height=0.035),
    ...     "cavity": Cylinder(radius=0.02, height=0.025, base=(0, 0, 0.005)),
    ... }
    >>> Difference(of=["outer", "cavity"]).evaluate([[0, 0, 0.02]], names) > 0
    array([ True])
    """

    kind: Literal["difference"] = "difference"

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return _core.Shape.difference(scope.build_all(self.of), self.smooth)
