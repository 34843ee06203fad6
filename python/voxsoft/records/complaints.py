"""Plain messages for the problems that pydantic finds."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, get_args

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from voxsoft.errors import ErrorDetail, FormulaError, UnitError, VoxSoftError
from voxsoft.records.places import closest, place

if TYPE_CHECKING:
    from voxsoft.records.record import Record

Path = tuple[str | int, ...]


def plain_error(error: ValidationError, model: type[Record], document: object) -> VoxSoftError:
    """Turn pydantic's error about `document` into ours, one problem per finding.

    Raises nothing; returns the error to raise: a ``FormulaError`` where only formulas are
    wrong, else the model's ``error_type``.
    """
    causes = [details.get("ctx", {}).get("error") for details in error.errors(include_url=False)]
    only_formulas = all(isinstance(cause, FormulaError) for cause in causes)
    error_type = FormulaError if only_formulas else model.error_type
    return error_type.listing(problems_of(error, model, document))


def problems_of(
    error: ValidationError, model: type[Record], document: object, reported: Collection[Path] = ()
) -> list[ErrorDetail]:
    """List the problems that pydantic found in `document`.

    Parameters
    ----------
    error
        The error that pydantic raised.
    model
        The model that the document was read as.
    document
        The document.
    reported
        Paths at which a problem is known already: no other one is reported there.
    """
    found = _without_echo(error.errors(include_url=False), document)
    problems = [problem for details in found for problem in _problems(details, model, document)]
    known = {place(path) for path in reported}
    return [*_merged([problem for problem in problems if not _is_reported(problem, known)])]


def _is_reported(problem: ErrorDetail, known: Collection[str]) -> bool:
    """Check if a problem is at or below one of the places that are known."""
    where = problem.where
    return any(where == each or where.startswith((f"{each}.", f"{each}[")) for each in known)


def _problems(
    details: ErrorDetails, model: type[Record], document: object
) -> Iterator[ErrorDetail]:
    path = list(_real_keys(details, document))
    where = place(path)
    cause = details.get("ctx", {}).get("error")
    if isinstance(cause, UnitError):
        yield ErrorDetail(where, cause.what, cause.hint)
    elif isinstance(cause, VoxSoftError):
        for problem in cause.problems:
            joined = ".".join(part for part in (where, problem.where) if part)
            yield ErrorDetail(joined.replace(".[", "["), problem.what, problem.hint)
    elif details["type"] == "extra_forbidden":
        hint = closest(str(path[-1]), _field_names(model, path[:-1], document))
        yield ErrorDetail(where, "is not known here", hint)
    elif details["type"] == "missing":
        yield ErrorDetail(where, "is missing")
    elif details["type"] in {"union_tag_invalid", "union_tag_not_found"}:
        yield _unknown_kind(details, where)
    else:
        yield ErrorDetail(where, _in_words(details))


def _real_keys(details: ErrorDetails, document: object) -> Iterator[str | int]:
    """Keep the steps that exist in the document; pydantic adds the names of union branches."""
    steps, here = details["loc"], document
    absent = details["type"] == "missing"
    for position, step in enumerate(steps):
        if absent and position == len(steps) - 1:
            yield step
        elif (child := _child(here, step)) is not _NOTHING:
            here = child
            yield step


_NOTHING = object()


def _child(table: object, step: str | int) -> object:
    if isinstance(table, Mapping):
        return table.get(step, _NOTHING)
    if isinstance(step, int):
        return table[step] if isinstance(table, Sequence) and step < len(table) else _NOTHING
    return getattr(table, step) if step in getattr(type(table), "model_fields", ()) else _NOTHING


def _unknown_kind(details: ErrorDetails, where: str) -> ErrorDetail:
    context = details.get("ctx", {})
    tags = [tag.strip(" '") for tag in str(context.get("expected_tags", "")).split(",") if tag]
    key = str(context.get("discriminator", "kind")).strip("'")
    place_of_key = f"{where}.{key}" if where else key
    if details["type"] == "union_tag_not_found":
        what = "is missing" if isinstance(details["input"], Mapping) else "expected a table"
        return ErrorDetail(place_of_key, what, closest("", tags) if tags else "")
    came = str(context.get("tag", ""))
    return ErrorDetail(place_of_key, f'"{came}" is not known', closest(came, tags))


_EXPECTED = {
    "string_type": "expected text",
    "int_type": "expected a whole number",
    "int_parsing": "expected a whole number",
    "int_from_float": "expected a whole number",
    "float_type": "expected a number",
    "float_parsing": "expected a number",
    "bool_type": "expected true or false",
    "bool_parsing": "expected true or false",
    "tuple_type": "expected a list",
    "list_type": "expected a list",
    "dict_type": "expected a table",
    "mapping_type": "expected a table",
    "model_type": "expected a table",
    "model_attributes_type": "expected a table",
}


def _in_words(details: ErrorDetails) -> str:
    kind, context = details["type"], details.get("ctx", {})
    if kind == "too_short":
        return f"has {context['actual_length']} entries; expected at least {context['min_length']}"
    if kind == "too_long":
        return f"has more than {context['max_length']} entries"
    came = details["input"]
    shown = f'"{came}"' if isinstance(came, str) else repr(came)
    shown = shown if len(shown) <= 60 else f"{shown[:57]}..."
    if kind == "literal_error":
        expected = f"expected {context['expected']}".replace("'", '"')
    elif kind in _EXPECTED:
        expected = _EXPECTED[kind]
    else:
        expected = details["msg"].replace("Input should be", "expected a value")
    return f"{shown} came; {expected}"


def _without_echo(found: Sequence[ErrorDetails], document: object) -> list[ErrorDetails]:
    """Drop complaints that only repeat a finding further inside.

    Text or a table may stand in one place (an operand's name, or the operand itself). A faulty
    table also fails as text; and a list with a faulty entry also fails as too short.
    """
    paths = [tuple(_real_keys(details, document)) for details in found]
    known = list(zip(found, paths, strict=True))
    return [
        details
        for details, path in known
        if not any(_echoes(details, path, other, other_path) for other, other_path in known)
    ]


def _echoes(
    details: ErrorDetails,
    path: tuple[str | int, ...],
    other: ErrorDetails,
    other_path: tuple[str | int, ...],
) -> bool:
    """Check if an `other` finding is the one that the input's author needs."""
    if path == other_path:
        wrong_unit = isinstance(other.get("ctx", {}).get("error"), UnitError)
        wrong_kind = other["type"] in {"union_tag_invalid", "union_tag_not_found"}
        return details["type"] in {"string_type", "tuple_type"} and (wrong_unit or wrong_kind)
    inside = len(other_path) > len(path) and other_path[: len(path)] == path
    return inside and details["type"] in {"string_type", "literal_error", "too_short"}


def _merged(problems: Sequence[ErrorDetail]) -> Iterator[ErrorDetail]:
    """Report a faulty value once, with all that is expected by the branches of a union."""
    by_place: dict[tuple[str, str], list[ErrorDetail]] = {}
    for problem in dict.fromkeys(problems):
        came = problem.what.partition(" came; ")[0] if " came; " in problem.what else problem.what
        by_place.setdefault((problem.where, came), []).append(problem)
    for (where, came), same in by_place.items():
        if len(same) == 1:
            yield same[0]
        else:
            expected = (p.what.removeprefix(f"{came} came; expected ") for p in same)
            yield ErrorDetail(
                where, f"{came} came; expected {', or '.join(expected)}", same[0].hint
            )


def _field_names(model: type[Record], path: Sequence[str | int], document: object) -> set[str]:
    """Collect the names that may stand in the table at `path`."""
    reached, here = list(records_in(model)), document
    for step in path:
        here = _child(here, step)
        if isinstance(step, int):
            continue
        inner = [
            f.annotation for m in reached for n, f in m.model_fields.items() if step in (n, f.alias)
        ]
        # A step that no field has is a key of a mapping such as [shapes]: same type as before.
        reached = [r for annotation in inner for r in records_in(annotation)] or reached
    chosen = here if isinstance(here, Mapping) else {}
    exact = [
        m
        for m in reached
        for tag in ("kind", "model")  # tells which of several tables this is
        if tag in m.model_fields and chosen.get(tag) in get_args(m.model_fields[tag].annotation)
    ]
    return {f.alias or n for m in exact or reached for n, f in m.model_fields.items()}


def records_in(annotation: object) -> Iterator[type[Record]]:
    """Find the record types inside an annotation: behind unions, tuples and mappings."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation  # type: ignore[misc]  # all models here are records
    else:
        for argument in get_args(annotation):
            yield from records_in(argument)
