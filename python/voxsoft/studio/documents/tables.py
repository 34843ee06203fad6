"""Measured tables dropped on the page: content of their columns, with units."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from voxsoft.calibration import Measurement, read_measurement
from voxsoft.calibration.measurement import QUANTITIES
from voxsoft.calibration.table import ARC, header_of, meaning_of
from voxsoft.errors import FileError, MeasurementError, VoxSoftError
from voxsoft.files.measured_tests import read_measured_test
from voxsoft.instruments.heads import unit_of, units_row
from voxsoft.instruments.table_text import TextTable
from voxsoft.studio.protocol import commands, events

#: Possible contents of a column, as the page offers them; "" is a column that is not read.
CHOICES: Final = ("", "arc", "probe", *QUANTITIES, "material", "note")
_LABELS: Final = ("probe", "material", "note")
#: Cells of a column that are shown.
_SAMPLE: Final = 5
#: Units of length, as the page offers them.
_UNITS: Final = ("mm", "cm", "m")


def guessed_columns(text: str) -> list[commands.ColumnMap]:
    r"""Guess the contents of the columns of a table from their names.

    Examples
    --------
    >>> [(c.quantity, c.unit) for c in guessed_columns("s (mm),dz [cm],remark\n1,2,a")]
    [('arc', 'mm'), ('dz', 'cm'), ('', '')]
    """
    header, _, below = _cells(text)
    found = []
    for index, column in enumerate(header):
        meaning, unit = meaning_of(column)
        if meaning in _LABELS:
            found.append(commands.ColumnMap(column=column, quantity=meaning))
        elif meaning == ARC or meaning in QUANTITIES:
            quantity = "arc" if meaning == ARC else meaning
            unit = unit or below.get(index, "")
            known = unit if unit in _UNITS else ""
            found.append(commands.ColumnMap(column=column, quantity=quantity, unit=known))
        else:
            found.append(commands.ColumnMap(column=column, quantity=""))
    return found


def mapped_text(text: str, columns: Sequence[commands.ColumnMap]) -> str:
    """Write a table anew with columns named as a measurement wants them.

    Raises
    ------
    MeasurementError
        A column that is not there, or a quantity or unit that is not known.
    """
    header, rows, _ = _cells(text)
    comments = [line for line in text.splitlines() if line.startswith("#")]
    chosen: list[tuple[int, str]] = []
    for each in columns:
        if not each.quantity:
            continue
        where = f"column {each.column}"
        if each.column not in header:
            raise MeasurementError(where, "is not in the table", f"it has {', '.join(header)}")
        if each.quantity not in CHOICES:
            raise MeasurementError(where, f'"{each.quantity}" is not known')
        name = each.quantity
        if name not in _LABELS:
            if each.unit not in _UNITS:
                raise MeasurementError(where, "needs a unit", f"choose from {', '.join(_UNITS)}")
            name = f"{ARC if name == 'arc' else name}_{each.unit}"
        chosen.append((header.index(each.column), name))
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([name for _, name in chosen])
    for row in rows:
        writer.writerow([row[index] if index < len(row) else "" for index, _ in chosen])
    return "\n".join([*comments, out.getvalue()])


def measured(
    name: str, text: str, columns: Sequence[commands.ColumnMap] | None, select: str | None
) -> tuple[events.Measured, Measurement | None]:
    """Read a table and say how it was understood.

    Returns
    -------
    event
        Event for the page.
    measurement
        None where the table cannot be used as it is; the event says why.
    """
    problems: list[events.Finding] = []
    found: Measurement | None = None
    header: list[str] = []
    rows: list[list[str]] = []
    used: list[commands.ColumnMap] = []
    try:
        header, rows, _ = _cells(text)
        used = list(columns) if columns is not None else guessed_columns(text)
        found = read_measurement(mapped_text(text, used), name=name, select=select)
    except VoxSoftError as error:
        problems = _findings(error)
    by_name = {each.column: each for each in used}
    event = events.Measured(
        name=name,
        columns=[
            events.MeasuredColumn(
                column=column,
                quantity=by_name[column].quantity if column in by_name else "",
                unit=by_name[column].unit if column in by_name else "",
                sample=[row[index] for row in rows[:_SAMPLE] if index < len(row)],
            )
            for index, column in enumerate(header)
        ],
        quantities=list(CHOICES),
        stations=0 if found is None else len(found),
        materials=_materials(header, rows, used),
        arcs=[] if found is None or found.arcs is None else found.arcs.tolist(),
        points=[] if found is None else _points(found),
        problems=problems,
    )
    return event, found


def table_uses(name: str, text: str) -> events.TableUses:
    r"""Say which uses a table can have, by the names of its columns.

    Raises
    ------
    MeasurementError
        It is no table.

    Examples
    --------
    >>> table_uses("a.csv", "strain,stress_kPa\n0,0").uses
    ['coupon']
    >>> table_uses("a.csv", "displacement_mm,force_N\n0,0").uses
    ['coupon', 'curve']
    >>> table_uses("a.csv", "arc_position_mm,dz_mm\n0,0").uses
    ['stations']
    >>> table_uses("a.csv", "pressure_kPa,angle_deg\n0,0").uses
    ['curve', 'stations']
    """
    # With its fits the package takes SciPy: a studio that starts does without.
    from voxsoft.materials.coupon import curve_quantities

    if is_test(name):
        return events.TableUses(name=name, uses=["stations"])
    named = curve_quantities(text, name=name)
    if named is not None:
        alone = "displacement" not in named and "force" not in named
        return events.TableUses(name=name, uses=["coupon"] if alone else ["coupon", "curve"])
    columns = {each.quantity for each in guessed_columns(text)}
    if columns & {"arc", "probe"}:
        return events.TableUses(name=name, uses=["stations"])
    return events.TableUses(name=name, uses=["curve", "stations"])


def is_test(name: str) -> bool:
    """Return True for a test of instruments, in TOML, by the name of its file."""
    return name.lower().endswith(".toml")


def measured_test(
    name: str, text: str, folder: Path
) -> tuple[events.Measured, tuple[Measurement, ...]]:
    """Read a test of instruments, whose files are in the folder of the document.

    Returns
    -------
    event
        Event for the page.
    measurements
        One for each load; none where the test cannot be used, as the event says.
    """
    found: tuple[Measurement, ...] = ()
    problems: list[events.Finding] = []
    try:
        test = read_measured_test(text, name)
        inside = folder.resolve()
        for file in test.files:
            if not (inside / file).resolve().is_relative_to(inside):
                hint = "copy the file beside the design"
                raise FileError(name, f"names {file}, which is outside of the folder", hint)
        found = tuple(test.measurements(folder))
    except VoxSoftError as error:
        problems = _findings(error)
    first = found[0] if found else None
    event = events.Measured(
        name=name,
        columns=[],
        quantities=list(CHOICES),
        stations=sum(len(each) for each in found),
        materials=[],
        arcs=[] if first is None or first.arcs is None else first.arcs.tolist(),
        points=[] if first is None else _points(first),
        problems=problems,
    )
    return event, found


def _findings(error: VoxSoftError) -> list[events.Finding]:
    return [
        events.Finding(severity="error", where=p.where, what=p.what, hint=p.hint)
        for p in error.problems
    ]


def _cells(text: str) -> tuple[list[str], list[list[str]], dict[int, str]]:
    """Header, rows with numbers in plain form, and units below the header, of a table."""
    table = TextTable.of(text, "table")
    if not table.rows:
        raise MeasurementError("table", "holds no table", "name the columns in its first line")
    at = header_of(table)
    header = table.rows[at].cells
    named = range(len(header))
    below = units_row(table.rows, at, named) or {}
    rows = table.rows[at + (2 if below else 1) :]
    columns = [index for index in named if meaning_of(header[index])[0] not in _LABELS]
    form = table.numbers(rows, columns)

    def plain(cell: str, index: int) -> str:
        try:
            return repr(form.read(cell)) if index in columns else cell
        except ValueError:
            return cell

    cells = [[plain(cell, index) for index, cell in enumerate(row.cells)] for row in rows]
    return list(header), cells, {i: u for i, u in below.items() if unit_of(u) is not None}


def _materials(
    header: list[str], rows: list[list[str]], used: Sequence[commands.ColumnMap]
) -> list[str]:
    labels = [each.column for each in used if each.quantity == "material"]
    if not labels or labels[0] not in header:
        return []
    index = header.index(labels[0])
    return list(dict.fromkeys(row[index] for row in rows if index < len(row)))


def _points(found: Measurement) -> list[tuple[float, float, float]]:
    """Measured numbers as points, zero along axes that were not measured [m]."""
    points = []
    for row in found.values:
        point = [0.0, 0.0, 0.0]
        for axis, value in zip(found.axes, row, strict=True):
            point[int(axis)] = float(value)
        points.append((point[0], point[1], point[2]))
    return points
