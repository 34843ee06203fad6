"""Reading and writing of quantities as text: ``"5 mm"``, ``"1070 kg/m^3"``, ``"9.81 m/s^2"``."""

from __future__ import annotations

import math
import re
from decimal import Context, Decimal
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any, Final

from voxsoft.errors import UnitError
from voxsoft.units import factors
from voxsoft.units.kinds import KINDS, Dimension, Kind, Quantity, describe_dimension
from voxsoft.units.workshop import READ, refusal, weight

if TYPE_CHECKING:
    import pint

SIGNIFICANT_DIGITS: Final = 12

_LONGEST_TEXT: Final = 120
_LONGEST_SHOWN: Final = 40  # degrees of an angle in radians have infinitely many digits
_NUMBER: Final = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?")
_JOINT: Final = r"(\s*[*/]\s*|\s+)"
_NAME: Final = r"([A-Za-z\u00b5\u03bc°%]+|1)(?:\^?(-?[1-9]))?(?![\d.])"
_COMPOUND: Final = re.compile(f"{_NAME}(?:{_JOINT}{_NAME})*")
_UNIT_FACTOR: Final = re.compile(f"{_JOINT}?{_NAME}")
_FORM: Final = 'write units like "mm", "kg/m^3" or "m/s^2"'
_SUPERSCRIPTS: Final = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
# Decimal arithmetic makes "35 mm" the float nearest to 0.035, which 35 * 1e-3 need not be.
_DECIMAL: Final = Context(prec=40, traps=[])

_LENGTH, _MASS, _TIME, _ANGLE = (KINDS[k].dimension for k in ("length", "mass", "time", "angle"))
_PRESSURE, _FORCE = KINDS["pressure"].dimension, KINDS["force"].dimension
_ENERGY, _VOLUME, _RATE = (KINDS[k].dimension for k in ("energy", "volume", "rate"))

#: Common units of soft-robotics designs. Most others are looked up by pint, whose registry takes
#: most of a second to load.
COMMON_UNITS: Final[dict[str, Dimension]] = {
    **dict.fromkeys(("um", "mm", "cm", "m", "inch"), _LENGTH),
    **dict.fromkeys(("mg", "g", "kg"), _MASS),
    **dict.fromkeys(("ms", "s"), _TIME),
    **dict.fromkeys(("mN", "N", "kN"), _FORCE),
    **dict.fromkeys(("Pa", "kPa", "MPa", "GPa", "bar", "psi"), _PRESSURE),
    **dict.fromkeys(("mJ", "J"), _ENERGY),
    **dict.fromkeys(("mW", "W"), KINDS["power"].dimension),
    **dict.fromkeys(("mL", "L"), _VOLUME),
    **dict.fromkeys(("deg", "rad"), _ANGLE),
    "Hz": _RATE,
    **dict.fromkeys(("mT", "T"), KINDS["magnetic field"].dimension),
    **dict.fromkeys(("V", "kV", "MV"), KINDS["voltage"].dimension),
    "K": KINDS["temperature"].dimension,
}


def parse(text: str, kind: str, *, where: str = "") -> float:
    """Read a quantity of a known kind from text.

    Parameters
    ----------
    text
        A number and a unit, ``"5 mm"``. Zero needs no unit.
    kind
        A key of :data:`voxsoft.units.KINDS`, such as ``"length"``.
    where
        Place to name in an error; default: the kind.

    Returns
    -------
    float
        Value in SI units.

    Raises
    ------
    UnitError
        No number, no unit, an unknown unit or a unit of another kind.

    Examples
    --------
    >>> parse("25 mm", "length")
    0.025
    >>> parse("1.07 g/cm^3", "density")
    1070.0
    >>> parse("5", "length")
    Traceback (most recent call last):
    ...
    voxsoft.errors.UnitError: length: "5" has no unit; expected a length. Try: write "5 mm"
    """
    due = KINDS[kind]
    where = where or kind
    number, unit = _split(text, where, due)
    if not unit:
        return _without_unit(number, text, where, due)
    quantity = _quantity(number, unit, text, where)
    if quantity.dimension != due.dimension:
        # Without its number: in another unit it would be another quantity.
        hint = weight(quantity.value, quantity.dimension, due.dimension) or _units_of(due)
        is_of = describe_dimension(quantity.dimension)
        raise UnitError(where, f'"{text}" is {is_of}; {_expected(due)}', hint)
    return quantity.value


def parse_any(text: str, *, where: str = "quantity") -> Quantity:
    """Read a quantity of any kind; a number without a unit is dimensionless.

    Examples
    --------
    >>> parse_any("4 kPa").value
    4000.0
    """
    return _any_quantity(text, where)


@lru_cache(maxsize=1024)  # a study reads the bounds of its parameters for every trial
def _any_quantity(text: str, where: str) -> Quantity:
    number, unit = _split(text, where, None)
    if not unit:
        return Quantity(_finite(float(number), text, where), Dimension())
    return _quantity(number, unit, text, where)


def format_percent(share: float) -> str:
    """Write a share in percent with two digits, in common notation: never with an exponent.

    Examples
    --------
    >>> format_percent(1e-4), format_percent(0.04567), format_percent(3.21e-8)
    ('0.01 %', '4.6 %', '0.0000032 %')
    >>> format_percent(1e-14)
    'less than 0.0000001 %'
    """
    if not math.isfinite(share):
        return f"{share} %"
    if 0 < abs(share) < 1e-9:
        return "less than 0.0000001 %"
    return f"{_plain(Decimal(f'{100 * share:.2g}'))} %"


def format_quantity(value: float, kind: str) -> str:
    """Write an SI value with a unit that suits its size, to 12 significant digits.

    Reading the text back gives the value rounded to 12 significant digits, exactly
    (:func:`round_significant`); for an angle in degrees, to within that rounding.

    Examples
    --------
    >>> format_quantity(0.005, "length")
    '5 mm'
    >>> format_quantity(1.2e6, "pressure")
    '1.2 MPa'
    """
    if not math.isfinite(value):
        return f"{value}"
    digits = Decimal(f"{value:.{SIGNIFICANT_DIGITS}g}")
    units = KINDS[kind].units
    if value == 0 or not units:
        return _plain(digits)
    if kind == "angle":
        return _format_angle(value, digits)
    scaled = [(digits / _exact_factor(unit), unit) for unit in units]
    preferred = ((n, unit) for n, unit in scaled if Decimal("0.1") <= abs(n) < 1000)
    number, unit = next(preferred, scaled[0])
    return f"{_plain(number)} {unit}"


def write_exactly(value: float, kind: str) -> str:
    """Write an SI value with a unit, with enough digits to read the same value back.

    Twelve digits are enough for any typed value; :func:`format_quantity` always stops there.

    Examples
    --------
    >>> write_exactly(0.005, "length"), write_exactly(0.1 + 0.2, "length")
    ('5 mm', '300.00000000000004 mm')
    >>> parse(write_exactly(0.001 / 3, "length"), "length") == 0.001 / 3
    True
    """
    text = format_quantity(value, kind)
    if not math.isfinite(value) or value == 0 or not KINDS[kind].units:
        return text
    if parse(text, kind) == value:
        return text
    unit = text.rpartition(" ")[2]
    digits = Decimal(repr(value))
    longer = f"{_DECIMAL.divide(digits, _exact_factor(unit)).normalize(_DECIMAL)} {unit}"
    if len(longer) <= _LONGEST_SHOWN and parse(longer, kind) == value:
        return longer
    si = next(unit for unit in KINDS[kind].units if _exact_factor(unit) == 1)
    return f"{value!r} {si}"


def round_significant(value: float) -> float:
    """Round to the 12 significant digits that identify a design."""
    return float(f"{value:.{SIGNIFICANT_DIGITS}g}")


def _format_angle(value: float, radians: Decimal) -> str:
    degrees = f"{_plain(Decimal(f'{math.degrees(value):.{SIGNIFICANT_DIGITS}g}'))} deg"
    if round_significant(parse(degrees, "angle")) == round_significant(value):
        return degrees
    return f"{_plain(radians)} rad"


def _plain(number: Decimal) -> str:
    if number == 0:
        return "0"
    text = f"{number.normalize(_DECIMAL):f}"
    return text if len(text) <= SIGNIFICANT_DIGITS + 6 else f"{number.normalize(_DECIMAL):e}"


def _split(text: str, where: str, due: Kind | None) -> tuple[str, str]:
    """Split `text` into its number and its unit, both still text."""
    stripped = text.strip()
    example = due.example if due else "5 mm"
    match = _NUMBER.match(stripped) if len(stripped) <= _LONGEST_TEXT else None
    if match is None:
        shown = text if len(text) <= _LONGEST_TEXT else f"{text[:40]}..."
        what = f'"{shown}" does not start with a number'
        if stripped.startswith("="):
            what = f'"{shown}" is a formula, which only a design file or table can hold'
        raise UnitError(where, f"{what}; {_expected(due)}" if due else what, f'write "{example}"')
    unit = stripped[match.end() :].strip()
    if unit.startswith(","):
        raise UnitError(where, f'"{text}" has a decimal comma', "use a decimal point")
    return match.group(), unit


def _without_unit(number: str, text: str, where: str, due: Kind) -> float:
    value = _finite(float(number), text, where)
    if value == 0 or not due.units:
        return value
    raise UnitError(where, f'"{text}" has no unit; {_expected(due)}', _suggest(number, due))


@lru_cache(maxsize=1024)  # a study reads the bounds and constants of its family for every trial
def _quantity(number: str, unit: str, text: str, where: str) -> Quantity:
    if refused := refusal(number, unit):
        raise UnitError(where, f'"{text}" {refused.what}', refused.hint)
    factor, dimension = _unit(unit, text, where)
    value = float(_DECIMAL.multiply(Decimal(number), factor))
    return Quantity(_finite(value, text, where), dimension)


def _finite(value: float, text: str, where: str) -> float:
    if not math.isfinite(value):
        raise UnitError(where, f'"{text}" is too large for a number', "check the exponent")
    return value


def _expected(kind: Kind) -> str:
    return "expected a plain number" if not kind.units else f"expected {kind.article}"


def _units_of(kind: Kind) -> str:
    return f"give it in {' or '.join(kind.units)}" if kind.units else "leave the unit out"


def _suggest(number: str, kind: Kind) -> str:
    return f'write "{number} {kind.units[0]}"' if kind.units else f'write "{number}"'


def _unit(unit: str, text: str, where: str) -> tuple[Decimal, Dimension]:
    """Return factor to SI and dimension of a compound unit such as ``kg/m^3`` or ``N*m``."""
    normalized = unit.translate(_SUPERSCRIPTS).replace("·", "*").replace("**", "^")
    normalized = normalized.replace("H2O", "HHO")  # its digit is no power
    if normalized.startswith("/"):
        normalized = f"1{normalized}"  # "5 /s" is "5 1/s"
    if not _COMPOUND.fullmatch(normalized):
        raise UnitError(where, f'"{unit}" in "{text}" is not a unit', _FORM)
    total, dimension = Decimal(1), Dimension()
    for joint, name, written_power in _UNIT_FACTOR.findall(normalized):
        if name == "1":
            continue
        factor, of_name = _named_unit(name, text, where)
        power = int(written_power or 1) * (-1 if joint.strip() == "/" else 1)
        total = _DECIMAL.multiply(total, _DECIMAL.power(factor, power))
        dimension = dimension.times(of_name, power)
    return total, dimension


def is_pint(value: object) -> bool:
    """Return True for a quantity of pint, from any registry, without loading pint."""
    return hasattr(value, "magnitude") and hasattr(value, "to_base_units")


def quantity_of(value: Any, where: str) -> Quantity:  # noqa: ANN401 - pint is loaded by its users
    """Read a quantity of pint.

    Parameters
    ----------
    value
        The quantity; one number, not an array.
    where
        Place to name in an error.

    Raises
    ------
    UnitError
        Not one number, or a unit that mechanics does not know.

    Examples
    --------
    >>> import pint
    >>> quantity_of(pint.Quantity(10, "mm"), "radius").value
    0.01
    """
    try:
        number = float(value.magnitude)
    except (TypeError, ValueError):
        raise UnitError(where, f'"{value}" is not one number', "give one quantity") from None
    if not math.isfinite(number):
        raise UnitError(where, f'"{value}" is not a finite number')
    factor, dimension = Decimal(1), Dimension()
    for name, power in value.unit_items():
        known, of_name = _named_unit(name, str(value), where)
        if power != int(power):
            raise UnitError(where, f'"{value}" has a unit to a broken power')
        factor = _DECIMAL.multiply(factor, _DECIMAL.power(known, int(power)))
        dimension = dimension.times(of_name, int(power))
    return Quantity(float(_DECIMAL.multiply(Decimal(repr(number)), factor)), dimension)


@cache
def _exact_factor(unit: str) -> Decimal:
    return _unit(unit, unit, "unit")[0]


def _named_unit(name: str, text: str, where: str) -> tuple[Decimal, Dimension]:
    known = _look_up(name)
    if isinstance(known, str):
        raise UnitError(where, f'"{text}": {known}', _FORM)
    return known


@cache
def _look_up(name: str) -> tuple[Decimal, Dimension] | str:
    """Return factor and dimension of one unit name, or the reason why there are none."""
    if name in COMMON_UNITS:
        return Decimal(repr(getattr(factors, name))), COMMON_UNITS[name]
    if name in READ:
        return READ[name]
    if name == "%":
        return Decimal("0.01"), Dimension()
    return _ask_pint("degree" if name == "°" else name)


def _ask_pint(name: str) -> tuple[Decimal, Dimension] | str:
    import pint

    registry = _pint_registry()
    try:
        base = registry.Quantity(1.0, name).to_base_units()
        start = registry.Quantity(0.0, name).to_base_units().magnitude
    except (pint.PintError, AssertionError, AttributeError, ValueError, TypeError):
        return f'there is no unit "{name}"'
    if start != 0:
        return f'"{name}" does not count from zero; write kelvin (80 °C are "353.15 K")'
    dimension = Dimension()
    exponents: dict[str, Any] = dict(base.unit_items())
    for base_name, exponent in exponents.items():
        if base_name not in _BASE_UNITS or exponent != int(exponent):
            return f'"{name}" is not a unit of mechanics, magnetism or heat'
        dimension = dimension.times(_BASE_UNITS[base_name], int(exponent))
    return Decimal(repr(float(base.magnitude))), dimension


_BASE_UNITS: Final = {
    "meter": _LENGTH,
    "kilogram": _MASS,
    "second": _TIME,
    "radian": _ANGLE,
    "ampere": Dimension(current=1),
    "kelvin": Dimension(temperature=1),
}


@cache
def _pint_registry() -> pint.UnitRegistry[Any]:
    import pint

    return pint.UnitRegistry()
