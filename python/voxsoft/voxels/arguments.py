"""Checks of the arguments of a grid's methods."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Literal

import numpy as np

from voxsoft.errors import UnitError, VoxelError
from voxsoft.units import to_si

Axis = Literal["x", "y", "z"] | Sequence[float]
Triple = tuple[float, float, float]

_AXES: dict[str, Triple] = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def triple(place: str, values: Sequence[float]) -> Triple:
    """Return three finite numbers."""
    try:
        x, y, z = (float(value) for value in values)
    except (TypeError, ValueError) as error:
        raise VoxelError(place, f"got {values!r}; expected three numbers") from error
    if not all(map(math.isfinite, (x, y, z))):
        raise VoxelError(place, f"got {(x, y, z)}; the numbers must be finite")
    return x, y, z


def whole(place: str, value: float, least: int, most: int) -> int:
    """Return a whole number within limits."""
    if value != int(value) or not least <= value <= most:
        raise VoxelError(place, f"got {value:g}; allowed are whole numbers {least} to {most}")
    return int(value)


def margins(place: str, cells: int | Sequence[int]) -> tuple[int, int, int]:
    """Return cells along three axes, from one number or three."""
    values = (cells, cells, cells) if isinstance(cells, int | np.integer) else cells
    x, y, z = (whole(place, n, 0, 2**31) for n in triple(place, values))
    return x, y, z


def length(place: str, value: float | str) -> float:
    """Return a length [m]: a number is taken as m, text and quantities of pint are converted."""
    try:
        return to_si(value, "length", place)
    except UnitError as error:
        raise VoxelError(error.where, error.what, error.hint) from None


def point(place: str, values: Sequence[float | str]) -> Triple:
    """Return three finite lengths [m]."""
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise VoxelError(place, f"got {values!r}; expected three numbers")
    return triple(place, [length(place, value) for value in values])


def positive_length(place: str, value: float | str) -> float:
    """Return a positive length [m]."""
    value = length(place, value)
    if not (math.isfinite(value) and value > 0.0):
        raise VoxelError(place, f"got {value} m; expected a positive length")
    return value


def axis_vector(axis: Axis) -> Triple:
    """Return the vector of an axis given by name or as three numbers."""
    if isinstance(axis, str):
        if axis not in _AXES:
            raise VoxelError("axis", f"got {axis!r}; allowed are 'x', 'y', 'z' or three numbers")
        return _AXES[axis]
    direction = triple("axis", axis)
    if not any(direction):
        raise VoxelError("axis", "the zero vector has no direction")
    return direction


def part_id(part: int) -> int:
    """Return the number of a part, 0 to 255."""
    if part != int(part) or not 0 <= part <= 255:
        raise VoxelError("part", f"got {part}; parts are numbered 0 (empty) to 255")
    return int(part)
