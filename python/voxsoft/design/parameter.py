"""A parameter: a named value that formulas of a design refer to."""

from __future__ import annotations

import math
from collections.abc import Mapping
from numbers import Real
from typing import Annotated, Any, Final

from pydantic import (
    Field,
    GetJsonSchemaHandler,
    SerializationInfo,
    SerializerFunctionWrapHandler,
    ValidationInfo,
    WithJsonSchema,
    field_validator,
    model_serializer,
    model_validator,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from voxsoft.errors import DesignError, ErrorDetail
from voxsoft.records import Record
from voxsoft.units import (
    KINDS,
    Dimension,
    Quantity,
    describe_dimension,
    format_quantity,
    is_pint,
    parse_any,
    quantity_of,
    read_from_file,
    write_exactly,
    writes_exactly,
)

_QUANTITIES: Final = ("value", "min", "max", "step")
_ROUNDING: Final = 1e-9  # of a bound: 0.1 + 0.2 is within a range that ends at 0.3


# Read by the model that holds it, which sees all quantities that must be of one kind.
AnyQuantity = Annotated[
    float,
    WithJsonSchema(
        {
            "type": ["string", "number"],
            "description": 'A quantity with its unit, such as "5 mm", or a formula.',
        }
    ),
]


class Parameter(Record):
    """A named value with an optional range and step, which a study may vary.

    Parameters
    ----------
    value
        The value. A file writes it with its unit, ``"25 mm"``.
    min, max
        The smallest and largest value that make sense; a value outside is an error.
    step
        The spacing of the values that a grid study tries. Values in between are valid.
    description
        Free text.
    kind
        The kind of quantity, a key of :data:`voxsoft.units.KINDS`; found from the unit. Give it
        where the numbers are plain SI floats.

    Notes
    -----
    After construction `value`, `min`, `max` and `step` are SI floats.

    Examples
    --------
    >>> wall = Parameter(value="5 mm", min="5 mm", max="15 mm", step="5 mm")
    >>> wall.value, wall.kind
    (0.005, 'length')
    >>> Parameter(value="20 mm", max="15 mm")
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: value: 20 mm is above max, 15 mm. Try: change value or max
    """

    value: AnyQuantity
    min: AnyQuantity | None = None
    max: AnyQuantity | None = None
    step: AnyQuantity | None = None
    description: str = ""
    kind: str = Field("number", json_schema_extra={"enum": [*sorted(KINDS)]})

    @model_validator(mode="before")
    @classmethod
    def _read_quantities(cls, data: Any, info: ValidationInfo) -> Any:  # noqa: ANN401
        """Take a bare value for a table, and bring every number to SI under one kind."""
        if isinstance(data, Parameter):
            return data
        table = dict(data) if isinstance(data, Mapping) else {"value": data}
        from_file = read_from_file(info)
        found = {
            name: read_quantity(table[name], name)
            for name in _QUANTITIES
            if table.get(name) is not None
        }
        return {**table, **as_one_kind(found, table.get("kind"), from_file=from_file)}

    @classmethod
    def __get_pydantic_json_schema__(
        cls, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Describe the short form as well: a bare quantity in place of the table."""
        table = handler.resolve_ref_schema(handler(schema))
        bare = {"type": ["string", "number"], "description": 'A quantity such as "5 mm".'}
        return {"anyOf": [bare, table]}

    @field_validator("kind")
    @classmethod
    def _known_kind(cls, kind: str) -> str:
        if kind not in KINDS:
            raise DesignError("", f'"{kind}" is not a kind', f"choose from {', '.join(KINDS)}")
        return kind

    @model_validator(mode="after")
    def _check_range(self) -> Parameter:
        low, high = self.min, self.max
        if low is not None and high is not None and low > high:
            raise DesignError("min", f"{self._say(low)} is above max, {self._say(high)}")
        if self.step is not None and self.step <= 0:
            raise DesignError("step", f"{self._say(self.step)} is not positive")
        slack = _ROUNDING * max(abs(low or 0.0), abs(high or 0.0))
        if low is not None and self.value < low - slack:
            self._refuse_value("below min", low, "min")
        if high is not None and self.value > high + slack:
            self._refuse_value("above max", high, "max")
        return self

    @model_serializer(mode="wrap")
    def _written(
        self, handler: SerializerFunctionWrapHandler, info: SerializationInfo
    ) -> dict[str, Any]:
        """Write numbers with their units in JSON mode, and leave out empty entries."""
        return write_quantities(handler(self), self.kind, info)

    @property
    def dimension(self) -> Dimension:
        """Exponents of length, mass, time and angle."""
        return KINDS[self.kind].dimension

    def _refuse_value(self, side: str, bound: float, name: str) -> None:
        what = f"{self._say(self.value)} is {side}, {self._say(bound)}"
        raise DesignError("value", what, f"change value or {name}")

    def _say(self, value: float) -> str:
        return format_quantity(value, self.kind)


def read_quantity(value: object, name: str) -> Quantity:
    """Read a quantity of any kind; `name` is the place an error names."""
    if isinstance(value, Quantity):
        return value
    if isinstance(value, str):
        return parse_any(value, where=name)
    if is_pint(value):
        return quantity_of(value, name)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise DesignError(name, f"{value!r} is not a quantity", 'write one such as "25 mm"')
    try:
        number = float(value)
    except OverflowError:
        raise DesignError(name, "is too large for a number") from None
    if not math.isfinite(number):
        raise DesignError(name, f"{number} is not a finite number", "leave it out, or give one")
    return Quantity(number, Dimension())


def kind_of(dimension: Dimension) -> str | None:
    """Name the kind that a dimension is taken for, if there is one.

    Examples
    --------
    >>> kind_of(KINDS["modulus"].dimension)
    'pressure'
    """
    return next((kind.name for kind in KINDS.values() if kind.dimension == dimension), None)


def write_quantities(table: dict[str, Any], kind: str, info: SerializationInfo) -> dict[str, Any]:
    """Write the quantities of a dumped table as text with units, which implies their kind."""
    if not info.mode_is_json():
        return table
    unitless = not KINDS[kind].units
    write = write_exactly if writes_exactly(info) else format_quantity
    written = {
        name: write(value, kind) if name in _QUANTITIES and not unitless else value
        for name, value in table.items()
        if value not in (None, "") and name != "kind"
    }
    # "0" does not tell its kind, nor does "1 kPa" that it is a modulus: the kind must be stated.
    implied = unitless or (
        kind == kind_of(KINDS[kind].dimension)
        and any(value not in (0, "0") for n, value in written.items() if n in _QUANTITIES)
    )
    return written if implied else {**written, "kind": kind}


def as_one_kind(
    found: Mapping[str, Quantity], stated: object, *, from_file: bool
) -> dict[str, object]:
    """Check that all quantities are of one kind; a bare zero, or SI under `kind`, is of any."""
    plain = Dimension()
    due = KINDS[stated].dimension if isinstance(stated, str) and stated in KINDS else None
    with_unit = [q.dimension for q in found.values() if q.dimension != plain]
    dimension = due or (with_unit[0] if with_unit else plain)
    bare_is_si = due is not None and not from_file
    wrong = [
        ErrorDetail(
            name, f"is {describe_dimension(q.dimension)}; expected {describe_dimension(dimension)}"
        )
        for name, q in found.items()
        if q.dimension != dimension and not (q.dimension == plain and (q.value == 0 or bare_is_si))
    ]
    if wrong:
        raise DesignError.listing(wrong)
    kind = kind_of(dimension)
    if kind is None:
        what = f"is {describe_dimension(dimension)}, which has no name"
        raise DesignError("value", what, "split the formula over the values that use it")
    kind_found = {"kind": stated if due is not None else kind} if found else {}
    return {**{name: q.value for name, q in found.items()}, **kind_found}
