"""Names in a design that must lead somewhere."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from voxsoft.design.contact import BODY, FLOOR
from voxsoft.design.document.resolution import is_inner_design
from voxsoft.errors import ErrorDetail, MaterialError, VoxSoftError
from voxsoft.materials import card_names, is_card_path, load_card
from voxsoft.records import Record, closest, place

Path = tuple[str | int, ...]


@dataclass(frozen=True)
class Included:
    """Names of a design that come from those of its bodies: of bodies, chambers and probes."""

    bodies: tuple[str, ...] = (BODY,)
    chambers: frozenset[str] = frozenset()
    probes: frozenset[str] = frozenset()


def dangling_references(
    document: Mapping[str, Any], empty: Collection[str], included: Included | None = None
) -> Iterator[ErrorDetail]:
    """Find every name in a design that leads nowhere, and shapes made of themselves.

    Parameters
    ----------
    document
        The design as tables or records with values in place of formulas. Values of a wrong type
        are passed over: reading the tables reports them.
    empty
        Names of subtracted shapes of which the parameters leave nothing.
    included
        Names that come from the designs of bodies; None where these could not be read.

    Yields
    ------
    ErrorDetail
        The place of the name, the name, and the closest one that exists.
    """
    shapes = _table(document, "shapes")
    yield from dangling_shapes(document, empty)
    yield from _circles(shapes)
    yield from _materials(document)
    known = included or Included()
    yield from _chambers(document, known)
    probes = {*_table(document, "probes"), *known.probes}
    for table in ("objectives", "constraints"):
        for key, target in _table(document, table).items():
            for option in ("probe", "base"):
                probe = entry_of(target, option)
                if (
                    isinstance(probe, str)
                    and probe not in probes
                    and (included or "." not in probe)
                ):
                    yield _unknown((table, key, option), "probe", probe, probes)
    if included is not None or not document.get("bodies"):
        yield from _objects(document, known)
        yield from _activations(document)
    if included is not None:
        yield from _bodies(document, included)


def dangling_shapes(document: Mapping[str, Any], empty: Collection[str]) -> Iterator[ErrorDetail]:
    """Find every name of a shape that there is not; see :func:`dangling_references`."""
    shapes = _table(document, "shapes")
    for path, name in shape_names(document):
        if name in empty:
            yield ErrorDetail(place(path), f'the shape "{name}" is empty at these parameters')
        elif name not in shapes:
            yield _unknown(path, "shape", name, shapes)


def entry_of(table: object, key: str) -> Any:  # noqa: ANN401 - a document holds anything
    """Return an entry of a table or a record; None where there is none."""
    return table.get(key) if isinstance(table, Mapping) else getattr(table, key, None)


def _table(document: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    table = document.get(key)
    return table if isinstance(table, Mapping) else {}


def _list(document: Mapping[str, Any], key: str) -> Iterator[tuple[Path, Any]]:
    entries = document.get(key)
    for index, entry in enumerate(entries if isinstance(entries, (list, tuple)) else ()):
        yield (key, index), entry


def _unknown(path: Path, what: str, name: str, known: Iterable[str]) -> ErrorDetail:
    return ErrorDetail(place(path), f'there is no {what} "{name}"', closest(name, map(str, known)))


def _parts(document: Mapping[str, Any]) -> Iterator[tuple[Path, Any]]:
    """The parts of a design and of its bodies."""
    yield from _list(document, "parts")
    for path, body in _list(document, "bodies"):
        for way, part in _list({"parts": entry_of(body, "parts")}, "parts"):
            yield (*path, *way), part


def _materials(document: Mapping[str, Any]) -> Iterator[ErrorDetail]:
    known = {*_table(document, "materials"), *card_names()}
    for path, part in _parts(document):
        material, where = entry_of(part, "material"), (*path, "material")
        if not isinstance(material, str) or material in known:
            continue
        if not is_card_path(material):
            yield _unknown(where, "material", material, known)
            continue
        try:
            load_card(material)
        except MaterialError as error:
            for problem in error.problems:
                yield ErrorDetail(place(where), f"{material}: {problem}")
        except VoxSoftError as error:  # the file cannot be read
            yield ErrorDetail(place(where), f"{error.where}: {error.what}", error.hint)


def _chambers(document: Mapping[str, Any], included: Included) -> Iterator[ErrorDetail]:
    known = {*_table(document, "chambers"), *included.chambers}
    users = list(_list(document, "loads"))
    for table in ("objectives", "constraints"):
        users += [((table, name), each) for name, each in _table(document, table).items()]
    for path, user in users:
        choice = entry_of(user, "cavity")
        of_a_body = isinstance(choice, str) and "." in choice  # found on the mesh
        if isinstance(choice, str) and choice != "all" and choice not in known and not of_a_body:
            hint = closest(choice, map(str, known))
            hint = hint or "name it under [chambers] by its place: { point = [x, y, z] }"
            yield ErrorDetail(place((*path, "cavity")), f'there is no chamber "{choice}"', hint)
    for path, user in (*_list(document, "supplies"), *_list(document, "connections")):
        named: list[tuple[Path, Any]] = [(("chamber",), entry_of(user, "chamber"))]
        chambers = entry_of(user, "chambers")
        if isinstance(chambers, (list, tuple)):
            named += [(("chambers", number), each) for number, each in enumerate(chambers)]
        for key, choice in named:
            of_a_body = isinstance(choice, str) and "." in choice
            if isinstance(choice, str) and choice not in ("all", *known) and not of_a_body:
                hint = closest(choice, map(str, known))
                hint = hint or "name it under [chambers] by its place: { point = [x, y, z] }"
                yield ErrorDetail(place((*path, *key)), f'there is no chamber "{choice}"', hint)


def _objects(document: Mapping[str, Any], included: Included) -> Iterator[ErrorDetail]:
    names = [entry_of(each, "name") for _, each in _list(document, "objects")]
    known = [*included.bodies, *(name for name in names if isinstance(name, str))]
    known += [FLOOR] if document.get("floor") is not None else []
    for table in ("objectives", "constraints"):
        for key, target in _table(document, table).items():
            name = entry_of(target, "object")
            if isinstance(name, str) and name not in known:
                yield _unknown((table, key, "object"), "object", name, known)


def _activations(document: Mapping[str, Any]) -> Iterator[ErrorDetail]:
    """Parts to swell or refine that are not there; designs of bodies look after their own."""
    names = [entry_of(part, "name") or entry_of(part, "shape") for _, part in _parts(document)]
    known = [name for name in names if isinstance(name, str)]
    of_parts = (*_list(document, "activations"), *_list(document, "refine"))
    for path, table in of_parts:
        name = entry_of(table, "part")
        if isinstance(name, str) and name not in known and "." not in name:
            yield _unknown((*path, "part"), "part", name, known)


def _bodies(document: Mapping[str, Any], included: Included) -> Iterator[ErrorDetail]:
    """Regions and parts that are of a body which there is not."""
    known = [] if included.bodies == (BODY,) else included.bodies
    parts = ((path, part) for path, part in _list(document, "parts"))
    for path, table in (*places_in(document), *parts):
        name = entry_of(table, "body")
        if isinstance(name, str) and not known:
            what = f'"{name}" is no name: there is one body, and [[bodies]] name several'
            yield ErrorDetail(place((*path, "body")), what, "leave body out")
        elif isinstance(name, str) and name not in known:
            yield _unknown((*path, "body"), "body", name, known)


def shape_names(document: Mapping[str, Any]) -> Iterator[tuple[Path, str]]:
    """Collect the names of shapes with their places, all over the design."""
    for name, shape in _table(document, "shapes").items():
        yield from operand_names(shape, ("shapes", name))
    if document.get("mesh") is None:  # else parts are those of its file
        for path, part in _list(document, "parts"):
            yield from _operand(entry_of(part, "shape"), (*path, "shape"))
    for path, region in places_in(document):
        yield from _operand(entry_of(region, "shape"), (*path, "shape"))


def places_in(document: Mapping[str, Any]) -> Iterator[tuple[Path, Any]]:
    """Whatever may name a shape beside the shapes and parts: places, at any depth."""
    for key, value in document.items():
        if key not in ("shapes", "parts", "parameters"):
            yield from _tables_in(value, (key,))


def _tables_in(value: object, path: Path) -> Iterator[tuple[Path, Any]]:
    if is_inner_design(path):
        return
    if isinstance(value, (list, tuple)):
        for index, entry in enumerate(value):
            yield from _tables_in(entry, (*path, index))
    elif isinstance(value, (Mapping, Record)):
        yield path, value
        for key, entry in value.items() if isinstance(value, Mapping) else value:
            yield from _tables_in(entry, (*path, key))


def operand_names(shape: object, path: Path) -> Iterator[tuple[Path, str]]:
    """Collect the names that a shape's operands go by, at any depth."""
    operands = entry_of(shape, "of")
    if isinstance(operands, (list, tuple)):
        for index, operand in enumerate(operands):
            yield from _operand(operand, (*path, "of", index))
    else:
        yield from _operand(operands, (*path, "of"))


def _operand(operand: object, path: Path) -> Iterator[tuple[Path, str]]:
    if isinstance(operand, str):
        yield path, operand
    elif operand is not None:
        yield from operand_names(operand, path)


def _circles(shapes: Mapping[str, Any]) -> Iterator[ErrorDetail]:
    uses = {
        name: [used for _, used in operand_names(shape, ()) if used in shapes]
        for name, shape in shapes.items()
    }
    reported: set[str] = set()
    for start in shapes:
        circle = _circle_from(start, uses)
        if circle and not reported & set(circle):
            reported.update(circle)
            yield ErrorDetail(place(("shapes", start)), f"is made of itself: {' → '.join(circle)}")


def _circle_from(start: str, uses: Mapping[str, list[str]]) -> list[str]:
    """Find a way from a name back to itself, as the names on it; empty if there is none."""
    came_from: dict[str, str] = {}
    waiting = [start]
    while waiting:
        here = waiting.pop()
        for used in uses[here]:
            if used == start:
                way = [here]
                while way[-1] != start:
                    way.append(came_from[way[-1]])
                return [*reversed(way), start]
            if used not in came_from:
                came_from[used] = here
                waiting.append(used)
    return []
