"""Annotated types: a pydantic field of type ``Length`` takes SI floats or text with a unit."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from numbers import Real
from typing import TYPE_CHECKING, Annotated, Any, Final

from pydantic_core import core_schema

from voxsoft.errors import UnitError
from voxsoft.units.kinds import KINDS, Dimension, Number, Quantity, describe_dimension
from voxsoft.units.text import format_quantity, is_pint, parse, quantity_of, write_exactly

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
    from pydantic.json_schema import JsonSchemaValue

#: Validation context of file readers, under which a bare number needs a unit.
FILE_CONTEXT: Final[Mapping[str, str]] = {"source": "file"}


def read_from_file(info: core_schema.ValidationInfo) -> bool:
    """Return True if a validation reads a file, where a number needs its unit."""
    return (info.context or {}).get("source") == "file"


#: Serialization context under which numbers are written with all their digits, not with twelve.
EXACT: Final[Mapping[str, bool]] = {"exact": True}


def writes_exactly(info: core_schema.SerializationInfo) -> bool:
    """Return True if written numbers must read back to the same bits."""
    return bool((info.context or {}).get("exact"))


_INFINITIES: Final = ("inf", "+inf", "-inf")


@dataclass(frozen=True, slots=True)
class UnitOf:
    """Annotation of a float as a quantity of one kind, for ``Annotated[float, ...]``.

    Parameters
    ----------
    kind
        A key of :data:`voxsoft.units.KINDS`.
    positive
        True to refuse zero and negative values.
    non_negative
        True to refuse negative values.
    infinite
        True to accept ``inf`` and ``-inf`` (an open range). NaN is always refused.

    Notes
    -----
    Accepts text with a unit, a :class:`Quantity` or one of pint, and a plain number,
    which is SI; but under the context ``{"source": "file"}`` only zero may be plain.
    In JSON mode a value is written as text with a unit, to 12 significant digits, or under the
    context :data:`EXACT` to all its digits.

    Examples
    --------
    >>> from pydantic import BaseModel
    >>> class Tube(BaseModel):
    ...     wall: Annotated[float, UnitOf("length", positive=True)]
    >>> Tube(wall="2 mm").wall
    0.002
    >>> Tube(wall=0.002).model_dump(mode="json")
    {'wall': '2 mm'}
    """

    kind: str
    positive: bool = False
    non_negative: bool = False
    infinite: bool = False

    def read(self, value: object, *, from_file: bool = False) -> float:
        """Convert text, number or :class:`Quantity` to SI; raise :class:`UnitError` if not."""
        return self._within_bounds(self._to_si(value, from_file), value)

    def _to_si(self, value: object, from_file: bool) -> float:
        kind = KINDS[self.kind]
        if isinstance(value, str):
            if self.infinite and value.strip() in _INFINITIES:
                return float(value)
            return parse(value, self.kind)
        if isinstance(value, Number):
            value = Quantity(float(value), Dimension())
        if isinstance(value, Quantity):
            return self._of_kind(value, "the formula gives ")
        if is_pint(value):
            return self._of_kind(quantity_of(value, self.kind), f'"{value}" is ')
        if isinstance(value, bool) or not isinstance(value, Real):
            raise UnitError(
                self.kind,
                f"{_shown(value)} is not a quantity; expected {self._due}",
                f'write "{kind.example}"' if kind.units else "write a number",
            )
        number = _to_float(value)
        if from_file and kind.units and number != 0 and math.isfinite(number):
            raise UnitError(
                self.kind,
                f"{value} has no unit; expected {self._due}",
                f'write "{number:g} {kind.units[0]}"',
            )
        return number

    def _of_kind(self, value: Quantity, came: str) -> float:
        zero = value.value == 0 and value.dimension == Dimension()
        if value.dimension != KINDS[self.kind].dimension and not zero:
            what = f"{came}{describe_dimension(value.dimension)}; expected {self._due}"
            raise UnitError(self.kind, what)
        return value.value

    def _within_bounds(self, number: float, value: object) -> float:
        if math.isnan(number) or (math.isinf(number) and not self.infinite):
            what, hint = "is not a finite number", ""
        elif self.positive and number <= 0:
            what, hint = "is not positive", f"give {self._due} above zero"
        elif self.non_negative and number < 0:
            what, hint = "is negative", f"give {self._due} of zero or more"
        else:
            return number
        shown = _shown(value) if isinstance(value, str) else format_quantity(number, self.kind)
        raise UnitError(self.kind, f"{shown} {what}", hint)

    @property
    def _due(self) -> str:
        kind = KINDS[self.kind]
        return kind.article if kind.units else "a plain number"

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Tell pydantic how to read and write this type."""
        return core_schema.with_info_plain_validator_function(
            lambda value, info: self.read(value, from_file=read_from_file(info)),
            serialization=core_schema.plain_serializer_function_ser_schema(
                self._written, info_arg=True, when_used="json"
            ),
        )

    def _written(self, value: float, info: core_schema.SerializationInfo) -> str | float:
        if math.isinf(value):
            return str(value)  # not a number of JSON, and the usual text in files
        if not KINDS[self.kind].units:
            return value
        write = write_exactly if writes_exactly(info) else format_quantity
        return write(value, self.kind) if value else 0

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Describe the type for JSON Schema: text with a unit, or a number."""
        kind = KINDS[self.kind]
        sign = "positive " if self.positive else "non-negative " if self.non_negative else ""
        if not kind.units:
            described = f"A {sign}number, or a formula."
        else:
            described = (
                f'A {sign}{kind.name} with its unit, such as "{kind.example}", or a formula; '
                "in a file only zero may be a bare number."
            )
        described_as: dict[str, Any] = {
            "type": ["string", "number"],
            "description": described,
            "x-kind": kind.name,
        }
        return described_as


def si_value(
    value: object,
    kind: str,
    where: str,
    *,
    positive: bool = False,
    non_negative: bool = False,
) -> float:
    """Read an argument of a function: an SI number, text with a unit, or a quantity of pint.

    Parameters
    ----------
    value
        Argument to read.
    kind
        A key of :data:`voxsoft.units.KINDS`.
    where
        Name of the argument, for the message.
    positive, non_negative
        See :class:`UnitOf`.

    Raises
    ------
    UnitError
        It is no such value, of another kind, or out of bounds.

    Examples
    --------
    >>> si_value("50 ms", "time", "record_interval")
    0.05
    >>> si_value(-1, "time", "record_interval", positive=True)
    Traceback (most recent call last):
    ...
    voxsoft.errors.UnitError: record_interval: -1 s is not positive. Try: give a time above zero
    """
    try:
        return UnitOf(kind, positive=positive, non_negative=non_negative).read(value)
    except UnitError as error:
        raise UnitError(where, error.what, error.hint) from None


def to_si(value: object, kind: str, where: str) -> float:
    """Convert text with a unit, or a quantity of pint, to SI; a number is SI already.

    For arguments whose bounds the caller checks; :func:`si_value` checks them itself.

    Examples
    --------
    >>> to_si("5 mm", "length", "voxel_size"), to_si(-1, "length", "x")
    (0.005, -1.0)
    """
    if isinstance(value, Real) and not isinstance(value, bool):
        return _to_float(value)
    return si_value(value, kind, where)


def _to_float(value: Real) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.inf


def _shown(value: object) -> str:
    shown = f'"{value}"' if isinstance(value, str) else repr(value)
    return shown if len(shown) <= 60 else f"{shown[:57]}..."


Length = Annotated[float, UnitOf("length")]
PositiveLength = Annotated[float, UnitOf("length", positive=True)]
NonNegativeLength = Annotated[float, UnitOf("length", non_negative=True)]
ExtendedLength = Annotated[float, UnitOf("length", infinite=True)]
Area = Annotated[float, UnitOf("area")]
Volume = Annotated[float, UnitOf("volume")]
Pressure = Annotated[float, UnitOf("pressure")]
Modulus = Annotated[float, UnitOf("modulus", positive=True)]
Density = Annotated[float, UnitOf("density")]
PositivePressure = Annotated[float, UnitOf("pressure", positive=True)]
PositiveDensity = Annotated[float, UnitOf("density", positive=True)]
NonNegativeDensity = Annotated[float, UnitOf("density", non_negative=True)]
Mass = Annotated[float, UnitOf("mass")]
PositiveMass = Annotated[float, UnitOf("mass", positive=True)]
Force = Annotated[float, UnitOf("force")]
Acceleration = Annotated[float, UnitOf("acceleration")]
Time = Annotated[float, UnitOf("time")]
PositiveTime = Annotated[float, UnitOf("time", positive=True)]
NonNegativeTime = Annotated[float, UnitOf("time", non_negative=True)]
Speed = Annotated[float, UnitOf("speed")]
NonNegativeSpeed = Annotated[float, UnitOf("speed", non_negative=True)]
Rate = Annotated[float, UnitOf("rate")]
NonNegativeRate = Annotated[float, UnitOf("rate", non_negative=True)]
Angle = Annotated[float, UnitOf("angle")]
Stiffness = Annotated[float, UnitOf("stiffness")]
Proportion = Annotated[float, UnitOf("number", positive=True)]
NonNegative = Annotated[float, UnitOf("number", non_negative=True)]
Energy = Annotated[float, UnitOf("energy")]
MagneticField = Annotated[float, UnitOf("magnetic field")]
ElectricField = Annotated[float, UnitOf("electric field")]
PositiveElectricField = Annotated[float, UnitOf("electric field", positive=True)]
PositiveTemperature = Annotated[float, UnitOf("temperature", positive=True)]
ThermalExpansion = Annotated[float, UnitOf("thermal expansion")]
Dimensionless = Annotated[float, UnitOf("number")]

Point = tuple[Length, Length, Length]
Vector = tuple[Dimensionless, Dimensionless, Dimensionless]
