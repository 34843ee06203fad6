"""Shapes from a Python function."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, WithJsonSchema, field_serializer, model_validator

from voxsoft import _core
from voxsoft.errors import ShapeError
from voxsoft.shapes.base import Scope, Shape
from voxsoft.units import Point

__all__ = [
    "Function",
]

_NotInFiles = WithJsonSchema({"not": {}, "description": "Python only; a file cannot hold code."})


class Function(Shape):
    """The points within a box where a vectorized Python function is negative.

    The function is called with three arrays of the same shape (n,), x, y, z in m, and returns one
    value for each; from several threads, though never at the same time. It is asked at every
    cell of the box: an :class:`Expression` is faster, and can be saved, which a function cannot.

    Examples
    --------
    >>> import numpy as np
    >>> ball = Function(
    ...     function=lambda x, y, z: np.sqrt(x**2 + y**2 + z**2) - 0.01,
    ...     low=(-0.02, -0.02, -0.02),
    ...     high=(0.02, 0.02, 0.02),
    ... )
    >>> ball.evaluate([[0, 0, 0]])
    array([-0.01])
    """

    kind: Literal["function"] = "function"
    function: Annotated[Callable[..., Any], _NotInFiles] = Field(
        description="Takes arrays x, y, z; returns an array that is negative inside."
    )
    low: Point = Field(description="Lowest corner of the box that contains the shape.")
    high: Point = Field(description="Highest corner of the box.")

    @model_validator(mode="after")
    def _has_room(self) -> Function:
        if any(low >= high for low, high in zip(self.low, self.high, strict=True)):
            raise ShapeError("high", "must be above low along every axis")
        return self

    @field_serializer("function")
    def _refuse(self, function: Callable[..., Any]) -> str:
        raise ShapeError(
            "function", "a Python function cannot be saved", "write it as an Expression"
        )

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return _core.Shape.sampled(self._values, self.low, self.high, False)

    def _values(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        values = np.asarray(self.function(*points.T), dtype=np.float64)
        if values.shape not in ((), (len(points),)):
            what = f"returned an array of shape {values.shape} for {len(points)} points"
            raise ShapeError("function", what, "return one value for each point")
        return np.ascontiguousarray(np.broadcast_to(values, len(points)))
