"""Key that changes along a path, and its values."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, Self

import numpy as np

from voxsoft.design import Design
from voxsoft.errors import SimulationError, VoxSoftError
from voxsoft.records import steps_of
from voxsoft.units import KINDS, format_quantity, parse_any, si_value, write_exactly

#: Key of the instants of all histories.
TIME: Final = "time"
#: Largest number of values of a path.
_MOST: Final = 10_000
_NUMBER: Final = r"[-+]?(?:\d+(?:\.\d+)?|\.\d+)(?:[eE][-+]?\d+)?"
#: Two numbers or more with dots between them, a unit, and the number of values.
_RANGE: Final = re.compile(rf"({_NUMBER}(?:\s*\.\.\s*{_NUMBER})+)\s*(.*?)\s*/\s*(\d+)")
_EXAMPLE: Final = (
    'write "loads[0].value=0..30 kPa/16" for 16 values from 0 to 30 kPa, "0..30..0 kPa/31" for '
    'there and back, or "time=0..2 s/21"'
)


@dataclass(frozen=True)
class Over:
    """Key that changes along a path, and its values.

    Attributes
    ----------
    key
        Name of the key as for :meth:`voxsoft.Design.with_values`, or ``"time"``.
    values
        Values in SI units, in the order in which they are reached.
    kind
        Quantity of the values, a key of :data:`voxsoft.units.KINDS`.
    """

    key: str
    values: tuple[float, ...]
    kind: str

    @classmethod
    def read(cls, text: str) -> Self:
        """Read a key and a range: two values or more, a unit, and the number of values.

        Raises
        ------
        SimulationError
            The text is not of that form.

        Examples
        --------
        >>> Over.read("loads[0].value=0..30 kPa/4").values
        (0.0, 10000.0, 20000.0, 30000.0)
        >>> Over.read("time = 0..1..0 s/5").values
        (0.0, 0.5, 1.0, 0.5, 0.0)
        """
        key, _, rest = text.partition("=")
        key = key.strip()
        found = _RANGE.fullmatch(rest.strip())
        if found is None or not steps_of(key):
            raise SimulationError("over", f'"{text}" is no key with a range', _EXAMPLE)
        unit, count = found[2], int(found[3])
        turns = [
            parse_any(f"{n} {unit}".strip(), where=key) for n in re.split(r"\s*\.\.\s*", found[1])
        ]
        if not len(turns) <= count <= _MOST:
            what = f"asks for {count} values between {len(turns)}"
            raise SimulationError("over", what, f"take {len(turns)} to {_MOST:,}")
        kind = _kind_of(key, turns[0].dimension)
        way = np.array([turn.value for turn in turns])
        far = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(way)))])
        if far[-1] == 0.0:
            raise SimulationError("over", f'"{rest.strip()}" does not change {key}', _EXAMPLE)
        values = np.interp(np.linspace(0.0, far[-1], count), far, way)
        return cls(key, tuple(map(float, values)), kind)

    @classmethod
    def of(cls, key: str, values: Sequence[float | str], design: Design) -> Self:
        """Take values as they are: in SI units or with their unit.

        Raises
        ------
        SimulationError
            No value, or one that is not of the kind that the key of the design has.
        """
        kind = "time" if key == TIME else _kind_of(key, _dimension_at(design, key))
        found = tuple(si_value(value, kind, key) for value in values)
        if not found:
            raise SimulationError("values", "is empty", "give the values along the path")
        return cls(key, found, kind)

    def up_to(self, count: int) -> Self:
        """Return the path with its first `count` values."""
        return replace(self, values=self.values[:count])

    def toml(self, value: float) -> str:
        """Write a value as in a design file."""
        units = KINDS[self.kind].units
        # A parameter that is zero without a unit is a plain number.
        return f"0 {units[0]}" if value == 0.0 and units else write_exactly(value, self.kind)

    def in_words(self, value: float) -> str:
        """Write the key with a value."""
        return f"{self.key} = {self.value_in_words(value)}"

    def value_in_words(self, value: float) -> str:
        """Write a value with a unit that suits it."""
        return format_quantity(float(f"{value:.6g}"), self.kind)


def _kind_of(key: str, dimension: object) -> str:
    """Return the kind of quantity of a dimension."""
    if key == TIME and dimension != KINDS["time"].dimension:
        raise SimulationError("over", "time has no unit of time", 'write "time=0..2 s/21"')
    for name, kind in KINDS.items():
        if kind.dimension == dimension:
            return name
    raise SimulationError("over", f"{key} is of no kind that a design has", _EXAMPLE)


def _dimension_at(design: Design, key: str) -> object:
    """Return the dimension of the present value of a key of a design."""
    if key in design.parameters:
        return parse_any(str(design.document["parameters"][key]["value"]), where=key).dimension
    here: Any = design.document
    try:
        for step in steps_of(key):
            here = here[step] if isinstance(here, Mapping) else here[int(step)]
        return parse_any(str(here), where=key).dimension
    except (KeyError, IndexError, ValueError, TypeError, VoxSoftError):
        what = "holds no quantity in this design"
        raise SimulationError(key, what, 'name a value, such as "loads[0].value"') from None
