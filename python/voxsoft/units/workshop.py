"""Ambiguous units of workshops: read to their right value, or refused with it."""

from __future__ import annotations

from decimal import Decimal
from typing import Final, NamedTuple

from voxsoft.units.kinds import KINDS, Dimension

#: Standard gravity in m/s² and pressure in Pa, exact by definition (CGPM 1901, 1954).
GRAVITY: Final = Decimal("9.80665")
ATMOSPHERE: Final = Decimal("101325")
#: Density of dry air at 0 °C and one atmosphere in kg/m³ (ISO 2533).
_AIR: Final = Decimal("1.2929")

_LENGTH, _PRESSURE = KINDS["length"].dimension, KINDS["pressure"].dimension
_ENERGY, _RATE = KINDS["energy"].dimension, KINDS["rate"].dimension
_FORCE, _MASS = KINDS["force"].dimension, KINDS["mass"].dimension
_PSI: Final = Decimal("6894.757293168361")

#: Factor to SI and dimension. A torque is an energy by its dimension; pint reads Nm as a count of
#: yarn and mil as an angle. Gauge pressures are pressures above ambient, as all in a design.
READ: Final[dict[str, tuple[Decimal, Dimension]]] = {
    "Nm": (Decimal(1), _ENERGY),
    "kNm": (Decimal(1000), _ENERGY),
    "mNm": (Decimal("1e-3"), _ENERGY),
    "Nmm": (Decimal("1e-3"), _ENERGY),
    "Ncm": (Decimal("1e-2"), _ENERGY),
    "mil": (Decimal("25.4e-6"), _LENGTH),
    "thou": (Decimal("25.4e-6"), _LENGTH),
    "rpm": (Decimal(1) / Decimal(60), _RATE),
    "Pag": (Decimal(1), _PRESSURE),
    "kPag": (Decimal(1000), _PRESSURE),
    "MPag": (Decimal(1000000), _PRESSURE),
    "barg": (Decimal(100000), _PRESSURE),
    "mbarg": (Decimal(100), _PRESSURE),
    "psig": (_PSI, _PRESSURE),
    "mmHHO": (GRAVITY, _PRESSURE),
    "cmHHO": (10 * GRAVITY, _PRESSURE),
    "inHHO": (Decimal("25.4") * GRAVITY, _PRESSURE),
}

#: Absolute pressures, with their factors to Pa.
_ABSOLUTE: Final = {
    "Paa": Decimal(1),
    "kPaa": Decimal(1000),
    "bara": Decimal(100000),
    "mbara": Decimal(100),
    "psia": _PSI,
}
#: Gas flows at standard conditions, with their factors to L/min.
_STANDARD: Final = {"slpm": Decimal(1), "slm": Decimal(1), "sccm": Decimal("1e-3")}


class Refusal(NamedTuple):
    """Reason why a unit is refused, and the text to write instead."""

    what: str
    hint: str


def refusal(number: str, unit: str) -> Refusal | None:
    """Return why a unit is not read, with the likely value; None for other units.

    Examples
    --------
    >>> refusal("2", "bara").hint
    'write "98.675 kPa": pressures of a design are above ambient, here of 101.325 kPa'
    >>> refusal("10", "slpm").hint
    'write "10 L/min" for the flow at 0 °C and 1 atm; a flow of mass is "0.215483333333 g/s" of air'
    """
    spelled = unit.removesuffix("abs").removesuffix("(a)").strip()
    if spelled != unit:
        unit = {"Pa": "Paa", "kPa": "kPaa", "bar": "bara", "mbar": "mbara", "psi": "psia"}.get(
            spelled, unit
        )
    if unit in _ABSOLUTE:
        gauge = (Decimal(number) * _ABSOLUTE[unit] - ATMOSPHERE) / 1000
        above = "pressures of a design are above ambient, here of 101.325 kPa"
        return Refusal("is an absolute pressure", f'write "{_shown(gauge)} kPa": {above}')
    if unit in _STANDARD:
        flow = Decimal(number) * _STANDARD[unit]
        mass = flow / 60 * _AIR
        how = f'write "{_shown(flow)} L/min" for the flow at 0 °C and 1 atm'
        what = "is a flow at standard conditions, which are not the same everywhere"
        return Refusal(what, f'{how}; a flow of mass is "{_shown(mass)} g/s" of air')
    return None


def weight(value: float, dimension: Dimension, due: Dimension) -> str:
    """Return the text to write for a mass where a force is expected; empty for all else.

    Examples
    --------
    >>> weight(2.0, KINDS["mass"].dimension, KINDS["force"].dimension)
    'its weight on Earth is "19.6133 N"'
    """
    if dimension != _MASS or due != _FORCE:
        return ""
    return f'its weight on Earth is "{_shown(Decimal(repr(value)) * GRAVITY)} N"'


def _shown(number: Decimal) -> str:
    return f"{float(number):.12g}"
