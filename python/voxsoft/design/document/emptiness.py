"""Subtracted shapes that vanish: a formula leaves nothing of a cavity when the wall fills it.

A design family reaches sizes where nothing is left to subtract: a wall as thick as the radius,
two caps as high as the body. Such a design is valid; it has no cavity. The rule:

    An operand that a difference subtracts, and one of whose sizes a *formula* makes zero or
    negative, is empty. A union leaves it out; whatever is made from it alone is empty too.
    A difference that subtracts nothing else becomes a union of its first operand.

A size that is written as a number and is not positive stays an error.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Annotated, Any, Final, get_args, get_origin

from pydantic.fields import FieldInfo

from voxsoft.design.document.resolution import Document
from voxsoft.records import Record
from voxsoft.shapes import KINDS, Difference, Shape
from voxsoft.units import Quantity, UnitOf

_OPERANDS: Final = "of"
_NOTHING_LEFT: Final = 1e-12  # m: rounding error of a size that is zero


def without_empty_shapes(document: Mapping[str, Any]) -> tuple[Document, tuple[str, ...]]:
    """Take empty subtracted shapes out of a resolved document.

    Parameters
    ----------
    document
        A document whose formulas are :class:`~voxsoft.units.Quantity` values.

    Returns
    -------
    tuple
        The document without empty shapes, and the names of those taken out.

    Examples
    --------
    >>> from voxsoft.design.document.resolution import resolve
    >>> shapes = {
    ...     "outer": {"kind": "sphere", "radius": "5 mm"},
    ...     "inner": {"kind": "sphere", "radius": "= r - r"},
    ...     "body": {"kind": "difference", "of": ["outer", "inner"]},
    ... }
    >>> resolved = resolve({"parameters": {"r": "5 mm"}, "shapes": shapes})
    >>> without_empty_shapes(resolved)[1]
    ('inner',)
    """
    shapes = document.get("shapes")
    pruning = _Pruning(shapes if isinstance(shapes, Mapping) else {})
    cleaned = dict(document)
    if isinstance(shapes, Mapping):
        named = {name: pruning.differences(table) for name, table in shapes.items()}
        named.update(pruning.subtracted)
        cleaned["shapes"] = {name: table for name, table in named.items() if table is not None}
    for key, value in document.items():
        if key != "shapes":
            cleaned[key] = pruning.differences(value)
    empty = tuple(name for name, table in pruning.subtracted.items() if table is None)
    return cleaned, empty


def holds_difference(value: object) -> bool:
    """Check if a difference is in part of a document, and so a shape that may vanish.

    Examples
    --------
    >>> holds_difference([{"shape": {"kind": "difference", "of": ["outer", "inner"]}}])
    True
    """
    if isinstance(value, Shape):
        return any(isinstance(each, Difference) for each in value.every())
    if isinstance(value, Mapping):
        return value.get("kind") == "difference" or any(map(holds_difference, value.values()))
    if isinstance(value, Record):
        return any(holds_difference(each) for _, each in value)
    return isinstance(value, (list, tuple)) and any(map(holds_difference, value))


def with_stand_ins(document: Mapping[str, Any]) -> Document:
    """Give sizes that vanished one meter, so that a design's empty shapes can be read as well.

    Examples
    --------
    >>> from voxsoft.design.document.resolution import resolve
    >>> inner = {"kind": "sphere", "radius": "= r - r"}
    >>> resolved = resolve({"parameters": {"r": "5 mm"}, "shapes": {"inner": inner}})
    >>> with_stand_ins(resolved)["shapes"]["inner"]["radius"].value
    1.0
    """
    return {key: _stand_in(value) for key, value in document.items()}


def _stand_in(value: Any) -> Any:  # noqa: ANN401 - a document holds anything
    if isinstance(value, list):
        return [_stand_in(entry) for entry in value]
    if not isinstance(value, Mapping):
        return value
    kind = value.get("kind")
    sizes = _sizes(kind) if isinstance(kind, str) else frozenset()
    return {
        key: _sized(entry) if key in sizes else _stand_in(entry) for key, entry in value.items()
    }


def _sized(value: Any) -> Any:  # noqa: ANN401
    if isinstance(value, list):
        return [_sized(entry) for entry in value]
    return Quantity(1.0, value.dimension) if _any_not_positive(value) else value


class _Pruning:
    """Follows names from subtracted operands; remembers the outcome of each."""

    def __init__(self, shapes: Mapping[str, Any]) -> None:
        self._shapes = shapes
        self.subtracted: dict[str, Any] = {}

    def differences(self, value: Any) -> Any:  # noqa: ANN401 - a document holds anything
        """Prune the subtracted operands of every difference in `value`."""
        if isinstance(value, (str, int, float, Quantity)):
            return value
        if isinstance(value, list):
            return [self.differences(entry) for entry in value]
        if not isinstance(value, Mapping):
            return value
        table = {key: self.differences(entry) for key, entry in value.items()}
        operands = table.get(_OPERANDS)
        if table.get("kind") != "difference" or not isinstance(operands, list) or not operands:
            return table
        first, *rest = operands
        kept = [operand for operand in map(self._operand, rest) if operand is not None]
        if kept or not rest:
            return {**table, _OPERANDS: [first, *kept]}
        return {"kind": "union", _OPERANDS: [first]}

    def _operand(self, operand: Any) -> Any:  # noqa: ANN401
        """Return a subtracted operand, pruned, or None if it is empty."""
        if not isinstance(operand, str):
            return self._table(operand)
        if operand not in self.subtracted and operand in self._shapes:
            self.subtracted[operand] = self._shapes[operand]  # ends a circular reference
            self.subtracted[operand] = self._table(self.differences(self._shapes[operand]))
        return None if self.subtracted.get(operand, operand) is None else operand

    def _table(self, table: Any) -> Any:  # noqa: ANN401
        if not isinstance(table, Mapping):
            return table
        if _has_vanished(table):
            return None
        operands, kind = table.get(_OPERANDS), table.get("kind")
        if operands is None:
            return table
        if not isinstance(operands, list):
            kept = self._operand(operands)
            return None if kept is None else {**table, _OPERANDS: kept}
        pruned = [self._operand(operand) for operand in operands]
        full = [operand for operand in pruned if operand is not None]
        # The first operand decides a difference; an intersection needs every one.
        decisive = pruned[:1] if kind == "difference" else pruned
        if (not full and pruned) or (None in decisive and kind != "union"):
            return None
        return table if kind == "difference" else {**table, _OPERANDS: full}


def _has_vanished(table: Mapping[str, Any]) -> bool:
    """Check if a formula makes one of the sizes of a shape zero or negative."""
    kind = table.get("kind")
    if not isinstance(kind, str):
        return False
    return any(_any_not_positive(table[size]) for size in _sizes(kind) if size in table)


@cache
def _sizes(kind: str) -> frozenset[str]:
    """The fields of a kind of shape that must be positive."""
    fields = KINDS[kind].model_fields if kind in KINDS else {}
    return frozenset(name for name, field in fields.items() if _must_be_positive(field))


def _any_not_positive(value: object) -> bool:
    if isinstance(value, list):
        return any(map(_any_not_positive, value))
    return isinstance(value, Quantity) and value.value <= _NOTHING_LEFT


def _must_be_positive(field: FieldInfo) -> bool:
    return any(isinstance(m, UnitOf) and m.positive for m in field.metadata) or (
        _holds_positive(field.annotation)
    )


def _holds_positive(annotation: object) -> bool:
    if get_origin(annotation) is Annotated:
        return any(isinstance(m, UnitOf) and m.positive for m in get_args(annotation)[1:])
    return any(map(_holds_positive, get_args(annotation)))
