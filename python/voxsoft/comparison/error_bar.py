"""Error bar of one number, and the error bars of a run."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from voxsoft.units import KINDS, format_quantity, si_value


@dataclass(frozen=True)
class ErrorBar:
    """One number with its error.

    Attributes
    ----------
    value
        Number on the voxels of the design, in SI units.
    estimate
        Extrapolation to ever smaller voxels.
    error
        Error of the estimate, to either side.
    kind
        A key of :data:`voxsoft.units.KINDS`.
    unknown
        Reason why there is no estimate; estimate and error are NaN then. Empty where there is one.
    """

    value: float
    estimate: float
    error: float
    kind: str
    unknown: str = ""

    @classmethod
    def within(
        cls, value: float, estimate: float, error: float, kind: str, bounds: tuple[float, float]
    ) -> ErrorBar:
        """Return a bar, or an unknown one where the estimate is outside the bounds of the number.

        A value that is outside already, as by rounding, is no reason to reject the estimate.

        Examples
        --------
        >>> bar = ErrorBar.within(1e-6, -2e-6, 3e-6, "volume", (0.0, math.inf))
        >>> print(bar)
        not known: smaller voxels point to -2 mL, beyond what it can be
        >>> bar.summary()["estimate"] is None
        True
        """
        low, high = bounds
        if min(low, value) <= estimate <= max(high, value):
            return cls(value, estimate, error, kind)
        beyond = format_quantity(float(f"{estimate:.2g}"), kind)
        why = f"smaller voxels point to {beyond}, beyond what it can be"
        return cls(value, math.nan, math.nan, kind, why)

    def __str__(self) -> str:
        """Write the estimate with its error, in a unit that suits both.

        Examples
        --------
        >>> str(ErrorBar(-0.0123, -0.01304, 0.00052, "length"))
        '-13.04 ± 0.52 mm'
        """
        if self.unknown:
            return f"not known: {self.unknown}"
        unit, factor = _unit_of([self])
        if self.estimate == self.error == 0.0:
            return "0"
        return f"{self.in_unit(factor)} {unit}".rstrip()

    def in_unit(self, factor: float) -> str:
        """Write both numbers in a unit: two digits of the error, at most five of the estimate."""
        if self.estimate == self.error == 0.0:
            return "0"
        largest = max(abs(self.estimate), self.error) / factor
        digits = 4 - math.floor(math.log10(largest)) if largest > 0.0 else 0
        if self.error > 0.0:
            digits = min(digits, 1 - math.floor(math.log10(self.error / factor)))
        digits = max(digits, 0)
        shown = [round(each / factor, digits) + 0.0 for each in (self.estimate, self.error)]
        return f"{shown[0]:.{digits}f} ± {shown[1]:.{digits}f}"

    def summary(self) -> dict[str, Any]:
        """Return plain data in SI units; estimate and error are None, with a reason, if unknown."""
        if self.unknown:
            return {"value": self.value, "estimate": None, "error": None, "reason": self.unknown}
        return {"value": self.value, "estimate": self.estimate, "error": self.error}


def vector_in_words(components: Sequence[ErrorBar]) -> str:
    """Write the components of a vector with their errors, in one unit.

    Examples
    --------
    >>> x = ErrorBar(0.0, 0.0, 0.0, "length")
    >>> z = ErrorBar(-0.0123, -0.01304, 0.00052, "length")
    >>> vector_in_words([x, x, z])
    '(0, 0, -13.04 ± 0.52) mm'
    """
    unit, factor = _unit_of(components)
    return f"({', '.join(bar.in_unit(factor) for bar in components)}) {unit}".rstrip()


def share_of(components: Sequence[ErrorBar], beside: float = 0.0) -> float | None:
    """Return the error as a part of the size of a number or vector; None where it has no size.

    Parameters
    ----------
    components
        One number, or the components of a vector.
    beside
        Part of a single number that is there without load, such as the volume of a chamber at rest:
        the size is the distance from it.

    Examples
    --------
    >>> share_of([ErrorBar(1.0, 1.1, 0.1, "volume")], beside=0.9)
    0.5
    """
    if any(bar.unknown for bar in components):
        return None
    size = math.hypot(*(bar.estimate - beside for bar in components))
    error = math.hypot(*(bar.error for bar in components))
    if error == 0.0:
        return 0.0
    return None if size == 0.0 else round(error / size, 12)


def _unit_of(bars: Sequence[ErrorBar]) -> tuple[str, float]:
    """Return a unit that suits the largest of some numbers, and its factor."""
    kind = bars[0].kind
    largest = max(max(abs(bar.estimate), bar.error) for bar in bars)
    units = KINDS[kind].units
    if not units:
        return "", 1.0
    unit = "deg" if kind == "angle" else format_quantity(largest, kind).partition(" ")[2]
    factors = {each: si_value(f"1 {each}", kind, "unit") for each in {*units, unit} - {""}}
    if unit == "" or largest < 0.1 * factors[unit]:
        unit = min(factors, key=lambda each: factors[each])
    return unit, factors[unit]


@dataclass(frozen=True)
class ErrorBars:
    """Discretization errors of a run.

    Attributes
    ----------
    probes
        Error bars of the components of each probe's displacement.
    metrics
        Error bar of each metric; without those that grow without a limit at sharp corners.
    volumes
        Error bar of the volume of each cavity, in the order of the mesh's cavities.
    voxel_sizes
        Sizes in m, falling; empty if there are no error bars.
    voxels
        Number of voxels at each size.
    regular
        True if all sizes hold the same body with two voxels or more through each wall; if not,
        the bars are wide, and may be too small where walls are single voxels.
    missing
        Reason why there are no error bars, or why an accuracy was not reached; empty otherwise.
    hint
        Hint to the user for that reason.
    seconds
        Time of the further runs in s.
    """

    probes: Mapping[str, tuple[ErrorBar, ErrorBar, ErrorBar]]
    metrics: Mapping[str, ErrorBar]
    volumes: tuple[ErrorBar, ...]
    voxel_sizes: tuple[float, ...] = ()
    voxels: tuple[int, ...] = ()
    regular: bool = False
    missing: str = ""
    hint: str = ""
    seconds: float = 0.0

    @classmethod
    def none(cls, missing: str, hint: str) -> ErrorBars:
        """Make empty error bars with a reason and a hint."""
        return cls({}, {}, (), missing=missing, hint=hint)

    @property
    def sentence(self) -> str:
        """Sentence on the runs behind the error bars, or on why there are none."""
        if not self.voxel_sizes:
            return f"no error bars: {self.missing}. Try: {self.hint}"
        lengths = [format_quantity(float(f"{size:.4g}"), "length") for size in self.voxel_sizes]
        words = f"error bars from voxels of {', '.join(lengths[:-1])} and {lengths[-1]}"
        if not self.regular:
            words += ", which are not the same body or have walls of one voxel: the bars are wide"
        return f"{words}; {self.missing}. Try: {self.hint}" if self.missing else words

    def summary(self) -> dict[str, Any]:
        """Everything as plain data in SI units (``"error_bars"`` in the ``--json`` of ``run``)."""
        return {
            "probes": {
                name: {axis: bar.summary() for axis, bar in zip("xyz", bars, strict=True)}
                for name, bars in self.probes.items()
            },
            "metrics": {name: bar.summary() for name, bar in self.metrics.items()},
            "cavities": [bar.summary() for bar in self.volumes],
            "voxel_sizes": list(self.voxel_sizes),
            "voxels": list(self.voxels),
            "regular": self.regular,
            "missing": self.missing,
            "hint": self.hint,
            "seconds": self.seconds,
        }
