"""Coupon test over time: a strain that is held, or one that grows at a constant rate."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final, Literal, get_args

import numpy as np

from voxsoft.errors import MeasurementError
from voxsoft.materials.hyperelastic import Floats
from voxsoft.records import closest

#: Kinds of a test over time.
TestKind = Literal["relaxation", "rate"]

_FEWEST: Final = 5
#: Part of the largest strain by which a held strain may differ from it: machines overshoot less.
_HELD: Final = 0.02
#: Part of the time of a relaxation test in which the strain may still change.
_STRETCHING: Final = 0.5
#: Part of the largest strain by which a strain may be off its line at one rate.
_STRAIGHT: Final = 0.05
#: Rows of a test beyond which neighbors are averaged: a fit takes as long as they are many.
_MANY: Final = 400


@dataclass(frozen=True)
class TimedTest:
    """Uniaxial test of one specimen over time.

    Parameters
    ----------
    time
        Time in s, (n,), rising. The specimen is at rest at time zero: a strain in a first row at
        time zero is sudden; in a later first row it was reached at a constant rate.
    strain
        Engineering strain, (n,), taken for linear between the rows.
    stress
        Engineering stress in Pa, (n,), zero at zero strain.
    kind
        ``"relaxation"``: the strain is held for more than half of the time; ``"rate"``: it grows at
        one rate.
    name
        Name in reports.

    Raises
    ------
    MeasurementError
        Fewer than five points, numbers that are not finite, lengths that differ, time that does not
        rise, stress or strain whose sign is turned, or a strain unlike the kind.

    Examples
    --------
    >>> test = TimedTest([0, 1, 2, 4, 8], [0.5] * 5, [30e3, 28e3, 27e3, 26e3, 26e3], "relaxation")
    >>> test.duration, test.rate
    (8.0, None)
    """

    time: Floats
    strain: Floats
    stress: Floats
    kind: TestKind = "relaxation"
    name: str = "test"

    def __post_init__(self) -> None:
        for key in ("time", "strain", "stress"):
            object.__setattr__(self, key, np.asarray(getattr(self, key), dtype=np.float64))
        self._check_kind()
        self._check_numbers()
        if self.kind == "relaxation":
            self._check_held()
        else:
            self._check_rate()

    @property
    def stretch(self) -> Floats:
        """Stretch, 1 plus the strain, (n,)."""
        stretches: Floats = 1.0 + self.strain
        return stretches

    @property
    def duration(self) -> float:
        """Time in s since the strain was reached (relaxation), or of all the test (rate)."""
        return float(self.time[-1] - (self.time[self.reached] if self.kind != "rate" else 0.0))

    @property
    def rate(self) -> float | None:
        """Strain rate in 1/s; None of a relaxation test."""
        if self.kind != "rate":
            return None
        return float(abs(self.strain[-1]) / self.time[-1])

    @property
    def shortest(self) -> float:
        """Shortest time in s between two rows, the start of the test included."""
        return float(np.diff(self.time, prepend=0.0)[0 if self.time[0] > 0.0 else 1 :].min())

    @property
    def ramp(self) -> float:
        """Time in s in which the strain of a relaxation test was reached; zero of a rate test."""
        return 0.0 if self.kind == "rate" else float(self.time[self.reached])

    @property
    def reached(self) -> int:
        """Row from which on the strain is held."""
        held = np.abs(self.strain - self.strain[-1]) <= _HELD * np.abs(self.strain).max()
        away = np.flatnonzero(~held)
        return 0 if len(away) == 0 else int(away[-1]) + 1

    def _check_kind(self) -> None:
        if self.kind not in get_args(TestKind):
            hint = closest(str(self.kind), get_args(TestKind))
            raise MeasurementError(self.name, f'"{self.kind}" is not a kind of test', hint)
        shapes = {v.shape for v in (self.time, self.strain, self.stress)}
        if self.time.ndim != 1 or len(shapes) > 1:
            what = "time, strain and stress do not pair up"
            raise MeasurementError(self.name, what, "give one of each in every row")
        if len(self.time) < _FEWEST:
            what = f"has {len(self.time)} points; expected at least {_FEWEST}"
            raise MeasurementError(self.name, what)

    def _check_numbers(self) -> None:
        if not all(np.isfinite(v).all() for v in (self.time, self.strain, self.stress)):
            raise MeasurementError(self.name, "holds numbers that are not finite")
        if self.time[0] < 0.0:
            what = f"begins at {self.time[0]:g} s, before time zero"
            raise MeasurementError(self.name, what, "count from the start of the pull")
        falls = np.flatnonzero(np.diff(self.time) <= 0.0)
        if len(falls):
            where = f"{self.name}, point {int(falls[0]) + 2}"
            raise MeasurementError(where, "the time does not rise", "take rows out that came twice")
        if self.strain.min() <= -1.0:
            what = f"strain {self.strain.min():g} is a length of zero or less"
            raise MeasurementError(self.name, what, "is the column in percent?")
        size = float(np.abs(self.strain).max())
        if size == 0.0:
            raise MeasurementError(self.name, "is never strained", "are columns swapped?")
        if float(self.strain @ self.stress) <= 0.0:
            what = "stress and strain have different signs"
            raise MeasurementError(self.name, what, "tension is positive in both")

    def _check_held(self) -> None:
        reached = self.reached
        if self.time[reached] > _STRETCHING * self.time[-1] or len(self.time) - reached < _FEWEST:
            raise MeasurementError(
                self.name,
                f"is no relaxation test: the strain changes until {self.time[reached]:g} s of "
                f"{self.time[-1]:g} s",
                "give a test in which it is held, or the part at one rate as a rate test (--rate)",
            )

    def _check_rate(self) -> None:
        line = self.strain[-1] * self.time / self.time[-1]
        off = np.abs(self.strain - line)
        size = float(np.abs(self.strain).max())
        if off.max() > _STRAIGHT * size:
            at = int(np.argmax(off))
            raise MeasurementError(
                f"{self.name}, point {at + 1}",
                f"is not of one rate: the strain is {self.strain[at]:.3g} at {self.time[at]:g} s, "
                f"and {line[at]:.3g} on the line from zero to the end",
                "cut it where the rate changes, and count the time from the start of the pull",
            )


def thinned(test: TimedTest) -> tuple[TimedTest, Floats]:
    """Average neighbors in a test of many rows, and return the root of how many each mean has.

    The means are at even distances in the rows of a pull, and in the logarithm of the time for
    which a strain was held.
    """
    rows = len(test.time)
    if rows <= _MANY:
        return test, np.ones(rows)
    held = rows if test.kind == "rate" else test.reached
    pulled = np.unique(np.linspace(0, held, _MANY // 2 + 1).astype(int))
    firsts = pulled[:-1]
    if held < rows:
        since = test.time[held:] - test.time[held]
        ages = np.geomspace(since[1], since[-1], _MANY // 2)
        later = held + np.searchsorted(since, ages)
        firsts = np.unique(np.concatenate([firsts, [held], later]))
    counts = np.diff(firsts, append=rows)
    time, strain, stress = (
        np.add.reduceat(each, firsts) / counts for each in (test.time, test.strain, test.stress)
    )
    return replace(test, time=time, strain=strain, stress=stress), np.sqrt(counts)
