"""Column: numbers of one quantity over time, as an instrument wrote them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import Shown, counted
from voxsoft.errors import MeasurementError
from voxsoft.instruments.heads import Unit, unit_of

Floats = NDArray[np.float64]

# Largest deviation of a step from the mean step, as a share of it, of times at a steady rate:
# loggers write times in milliseconds.
_STEADY = 0.05


class Gap(NamedTuple):
    """Interval of time in which nothing was measured: from its first to its last row, in s."""

    start: float
    end: float


@dataclass(frozen=True, eq=False, repr=False)
class Column(Shown):
    """Numbers of one quantity, in the order of their rows.

    Parameters
    ----------
    name
        Name in the file, without the unit.
    unit
        Unit in the file; empty if it says none.
    numbers
        Numbers in that unit, (n,); NaN where nothing was measured.
    times
        Time of each row in s, (n,), rising; None without a base of time.

    Raises
    ------
    MeasurementError
        A unit that is not known, times that do not rise, or lists of unequal length.

    Examples
    --------
    >>> force = Column("Load", "kN", [0.0, np.nan, 0.002], [0.0, 0.1, 0.2])
    >>> force.kind, force.values.tolist(), force.rate, force.gaps
    ('force', [0.0, nan, 2.0], 10.0, (Gap(start=0.1, end=0.1),))
    """

    name: str
    unit: str
    numbers: Floats
    times: Floats | None = None

    def __post_init__(self) -> None:
        numbers = np.array(self.numbers, dtype=np.float64)
        numbers.setflags(write=False)
        object.__setattr__(self, "numbers", numbers)
        where = f'column "{self.name}"'
        if unit_of(self.unit) is None:
            hint = f'give its unit: units={{"{self.name}": "N"}}, say'
            raise MeasurementError(where, f'there is no unit "{self.unit}"', hint)
        if numbers.ndim != 1:
            raise MeasurementError(where, f"has numbers of the shape {numbers.shape}")
        if self.times is None:
            return
        times = np.array(self.times, dtype=np.float64)
        times.setflags(write=False)
        object.__setattr__(self, "times", times)
        if times.shape != numbers.shape:
            what = f"has {len(numbers)} numbers at {times.size} times"
            raise MeasurementError(where, what)
        if not np.isfinite(times).all() or (np.diff(times) <= 0.0).any():
            back = np.flatnonzero(~(np.diff(times) > 0.0))
            at = int(back[0]) + 1 if len(back) else 0
            what = f"row {at + 1} is at {times[at]:g} s, after {times[max(at - 1, 0)]:g} s"
            raise MeasurementError(where, what, "take out rows that come twice, or their times")

    def _lines(self) -> Iterator[str]:
        yield self.account

    @property
    def kind(self) -> str:
        """Quantity: ``"force"``, ``"length"``, ..., ``"number"`` without a unit, ``"pixels"``."""
        return self._unit.kind

    @cached_property
    def values(self) -> Floats:
        """Numbers in SI units, (n,); numbers without a unit, and pixels, as they are."""
        values: Floats = self.numbers * self._unit.factor + self._unit.offset
        values.setflags(write=False)
        return values

    @property
    def rate(self) -> float | None:
        """Rows per second, if they come at a steady rate."""
        if self.times is None or len(self.times) < 2:
            return None
        steps = np.diff(self.times)
        mean = float(self.times[-1] - self.times[0]) / len(steps)
        steady = float(np.abs(steps - mean).max()) <= _STEADY * mean
        return float(f"{1.0 / mean:.9g}") if steady else None

    @property
    def gaps(self) -> tuple[Gap, ...]:
        """Intervals without a number; those of no time count rows from 0."""
        times = np.arange(len(self.numbers), dtype=np.float64) if self.times is None else self.times
        missing = np.concatenate([[False], ~np.isfinite(self.numbers), [False]])
        starts = np.flatnonzero(~missing[:-1] & missing[1:])
        ends = np.flatnonzero(missing[:-1] & ~missing[1:]) - 1
        return tuple(
            Gap(float(times[a]), float(times[b])) for a, b in zip(starts, ends, strict=True)
        )

    @property
    def account(self) -> str:
        """Name, unit, rate and gaps in a line."""
        unit = self.unit or "no unit"
        line = f"{self.name}: {self.kind} in {unit}" if self.unit else f"{self.name}: {unit}"
        line += f", {counted(len(self.numbers), 'row')}"
        if self.times is not None and len(self.times):
            rate = self.rate
            line += f" at {rate:g} Hz" if rate is not None else " at uneven times"
            line += f" from {self.times[0]:g} s to {self.times[-1]:g} s"
        gaps = self.gaps
        if gaps:
            rows = int(np.count_nonzero(~np.isfinite(self.numbers)))
            first = gaps[0]
            where = "" if self.times is None else f", the first from {first.start:g} s"
            line += f"; {counted(len(gaps), 'gap')} of {counted(rows, 'row')}{where}"
        return line

    @property
    def _unit(self) -> Unit:
        found = unit_of(self.unit)
        assert found is not None  # checked when it was made
        return found
