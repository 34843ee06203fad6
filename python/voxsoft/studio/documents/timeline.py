"""Histories of a design as the page draws them: lines over time, and entries that use them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import PurePath
from typing import Any, Final

from voxsoft.design import Design, History, Tendon
from voxsoft.design.document.formula import is_formula
from voxsoft.design.line import Valve
from voxsoft.records import Record
from voxsoft.simulation.loads import readings
from voxsoft.studio.protocol import events
from voxsoft.units import format_quantity

#: Sections with histories, in the order of the page, each with the name of one entry.
_SECTIONS: Final = {
    "loads": "load",
    "supplies": "supply",
    "connections": "connection",
    "tendons": "tendon",
    "activations": "activation",
    "clamps": "clamp",
    "objects": "object",
    "bodies": "body",
}
#: Largest number of drawn points of a curve; those that can be dragged are all sent.
_DRAWN: Final = 2_000
#: Keys under which an entry says how much it is.
_AMOUNTS: Final = (
    *("value", "tension", "length", "shortening", "source", "displacement"),
    *("conductance", "area"),
)

Path = list[str | int]
Source = Mapping[str, Any]


@dataclass(frozen=True)
class _Place:
    """A place of a design that can have a history."""

    path: Path
    title: str
    amount: str
    history: History | None
    low: float | None = None
    high: float | None = None


def timeline_of(
    design: Design, source: Source, *, included: bool = False
) -> list[events.HistoryLine]:
    """All histories of a design, named ones first, and the places that have none yet.

    Parameters
    ----------
    design, source
        The design, and the document that it was read from. Histories of the designs of bodies come
        last: those of a file once, however many bodies are made of it.
    included
        True if it is that of a body: its objects, and loads on everything, are left out.
    """
    places = [
        place for place in _places(design, source) if not (included and _left_out(design, place))
    ]
    named: dict[str, list[_Place]] = {name: [] for name in design.histories}
    alone: list[events.HistoryLine] = []
    for place in places:
        written = _at(source, [*place.path, "history"])
        if isinstance(written, str) and written in named:
            named[written].append(place)
        else:
            alone.append(
                _line([*place.path, "history"], place.title, place.history, written, [place])
            )
    lines = [
        _line(["histories", name], name, history, _at(source, ["histories", name]), named[name])
        for name, history in design.histories.items()
    ]
    inner = _of_bodies(design)
    return [*lines, *sorted([*alone, *inner], key=lambda line: line.way == "none")]


def _left_out(design: Design, place: _Place) -> bool:
    """Check if a place of a design is without use where the design is that of a body."""
    section, index = place.path[:2]
    if section == "loads":  # those that act on everything are the outer design's
        fields = type(design.loads[int(index)]).model_fields
        return "region" not in fields and "cavity" not in fields
    return section == "objects"


def _of_bodies(design: Design) -> list[events.HistoryLine]:
    """The histories in the designs of bodies, each with the bodies that follow it."""
    found: dict[object, events.HistoryLine] = {}
    for index, body in enumerate(design.bodies):
        if body.included is None:
            continue
        is_file = isinstance(body.design, str)
        file = PurePath(str(body.design)).name if is_file else ""
        for line in timeline_of(body.included, body.included.document, included=True):
            if is_file and line.way == "none":
                continue  # it can get no history here
            line.used_by = [
                events.HistoryUse(title=f"{use.title} of {body.name}", amount=use.amount)
                for use in line.used_by
            ]
            # An entry in a table of the document is changed there.
            line.path = ["bodies", index, "design", *line.path]
            line.lives = line.lives or file
            where = (file, *line.path[3:]) if is_file else tuple(line.path)
            key = (where, tuple(line.times), tuple(line.factors))
            known = found.setdefault(key, line)
            if known is not line:
                known.used_by += line.used_by
    return list(found.values())


def _line(
    path: Path, title: str, history: History | None, written: object, users: list[_Place]
) -> events.HistoryLine:
    line = events.HistoryLine(
        path=path,
        title=title,
        used_by=[events.HistoryUse(title=each.title, amount=each.amount) for each in users],
        way="none",
    )
    lows = [each.low for each in users if each.low is not None]
    highs = [each.high for each in users if each.high is not None]
    line.low, line.high = max(lows, default=None), min(highs, default=None)
    if history is not None:
        table = written if isinstance(written, Mapping) else {}
        line.way, line.words = _way(history, table)
        line.times, line.factors = _curve(history, thin=line.way != "points")
        line.repeat = history.repeat
    return line


def _way(history: History, written: Source) -> tuple[events.HistoryWay, str]:
    """Form in which a history is written, and its text where it is no list of points."""
    if "table" in written:
        column = f", column {written['column']}" if "column" in written else ""
        return "table", f"table {written['table']}{column}"
    if history.expression is not None:
        duration = format_quantity(history.duration or 0.0, "time")
        return "expression", f"{history.expression}, for {duration}"
    if history.sine is not None:
        sine = history.sine
        cycles = "" if sine.cycles == 1 else f", {sine.cycles} cycles"
        period = format_quantity(sine.period, "time")
        return "sine", f"sine of {sine.low:g} to {sine.high:g}, period {period}{cycles}"
    return "points", ""


def _curve(history: History, *, thin: bool) -> tuple[list[float], list[float]]:
    """One cycle: instants in s and factors."""
    count = 1 + (len(history.times) - 1) // history.repeat
    times, factors = history.times[:count], history.factors[:count]
    if not thin or count <= _DRAWN:
        return list(times), list(factors)
    kept = sorted({round(index * (count - 1) / (_DRAWN - 1)) for index in range(_DRAWN)})
    return [times[index] for index in kept], [factors[index] for index in kept]


def _places(design: Design, source: Source) -> Iterator[_Place]:
    for section, single in _SECTIONS.items():
        for index, record in enumerate(getattr(design, section)):
            path: Path = [section, index]
            title = _title(design, section, single, index)
            for inner, owner in _owners(record, []):
                key = inner[-1] if inner else None
                yield _Place(
                    [*path, *inner],
                    _capital(title if key is None else f"{key} of {title}"),
                    _amount(design, section, index, [*path, *inner], source),
                    owner.history,
                    *_bounds(owner),
                )


def _owners(record: Record, path: Path) -> Iterator[tuple[Path, Any]]:
    """Everything in a record that can have a history, itself included."""
    for name in type(record).model_fields:
        value = getattr(record, name)
        if name == "history":
            yield path, record
        elif isinstance(value, Record) and not isinstance(value, Design):
            yield from _owners(value, [*path, name])


def _title(design: Design, section: str, single: str, index: int) -> str:
    record: Any = getattr(design, section)[index]
    if section == "loads":
        return readings(design)[index].label
    if section == "activations":
        return f"{record.kind} of {record.part}"
    name = getattr(record, "name", None) or getattr(record, "chamber", None)
    return f"{single} {index + 1 if name is None else name}"


def _amount(design: Design, section: str, index: int, path: Path, source: Source) -> str:
    """Value of a factor of 1, in words; "" where that is no number of the text."""
    if section == "loads":
        reading = readings(design)[index]
        return format_quantity(float(f"{reading.size:.4g}"), reading.quantity)
    table = _at(source, path)
    if isinstance(table, Mapping):
        given = (table.get(key) for key in _AMOUNTS)
        return next(filter(None, map(_written, given)), "")
    return ""


def _written(value: object) -> str:
    """An amount or the components of one as they are written; "" where that is no number."""
    if isinstance(value, list):
        return "" if any(map(is_formula, value)) else f"({', '.join(map(str, value))})"
    return value if isinstance(value, str) and not is_formula(value) else ""


def _bounds(owner: object) -> tuple[float | None, float | None]:
    """Between which factors the history of something must stay."""
    if isinstance(owner, Valve):
        return 0.0, 1.0
    if isinstance(owner, Tendon) and owner.shortening is None:
        return 0.0, None
    return None, None


def _at(source: object, path: Path) -> object:
    for step in path:
        if isinstance(source, Mapping):
            source = source.get(step)
        elif isinstance(source, list) and isinstance(step, int) and step < len(source):
            source = source[step]
        else:
            return None
    return source


def _capital(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}"
