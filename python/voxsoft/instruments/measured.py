"""Measured data: columns of one or several files of instruments, over one clock."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from voxsoft._shown import Shown, counted
from voxsoft.errors import MeasurementError
from voxsoft.instruments import clocks
from voxsoft.instruments.column import Column, Floats, Gap
from voxsoft.records import closest
from voxsoft.units import si_value

_AXES = ("x", "y", "z")


class Track(NamedTuple):
    """Path of a point that a camera saw.

    Attributes
    ----------
    times
        Time of each row in s, (n,).
    positions
        Coordinates x, y, z in m, (n, 3); NaN where the point was hidden, and along axes that were
        not measured.
    """

    times: Floats
    positions: Floats


@dataclass(frozen=True, eq=False, repr=False)
class Measured(Shown):
    """Measured data, as :func:`voxsoft.measured` reads them.

    Parameters
    ----------
    name
        Name of the file.
    columns
        Columns in the order of the file; each has its own times.
    notes
        Sentences on axes, scales, rows that were left out, and the clock.

    Raises
    ------
    MeasurementError
        No columns, or two of one name.

    Examples
    --------
    >>> times = np.arange(5) / 10
    >>> press = Column("pressure", "kPa", [0, 0, 20, 20, 20], times)
    >>> test = Measured("log.csv", (press,))
    >>> float(test["pressure"].values.max()), round(test.step("pressure"), 9)
    (20000.0, 0.15)
    >>> print(test.account)
    log.csv
    pressure: pressure in kPa, 5 rows at 10 Hz from 0 s to 0.4 s
    """

    name: str
    columns: tuple[Column, ...]
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not self.columns:
            raise MeasurementError(self.name, "holds no column of numbers")
        names = self.names
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise MeasurementError(self.name, f'"{twice}" comes twice', "rename one of them")

    def _lines(self) -> Iterator[str]:
        yield f"{self.name}: {counted(len(self.columns), 'column')}"
        yield from (column.account for column in self.columns)
        yield from self.notes

    @property
    def account(self) -> str:
        """Units, times, rates, gaps, axes and changes of all columns, as lines."""
        columns = (column.account for column in self.columns)
        return "\n".join([self.name, *columns, *self.notes])

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the columns."""
        return tuple(column.name for column in self.columns)

    def __len__(self) -> int:
        """Count the columns."""
        return len(self.columns)

    def __getitem__(self, name: str) -> Column:
        """Return a column by its name.

        Upper and lower case are alike; of ``"group/channel"`` the second part is enough where one
        column has it.

        Raises
        ------
        MeasurementError
            No column, or several, of that name.
        """
        asked = name.casefold()
        alike = [c for c in self.columns if c.name.casefold() == asked]
        ends = [c for c in self.columns if c.name.casefold().rpartition("/")[2] == asked]
        found = [c for c in alike if c.name == name] or alike or ends
        if len(found) == 1:
            return found[0]
        if found:
            came = " and ".join(f'"{column.name}"' for column in found)
            raise MeasurementError(self.name, f'"{name}" may be {came}', "give the whole name")
        hint = closest(name, self.names) or f"it has {', '.join(self.names)}"
        raise MeasurementError(self.name, f'has no column "{name}"', hint)

    def selected(self, *names: str) -> Measured:
        """Return some of the columns.

        Raises
        ------
        MeasurementError
            No column, or several, of a name.
        """
        return replace(self, columns=tuple(self[name] for name in names))

    @property
    def tracks(self) -> tuple[str, ...]:
        """Names of the points with a column for some of their coordinates, ``"tip x"``."""
        stems = (column.name.rpartition(" ") for column in self.columns)
        return tuple(dict.fromkeys(stem for stem, _, axis in stems if stem and axis in _AXES))

    def track(self, name: str) -> Track:
        """Return the path of a point.

        Raises
        ------
        MeasurementError
            No such point; coordinates that are no lengths, or without times.
        """
        if name not in self.tracks:
            hint = closest(name, self.tracks) or f"it has {', '.join(self.tracks) or 'none'}"
            raise MeasurementError(self.name, f'has no point "{name}"', hint)
        seen = {a: self[f"{name} {a}"] for a in _AXES if f"{name} {a}" in self.names}
        first = next(iter(seen.values()))
        for column in seen.values():
            _refuse_unplaced(self.name, column)
        if first.times is None:
            hint = "give the rate of the camera: rate=, in frames per second"
            raise MeasurementError(self.name, "has no times", hint)
        positions = np.full((len(first.times), 3), np.nan)
        for axis, column in seen.items():
            if column.times is None or not np.array_equal(column.times, first.times):
                what = f'the coordinates of "{name}" are at different times'
                raise MeasurementError(self.name, what, "resample them")
            positions[:, _AXES.index(axis)] = column.values
        return Track(first.times, positions)

    def during(self, start: float | str, end: float | str) -> Measured:
        """Return the rows between two times, in s or with a unit, both included.

        Raises
        ------
        MeasurementError
            A column without times, or without a row in between.
        """
        low, high = (si_value(each, "time", "time") for each in (start, end))
        columns = []
        for column in self.columns:
            times = clocks.times_of(self.name, column)
            kept = (times >= low) & (times <= high)
            if not kept.any():
                what = f"has no row of {column.name} between {low:g} s and {high:g} s"
                hint = f"its rows are at {times[0]:g} s to {times[-1]:g} s"
                raise MeasurementError(self.name, what, hint)
            columns.append(replace(column, numbers=column.numbers[kept], times=times[kept]))
        return replace(self, columns=tuple(columns))

    def mean(self, name: str) -> float:
        """Return the mean of a column in SI units, of the rows with a number.

        Raises
        ------
        MeasurementError
            No such column, or no row with a number.
        """
        values = self[name].values
        seen = values[np.isfinite(values)]
        if not len(seen):
            raise MeasurementError(self.name, f"{name} was not seen: all its rows are gaps")
        return float(seen.mean())

    def step(self, name: str) -> float:
        """Return the time at which a column makes its step, in s.

        It is the time at which it crosses the middle between its levels before and after, by a
        line between two rows.

        Raises
        ------
        MeasurementError
            No such column, no times, or no step that stands out of its noise.
        """
        return clocks.step_of(self.name, self[name])

    def resampled(self, rate: float | str, *, over_gaps: bool = False) -> Measured:
        """Return all columns at the same times, at a steady rate, as far as all of them reach.

        A column with more rows is averaged around each time; one with fewer is read off the line
        between two rows. Gaps stay gaps.

        Parameters
        ----------
        rate
            Rows per second, or with a unit (``"100 Hz"``).
        over_gaps
            True to go over gaps by a line.

        Raises
        ------
        MeasurementError
            A column without times, or no time that all columns have.
        """
        hertz = si_value(rate, "rate", "rate", positive=True)
        times = clocks.common_times(self.name, self.columns, hertz)
        columns, notes = [], []
        for column in self.columns:
            numbers, how = clocks.resampled(self.name, column, times, hertz, over_gaps=over_gaps)
            columns.append(replace(column, numbers=numbers, times=times))
            notes.append(f"{column.name}: resampled to {hertz:g} Hz by {how}")
        return replace(self, columns=tuple(columns), notes=(*self.notes, *notes))

    def shifted(self, seconds: float | str) -> Measured:
        """Return the columns with later times, by some seconds or a time with a unit.

        Raises
        ------
        MeasurementError
            A column without times.
        """
        later = si_value(seconds, "time", "time")
        columns = tuple(
            replace(column, times=clocks.times_of(self.name, column) + later)
            for column in self.columns
        )
        return replace(self, columns=columns)

    def synchronized(
        self, other: Measured, *, by: str | None = None, step: tuple[str, str] | None = None
    ) -> Measured:
        """Return the columns of two files over the clock of this one.

        Parameters
        ----------
        other
            Data of another instrument in the same test.
        by
            Name of a quantity that both recorded, such as a trigger: the other is shifted to where
            the two are most alike (largest correlation).
        step
            A column of this one and one of the other that make their step at the same moment: a
            valve that opens and a tip that begins to move. Give one of `by` and `step`.

        Returns
        -------
        Measured
            All columns; names that both have are ``"file/name"``. The shift stands in the notes.

        Raises
        ------
        MeasurementError
            No such column, no times, no step, or courses that are not alike.

        Examples
        --------
        >>> def log(name, start):
        ...     times = np.arange(40) / 10
        ...     return Measured(name, (Column("valve", "V", 5.0 * (times > start), times),))
        >>> both = log("a.csv", 1.0).synchronized(log("b.csv", 2.5), step=("valve", "valve"))
        >>> both.names, round(both.step("b.csv/valve"), 9)
        (('a.csv/valve', 'b.csv/valve'), 1.05)
        """
        if (by is None) == (step is None):
            raise MeasurementError(
                self.name, "needs by=, a column of both, or step=, one of each", "give one of them"
            )
        if step is not None:
            mine, its = step
            shift = self.step(mine) - other.step(its)
            how = f"the steps of {mine} and {its}"
        else:
            assert by is not None
            shift, alike = clocks.shift_between(self.name, self[by], other.name, other[by])
            how = f"{by}, which correlates to {alike:.3f}"
        moved = other.shifted(shift)
        note = f"{other.name} is shifted by {shift:.6g} s to the clock of {self.name}, by {how}"
        shared = {*self.names} & {*other.names}

        def named(of: Measured) -> Iterator[Column]:
            for column in of.columns:
                own = column.name in shared
                yield replace(column, name=f"{of.name}/{column.name}") if own else column

        return Measured(
            f"{self.name} + {other.name}",
            (*named(self), *named(moved)),
            (*self.notes, *other.notes, note),
        )

    @property
    def gaps(self) -> dict[str, tuple[Gap, ...]]:
        """Gaps by the name of their column; columns without any are left out."""
        return {column.name: column.gaps for column in self.columns if column.gaps}


def _refuse_unplaced(name: str, column: Column) -> None:
    """Refuse coordinates that are no lengths."""
    if column.kind == "length":
        return
    if column.kind == "pixels":
        hint = 'give the size of a pixel in the plane of the body: pixel="0.2 mm", say'
        raise MeasurementError(name, f"{column.name} is in pixels", hint)
    what = f"{column.name} has no unit" if not column.unit else f"{column.name} is no length"
    raise MeasurementError(name, what, 'give it: unit="mm", say')
