"""Logs and exports as text: a header, units, times, and gaps."""

from __future__ import annotations

import re
from datetime import datetime
from typing import Final, NamedTuple

import numpy as np

from voxsoft.errors import MeasurementError
from voxsoft.instruments.column import Column, Floats
from voxsoft.instruments.heads import is_time, is_unit, split_name, unit_of, units_row
from voxsoft.instruments.options import Options
from voxsoft.instruments.table_text import NumberForm, TextRow, TextTable

_NOTHING: Final = ("", "-", "--", "---", "nan", "n/a", "na", "null", "none", "inf", "-inf")
_CLOCK: Final = re.compile(r"(?:(\d+):)?(\d{1,2}):(\d{1,2}(?:[.,]\d+)?)")
#: Forms of dates that Python's ISO reader does not take; day before month, as a point tells.
_DATES: Final = ("%d.%m.%Y %H:%M:%S.%f", "%d.%m.%Y %H:%M:%S", "%Y/%m/%d %H:%M:%S.%f")


class Found(NamedTuple):
    """Columns of a file, and sentences on how they were read."""

    columns: list[Column]
    notes: list[str]


def read_text(text: str, name: str, options: Options) -> Found:
    r"""Read columns of numbers from a table with a header, in which units may stand.

    Cells without a number are gaps; columns without any are left out, which the notes say.

    Parameters
    ----------
    text
        Comma, semicolon or tab separated, with any lines above the header.
    name
        Name in errors.
    options
        Units, rate, and the column of the time.

    Raises
    ------
    MeasurementError
        No header above the numbers, no column of numbers, or times that are none.

    Examples
    --------
    >>> log = "logger 7\nTime (s);p [kPa]\n0,0;1,5\n0,1;\n0,2;2,5"
    >>> press = read_text(log, "log.csv", Options()).columns[0]
    >>> press.name, press.values.tolist(), press.rate
    ('p', [1500.0, nan, 2500.0], 10.0)
    """
    table = TextTable.of(text, name)
    if not table.rows:
        raise MeasurementError(name, "is empty", "save the table as CSV")
    header = table.likely_header(is_unit)
    heads = table.rows[header].cells
    if all(_has_number(cell) for cell in heads):
        hint = "write a line above the numbers: time_s,pressure_kPa, say"
        raise MeasurementError(f"{name}, line {table.rows[header].line}", "names no columns", hint)
    table.check_lengths(header)
    at = [index for index, head in enumerate(heads) if head]
    below = units_row(table.rows, header, at)
    whole = None if below is None else {i: u for i, u in below.items() if unit_of(u) is not None}
    has_units = below is not None and len(whole or ()) == len(below)
    rows = table.rows[header + (2 if has_units else 1) :]
    named = {index: split_name(heads[index]) for index in at}
    clock = _clock(table, named, options)
    columns: list[Column] = []
    notes: list[str] = []
    times: Floats | None = None
    if options.rate is not None:
        times = np.arange(len(rows)) / options.rate
        if clock is not None:
            notes.append(f"{heads[clock]} is not read: the rate was given")
    elif clock is not None:
        unit = options.unit_of(named[clock][0], named[clock][1])
        unit = unit or ((whole or {}).get(clock, "") if has_units else "")
        times, note = _times(table, rows, clock, heads[clock], unit)
        notes += [note] if note else []
    for index, (label, unit) in named.items():
        if index == clock:
            continue
        numbers = _numbers(table, rows, index)
        if numbers is None:
            if any(row.cell(index) for row in rows):
                notes.append(f'"{heads[index]}" holds text, and is left out')
            continue
        written = unit or ((whole or {}).get(index, "") if has_units else "")
        columns.append(Column(label, options.unit_of(label, written), numbers, times))
    return Found(columns, notes)


def _clock(table: TextTable, named: dict[int, tuple[str, str]], options: Options) -> int | None:
    """Return the column of the time, by its name or the one that was given."""
    if options.time is not None:
        asked = options.time.casefold()
        heads = table.rows[table.likely_header(is_unit)].cells
        for index, (label, _) in named.items():
            if asked in (label.casefold(), heads[index].casefold()):
                return index
        came = ", ".join(f'"{label}"' for label, _ in named.values())
        raise MeasurementError(table.name, f'has no column "{options.time}"', f"it has {came}")
    found = [index for index, (label, _) in named.items() if is_time(label)]
    if len(found) > 1:
        came = " and ".join(f'"{named[index][0]}"' for index in found)
        raise MeasurementError(table.name, f"{came} are both times", "choose one: time=")
    return found[0] if found else None


def _times(
    table: TextTable, rows: tuple[TextRow, ...], at: int, head: str, unit: str
) -> tuple[Floats, str]:
    """Return the times of all rows in s, from the first one on for clocks and dates."""
    cells = [row.cell(at) for row in rows]
    where = f"{table.name}, column {head}"
    numbers = _numbers(table, rows, at)
    if numbers is not None:
        if not np.isfinite(numbers).all():
            line = rows[int(np.argmin(np.isfinite(numbers)))].line
            what = "is no time"
            raise MeasurementError(f"{table.name}, line {line}, {head}", what, "take it out")
        known = unit_of(unit)
        if known is None or known.kind != "time":
            what = "has no unit" if not unit else f'"{unit}" is no unit of time'
            raise MeasurementError(where, what, f'call it "{head} (s)", or give units= or rate=')
        return numbers * known.factor, ""
    times = np.array([_seconds(cell) for cell in cells])
    if not np.isfinite(times).all():
        wrong = int(np.argmin(np.isfinite(times)))
        what = f'"{cells[wrong][:40]}" is no time'
        hint = "write seconds, 12:30:15.25 or 2026-11-30T12:30:15.25, or give the rate"
        raise MeasurementError(f"{table.name}, line {rows[wrong].line}, {head}", what, hint)
    return times - times[0], f"Times count from {cells[0]}"


def _seconds(cell: str) -> float:
    """Return seconds of a time of day or a date; NaN if it is none."""
    clock = _CLOCK.fullmatch(cell)
    if clock:
        hours, minutes, seconds = clock.groups()
        whole = 3600.0 * int(hours or 0) + 60.0 * int(minutes)
        return whole + float(seconds.replace(",", "."))
    text = cell.replace(",", ".")
    try:
        return datetime.fromisoformat(text).timestamp()
    except ValueError:
        pass
    for form in _DATES:
        try:
            return datetime.strptime(text, form).timestamp()
        except ValueError:
            continue
    return np.nan


def _numbers(table: TextTable, rows: tuple[TextRow, ...], at: int) -> Floats | None:
    """Return the numbers of a column, NaN for cells without one; None if it holds text."""
    cells = [row.cell(at) for row in rows]
    form = NumberForm.of(cells, table.name, columns_by_comma=table.separator == ",")
    found = np.full(len(cells), np.nan)
    for index, cell in enumerate(cells):
        if cell.lower() in _NOTHING:
            continue
        try:
            found[index] = form.read(cell)
        except ValueError:
            return None
    return found if np.isfinite(found).any() else None


def _has_number(cell: str) -> bool:
    return not cell or cell.lower() in _NOTHING or bool(re.fullmatch(r"[-+\d.,eE ]+", cell))
