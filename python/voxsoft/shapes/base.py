"""Base of all shapes: combination, motion, thickening, compilation and sampling."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field

from voxsoft import _core
from voxsoft.errors import ShapeError, VoxSoftError
from voxsoft.records import Record, closest

if TYPE_CHECKING:
    from voxsoft.shapes.booleans import Difference, Intersection, Union
    from voxsoft.shapes.expressions import Expression
    from voxsoft.shapes.repeats import Array, PolarArray
    from voxsoft.shapes.surfaces import Offset, Shell
    from voxsoft.shapes.transforms import Mirror, Rotate, Scale, Translate

Triple = tuple[float, float, float]

#: Largest depth of nested shapes, long before Python's own limit.
_DEEPEST = 100


class Shape(Record):
    """A solid described by a function s(x, y, z) that is negative inside.

    Shapes are immutable values: operators and methods give new ones. ``a | b`` is the union,
    ``a & b`` the intersection, ``a - b`` the difference. Required fields may be given by
    position, in the order of its signature; all else goes by name.

    Examples
    --------
    >>> from voxsoft.shapes import Box, Sphere
    >>> dented = Box(size=(0.04, 0.04, 0.01)) - Sphere(center=(0.02, 0.02, 0.01), radius=0.005)
    >>> dented.kind
    'difference'
    >>> dented.bounds()
    ((0.0, 0.0, 0.0), (0.04, 0.04, 0.01))
    """

    error_type: ClassVar[type[VoxSoftError]] = ShapeError

    kind: str = Field(description="Kind of the shape.")

    @classmethod
    def _positional(cls) -> tuple[str, ...]:
        """Names of required fields, which may be given by position: ``Sphere(5 * mm)``."""
        fields = cls.model_fields.items()
        return tuple(name for name, info in fields if info.is_required() and name != "kind")

    @abstractmethod
    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape; `scope` builds the operands."""

    def build(self, names: Mapping[str, Shape] | None = None) -> _core.Shape:
        """Return the shape in the compiled form that the sampler takes.

        Parameters
        ----------
        names : mapping of str to Shape, optional
            Shapes that operands given by name refer to.

        Raises
        ------
        ShapeError
            For sizes that do not fit together, unknown names and circular references.
        """
        return Scope(names or {}).build(self)

    def every(self, names: Mapping[str, Shape] | None = None) -> Iterator[Shape]:
        """Iterate over this shape and all of its operands, each once.

        Parameters
        ----------
        names : mapping of str to Shape, optional
            Shapes that operands given by name refer to; without it those are left out.

        Examples
        --------
        >>> from voxsoft.shapes import Box, Sphere
        >>> [shape.kind for shape in (Box(size=(1, 1, 1)) - Sphere(radius=0.5)).every()]
        ['difference', 'box', 'sphere']
        """
        known = dict(names or {})
        ahead: list[str | Shape] = [self]
        while ahead:
            found = ahead.pop()
            # Removed on the first visit, so that a name is followed once, also if it refers to
            # itself.
            shape = known.pop(found, None) if isinstance(found, str) else found
            if shape is not None:
                yield shape
                below = getattr(shape, "of", ())
                ahead += reversed(below if isinstance(below, tuple) else (below,))

    def evaluate(
        self, points: ArrayLike, names: Mapping[str, Shape] | None = None
    ) -> NDArray[np.float64]:
        """Return s at `points`, in float64: negative inside.

        Parameters
        ----------
        points : array_like, shape (n, 3)
            Points [m].
        names : mapping of str to Shape, optional
            Shapes that operands given by name refer to.

        Returns
        -------
        numpy.ndarray, shape (n,)
            Signed distances [m] where the shape is a true distance; NaN where it has no value.

        Examples
        --------
        >>> from voxsoft.shapes import Sphere
        >>> Sphere(radius=0.01).evaluate([[0.0, 0.0, 0.03]])
        array([0.02])
        """
        places = np.ascontiguousarray(points, dtype=np.float64)
        if places.ndim != 2 or places.shape[1] != 3:
            raise ShapeError("points", f"has shape {places.shape}; expected (n, 3)")
        return self.build(names).evaluate(places)

    def bounds(self, names: Mapping[str, Shape] | None = None) -> tuple[Triple, Triple]:
        """Return the lowest and highest corner [m] of a box that contains the shape.

        A side is infinite where the shape has no end (a half-space, a gyroid). The box may be
        larger than the shape, never smaller.

        Examples
        --------
        >>> from voxsoft.shapes import Cylinder
        >>> Cylinder(radius=0.01, height=0.02, axis="x").bounds()
        ((0.0, -0.01, -0.01), (0.02, 0.01, 0.01))
        """
        return self.build(names).bounds()

    def __or__(self, other: Shape) -> Union:
        from voxsoft.shapes.booleans import Union

        return Union(of=(*_flat(self, Union), *_flat(other, Union)))

    def __and__(self, other: Shape) -> Intersection:
        from voxsoft.shapes.booleans import Intersection

        return Intersection(of=(*_flat(self, Intersection), *_flat(other, Intersection)))

    def __sub__(self, other: Any) -> Difference | Expression:  # noqa: ANN401 - see Expression
        from voxsoft.shapes.booleans import Difference

        if not isinstance(other, Shape):
            return NotImplemented
        return Difference(of=(self, other))

    def translate(self, by: Sequence[float | str]) -> Translate:
        """Return the shape moved by three lengths [m]."""
        from voxsoft.shapes.transforms import Translate

        return Translate(of=self, by=by)

    def rotate(
        self,
        angle: float | str,
        axis: str | Sequence[float] = "z",
        center: Sequence[float | str] = (0, 0, 0),
    ) -> Rotate:
        """Return the shape turned by `angle` [rad] around `axis` through `center`."""
        from voxsoft.shapes.transforms import Rotate

        return Rotate(of=self, angle=angle, axis=axis, center=center)

    def scale(
        self, factor: float | Sequence[float], center: Sequence[float | str] = (0, 0, 0)
    ) -> Scale:
        """Return the shape enlarged by one factor, or by one for each axis, from `center`."""
        from voxsoft.shapes.transforms import Scale

        return Scale(of=self, factor=factor, center=center)

    def mirror(
        self,
        normal: str | Sequence[float],
        point: Sequence[float | str] = (0, 0, 0),
        *,
        keep: bool = False,
    ) -> Mirror:
        """Return the mirror image across a plane; with `keep`, the shape and its image."""
        from voxsoft.shapes.transforms import Mirror

        return Mirror(of=self, normal=normal, point=point, keep=keep)

    def array(self, count: Sequence[int], spacing: Sequence[float | str]) -> Array:
        """Return `count` copies along x, y, z, `spacing` [m] apart."""
        from voxsoft.shapes.repeats import Array

        return Array(of=self, count=count, spacing=spacing)

    def polar_array(self, count: int, **arguments: Any) -> PolarArray:  # noqa: ANN401
        """Return `count` copies around an axis; see :class:`PolarArray` for the arguments."""
        from voxsoft.shapes.repeats import PolarArray

        return PolarArray(of=self, count=count, **arguments)

    def offset(self, distance: float | str) -> Offset:
        """Return the shape grown by `distance` [m], or shrunk by a negative one."""
        from voxsoft.shapes.surfaces import Offset

        return Offset(of=self, distance=distance)

    def shell(self, thickness: float | str) -> Shell:
        """Return the wall of `thickness` [m] around the surface: |s| < thickness/2."""
        from voxsoft.shapes.surfaces import Shell

        return Shell(of=self, thickness=thickness)


def _flat(shape: Shape, kind: type[Union] | type[Intersection]) -> tuple[str | Shape, ...]:
    """Flatten a sharp union in a union, so that a long sum of shapes stays shallow."""
    if isinstance(shape, kind) and shape.smooth == 0:
        return shape.of
    return (shape,)


class Scope:
    """Shapes that names refer to, while one shape is built.

    Parameters
    ----------
    names
        Shapes by name.
    """

    def __init__(self, names: Mapping[str, Shape]) -> None:
        self._names = names
        self._built: dict[str, _core.Shape] = {}
        self._open: list[str] = []
        self._depth = 0

    def resolve(self, operand: str | Shape) -> Shape:
        """Return an operand, or the shape that it names."""
        if isinstance(operand, Shape):
            return operand
        if operand not in self._names:
            raise ShapeError("", f'"{operand}" is not a shape', closest(operand, self._names))
        return self._names[operand]

    def build(self, operand: str | Shape) -> _core.Shape:
        """Build an operand; a named one only once."""
        if isinstance(operand, Shape):
            return self._make(operand, operand.kind)
        if operand in self._open:
            circle = " -> ".join([*self._open[self._open.index(operand) :], operand])
            raise ShapeError(operand, f"refers to itself: {circle}", "break the circle")
        if operand not in self._built:
            shape = self.resolve(operand)
            self._open.append(operand)
            self._built[operand] = self._make(shape, operand)
            self._open.pop()
        return self._built[operand]

    def build_all(self, operands: Sequence[str | Shape]) -> list[_core.Shape]:
        """Build several operands."""
        return [self.build(operand) for operand in operands]

    def _make(self, shape: Shape, label: str) -> _core.Shape:
        self._depth += 1
        if self._depth > _DEEPEST:
            raise ShapeError(label, f"shapes are nested deeper than {_DEEPEST} levels")
        try:
            made = shape.make(self)
        except ShapeError as error:
            where = ".".join(part for part in (label, error.where) if part)
            raise ShapeError(where, error.what, error.hint) from None
        self._depth -= 1
        return made
