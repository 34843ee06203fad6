"""Names in a design that must lead somewhere."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from voxsoft.design.region import Region
from voxsoft.errors import Problem
from voxsoft.materials import card_names
from voxsoft.records import closest, place
from voxsoft.shapes import Shape

if TYPE_CHECKING:
    from voxsoft.design.model import Design

Path = tuple[str | int, ...]


def dangling_references(design: Design) -> Iterator[Problem]:
    """Find every name in a design that leads nowhere, and shapes made of themselves.

    Parameters
    ----------
    design
        The design; its tables are valid each on its own.

    Yields
    ------
    Problem
        The place of the name, the name, and the closest one that exists.
    """
    for path, name in _shape_names(design):
        if name in design.empty_shapes:
            yield Problem(place(path), f'the shape "{name}" is empty at these parameters')
        elif name not in design.shapes:
            yield _unknown(path, "shape", name, design.shapes)
    yield from _circles(design.shapes)
    materials = {*design.materials, *card_names()}
    for index, part in enumerate(design.parts):
        if isinstance(part.material, str) and part.material not in materials:
            yield _unknown(("parts", index, "material"), "material", part.material, materials)
    for table in ("objectives", "constraints"):
        for key, target in getattr(design, table).items():
            if target.probe is not None and target.probe not in design.probes:
                yield _unknown((table, key, "probe"), "probe", target.probe, design.probes)


def _unknown(path: Path, what: str, name: str, known: Iterable[str]) -> Problem:
    return Problem(place(path), f'there is no {what} "{name}"', closest(name, known))


def _shape_names(design: Design) -> Iterator[tuple[Path, str]]:
    """Collect the names of shapes with their places, all over the design."""
    for name, shape in design.shapes.items():
        yield from operand_names(shape, ("shapes", name))
    for index, part in enumerate(design.parts):
        yield from _operand(part.shape, ("parts", index, "shape"))
    for path, region in _regions(design):
        if region.shape is not None:
            yield from _operand(region.shape, (*path, "shape"))


def _regions(design: Design) -> Iterator[tuple[Path, Region]]:
    for index, layer in enumerate(design.layers):
        yield ("layers", index, "region"), layer.region
    for index, clamp in enumerate(design.clamps):
        yield ("clamps", index, "region"), clamp.region
    for index, load in enumerate(design.loads):
        region = getattr(load, "region", None)
        if region is not None:
            yield ("loads", index, "region"), region
    for name, probe in design.probes.items():
        yield ("probes", name), probe


def operand_names(shape: Shape, path: Path) -> Iterator[tuple[Path, str]]:
    """Collect the names that a shape's operands go by, at any depth."""
    operands = getattr(shape, "of", None)
    if isinstance(operands, tuple):
        for index, operand in enumerate(operands):
            yield from _operand(operand, (*path, "of", index))
    elif operands is not None:
        yield from _operand(operands, (*path, "of"))


def _operand(operand: str | Shape, path: Path) -> Iterator[tuple[Path, str]]:
    if isinstance(operand, str):
        yield path, operand
    else:
        yield from operand_names(operand, path)


def _circles(shapes: Mapping[str, Shape]) -> Iterator[Problem]:
    uses = {
        name: [used for _, used in operand_names(shape, ()) if used in shapes]
        for name, shape in shapes.items()
    }
    reported: set[str] = set()
    for start in shapes:
        circle = _circle_from(start, uses)
        if circle and not reported & set(circle):
            reported.update(circle)
            yield Problem(place(("shapes", start)), f"is made of itself: {' → '.join(circle)}")


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
