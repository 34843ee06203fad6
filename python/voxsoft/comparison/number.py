"""Number of a run with the part of it that the deformation of the body makes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final, NamedTuple

#: Bounds of a number that may have any value.
ANY: Final = (-math.inf, math.inf)


class Number(NamedTuple):
    """A number of a run in SI units.

    Attributes
    ----------
    value
        The number.
    kind
        A key of :data:`voxsoft.units.KINDS`.
    deformed
        Size of the part of it that the deformation of the body makes: its distance from the number
        that a rigid body under these loads would have. Zero for one that is prescribed.
    bounds
        Range of the number for every body.
    scale
        Size of the vector of which it is a component: far smaller ones are rounding. Zero for a
        number of its own.

    Examples
    --------
    >>> Number.of(-3.0, "force").deformed
    3.0
    """

    value: float
    kind: str
    deformed: float
    bounds: tuple[float, float] = ANY
    scale: float = 0.0

    @classmethod
    def of(
        cls,
        value: float,
        kind: str,
        *,
        rigid: float = 0.0,
        bounds: tuple[float, float] = ANY,
        scale: float = 0.0,
    ) -> Number:
        """Make a number from its value and that of a rigid body under these loads.

        A rigid one may be far larger, as the pressure of a liquid under a stroke: then the walls
        decide all of the number and no more.

        Examples
        --------
        >>> round(Number.of(1.1, "volume", rigid=1.0).deformed, 9)
        0.1
        >>> Number.of(5e3, "pressure", rigid=2e9).deformed
        5000.0
        """
        deformed = min(abs(value - rigid), abs(value)) if rigid else abs(value)
        return cls(float(value), kind, float(deformed), bounds, float(scale))


#: Numbers of a run by group, entry and name, as in ``("contacts", "body", "cube", "area")``.
Numbers = Mapping[tuple[str, ...], Number]


def vector(
    key: tuple[str, ...],
    components: Sequence[float],
    kind: str,
    *,
    rigid: Sequence[float] = (0.0, 0.0, 0.0),
    scale: float | None = None,
) -> dict[tuple[str, ...], Number]:
    """Make the numbers of a vector, by its key and ``"x"``, ``"y"``, ``"z"``.

    Parameters
    ----------
    key
        Group and entry.
    components
        The vector, (3,).
    kind
        A key of :data:`voxsoft.units.KINDS`.
    rigid
        The vector of a rigid body under these loads.
    scale
        Size beside which a component is rounding; default: that of the vector.

    Examples
    --------
    >>> tip = vector(("probes", "tip"), (0.0, 3e-3, -4e-3), "length")
    >>> tip["probes", "tip", "z"].deformed, round(tip["probes", "tip", "x"].scale, 9)
    (0.004, 0.005)
    """
    size = math.hypot(*components) if scale is None else scale
    return {
        (*key, axis): Number(float(now), kind, abs(float(now) - float(still)), ANY, size)
        for axis, now, still in zip("xyz", components, rigid, strict=True)
    }
