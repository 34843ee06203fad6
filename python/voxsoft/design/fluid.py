"""Contents of chambers: gases, liquids and their temperature."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Any, Final, Literal

from pydantic import Discriminator, Field, Tag, ValidationInfo
from pydantic.functional_serializers import PlainSerializer
from pydantic.functional_validators import BeforeValidator
from pydantic.json_schema import WithJsonSchema

from voxsoft.errors import DesignError, UnitError
from voxsoft.records import Record
from voxsoft.units import Dimensionless, Modulus, PositiveDensity, UnitOf
from voxsoft.units.types import read_from_file

#: The pressure that gauge pressures are counted from [Pa].
ATMOSPHERE: Final = 101_325.0
#: 20 °C in K.
ROOM: Final = 293.15
_ZERO_CELSIUS: Final = 273.15
_TEMPERATURE: Final = re.compile(r"\s*([+-]?[\d.]+(?:e[+-]?\d+)?)\s*(K|kelvin|°C|degC|C)\s*", re.I)

Viscosity = Annotated[float, UnitOf("viscosity", positive=True)]


def _kelvin(value: object, info: ValidationInfo) -> object:
    """Read text with a unit; a plain number is in kelvin, and no file may hold one."""
    if isinstance(value, str):
        found = _TEMPERATURE.fullmatch(value)
        if found is None:
            what = f'"{value}" is not a temperature'
            raise UnitError("", what, 'write "20 degC" or "293.15 K"')
        number = float(found[1])
        value = number if found[2].lower() in ("k", "kelvin") else number + _ZERO_CELSIUS
    elif read_from_file(info) and isinstance(value, (int, float)):
        what = f"{value!r} has no unit; expected a temperature"
        raise UnitError("", what, 'write "20 degC" or "293.15 K"')
    if isinstance(value, (int, float)) and not isinstance(value, bool) and value <= 0.0:
        what = f"is {value:g} K, and nothing is colder than 0 K (-273.15 degC)"
        raise DesignError("", what, 'write "20 degC" or "293.15 K"')
    return value


#: In K; text such as ``"20 degC"`` is taken too.
Temperature = Annotated[
    float,
    BeforeValidator(_kelvin),
    PlainSerializer(lambda value: f"{value!r} K", return_type=str, when_used="json"),
    WithJsonSchema(
        {
            "type": "string",
            "description": 'A temperature with its unit, such as "20 degC" or "293.15 K".',
            "examples": ["20 degC"],
        }
    ),
]


class Gas(Record):
    """An ideal gas: ``(p + atmosphere) V = m R T``, at a temperature that walls and lines keep.

    Parameters
    ----------
    gas_constant
        ``R`` in J/(kg K); default: that of dry air.
    viscosity
        Dynamic; default: that of air at 20 °C.

    Examples
    --------
    >>> Gas(gas_constant=188.9).gas_constant  # carbon dioxide
    188.9
    """

    kind: Literal["gas"] = "gas"
    gas_constant: Annotated[Dimensionless, Field(gt=0)] = 287.05
    viscosity: Viscosity = 1.813e-5


class Liquid(Record):
    """A liquid whose density grows with its pressure as ``exp(p/K)``.

    Parameters
    ----------
    density
        Under the atmosphere; default: that of water at 20 °C.
    bulk_modulus
        ``K``; default: that of water. Air in the lines makes it much smaller.
    viscosity
        Dynamic; default: that of water at 20 °C.

    Examples
    --------
    >>> Liquid(bulk_modulus="0.5 GPa").density
    998.2
    """

    kind: Literal["liquid"] = "liquid"
    density: PositiveDensity = 998.2
    bulk_modulus: Modulus = 2.18e9
    viscosity: Viscosity = 1.002e-3


#: Fluids that have a name.
FLUIDS: Final[Mapping[str, Gas | Liquid]] = {"air": Gas(), "water": Liquid()}


def _kind_of(value: object) -> str:
    if isinstance(value, str):
        return "name"
    kind: Any = value.get("kind") if isinstance(value, Mapping) else getattr(value, "kind", None)
    return kind if kind in ("gas", "liquid") else "gas"


#: ``"air"``, ``"water"``, or a table.
FluidChoice = Annotated[
    Annotated[Literal["air", "water"], Tag("name")]
    | Annotated[Gas, Tag("gas")]
    | Annotated[Liquid, Tag("liquid")],
    Discriminator(_kind_of),
]


def fluid_of(choice: str | Gas | Liquid) -> Gas | Liquid:
    """Return the fluid that a choice means.

    Examples
    --------
    >>> fluid_of("water").kind
    'liquid'
    """
    return FLUIDS[choice] if isinstance(choice, str) else choice
