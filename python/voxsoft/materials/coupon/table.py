"""Reading of curves from the tables of testing machines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from voxsoft.errors import MeasurementError
from voxsoft.instruments.heads import is_unit, split_head, unit_of, units_row
from voxsoft.instruments.measured import Measured
from voxsoft.instruments.table_text import PREAMBLE, TextRow, TextTable
from voxsoft.materials.coupon.curve import Curve
from voxsoft.materials.coupon.cycles import Cycles
from voxsoft.materials.coupon.timed import TestKind, TimedTest
from voxsoft.materials.homogeneous import Mode
from voxsoft.materials.hyperelastic import Floats
from voxsoft.units import KINDS, format_quantity, to_si

# English and German column names of machines of Instron, MTS, Shimadzu and ZwickRoell. "Travel" is
# that of the crosshead.
_NAMES: Final = {
    "strain": (
        *("strain", "eng strain", "engineering strain", "nominal strain", "tensile strain"),
        *("dehnung", "technische dehnung", "nenndehnung"),
    ),
    "stretch": ("stretch", "stretch ratio", "lambda"),
    "displacement": (
        *("displacement", "extension", "tensile extension", "elongation", "crosshead", "stroke"),
        *("standard travel", "crosshead travel", "crosshead displacement", "deformation", "disp."),
        *("weg", "standardweg", "traversenweg", "verlängerung", "verformung"),
    ),
    "stress": (
        *("stress", "eng stress", "engineering stress", "nominal stress", "tensile stress"),
        *("spannung", "technische spannung", "nennspannung", "zugspannung"),
    ),
    "force": (
        *("force", "load", "tensile load", "standard force", "test force", "axial force"),
        *("kraft", "standardkraft", "prüfkraft"),
    ),
    "time": ("time", "test time", "elapsed time", "zeit", "prüfzeit"),
}
# Displacements that give way to another one in the same table.
_SECOND: Final = (
    *("crosshead", "crosshead travel", "crosshead displacement", "traversenweg"),
    *("deformation", "verformung"),
)
# Columns of compression, whose sign differs between machines: they are negative here.
_PRESSED: Final = {
    "strain": ("compressive strain", "compression strain", "stauchung"),
    "displacement": (
        *("compressive extension", "compressive displacement", "compression", "druckweg"),
        *("compressive extension at standard", "compression displacement"),
    ),
    "stress": ("compressive stress", "compression stress", "druckspannung"),
    "force": ("compressive load", "compressive force", "compression load", "druckkraft"),
}
_TRUE: Final = (
    *("true strain", "log strain", "true stress", "cauchy stress"),
    *("wahre dehnung", "wahre spannung"),
)
_LABELS: Final = frozenset(
    label for names in (_NAMES, _PRESSED) for labels in names.values() for label in labels
) | {*_TRUE}
_STRAINS: Final = ("strain", "stretch", "displacement")
_STRESSES: Final = ("stress", "force")
_KIND: Final = {"displacement": "length", "stress": "pressure", "force": "force", "time": "time"}
_EXAMPLE: Final = {
    "displacement": "displacement_mm",
    "stress": "stress_kPa",
    "force": "force_N",
    "time": "time_s",
}
_ALLOWED: Final = (
    "strain (or strain_percent, stretch, displacement_mm) and stress_kPa (or _Pa, _MPa, force_N)"
)
# Upper limit of the strain of any rubber: some stretch to 20 times their length.
_LARGEST_STRAIN: Final = 25.0


class _Column(NamedTuple):
    """Column of a table: index, head, quantity, unit; if it says compression, or gives way."""

    at: int
    head: str
    name: str
    unit: str
    pressed: bool = False
    second: bool = False


def read_curve(
    data: str | Measured,
    *,
    name: str = "curve",
    mode: Mode = "uniaxial",
    area: float | str | None = None,
    length: float | str | None = None,
) -> Curve:
    r"""Read a stress-strain curve from a table with one header line.

    Parameters
    ----------
    data
        Text, comma, semicolon or tab separated, or measured data (:func:`voxsoft.measured`).
        Columns are found by name, units stand behind the name or in the line below:
        ``strain`` (or ``eng_strain``; ``strain_percent``, ``strain (%)``), ``stretch`` or
        ``displacement_mm``; and ``stress_kPa`` (``stress [MPa]``, ``eng_stress_Pa``, ...) or
        ``force_N``. Strain and stress are engineering quantities. Other columns are left alone.
    name
        Name in errors and reports.
    mode
        Mode of the test: ``"uniaxial"``, ``"equibiaxial"`` or ``"planar"``.
    area
        Original cross section in m² or with its unit, for a column of forces.
    length
        Original gauge length in m or with its unit, for a column of displacements.

    Returns
    -------
    Curve
        Curve, cut at the largest stress if the stress falls to less than half of it after that: the
        specimen broke.

    Raises
    ------
    MeasurementError
        No such columns (those that came are listed), a unit of the wrong kind, text where a number
        belongs, too few points, a cycle.

    Examples
    --------
    >>> rows = "".join(f"\n{10 * i},{i}" for i in range(8))
    >>> read_curve("strain (%),stress [kPa]" + rows).stress[:3].tolist()
    [0.0, 1000.0, 2000.0]
    >>> read_curve("time,voltage")
    Traceback (most recent call last):
    ...
    voxsoft.errors.MeasurementError: curve: no column of strain and no column of stress among ...
    """
    strain, stress = _columns(data, name, area, length)
    broken = _break(strain, stress)
    whole = slice(None) if broken is None else slice(0, broken + 1)
    return Curve(
        strain[whole],
        stress[whole],
        mode,
        name,
        None if broken is None else float(strain[broken]),
    )


def read_cycles(
    data: str | Measured,
    *,
    name: str = "cycles",
    mode: Mode = "uniaxial",
    area: float | str | None = None,
    length: float | str | None = None,
) -> Cycles:
    r"""Read a test with load and unload from a table; see :func:`read_curve` for its form.

    Raises
    ------
    MeasurementError
        The errors of :func:`read_curve`; or a strain that never falls.

    Examples
    --------
    >>> way = [0, 2, 4, 6, 8, 10, 8, 6, 4, 2, 0]
    >>> text = "strain (%),stress_kPa" + "".join(f"\n{x},{x}" for x in way)
    >>> read_cycles(text).strain[5:7].tolist()
    [0.1, 0.08]
    """
    return Cycles(*_columns(data, name, area, length), mode, name)


def read_timed_test(
    data: str | Measured,
    *,
    kind: TestKind,
    name: str = "test",
    area: float | str | None = None,
    length: float | str | None = None,
) -> TimedTest:
    r"""Read a uniaxial test over time from a table; see :func:`read_curve` for its form.

    Parameters
    ----------
    data
        Table with a column of the time besides, ``time_s`` (``Time (min)``, ``Zeit [s]``).
    kind
        ``"relaxation"``: the strain is held; ``"rate"``: it grows at one rate.
    name, area, length
        See :func:`read_curve`.

    Raises
    ------
    MeasurementError
        The errors of :func:`read_curve`; no column of the time; or a strain that is not held, or
        does not grow at one rate.

    Examples
    --------
    >>> rows = "".join(f"\n{10 * i},50,{20 + 10 / (1 + i)}" for i in range(8))
    >>> read_timed_test("time_s,strain (%),stress_kPa" + rows, kind="relaxation").duration
    70.0
    """
    strain, stress, time = _timed_columns(data, name, area, length)
    return TimedTest(time, strain, stress, kind, name)


def curve_quantities(text: str, *, name: str = "table") -> tuple[str, str] | None:
    """Return the names of the quantities of a curve in a table, or None of any other table.

    Parameters
    ----------
    text
        Text of the table; see :func:`read_curve`.
    name
        Name in errors.

    Raises
    ------
    MeasurementError
        The text is no table.

    Examples
    --------
    >>> curve_quantities("time_s,Extension (mm),Load (N)")
    ('displacement', 'force')
    >>> curve_quantities("pressure_kPa,angle_deg") is None
    True
    """
    for row in TextTable.of(text, name).rows[:PREAMBLE]:
        names = {column.name for column in _known(row)}
        across = next((each for each in _STRAINS if each in names), None)
        along = next((each for each in _STRESSES if each in names), None)
        if across and along:
            return across, along
    return None


def _columns(
    data: str | Measured, name: str, area: float | str | None, length: float | str | None
) -> tuple[Floats, Floats]:
    """Return strain and stress in Pa, uncorrected, from a table."""
    return _quantities(data, name, area, length, timed=False)[:2]


def _timed_columns(
    data: str | Measured, name: str, area: float | str | None, length: float | str | None
) -> tuple[Floats, Floats, Floats]:
    """Return strain, stress in Pa and time in s from a table."""
    strain, stress, time = _quantities(data, name, area, length, timed=True)
    assert time is not None
    return strain, stress, time


def _quantities(
    data: str | Measured,
    name: str,
    area: float | str | None,
    length: float | str | None,
    *,
    timed: bool,
) -> tuple[Floats, Floats, Floats | None]:
    """Return strain, stress in Pa and, if asked, time in s from a table."""
    length = None if length is None else to_si(length, "length", "length")
    area = None if area is None else to_si(area, "area", "area")
    if isinstance(data, str):
        columns, numbers = _of_text(data, name, timed)
    else:
        columns, numbers = _of_measured(data, name, timed)
    strain = _strain(numbers[:, 0], columns[0], length, name)
    stress = _stress(numbers[:, 1], columns[1], area, name)
    strain, stress = (
        _compressive(values) if column.pressed else values
        for values, column in ((strain, columns[0]), (stress, columns[1]))
    )
    return strain, stress, numbers[:, 2] * _factor(columns[2], name) if timed else None


def _of_text(text: str, name: str, timed: bool) -> tuple[list[_Column], Floats]:
    """Return the columns that are read, and their numbers, from a text."""
    table = TextTable.of(text, name)
    if not table.rows:
        raise MeasurementError(name, "is empty", f"give columns {_ALLOWED}")
    header, columns = _header(table, timed)
    table.check_lengths(header)
    first = header + 1
    below = units_row(table.rows, header, [column.at for column in columns])
    if below is not None:
        first += 1
        if not any(column.unit for column in columns):
            columns = [column._replace(unit=below[column.at]) for column in columns]
    return columns, _numbers(table, table.rows[first:], columns)


def _of_measured(data: Measured, name: str, timed: bool) -> tuple[list[_Column], Floats]:
    """Return the columns that are read, and their numbers, from measured data."""
    columns = [
        found._replace(unit=column.unit, head=column.name)
        for at, column in enumerate(data.columns)
        if (found := _column(at, column.name.rpartition("/")[2]))
    ]
    across, along = _one_of(columns, _STRAINS, name), _one_of(columns, _STRESSES, name)
    if across is None or along is None:
        raise _missing(name, [column.name for column in data.columns], columns)
    chosen = [data.columns[across.at], data.columns[along.at]]
    clocks = [column.times for column in chosen]
    alone = sum(times is None for times in clocks)
    if alone == 1 or (not alone and not _alike(*clocks)):
        what = f'"{across.head}" and "{along.head}" were measured at different times'
        raise MeasurementError(name, what, "give .resampled(rate) of the measured data")
    numbers = [column.numbers for column in chosen]
    used = [across, along]
    if timed:
        if clocks[0] is None:
            raise MeasurementError(name, "has no time", "give rate= or time= to vs.measured")
        used.append(_Column(-1, "time", "time", "s"))
        numbers.append(clocks[0])
    table = np.stack(numbers, axis=1)
    return used, table[np.isfinite(table).all(axis=1)]


def _alike(first: Floats | None, second: Floats | None) -> bool:
    return first is not None and second is not None and bool(np.array_equal(first, second))


def _header(table: TextTable, timed: bool) -> tuple[int, list[_Column]]:
    """Find the line that names a strain and a stress; machines write some lines above it."""
    for at, row in enumerate(table.rows[:PREAMBLE]):
        columns = _known(row)
        where = f"{table.name}, line {row.line}"
        across = _one_of(columns, _STRAINS, where)
        along = _one_of(columns, _STRESSES, where)
        if across and along:
            over = [_time_column(row, columns, where)] if timed else []
            return at, [across, along, *over]
    likely = table.rows[table.likely_header(is_unit)]
    raise _missing(table.name, likely.cells, _known(likely))


def _known(row: TextRow) -> list[_Column]:
    return [column for i, cell in enumerate(row.cells) if (column := _column(i, cell))]


def _missing(name: str, cells: Sequence[str], found: Sequence[_Column]) -> MeasurementError:
    heads = [cell for cell in cells if cell]
    missing = [
        f"no column of {what}"
        for what, names in (("strain", _STRAINS), ("stress", _STRESSES))
        if not any(column.name in names for column in found)
    ]
    came = ", ".join(f'"{head}"' for head in heads[:12]) + (", ..." if len(heads) > 12 else "")
    hint = f"name them {_ALLOWED}"
    if any(split_head(head, _LABELS)[0] in _TRUE for head in heads):
        hint = "expected engineering quantities: stress = true stress/stretch, strain = stretch - 1"
    return MeasurementError(name, f"{' and '.join(missing)} among {came}", hint)


def _time_column(header: TextRow, columns: Sequence[_Column], where: str) -> _Column:
    found = _one_of(columns, ("time",), where)
    if found is None:
        heads = ", ".join(f'"{cell}"' for cell in header.cells if cell)
        raise MeasurementError(
            where, f"no column of the time among {heads}", "call it time_s (or _min, _h)"
        )
    return found


def _one_of(columns: Sequence[_Column], names: Sequence[str], where: str) -> _Column | None:
    """Choose the column with the first of these names."""
    for name in names:
        same = [column for column in columns if column.name == name]
        same = [column for column in same if not column.second] or same
        if len(same) > 1:
            heads = " and ".join(f'"{column.head}"' for column in same)
            raise MeasurementError(where, f"{heads} are both a {name}", "leave one of them out")
        if same:
            return same[0]
    return None


def _column(index: int, cell: str) -> _Column | None:
    label, unit = split_head(cell, _LABELS)
    for pressed, labels in ((False, _NAMES), (True, _PRESSED)):
        for name, known in labels.items():
            if label in known:
                return _Column(index, cell, name, unit, pressed, label in _SECOND)
    return None


def _compressive(values: Floats) -> Floats:
    """Return numbers of a column of compression with the sign of compression, negative."""
    if not len(values):
        return values
    largest = values[np.argmax(np.abs(values))]
    return -values if largest > 0.0 else values


def _numbers(table: TextTable, rows: Sequence[TextRow], columns: Sequence[_Column]) -> Floats:
    form = table.numbers(rows, [column.at for column in columns])
    found = []
    for row in rows:
        pair = []
        for column in columns:
            cell = row.cell(column.at)
            try:
                pair.append(form.read(cell))
            except ValueError:
                raise MeasurementError(
                    f"{table.name}, line {row.line}",
                    f'"{cell[:40]}" in column "{column.head}" is not a number',
                    "take the line out if nothing was measured there",
                ) from None
        found.append(pair)
    return np.array(found, dtype=np.float64).reshape(-1, len(columns))


def _factor(column: _Column, name: str) -> float:
    kind = _KIND[column.name]
    where, example = f'column "{column.head}"', f'call it "{_EXAMPLE[column.name]}", say'
    if not column.unit:
        raise MeasurementError(name, f"{where} has no unit", example)
    found = unit_of(column.unit)
    if found is None:
        what = f'{where}: there is no unit "{column.unit}"'
        raise MeasurementError(name, what, example)
    if found.kind != kind:
        what = f'{where}: "{column.unit}" is no unit of {kind}; expected {KINDS[kind].article}'
        raise MeasurementError(name, what, example)
    return found.factor


def _strain(
    values: Floats,
    column: _Column,
    length: float | None,
    name: str,
) -> Floats:
    if column.name == "displacement":
        if length is None:
            raise MeasurementError(
                name,
                f'column "{column.head}" is a displacement, which needs the gauge length',
                'give --length "33 mm"',
            )
        return values * _factor(column, name) / length
    unit = unit_of(column.unit)
    if unit is None or unit.kind != "number":
        raise MeasurementError(
            name, f'column "{column.head}": "{column.unit}" is no unit of strain', "use % or none"
        )
    values = values * unit.factor
    strain = values - 1.0 if column.name == "stretch" else values
    if len(strain) and np.abs(strain).max() > _LARGEST_STRAIN:
        raise MeasurementError(
            name,
            f'column "{column.head}" goes to {np.abs(values).max():g}; no rubber stretches so far',
            'if these are percent, call it "strain_percent"',
        )
    return strain


def _stress(
    values: Floats,
    column: _Column,
    area: float | None,
    name: str,
) -> Floats:
    if column.name == "stress":
        return values * _factor(column, name)
    if area is None:
        raise MeasurementError(
            name,
            f'column "{column.head}" is a force, which needs the original cross section',
            f'give --area "{format_quantity(18e-6, "area")}"',
        )
    return values * _factor(column, name) / area


def _break(
    strain: Floats,
    stress: Floats,
) -> int | None:
    """Return the index of the last point before the break, if the specimen broke in tension."""
    if len(stress) < 2 or not (np.isfinite(stress).all() and np.isfinite(strain).all()):
        return None
    top = int(np.argmax(stress))
    broke = top < len(stress) - 1 and stress[top] > 0.0 and stress[-1] < 0.5 * stress[top]
    return top if broke else None
