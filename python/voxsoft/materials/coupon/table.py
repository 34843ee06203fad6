"""Reading of curves from the tables of testing machines."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from voxsoft.errors import MeasurementError, UnitError
from voxsoft.materials.coupon.curve import Curve
from voxsoft.materials.coupon.cycles import Cycles
from voxsoft.materials.coupon.timed import TestKind, TimedTest
from voxsoft.materials.homogeneous import Mode
from voxsoft.materials.hyperelastic import Floats
from voxsoft.units import format_quantity, parse, to_si

# English and German column names of machines of Instron, MTS, Shimadzu and ZwickRoell. "Travel" is
# that of the crosshead; compression, whose sign differs between machines, is not guessed.
_NAMES: Final = {
    "strain": (
        *("strain", "eng strain", "engineering strain", "nominal strain", "tensile strain"),
        *("dehnung", "technische dehnung", "nenndehnung"),
    ),
    "stretch": ("stretch", "stretch ratio", "lambda"),
    "displacement": (
        *("displacement", "extension", "tensile extension", "elongation", "crosshead", "stroke"),
        *("standard travel", "weg", "standardweg", "traversenweg", "verlängerung"),
    ),
    "stress": (
        *("stress", "eng stress", "engineering stress", "nominal stress", "tensile stress"),
        *("spannung", "technische spannung", "nennspannung", "zugspannung"),
    ),
    "force": ("force", "load", "tensile load", "standard force", "kraft", "standardkraft"),
    "time": ("time", "test time", "elapsed time", "zeit", "prüfzeit"),
}
_TRUE: Final = (
    *("true strain", "log strain", "true stress", "cauchy stress"),
    *("wahre dehnung", "wahre spannung"),
)
_STRAINS: Final = ("strain", "stretch", "displacement")
_STRESSES: Final = ("stress", "force")
_KIND: Final = {"displacement": "length", "stress": "pressure", "force": "force", "time": "time"}
_EXAMPLE: Final = {
    "displacement": "displacement_mm",
    "stress": "stress_kPa",
    "force": "force_N",
    "time": "time_s",
}
_NO_UNIT: Final = ("", "-", "1", "mm/mm", "m/m", "in/in")
_PERCENT: Final = ("%", "percent", "pct")
# Machines write units in any case; "Mpa" is no millipascal.
_CASELESS: Final = {u.lower(): u for u in ("Pa", "kPa", "MPa", "GPa", "N", "kN", "mm", "m", "psi")}
_ALLOWED: Final = (
    "strain (or strain_percent, stretch, displacement_mm) and stress_kPa (or _Pa, _MPa, force_N)"
)
# Upper limit of the strain of any rubber: some stretch to 20 times their length.
_LARGEST_STRAIN: Final = 25.0
_LARGEST_TEXT: Final = 50_000_000


class _Column(NamedTuple):
    at: int
    head: str
    name: str
    unit: str


def read_curve(
    text: str,
    *,
    name: str = "curve",
    mode: Mode = "uniaxial",
    area: float | str | None = None,
    length: float | str | None = None,
) -> Curve:
    r"""Read a stress-strain curve from a table with one header line.

    Parameters
    ----------
    text
        Comma, semicolon or tab separated. Columns are found by name, units stand behind the name:
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
    strain, stress = _columns(text, name, area, length)
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
    text: str,
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
    return Cycles(*_columns(text, name, area, length), mode, name)


def read_timed_test(
    text: str,
    *,
    kind: TestKind,
    name: str = "test",
    area: float | str | None = None,
    length: float | str | None = None,
) -> TimedTest:
    r"""Read a uniaxial test over time from a table; see :func:`read_curve` for its form.

    Parameters
    ----------
    text
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
    strain, stress, time = _timed_columns(text, name, area, length)
    return TimedTest(time, strain, stress, kind, name)


def _columns(
    text: str, name: str, area: float | str | None, length: float | str | None
) -> tuple[Floats, Floats]:
    """Return strain and stress in Pa, uncorrected, from a table."""
    return _quantities(text, name, area, length, timed=False)[:2]


def _timed_columns(
    text: str, name: str, area: float | str | None, length: float | str | None
) -> tuple[Floats, Floats, Floats]:
    """Return strain, stress in Pa and time in s from a table."""
    strain, stress, time = _quantities(text, name, area, length, timed=True)
    assert time is not None
    return strain, stress, time


def _quantities(
    text: str,
    name: str,
    area: float | str | None,
    length: float | str | None,
    *,
    timed: bool,
) -> tuple[Floats, Floats, Floats | None]:
    """Return strain, stress in Pa and, if asked, time in s from a table."""
    length = None if length is None else to_si(length, "length", "length")
    area = None if area is None else to_si(area, "area", "area")
    separator, rows = _rows(text, name)
    start, across, along = _header(rows, name)
    columns = [across, along]
    if timed:
        columns.append(_time_column(rows[start], f"{name}, line {start + 1}"))
    if _is_units_row(rows, start, columns):
        unit_row = rows[start + 1]
        columns = [c._replace(unit=unit_row[c.at].strip(" ()[]")) for c in columns]
        start += 1
    numbers = _numbers(rows, start + 1, columns, name, decimal_comma=separator != ",")
    strain = _strain(numbers[:, 0], columns[0], length, name)
    stress = _stress(numbers[:, 1], columns[1], area, name)
    return strain, stress, numbers[:, 2] * _factor(columns[2], name) if timed else None


def _time_column(header: Sequence[str], where: str) -> _Column:
    columns = [column for i, cell in enumerate(header) if (column := _column(i, cell))]
    found = _one_of(columns, ("time",), where)
    if found is None:
        heads = ", ".join(f'"{cell.strip()}"' for cell in header if cell.strip())
        raise MeasurementError(
            where, f"no column of the time among {heads}", "call it time_s (or _min, _h)"
        )
    return found


def _rows(text: str, name: str) -> tuple[str, list[list[str]]]:
    if len(text) > _LARGEST_TEXT or "\0" in text:
        raise MeasurementError(name, "is not a table of text", "save the table as CSV")
    lines = text.lstrip("\ufeff").splitlines()
    # Lines above the header may have none; with decimal commas, the separator is in all lines.
    separator = max(";\t,", key=lambda each: sum(each in line for line in lines[:100]))
    try:
        rows = list(csv.reader(io.StringIO("\n".join(lines)), delimiter=separator))
    except csv.Error as error:
        raise MeasurementError(name, f"is not a table: {error}", "save it as CSV") from None
    if not any(any(cell.strip() for cell in row) for row in rows):
        raise MeasurementError(name, "is empty", f"give columns {_ALLOWED}")
    return separator, rows


def _header(rows: Sequence[Sequence[str]], name: str) -> tuple[int, _Column, _Column]:
    """Find the line that names a strain and a stress; machines write some lines above it."""
    first = next(i for i, row in enumerate(rows) if any(cell.strip() for cell in row))
    for at, row in enumerate(rows[: first + 60]):
        columns = [column for i, cell in enumerate(row) if (column := _column(i, cell))]
        across = _one_of(columns, _STRAINS, f"{name}, line {at + 1}")
        along = _one_of(columns, _STRESSES, f"{name}, line {at + 1}")
        if across and along:
            return at, across, along
    likely = rows[_above_numbers(rows, first)]
    heads = [cell.strip() for cell in likely if cell.strip()]
    found = [column for i, cell in enumerate(likely) if (column := _column(i, cell))]
    missing = [
        f"no column of {what}"
        for what, names in (("strain", _STRAINS), ("stress", _STRESSES))
        if not any(column.name in names for column in found)
    ]
    came = ", ".join(f'"{head}"' for head in heads[:12]) + (", ..." if len(heads) > 12 else "")
    hint = f"name them {_ALLOWED}"
    if any(_split(head)[0] in _TRUE for head in heads):
        hint = "expected engineering quantities: stress = true stress/stretch, strain = stretch - 1"
    raise MeasurementError(name, f"{' and '.join(missing)} among {came}", hint)


def _above_numbers(rows: Sequence[Sequence[str]], first: int) -> int:
    """Find the most likely header line: the one above the numbers and their units."""
    filled = [at for at in range(first, len(rows)) if any(cell.strip() for cell in rows[at])]
    numbers = next((n for n, at in enumerate(filled) if all(map(_is_number, rows[at]))), 0)
    above = [at for at in filled[:numbers] if not all(map(_is_unit, rows[at]))]
    return above[-1] if above else first


def _is_number(cell: str) -> bool:
    try:
        float(cell.replace(",", ".") or "0")
    except ValueError:
        return False
    return True


def _is_unit(cell: str) -> bool:
    unit = cell.strip(" ()[]").lower()
    return unit in (*_NO_UNIT, *_PERCENT, *_CASELESS, "s", "min")


def _one_of(columns: Sequence[_Column], names: Sequence[str], where: str) -> _Column | None:
    """Choose the column with the first of these names."""
    for name in names:
        same = [column for column in columns if column.name == name]
        if len(same) > 1:
            heads = " and ".join(f'"{column.head}"' for column in same)
            raise MeasurementError(where, f"{heads} are both a {name}", "leave one of them out")
        if same:
            return same[0]
    return None


def _column(index: int, cell: str) -> _Column | None:
    label, unit = _split(cell)
    for name, labels in _NAMES.items():
        if label in labels:
            return _Column(index, cell.strip(), name, unit)
    return None


def _split(cell: str) -> tuple[str, str]:
    """Split a head such as ``eng_stress_Pa`` or ``Load [N]`` into its label and its unit."""
    head = cell.strip()
    bracketed = re.fullmatch(r"(.*?)[\s_]*[(\[](.*)[)\]]", head)
    if bracketed:
        return _label(bracketed[1]), bracketed[2].strip()
    known = {label for labels in _NAMES.values() for label in labels}
    if _label(head) in known or _label(head) in _TRUE:
        return _label(head), ""
    label, joint, unit = head.replace(" ", "_").rpartition("_")
    return (_label(label), unit) if joint else (_label(head), "")


def _label(text: str) -> str:
    return re.sub(r"[\s_]+", " ", text).strip().lower()


def _is_units_row(rows: Sequence[Sequence[str]], start: int, columns: Sequence[_Column]) -> bool:
    if start + 1 >= len(rows) or any(column.unit for column in columns):
        return False
    row = rows[start + 1]
    cells = [row[column.at].strip() if column.at < len(row) else "" for column in columns]
    return any(cells) and all(not re.search(r"\d", cell.replace("^2", "")) for cell in cells)


def _numbers(
    rows: Sequence[Sequence[str]],
    start: int,
    columns: Sequence[_Column],
    name: str,
    *,
    decimal_comma: bool,
) -> Floats:
    found = []
    for number, row in enumerate(rows[start:], start=start + 1):
        if not any(cell.strip() for cell in row):
            continue
        pair = []
        for column in columns:
            cell = row[column.at].strip() if column.at < len(row) else ""
            try:
                pair.append(float(cell.replace(",", ".") if decimal_comma else cell))
            except ValueError:
                raise MeasurementError(
                    f"{name}, line {number}",
                    f'"{cell[:40]}" in column "{column.head}" is not a number',
                    "take the line out if nothing was measured there",
                ) from None
        found.append(pair)
    return np.array(found, dtype=np.float64).reshape(-1, len(columns))


def _factor(column: _Column, name: str) -> float:
    kind = _KIND[column.name]
    if not column.unit:
        raise MeasurementError(
            name,
            f'column "{column.head}" has no unit',
            f'call it "{_EXAMPLE[column.name]}", say',
        )
    try:
        return parse(f"1 {_CASELESS.get(column.unit.lower(), column.unit)}", kind)
    except UnitError as error:
        raise MeasurementError(
            name, f'column "{column.head}": {error.what}', f'call it "{_EXAMPLE[column.name]}", say'
        ) from None


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
    unit = column.unit.lower()
    if unit in _PERCENT:
        values = values / 100.0
    elif unit not in _NO_UNIT:
        raise MeasurementError(
            name, f'column "{column.head}": "{column.unit}" is no unit of strain', "use % or none"
        )
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
