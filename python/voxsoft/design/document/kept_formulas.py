"""Formulas that outlive a replacement: entries of a design that are handed on as they are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from voxsoft.design.document.formula import is_formula
from voxsoft.design.document.resolution import formulas
from voxsoft.records import Record

#: Records by their identity, each with the text or table it was written as.
_Pieces = dict[int, tuple[Record, Any]]


def with_kept_formulas(
    entries: Mapping[str, Any], source: Mapping[str, Any], changes: Mapping[str, Any]
) -> dict[str, Any]:
    """Put formulas back into the new entries of a design.

    In ``design.replace(clamps=[*design.clamps, press])`` the old clamps are records, which hold
    values; those of them that were written with formulas of parameters go on with these.

    Parameters
    ----------
    entries
        The design's values by key.
    source
        Source of these values, with formulas.
    changes
        New values by key; they are not changed.
    """
    pieces: _Pieces = {}
    for key, piece in source.items():
        if key in entries:
            _collect(entries[key], piece, pieces)
    return (
        {key: _restored(value, pieces) for key, value in changes.items()} if pieces else {**changes}
    )


def _collect(value: object, piece: object, pieces: _Pieces) -> bool:
    """Pair records with their source; False where the two are not alike.

    They differ where a subtracted shape was left out because it is empty.
    """
    if isinstance(value, Record):
        if isinstance(piece, Mapping):
            written = {**value._entries(), **_by_field(value)}
            alike = [
                name in written and _collect(written[name], inner, pieces)
                for name, inner in piece.items()
            ]
            if not all(alike):
                return False
        if not isinstance(piece, Record) and (is_formula(piece) or any(formulas(piece))):
            pieces[id(value)] = value, piece
        return True
    if isinstance(value, tuple) and isinstance(piece, (list, tuple)):
        alike = [_collect(*pair, pieces) for pair in zip(value, piece, strict=False)]
        return all(alike) and len(value) == len(piece)
    if isinstance(value, Mapping) and isinstance(piece, Mapping):
        shared = [key for key in piece if key in value]
        alike = [_collect(value[key], piece[key], pieces) for key in shared]
        return all(alike) and len(shared) == len(piece)
    return not isinstance(value, str) or value == piece or is_formula(piece)


def _by_field(record: Record) -> dict[str, Any]:
    return {name: getattr(record, name) for name in type(record).model_fields}


def _restored(value: Any, pieces: _Pieces) -> Any:  # noqa: ANN401 - a document holds anything
    if isinstance(value, Record):
        if id(value) in pieces:
            return pieces[id(value)][1]
        entries = value._entries()
        inner = {name: _restored(entry, pieces) for name, entry in entries.items()}
        return value if all(inner[name] is entries[name] for name in inner) else inner
    if isinstance(value, (list, tuple)):
        entries_of = [_restored(entry, pieces) for entry in value]
        return value if all(a is b for a, b in zip(entries_of, value, strict=True)) else entries_of
    if isinstance(value, Mapping):
        table = {key: _restored(entry, pieces) for key, entry in value.items()}
        return value if all(table[key] is value[key] for key in value) else table
    return value
