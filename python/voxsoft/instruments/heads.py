"""Heads of columns: a name and a unit, as instruments and their users write them."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from functools import lru_cache
from typing import Final, NamedTuple

from voxsoft.errors import UnitError
from voxsoft.instruments.table_text import TextRow
from voxsoft.units import KINDS, describe_dimension, parse_any

# Machines write units in any case; "Mpa" is no millipascal.
_CASELESS: Final = {
    unit.lower(): unit
    for unit in ("Pa", "kPa", "MPa", "GPa", "N", "kN", "mm", "m", "psi", "bar", "mbar", "V", "Hz")
}
_SPELLED: Final = {
    **dict.fromkeys(("sec", "secs", "second", "seconds", "sek"), "s"),
    **dict.fromkeys(("msec", "millisecond", "milliseconds"), "ms"),
    **dict.fromkeys(("minute", "minutes"), "min"),
    **dict.fromkeys(("hour", "hours", "std"), "h"),
    **dict.fromkeys(("°", "degree", "degrees"), "deg"),
    "volt": "V",
    "volts": "V",
    "newton": "N",
    "in": "inch",
}
#: Units of a plain number, with the number that they are.
_RATIOS: Final = {
    **dict.fromkeys(("", "-", "1", "mm/mm", "m/m", "in/in"), 1.0),
    **dict.fromkeys(("%", "percent", "pct"), 1e-2),
    **dict.fromkeys(("mm/m", "‰", "mstrain", "millistrain"), 1e-3),
    **dict.fromkeys(("um/m", "µm/m", "μm/m", "µε", "με", "ue", "ustrain", "microstrain"), 1e-6),
}
_CELSIUS: Final = ("°c", "degc", "deg c", "celsius")
_PIXELS: Final = ("px", "pixel", "pixels")
_ZERO_CELSIUS: Final = 273.15
_TIMES: Final = (
    *("time", "test time", "elapsed time", "timestamp", "time stamp", "datetime", "date time"),
    *("zeit", "prüfzeit", "date/time", "datum/zeit", "zeitstempel"),
)


class Unit(NamedTuple):
    """Unit of a column: ``SI value = factor · number + offset``.

    Attributes
    ----------
    factor, offset
        Numbers of the rule above.
    kind
        Name of the quantity, such as ``"force"``; ``"number"`` without a unit or of ratios;
        ``"pixels"`` of places in a picture.
    """

    factor: float
    kind: str
    offset: float = 0.0


@lru_cache(maxsize=512)
def unit_of(text: str) -> Unit | None:
    """Return the unit that a text names; None if it is none.

    Examples
    --------
    >>> unit_of("kPa")
    Unit(factor=1000.0, kind='pressure', offset=0.0)
    >>> unit_of("mm/m").factor, unit_of("mm/m").kind
    (0.001, 'number')
    >>> unit_of("degC").offset, unit_of("batch") is None
    (273.15, True)
    """
    bare = text.strip()
    lower = bare.lower()
    if lower in _RATIOS:
        return Unit(_RATIOS[lower], "number")
    if lower in _PIXELS:
        return Unit(1.0, "pixels")
    if lower in _CELSIUS:
        return Unit(1.0, "temperature", _ZERO_CELSIUS)
    if re.search(r"\s\S|[A-Za-z]{12}", bare):  # no name is sent through the table of all units
        return None
    known = _CASELESS.get(lower) or _SPELLED.get(lower) or bare
    try:
        found = parse_any(f"1 {known}")
    except UnitError:
        return None
    if not any(found.dimension):  # words for numbers, as "strain" and "count" are
        return None
    name = describe_dimension(found.dimension).removeprefix("an ").removeprefix("a ")
    return Unit(found.value, name if name in KINDS else "other")


def is_unit(cell: str) -> bool:
    """Return True for a cell that is empty or holds a unit alone, in brackets or not."""
    bare = bare_unit(cell)
    return not re.search(r"\d{2}|^\d$", bare) and unit_of(bare) is not None


def bare_unit(cell: str) -> str:
    """Return a unit without its brackets."""
    return cell.strip(" ()[]")


def split_head(cell: str, known: Collection[str] = ()) -> tuple[str, str]:
    """Split a head into its label, in lower case with single spaces, and its unit.

    Parameters
    ----------
    cell
        Head such as ``stress_kPa``, ``Load [N]``, ``Force / N`` or ``Kraft in N``.
    known
        Labels that are taken as they are, and after which any word is meant for a unit.

    Examples
    --------
    >>> split_head("eng_stress_Pa"), split_head("Load [N]"), split_head("Kraft in N")
    (('eng stress', 'Pa'), ('load', 'N'), ('kraft', 'N'))
    >>> split_head("stress_blah"), split_head("stress_blah", {"stress"})
    (('stress blah', ''), ('stress', 'blah'))
    """
    label, unit = split_name(cell, known)
    return _label(label), unit


def split_name(cell: str, known: Collection[str] = ()) -> tuple[str, str]:
    """Split a head like :func:`split_head`, with the label as it is written.

    Examples
    --------
    >>> split_name("Tip X [mm]"), split_name("Tip_x_mm")
    (('Tip X', 'mm'), ('Tip x', 'mm'))
    """
    head = cell.strip()
    bracketed = re.fullmatch(r"(.*?)[\s_]*[(\[](.*)[)\]]", head)
    if bracketed:
        return _spaced(bracketed[1]), bracketed[2].strip()
    if _label(head) in known:
        return _spaced(head), ""
    apart = re.fullmatch(r"(.*\S)\s*(?:\s/\s|\sin\s)\s*(\S+)", head)
    if apart and unit_of(apart[2]) is not None:
        return _spaced(apart[1]), apart[2]
    label, joint, unit = head.replace(" ", "_").rpartition("_")
    meant = _label(label) in known or (not unit.isdigit() and unit_of(unit) is not None)
    return (_spaced(label), unit) if joint and label and meant else (_spaced(head), "")


def is_time(label: str) -> bool:
    """Return True for the name of a column of times; ``T`` is a temperature.

    Examples
    --------
    >>> is_time("t"), is_time("T"), is_time("Test time")
    (True, False, True)
    """
    return label == "t" or label.casefold() in _TIMES


def units_row(rows: Sequence[TextRow], header: int, at: Sequence[int]) -> dict[int, str] | None:
    """Return the units in the row below a header, by column; None if it holds none.

    Parameters
    ----------
    rows
        Rows of the table.
    header
        Index of its header.
    at
        Columns that are read.
    """
    if header + 1 >= len(rows):
        return None
    row = rows[header + 1]
    cells = {index: row.cell(index) for index in at}
    if not any(cells.values()) or not all(map(_may_be_unit, cells.values())):
        return None
    return {index: bare_unit(cell) for index, cell in cells.items()}


def _may_be_unit(cell: str) -> bool:
    in_brackets = bool(re.fullmatch(r"[(\[].*[)\]]", cell)) and not re.search(r"\d{2}", cell)
    return in_brackets or is_unit(cell)


def _label(text: str) -> str:
    return _spaced(text).lower()


def _spaced(text: str) -> str:
    return re.sub(r"[\s_]+", " ", text).strip()
