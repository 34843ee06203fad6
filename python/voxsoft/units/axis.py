"""Axes: coordinate axes by name, or any direction."""

from __future__ import annotations

from typing import Literal

from voxsoft.units.types import Vector

#: A coordinate axis by name, or any direction as three numbers.
Axis = Literal["x", "y", "z"] | Vector

_AXES: dict[str, tuple[float, float, float]] = {
    "x": (1.0, 0.0, 0.0),
    "y": (0.0, 1.0, 0.0),
    "z": (0.0, 0.0, 1.0),
}


def direction(axis: str | tuple[float, float, float]) -> tuple[float, float, float]:
    """Return the unit vector of a named axis; other directions as they are.

    Examples
    --------
    >>> direction("z")
    (0.0, 0.0, 1.0)
    """
    return _AXES[axis] if isinstance(axis, str) else axis
