"""Kinds of quantity (length, pressure, ...) and the dimensions behind them."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, NamedTuple


class Dimension(NamedTuple):
    """Exponents of length, mass, time, angle, electric current and temperature.

    An angle has a dimension of its own here: a bare number must not pass for radians.

    Examples
    --------
    >>> KINDS["force"].dimension
    Dimension(length=1, mass=1, time=-2, angle=0, current=0, temperature=0)
    """

    length: int = 0
    mass: int = 0
    time: int = 0
    angle: int = 0
    current: int = 0
    temperature: int = 0

    def times(self, other: Dimension, power: int = 1) -> Dimension:
        """Return the dimension of a product with `other` raised to `power`."""
        return Dimension(*(a + power * b for a, b in zip(self, other, strict=True)))


@dataclass(frozen=True, slots=True)
class Quantity:
    """Number in SI units together with its dimension; the value of a formula."""

    value: float
    dimension: Dimension

    def __str__(self) -> str:
        return f"{self.value:.12g} SI ({describe_dimension(self.dimension)})"


class Number(float):
    """Value of a formula without dimension.

    A plain float counts as SI where a unit is expected; this one is known to be no quantity.
    """


@dataclass(frozen=True, slots=True)
class Kind:
    """Kind of quantity: its name, dimension and the units it is written in, preferred first."""

    name: str
    dimension: Dimension
    units: tuple[str, ...]

    @property
    def article(self) -> str:
        """Name with its article, for error messages: ``"an area"``."""
        return f"{'an' if self.name[0] in 'aeiou' else 'a'} {self.name}"

    @property
    def example(self) -> str:
        """Text that would be accepted, such as ``"5 mm"``."""
        return f"5 {self.units[0]}" if self.units else "5"


_ALL: Final = (
    Kind("length", Dimension(1), ("mm", "m", "um")),
    Kind("curvature", Dimension(-1), ("1/m", "1/mm")),
    Kind("area", Dimension(2), ("mm^2", "m^2")),
    Kind("volume", Dimension(3), ("mL", "mm^3", "m^3")),
    Kind("pressure", Dimension(-1, 1, -2), ("kPa", "Pa", "MPa")),
    Kind("modulus", Dimension(-1, 1, -2), ("kPa", "Pa", "MPa", "GPa")),
    Kind("density", Dimension(-3, 1), ("kg/m^3",)),
    Kind("mass", Dimension(0, 1), ("g", "kg", "mg")),
    Kind("force", Dimension(1, 1, -2), ("N", "mN", "kN")),
    Kind("acceleration", Dimension(1, 0, -2), ("m/s^2",)),
    Kind("time", Dimension(0, 0, 1), ("s", "ms")),
    Kind("rate", Dimension(0, 0, -1), ("1/s",)),
    Kind("speed", Dimension(1, 0, -1), ("m/s", "mm/s")),
    Kind("angle", Dimension(0, 0, 0, 1), ("deg", "rad")),
    Kind("stiffness", Dimension(0, 1, -2), ("N/m",)),
    Kind("compliance", Dimension(0, -1, 2), ("m/N", "mm/N")),
    Kind("volume compliance", Dimension(4, -1, 2), ("m^3/Pa",)),
    Kind("volume flow", Dimension(3, 0, -1), ("mL/s", "L/min", "m^3/s")),
    Kind("mass flow", Dimension(0, 1, -1), ("g/s", "kg/s")),
    Kind("conductance", Dimension(4, -1, 1), ("L/s/bar", "m^3/s/Pa")),
    Kind("viscosity", Dimension(-1, 1, -1), ("Pa*s",)),
    Kind("energy", Dimension(2, 1, -2), ("J", "mJ")),
    Kind("power", Dimension(2, 1, -3), ("W", "mW")),
    Kind("angular speed", Dimension(0, 0, -1, 1), ("rad/s", "deg/s")),
    Kind("torque", Dimension(2, 1, -2), ("N*m", "N*mm")),
    Kind("magnetic field", Dimension(mass=1, time=-2, current=-1), ("mT", "T")),
    Kind("voltage", Dimension(2, 1, -3, current=-1), ("kV", "V", "MV")),
    Kind("electric field", Dimension(1, 1, -3, current=-1), ("MV/m", "V/m", "kV/mm")),
    Kind("temperature", Dimension(temperature=1), ("K",)),
    Kind("thermal expansion", Dimension(temperature=-1), ("1/K",)),
    Kind("number", Dimension(), ()),
)

#: Every kind by name.
KINDS: Final = MappingProxyType({kind.name: kind for kind in _ALL})


def describe_dimension(dimension: Dimension) -> str:
    """Describe a dimension in words: the kind's name, or the exponents where it has none.

    Examples
    --------
    >>> describe_dimension(Dimension(length=1))
    'a length'
    >>> describe_dimension(Dimension(length=4))
    'length^4'
    """
    for kind in KINDS.values():
        if kind.dimension == dimension:
            return "a plain number" if kind.name == "number" else kind.article
    named = zip(Dimension._fields, dimension, strict=True)
    return "·".join(f"{name}^{power}" if power != 1 else name for name, power in named if power)
