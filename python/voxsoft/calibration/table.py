"""Measurements from tables of text, with units in the names of the columns."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from voxsoft.calibration.measurement import QUANTITIES, Measurement
from voxsoft.errors import MeasurementError
from voxsoft.records import closest

ARC: Final = "arc_position_from_clamp"
UNITS: Final = {"m": 1.0, "cm": 1e-2, "mm": 1e-3}
_LABELS: Final = ("probe", "material", "note")
_WITH_UNIT: Final = re.compile(rf"({ARC}|d?[xyz])(?:_(.*))?")
_COMMA: Final = re.compile(r"[+-]?\d*,\d*(e[+-]?\d+)?", re.IGNORECASE)
_ALLOWED: Final = (
    f"columns are probe or {ARC}_mm for the station, x_mm, y_mm, z_mm for positions relative to "
    "the clamp face, dx_mm, dy_mm, dz_mm for displacements (units: _m, _cm, _mm), "
    "and material, note"
)


@dataclass(frozen=True)
class _Row:
    line: int
    cells: dict[str, str]


def read_measurement(text: str, *, name: str = "table", select: str | None = None) -> Measurement:
    r"""Read one measurement from text with commas, semicolons or tabs between columns.

    Beside semicolons and tabs, numbers may have decimal commas, as spreadsheets write them in much
    of Europe.

    Lines that start with ``#`` are comments; they name the source of the data and become the
    measurement's source. The first other line names the columns:

    - the station: ``probe`` (a probe of the design) or ``arc_position_from_clamp_m``, on the
      lower edge unless a calibration is given another line;
    - the measured numbers: ``x_m``, ``y_m``, ``z_m``, positions relative to the clamp face, and
      ``dx_m``, ``dy_m``, ``dz_m``, displacements; either may be ``_mm`` or ``_cm``;
    - ``material``, where one table holds several; ``note``, which is not read, as columns without
      a name are not.

    Parameters
    ----------
    text
        Content of the table.
    name
        Name of the table in errors: the file's name.
    select
        Name of the material to take from a table of several; upper and lower case are alike.

    Returns
    -------
    Measurement
        Measurement in SI units, named after its material if the table has one.

    Raises
    ------
    MeasurementError
        A column, unit or cell that cannot be read, with its line; or no such material.

    Examples
    --------
    >>> table = "# me, 2026, CC0\nprobe,dz_mm\ntip,-12.5"
    >>> seen = read_measurement(table)
    >>> seen.probes, float(seen.values[0, 0]), seen.source
    (('tip',), -0.0125, 'me, 2026, CC0')
    """
    _refuse_binary(text, name)
    numbered = list(enumerate(text.removeprefix("\ufeff").splitlines(), start=1))
    comments = [line.lstrip("# ").rstrip() for _, line in numbered if line.startswith("#")]
    lines = [(at, line) for at, line in numbered if line.strip() and not line.startswith("#")]
    if not lines:
        raise MeasurementError(name, "holds no table", _ALLOWED)
    header = lines[0][1]
    separator = max(",;\t", key=header.count)
    columns = _columns(_cells(header, separator), name)
    rows = list(_rows(lines[1:], columns, separator, name))
    rows = _selected(rows, columns, select, name)
    source = " ".join(comment for comment in comments if comment)
    return _measurement(rows, columns, source, name)


def _refuse_binary(text: str, name: str) -> None:
    if "\0" in text:
        raise MeasurementError(name, "is not a text file", "save the table as CSV")


def _cells(line: str, separator: str) -> list[str]:
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]


def _columns(columns: list[str], name: str) -> list[str]:
    if {"X", "Y"} <= {*columns}:
        what = "X and Y are places in a picture, as ImageJ measures them, and name no station"
        hint = (
            f"add a column probe or {ARC}_mm, call X x_mm, measured from the clamp face, and Y "
            "dz_mm, the displacement upward (a picture's Y points down)"
        )
        raise MeasurementError(f"{name}, header", what, hint)
    named = [column for column in columns if column]
    for column in named:
        _check_column(column, name)
    bare = [_stem(column) for column in named]
    twice = next((column for column in bare if bare.count(column) > 1), None)
    if twice:
        raise MeasurementError(f"{name}, header", f'"{twice}" comes twice', "keep one of them")
    if ("probe" in bare) == (ARC in bare):
        what = "both probe and arc position" if "probe" in bare else "no column for the station"
        raise MeasurementError(f"{name}, header", f"has {what}", _ALLOWED)
    if not set(bare) & set(QUANTITIES):
        raise MeasurementError(f"{name}, header", "has no measured quantity", _ALLOWED)
    return columns


def _check_column(column: str, name: str) -> None:
    if column in _LABELS:
        return
    match = _WITH_UNIT.fullmatch(column)
    where = f"{name}, column {column}"
    if match is None:
        known = [*_LABELS, f"{ARC}_m", *(f"{quantity}_m" for quantity in QUANTITIES)]
        hint = closest(column, known)
        raise MeasurementError(where, "is not known", hint if "did" in hint else _ALLOWED)
    if match.group(2) is None:
        raise MeasurementError(where, "has no unit", f'write "{column}_mm"')
    if match.group(2) not in UNITS:
        raise MeasurementError(
            where, f'"{match.group(2)}" is not a unit here', "convert to _m, _cm or _mm"
        )


def _stem(column: str) -> str:
    return column if column in _LABELS else column.rpartition("_")[0]


def _rows(
    lines: Sequence[tuple[int, str]], columns: list[str], separator: str, name: str
) -> Iterator[_Row]:
    for at, line in lines:
        cells = _cells(line, separator)
        if len(cells) != len(columns):
            last = at == lines[-1][0] and len(cells) < len(columns)
            raise MeasurementError(
                f"{name}, line {at}",
                f"has {len(cells)} cells; there are {len(columns)} columns",
                "the file may have been cut off"
                if last
                else "use decimal points, or semicolons between columns",
            )
        if separator != ",":
            cells = [cell.replace(",", ".") if _COMMA.fullmatch(cell) else cell for cell in cells]
        yield _Row(at, dict(zip(columns, cells, strict=True)))


def _selected(rows: list[_Row], columns: list[str], select: str | None, name: str) -> list[_Row]:
    if "material" not in columns:
        if select is not None:
            raise MeasurementError(name, f'has no column "material" to find "{select}" in')
        return rows
    materials = list(dict.fromkeys(row.cells["material"] for row in rows))
    listed = ", ".join(f'"{material}"' for material in materials)
    if select is None:
        if len(materials) > 1:
            raise MeasurementError(
                name, f"holds several materials: {listed}", "choose one: --material, or select="
            )
        return rows
    found = [row for row in rows if row.cells["material"].casefold() == select.casefold()]
    if not found:
        raise MeasurementError(name, f'has no material "{select}"', f"it holds {listed}")
    return found


def _measurement(rows: list[_Row], columns: list[str], source: str, name: str) -> Measurement:
    if not rows:
        raise MeasurementError(name, "has a header and no rows", "the file may have been cut off")
    measured = [column for column in columns if _stem(column) in QUANTITIES]
    values = np.array([[_length(row, column, name) for column in measured] for row in rows])
    arc = next((column for column in columns if _stem(column) == ARC), None)
    title = rows[0].cells.get("material") or name
    try:
        return Measurement(
            quantities=[_stem(column) for column in measured],
            values=values,
            arcs=[_length(row, arc, name) for row in rows] if arc else None,
            probes=None if arc else [row.cells["probe"] for row in rows],
            name=title,
            source=source,
        )
    except MeasurementError as error:
        raise MeasurementError(f"{name}, {error.where}", error.what, error.hint) from None


def _length(row: _Row, column: str, name: str) -> float:
    cell = row.cells[column]
    where = f"{name}, line {row.line}, {column}"
    try:
        value = float(cell)
    except ValueError:
        came = f'"{cell}" is not a number' if cell else "the cell is empty"
        raise MeasurementError(
            where, came, "leave out stations that were not seen; units stand in the header"
        ) from None
    if not np.isfinite(value):
        raise MeasurementError(
            where, f"{cell} is not a finite number", "leave out stations that were not seen"
        )
    return value * UNITS[column.rpartition("_")[2]]
