"""Profiles: the share of an activation at each place of a part."""

from __future__ import annotations

import re
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator

from voxsoft import _core
from voxsoft.errors import DesignError, ShapeError
from voxsoft.records import Record
from voxsoft.units import Dimensionless, Length

Axis = Literal["x", "y", "z"]


class Profile(Record):
    """A factor on the value of an activation that differs from place to place.

    Places are those of the body as drawn, in its own frame.

    Parameters
    ----------
    axis
        Axis along which it changes, with `at` and `factor`.
    at
        Coordinates along the axis, rising; two at least.
    factor
        The factor at each of them: linear between, constant outside.
    expression
        A function of ``x``, ``y``, ``z`` in m in place of these; the functions of
        :class:`voxsoft.shapes.Expression`.

    Examples
    --------
    >>> hot_on_top = Profile(axis="z", at=["0 mm", "5 mm"], factor=[0, 1])
    >>> hot_on_top.values([[0.0, 0.0, 0.001], [0.0, 0.0, 0.009]]).tolist()
    [0.2, 1.0]
    >>> Profile(expression="1 - (x^2 + y^2) / 0.01^2").values([[0.005, 0.0, 0.0]]).tolist()
    [0.75]
    """

    axis: Axis | None = None
    at: tuple[Length, ...] = ()
    factor: tuple[Dimensionless, ...] = ()
    expression: str | None = None

    @model_validator(mode="after")
    def _check(self) -> Profile:
        table = self.axis is not None or self.at or self.factor
        if table and self.expression is not None:
            hint = "give axis, at and factor, or an expression"
            raise DesignError("", "has a table and an expression", hint)
        if self.expression is not None:
            self._function()
            return self
        if self.axis is None:
            hint = 'give axis = "z", at = ["0 mm", "5 mm"] and factor = [0, 1], or an expression'
            raise DesignError("axis", "is missing", hint)
        if len(self.at) < 2:
            raise DesignError("at", f"has {len(self.at)} of 2 places or more", "give its ends")
        if len(self.at) != len(self.factor):
            what = f"has {len(self.at)} places and {len(self.factor)} factors"
            raise DesignError("factor", what, "give one factor for each place")
        if any(later <= earlier for earlier, later in pairwise(self.at)):
            raise DesignError("at", "does not rise", "sort the places and drop repeats")
        return self

    def values(self, points: NDArray[np.float64] | list[list[float]]) -> NDArray[np.float64]:
        """Return the factor at points.

        Parameters
        ----------
        points : array_like, shape (n, 3)
            In m, in the frame of the body.
        """
        places = np.asarray(points, dtype=float)
        if self.axis is None:
            return self._function().evaluate(places)
        along = places[:, "xyz".index(self.axis)]
        return np.asarray(np.interp(along, self.at, self.factor), dtype=float)

    def mirrored(self, axis: Axis) -> Profile:
        """Return the image in the plane through the origin across an axis.

        Examples
        --------
        >>> Profile(axis="x", at=(0.0, 0.02), factor=(0, 1)).mirrored("x")
        Profile(axis='x', at=(-0.02, 0.0), factor=(1.0, 0.0))
        >>> Profile(expression="x + y").mirrored("x").expression
        '(-x) + y'
        """
        if self.expression is not None:
            return self.replace(expression=re.sub(rf"\b{axis}\b", f"(-{axis})", self.expression))
        if self.axis != axis:
            return self
        at = tuple(0.0 - place for place in reversed(self.at))
        return self.replace(at=at, factor=tuple(reversed(self.factor)))

    def _function(self) -> _core.Shape:
        assert self.expression is not None
        try:
            return _core.Shape.expression(self.expression)
        except ShapeError as error:
            hint = 'write a function of x, y, z in m, such as "z / 0.005"'
            raise DesignError("expression", error.what, hint) from None
