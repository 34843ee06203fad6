"""Measurements from tables of text, with units in the names of the columns."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import replace
from typing import Final, NamedTuple, get_args

import numpy as np

from voxsoft.calibration.line import LineName
from voxsoft.calibration.measurement import QUANTITIES, Measurement
from voxsoft.errors import MeasurementError
from voxsoft.instruments.heads import is_unit, split_head, unit_of, units_row
from voxsoft.instruments.table_text import PREAMBLE, NumberForm, TextRow, TextTable
from voxsoft.records import closest

ARC: Final = "arc_position_from_clamp"
#: Labels of the arc position, as a head without its unit.
ARCS: Final = ("arc position from clamp", "arc position", "arc length", "arc", "s")
_LABELS: Final = ("probe", "material", "note")
_KNOWN: Final = frozenset((*ARCS, *QUANTITIES, *_LABELS))
_LINE: Final = "line:"
_SET: Final = "set:"
_ALLOWED: Final = (
    f"columns are probe or {ARC}_mm for the station, x_mm, y_mm, z_mm for positions relative to "
    "the clamp face, dx_mm, dy_mm, dz_mm for displacements (or in other units of length), "
    "and material, note"
)


class _Head(NamedTuple):
    """Head of a column: index, text, meaning, and its unit in m (0 of text)."""

    at: int
    text: str
    label: str
    factor: float = 0.0


def read_measurement(text: str, *, name: str = "table", select: str | None = None) -> Measurement:
    r"""Read one measurement from text with commas, semicolons or tabs between columns.

    Beside semicolons and tabs, numbers may have decimal commas, as spreadsheets write them in much
    of Europe; thousands may be set apart. Lines above the header are passed over.

    Lines that start with ``#`` are comments; they name the source of the data and become the
    measurement's source. ``# line: centerline`` (or ``lower-edge``, ``upper-edge``) says on which
    line of the body arc positions were marked; ``# set: loads[0].value=12 kPa`` says a value of the
    design in this test. The header names the columns:

    - the station: ``probe`` (a probe of the design) or ``arc_position_from_clamp_m``, on the
      lower edge unless a calibration is given another line;
    - the measured numbers: ``x_m``, ``y_m``, ``z_m``, positions relative to the clamp face, and
      ``dx_m``, ``dy_m``, ``dz_m``, displacements; either in any unit of length, behind the name
      (``x_mm``, ``x [mm]``) or in the line below;
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
    table = TextTable.of(text, name)
    if not table.rows:
        raise MeasurementError(name, "holds no table", _ALLOWED)
    at = header_of(table)
    heads = _heads(table, at)
    rows = table.rows[at + 1 :]
    if units_row(table.rows, at, [head.at for head in heads if head.label not in _LABELS]):
        rows = rows[1:]
    _check_lengths(rows, len(table.rows[at].cells), name)
    chosen = _selected(rows, heads, select, name)
    lines, changes = (
        [each for each in table.comments if each.lower().startswith(key)] for key in (_LINE, _SET)
    )
    source = " ".join(each for each in table.comments if each not in (*lines, *changes))
    found = _measurement(table, chosen, heads, source)
    return replace(
        found,
        line=_line(lines, name),
        changes=tuple(each[len(_SET) :].strip() for each in changes),
    )


def table_of(measurement: Measurement) -> str:
    """Write a measurement as a table that :func:`read_measurement` reads back as it is, but names.

    Examples
    --------
    >>> seen = Measurement(quantities=["dz"], values=[[-0.005]], probes=["tip"], changes=["a=1 mm"])
    >>> print(table_of(seen), end="")
    # set: a=1 mm
    probe,dz_m
    tip,-0.005
    """
    comments = [measurement.source] if measurement.source else []
    comments += [f"{_LINE} {measurement.line}"] if measurement.line else []
    comments += [f"{_SET} {change}" for change in measurement.changes]
    arcs = measurement.arcs
    stations = list(map(repr, arcs.tolist())) if arcs is not None else measurement.probes
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(
        ["probe" if arcs is None else f"{ARC}_m", *(f"{each}_m" for each in measurement.quantities)]
    )
    for station, row in zip(stations or (), measurement.values.tolist(), strict=True):
        writer.writerow([station, *map(repr, row)])
    return "".join(f"# {comment}\n" for comment in comments) + out.getvalue()


def _line(comments: Sequence[str], name: str) -> LineName | None:
    """Return the line of the body that the comments name, if any."""
    named = {comment[len(_LINE) :].strip().lower().replace(" ", "-") for comment in comments}
    if not named:
        return None
    lines: dict[str, LineName] = {line: line for line in get_args(LineName)}
    if len(named) > 1 or not named <= set(lines):
        came = " and ".join(f'"{line}"' for line in sorted(named))
        raise MeasurementError(f"{name}, # line:", came, f"name one of {', '.join(lines)}")
    return lines[named.pop()]


def header_of(table: TextTable) -> int:
    """Find the row that names a station and a measured quantity; lines may stand above it."""
    for at, row in enumerate(table.rows[:PREAMBLE]):
        labels = {meaning_of(cell)[0] for cell in row.cells}
        if labels & {"probe", ARC} and labels & {*QUANTITIES}:
            return at
    return table.likely_header(is_unit)


def meaning_of(cell: str) -> tuple[str, str]:
    """Return the meaning of a head and its unit.

    Examples
    --------
    >>> meaning_of("Arc position (mm)"), meaning_of("dz_m"), meaning_of("remark")
    (('arc_position_from_clamp', 'mm'), ('dz', 'm'), ('remark', ''))
    """
    label, unit = split_head(cell, _KNOWN)
    return (ARC if label in ARCS else label), unit


def _heads(table: TextTable, at: int) -> list[_Head]:
    name, cells = table.name, table.rows[at].cells
    if {"X", "Y"} <= {*cells}:
        raise _of_a_picture(name)
    named = [index for index, cell in enumerate(cells) if cell]
    below = units_row(table.rows, at, named) or {}
    heads = [_head(index, cells[index], below.get(index, ""), name) for index in named]
    labels = [head.label for head in heads]
    twice = next((label for label in labels if labels.count(label) > 1), None)
    if twice:
        raise MeasurementError(f"{name}, header", f'"{twice}" comes twice', "keep one of them")
    if ("probe" in labels) == (ARC in labels):
        what = "both probe and arc position" if "probe" in labels else "no column for the station"
        raise MeasurementError(f"{name}, header", f"has {what}", _ALLOWED)
    if not {*labels} & {*QUANTITIES}:
        raise MeasurementError(f"{name}, header", "has no measured quantity", _ALLOWED)
    return heads


def _of_a_picture(name: str) -> MeasurementError:
    what = "X and Y are places in a picture, as ImageJ measures them, and name no station"
    hint = (
        f'describe them in a test (TOML): picture = {{ file = "{name}", unit = "mm", stations = '
        '["0 mm", "15 mm"] }, the first at the clamp face; or add a column probe, and call X x_mm, '
        "from the clamp face, and Y dz_mm, upward (a picture's Y points down)"
    )
    return MeasurementError(f"{name}, header", what, hint)


def _head(at: int, cell: str, below: str, name: str) -> _Head:
    label, unit = meaning_of(cell)
    if label in _LABELS:
        return _Head(at, cell, label)
    where = f"{name}, column {cell}"
    if label not in (ARC, *QUANTITIES):
        known = [*_LABELS, f"{ARC}_m", *(f"{quantity}_m" for quantity in QUANTITIES)]
        hint = closest(cell, known)
        raise MeasurementError(where, "is not known", hint if "did" in hint else _ALLOWED)
    found = unit_of(unit or below)
    if not (unit or below):
        raise MeasurementError(where, "has no unit", f'write "{cell}_mm"')
    if found is None or found.kind != "length":
        what = f'"{unit or below}" is not a unit of length'
        raise MeasurementError(where, what, "convert to _m, _cm or _mm")
    return _Head(at, cell, label, found.factor)


def _check_lengths(rows: Sequence[TextRow], width: int, name: str) -> None:
    for row in rows:
        if len(row.cells) == width or (len(row.cells) > width and not any(row.cells[width:])):
            continue
        last = row is rows[-1] and len(row.cells) < width
        raise MeasurementError(
            f"{name}, line {row.line}",
            f"has {len(row.cells)} cells; there are {width} columns",
            "the file may have been cut off"
            if last
            else "use decimal points, or semicolons between columns",
        )


def _selected(
    rows: Sequence[TextRow], heads: Sequence[_Head], select: str | None, name: str
) -> list[TextRow]:
    column = next((head.at for head in heads if head.label == "material"), None)
    if column is None:
        if select is not None:
            raise MeasurementError(name, f'has no column "material" to find "{select}" in')
        return list(rows)
    materials = list(dict.fromkeys(row.cell(column) for row in rows))
    listed = ", ".join(f'"{material}"' for material in materials)
    if select is None:
        if len(materials) > 1:
            raise MeasurementError(
                name, f"holds several materials: {listed}", "choose one: --material, or select="
            )
        return list(rows)
    found = [row for row in rows if row.cell(column).casefold() == select.casefold()]
    if not found:
        raise MeasurementError(name, f'has no material "{select}"', f"it holds {listed}")
    return found


def _measurement(
    table: TextTable,
    rows: Sequence[TextRow],
    heads: Sequence[_Head],
    source: str,
) -> Measurement:
    name = table.name
    if not rows:
        raise MeasurementError(name, "has a header and no rows", "the file may have been cut off")
    form = table.numbers(rows, [head.at for head in heads if head.factor])
    measured = [head for head in heads if head.label in QUANTITIES]
    values = np.array([[_length(row, head, form, name) for head in measured] for row in rows])
    at = {head.label: head for head in heads}
    arc, material = at.get(ARC), at.get("material")
    try:
        return Measurement(
            quantities=[head.label for head in measured],
            values=values,
            arcs=[_length(row, arc, form, name) for row in rows] if arc else None,
            probes=None if arc else [row.cell(at["probe"].at) for row in rows],
            name=(rows[0].cell(material.at) if material else "") or name,
            source=source,
        )
    except MeasurementError as error:
        raise MeasurementError(f"{name}, {error.where}", error.what, error.hint) from None


def _length(row: TextRow, head: _Head, form: NumberForm, name: str) -> float:
    cell = row.cell(head.at)
    where = f"{name}, line {row.line}, {head.text}"
    try:
        value = form.read(cell)
    except ValueError:
        came = f'"{cell}" is not a number' if cell else "the cell is empty"
        raise MeasurementError(
            where, came, "leave out stations that were not seen; units stand in the header"
        ) from None
    if not np.isfinite(value):
        raise MeasurementError(
            where, f"{cell} is not a finite number", "leave out stations that were not seen"
        )
    return value * head.factor
