"""Histories: factors of a load or a motion over time."""

from __future__ import annotations

import csv
import math
import os
import re
from bisect import bisect_right
from collections.abc import Mapping
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any, Final, Self

import numpy as np
from pydantic import ConfigDict, Field, model_validator

from voxsoft import _core
from voxsoft.errors import DesignError, ErrorDetail, ShapeError
from voxsoft.records import Record, closest, place
from voxsoft.units import Dimensionless, PositiveTime, Time, to_si

#: Straight pieces in a period of a sine: they are off by an eight-hundredth of its height at most.
_PIECES: Final = 64
#: An expression is cut into as many pieces as bring it this near, as a part of its range.
_NEAR: Final = 1.0 / 800.0
#: The most pieces of an expression: a steeper change, such as a step, is a ramp this short.
_MOST_PIECES: Final = 4096
#: The most instants of a history.
_MOST: Final = 100_000
#: Factors at the ends of a cycle are the same to this part of the largest.
_SAME: Final = 1e-9


class Sine(Record):
    """A factor that swings between two values, beginning at the lower one.

    Parameters
    ----------
    period
        Duration of one cycle.
    low, high
        The ends of the swing; default: 0 and 1.
    cycles
        Number of cycles; after them it stays at the lower end.

    Examples
    --------
    >>> Sine(period="2 s", cycles=3).cycles
    3
    """

    period: PositiveTime
    low: Dimensionless = 0.0
    high: Dimensionless = 1.0
    cycles: int = Field(1, ge=1, le=_MOST // _PIECES)


class History(Record):
    """A factor over time, linear between the given instants and constant outside them.

    Parameters
    ----------
    time
        Instants, rising; at least one. Two steps that follow each other at once take two instants
        a little apart.
    factor
        Factor on the load at each instant.
    sine
        Swings in place of `time` and `factor`.
    expression
        A function of ``t``, the time in seconds, in place of `time` and `factor`; the functions of
        :class:`voxsoft.shapes.Expression`. It is followed by straight pieces, an eight-hundredth
        of its range off at most; a change steeper than 4,096 pieces allow, such as a step, is a
        ramp of one piece.
    duration
        Duration of the expression; then its last value stays.
    repeat
        Number of times the whole is gone through; its end must be its beginning. Default: once.

    Examples
    --------
    >>> ramp = History(time=("0 s", "1 s"), factor=(0, 1))
    >>> ramp.at(0.25), ramp.at(5.0)
    (0.25, 1.0)
    >>> breath = History(sine={"period": "2 s"}, repeat=2)
    >>> breath.at(1.0), breath.at(3.0), breath.times[-1]
    (1.0, 1.0, 4.0)
    >>> charge = History(expression="1 - exp(-t / 0.5)", duration="3 s")
    >>> round(charge.at("0.5 s"), 2)
    0.63
    """

    model_config = ConfigDict(
        json_schema_extra={"examples": [{"time": ["0 s", "1 s"], "factor": [0, 1]}]}
    )

    time: tuple[Time, ...] = Field((), max_length=_MOST)
    factor: tuple[Dimensionless, ...] = Field((), max_length=_MOST)
    sine: Sine | None = None
    expression: str | None = None
    duration: PositiveTime | None = None
    repeat: int = Field(1, ge=1)

    @model_validator(mode="after")
    def _check(self) -> History:
        ways = {
            "instants": self.time or self.factor,
            "a sine": self.sine is not None,
            "an expression": self.expression is not None,
        }
        given = [way for way, is_given in ways.items() if is_given]
        if len(given) > 1:
            raise DesignError("", f"has {' and '.join(given)}", "give one of them")
        if not given:
            hint = "give time and factor, a sine, or an expression"
            raise DesignError("", "has no instants", hint)
        if (self.expression is None) != (self.duration is None):
            missing = "expression" if self.expression is None else "duration"
            hint = 'give both, as in expression = "1 - exp(-t / 0.5)", duration = "3 s"'
            raise DesignError(missing, "is missing", hint)
        if self.time and not self.factor:
            raise DesignError("factor", "is empty; at least 1 is needed", "give one for each time")
        if len(self.time) != len(self.factor):
            raise DesignError(
                "",
                f"has {len(self.time)} times and {len(self.factor)} factors",
                "give one factor for each time",
            )
        if any(later <= earlier for earlier, later in pairwise(self.time)):
            raise DesignError("time", "does not rise", "sort the instants and drop repeats")
        times, factors = self._cycle
        if self.repeat * len(times) > _MOST:
            what = f"makes {self.repeat * len(times):,} instants"
            raise DesignError("repeat", what, f"stay below {_MOST:,}")
        largest = max(map(abs, factors))
        if self.repeat > 1 and (len(times) == 1 or abs(factors[0] - factors[-1]) > _SAME * largest):
            what = f"ends with {factors[-1]:g} and begins with {factors[0]:g}"
            raise DesignError("repeat", what, "let a cycle end where it begins")
        return self

    @cached_property
    def _cycle(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Instants and factors, gone through once."""
        if self.expression is not None and self.duration is not None:
            return _pieces_of(self.expression, self.duration)
        if self.sine is None:
            return self.time, self.factor
        sine, count = self.sine, self.sine.cycles * _PIECES
        steps = np.arange(count + 1)
        middle, half = (sine.low + sine.high) / 2.0, (sine.high - sine.low) / 2.0
        factors = middle - half * np.cos(2.0 * np.pi * (steps % _PIECES) / _PIECES)
        return tuple((sine.period / _PIECES * steps).tolist()), tuple(factors.tolist())

    @cached_property
    def _whole(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        times, factors = self._cycle
        long = times[-1] - times[0]
        rest = [
            (cycle * long + time, factor)
            for cycle in range(1, self.repeat)
            for time, factor in zip(times[1:], factors[1:], strict=True)
        ]
        later = zip(*rest, strict=True) if rest else ((), ())
        more_times, more_factors = later
        return (*times, *more_times), (*factors, *more_factors)

    @property
    def times(self) -> tuple[float, ...]:
        """All instants in s."""
        return self._whole[0]

    @property
    def factors(self) -> tuple[float, ...]:
        """The factor at each of them."""
        return self._whole[1]

    def at(self, time: float | str) -> float:
        """Return the factor at a time.

        Parameters
        ----------
        time
            The instant, in seconds or with its unit.
        """
        time = to_si(time, "time", "time")
        times, factors = self._whole
        after = bisect_right(times, time)
        if after == 0:
            return factors[0]
        if after == len(times):
            return factors[-1]
        t0, t1 = times[after - 1 : after + 1]
        f0, f1 = factors[after - 1 : after + 1]
        return f0 + (f1 - f0) * (time - t0) / (t1 - t0)

    @classmethod
    def from_table(
        cls,
        path: str | os.PathLike[str],
        column: str | None = None,
        **more: Any,  # noqa: ANN401
    ) -> Self:
        r"""Read a history from a CSV file with a column ``time_s``.

        Parameters
        ----------
        path
            The file; its first line names the columns, lines that begin with ``#`` are left out.
        column
            The column of the factors; default: the one after ``time_s``.
        **more
            Other fields, such as ``repeat``.

        Raises
        ------
        DesignError
            A file that cannot be read, a column that is missing, a number that is none, or
            instants that do not rise, with the line.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> with TemporaryDirectory() as folder:
        ...     file = Path(folder) / "breath.csv"
        ...     _ = file.write_text("time_s,left,right\n0,0,1\n1,1,0\n")
        ...     History.from_table(file, "right").factor
        (1.0, 0.0)
        """
        return cls(**read_table(path, column), **more)


def _pieces_of(expression: str, duration: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Instants and values of an expression, near enough to each other to be joined by lines."""
    # Sampled finely from the start: a short peak must not hide between few instants.
    times = np.linspace(0.0, duration, 2 * _MOST_PIECES + 1)
    values = _values_of(expression, times)
    pieces = _PIECES
    while pieces < _MOST_PIECES:
        each = 2 * _MOST_PIECES // pieces
        chords = np.interp(times, times[::each], values[::each])
        if np.abs(values - chords).max() <= _NEAR * np.ptp(values):
            break
        pieces *= 2
    each = 2 * _MOST_PIECES // pieces
    return tuple(times[::each].tolist()), tuple(values[::each].tolist())


def _values_of(expression: str, times: np.ndarray) -> np.ndarray:
    """Values of a function of t, read as an expression of shapes reads a function of x alone."""
    hint = 'write a function of t in seconds, such as "1 - exp(-t / 0.5)"'
    if re.search(r"\b[xyz]\b", expression):
        raise DesignError("expression", "is a function of x, y or z", hint)
    try:
        function = _core.Shape.expression(re.sub(r"\bt\b", "x", expression))
    except ShapeError as error:
        what = error.what.replace("x y z pi", "t pi")
        raise DesignError("expression", what, hint) from None
    points = np.column_stack([times, np.zeros_like(times), np.zeros_like(times)])
    values = np.asarray(function.evaluate(points), dtype=float)
    if not np.isfinite(values).all():
        at = times[~np.isfinite(values)][0]
        raise DesignError("expression", f"has no value at {at:g} s", hint)
    return values


def read_table(path: str | os.PathLike[str], column: str | None) -> dict[str, list[float]]:
    """Read ``time`` and ``factor`` of a table; see :meth:`History.from_table`."""
    where = f"table {os.fspath(path)}"
    try:
        lines = Path(path).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise DesignError(where, f"cannot be read: {error}", "name a CSV file") from None
    numbered = [
        (number, line)
        for number, line in enumerate(lines, start=1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    rows = csv.DictReader(line for _, line in numbered)
    names = list(rows.fieldnames or ())
    if "time_s" not in names or len(names) < 2:
        hint = 'name the columns in the first line, "time_s,factor"'
        raise DesignError(where, "has no column time_s with another one", hint)
    chosen = column or next(name for name in names if name != "time_s")
    if chosen not in names:
        raise DesignError(where, f'has no column "{chosen}"', closest(chosen, names))
    found: dict[str, list[float]] = {"time": [], "factor": []}
    for (number, _), row in zip(numbered[1:], rows, strict=False):
        for key, name in (("time", "time_s"), ("factor", chosen)):
            found[key].append(_number(row[name], f"{where}, line {number}, {name}"))
        if len(found["time"]) > 1 and found["time"][-1] <= found["time"][-2]:
            what = f"{found['time'][-1]:g} s comes after {found['time'][-2]:g} s"
            raise DesignError(f"{where}, line {number}", what, "sort the lines, drop repeats")
    if not found["time"]:
        raise DesignError(where, "has no lines", "write a line for each instant")
    return found


def _number(text: str | None, where: str) -> float:
    try:
        value = float(text or "")
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        came = "is empty" if not (text or "").strip() else f'"{text}" is no number'
        raise DesignError(where, came, "write a number, and leave no gaps")
    return value


def with_tables(value: Any, folder: Path) -> Any:  # noqa: ANN401 - a document holds anything
    """Put the instants of tables in place of their files, which are meant from a folder.

    Examples
    --------
    >>> with_tables({"loads": [{"history": "breath"}]}, Path())
    {'loads': [{'history': 'breath'}]}
    """
    if isinstance(value, list):
        return [with_tables(entry, folder) for entry in value]
    if not isinstance(value, Mapping):
        return value
    found = {
        key: _tables_of(entry, folder) if key == "histories" else with_tables(entry, folder)
        for key, entry in value.items()
    }
    if isinstance(found.get("history"), dict):
        found["history"] = _inlined(found["history"], folder)
    return found


def _tables_of(entry: object, folder: Path) -> object:
    if not isinstance(entry, Mapping):
        return entry
    return {name: _inlined(each, folder) for name, each in entry.items()}


def _inlined(entry: Any, folder: Path) -> Any:  # noqa: ANN401 - a document holds anything
    if not isinstance(entry, Mapping) or not isinstance(entry.get("table"), str):
        return entry
    rest = {key: each for key, each in entry.items() if key not in ("table", "column")}
    table = read_table(folder / entry["table"], entry.get("column"))
    seconds = [f"{time!r} s" for time in table["time"]]
    return {"time": seconds, "factor": table["factor"], **rest}


def with_named(document: Mapping[str, Any]) -> tuple[dict[str, Any], list[ErrorDetail]]:
    """Put histories in place of their names, and find names that are none, which are left out.

    Examples
    --------
    >>> breath = {"time": ["0 s"], "factor": [1]}
    >>> loads = [{"history": "breath"}, {"history": "breth"}]
    >>> found, problems = with_named({"histories": {"breath": breath}, "loads": loads})
    >>> found["loads"]
    [{'history': {'time': ['0 s'], 'factor': [1]}}, {}]
    >>> str(problems[0])
    'loads[1].history: there is no history "breth". Try: did you mean "breath"?'
    """
    known = document.get("histories")
    known = known if isinstance(known, Mapping) else {}
    problems: list[ErrorDetail] = []

    def put(value: Any, path: tuple[str | int, ...]) -> Any:  # noqa: ANN401 - as a document
        if isinstance(value, (list, tuple)):
            return type(value)(put(each, (*path, index)) for index, each in enumerate(value))
        if not isinstance(value, Mapping):
            return value
        # Designs within designs have histories of their own.
        found = {k: each if k == "design" else put(each, (*path, k)) for k, each in value.items()}
        name = found.get("history")
        if isinstance(name, str) and name in known:
            found["history"] = known[name]
        elif isinstance(name, str):
            what = f'there is no history "{name}"'
            where = place((*path, "history"))
            problems.append(ErrorDetail(where, what, closest(name, list(known))))
            del found["history"]
        return found

    without = ("histories", "parameters", "shapes")
    kept = {k: each if k in without else put(each, (k,)) for k, each in document.items()}
    return kept, problems
