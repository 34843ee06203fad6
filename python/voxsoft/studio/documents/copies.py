"""Copies of bodies and objects of a design, as changes of its text.

Each way to copy is written so that formulas stay formulas where they can.
"""

from __future__ import annotations

import copy
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from voxsoft.design import Body, Design, Motion, Object
from voxsoft.design.contact import BODY, FLOOR
from voxsoft.design.document.formula import is_formula
from voxsoft.design.isometry import SAME, Isometry
from voxsoft.errors import DesignError
from voxsoft.studio.protocol import commands
from voxsoft.studio.protocol.message import Triple

#: Place of a change, by keys and indices from the top, and the new value; None removes it.
Change = tuple[list[str | int], Any]
Way = commands.Beside | commands.InMirror | commands.Around
Table = Mapping[str, Any]

#: Lists whose entries may be of one body.
_LISTS: Final = ("parts", "layers", "springs", "clamps", "loads")
#: Tables whose entries may be.
_TABLES: Final = ("chambers", "probes")
#: Keys of directions or places in the frame of the design.
_DIRECTED: Final = ("motion", "anchor", "axes")


@dataclass
class Copying:
    """Changes that copy something, and the entries that stay as they are.

    Attributes
    ----------
    changes
        In turn.
    left
        Places of entries that are of the original alone, as the copy would need others.
    """

    changes: list[Change] = field(default_factory=list)
    left: list[str] = field(default_factory=list)


def free_name(wanted: str, taken: Collection[str]) -> str:
    """Return a name that is still free.

    Examples
    --------
    >>> free_name("left", ["left", "left-2"])
    'left-3'
    """
    names = (wanted if number == 1 else f"{wanted}-{number}" for number in range(1, 10_000))
    return next(name for name in names if name not in taken)


def names_of(design: Design | None) -> list[str]:
    """All names that a new body or object of a design cannot have."""
    if design is None:
        return [BODY, FLOOR]
    bodies = [body.name for body in design.bodies]
    return [BODY, FLOOR, *bodies, *(each.name for each in design.objects)]


def copied(source: Table, design: Design, name: str, way: Way) -> Copying:
    """Copy a body or an object.

    Parameters
    ----------
    source, design
        The document with its formulas, and the design that it is.
    name
        Name of the body or object.
    way
        Direction of the copies.

    Raises
    ------
    DesignError
        There is nothing of that name, or it cannot be copied in that way.
    """
    key, index, original = _found(design, name)
    written: Table = source[key][index]
    if isinstance(way, commands.InMirror) and isinstance(original, Body) and not original.design:
        what = "has parts of its own, and only a design can be mirrored"
        hint = "copy it, and mirror its shapes; or put the parts in a design file of their own"
        raise DesignError(name, what, hint)
    found = Copying()
    taken, first = names_of(design), len(source[key])
    for number, isometry in enumerate(_isometries(way)):
        new = free_name(name, taken)
        taken.append(new)
        table = {**copy.deepcopy(written), "name": new}
        if isinstance(original, Body):
            table |= _posed(written, original, isometry, way, number + 1)
            _copy_entries(found, source, name, new, way)
        else:
            table["shape"] = _placed_shape(written["shape"], way, number + 1)
        if isinstance(original.motion, Motion):
            table["motion"] = _motion(written["motion"], original.motion, isometry)
        kept = {entry: value for entry, value in table.items() if value is not None}
        found.changes.append(([key, first + number], kept))
        _copy_pairs(found, source, name, new)
    return found


def moved(source: Table, design: Design, name: str, by: Triple) -> list[Change]:
    """Move a body or an object, with the center that its own motion turns about.

    Raises
    ------
    DesignError
        There is nothing of that name.
    """
    key, index, original = _found(design, name)
    written, way = source[key][index], commands.Beside(by=by)
    isometry = Isometry.move(by)
    if isinstance(original, Body):
        posed = _posed(written, original, isometry, way, 1)
        changes: list[Change] = [([key, index, "position"], posed["position"])]
    else:
        changes = [([key, index, "shape"], _placed_shape(written["shape"], way, 1))]
    if isinstance(original.motion, Motion) and original.motion.rotation is not None:
        motion = _motion(written["motion"], original.motion, isometry)
        changes.append(([key, index, "motion"], motion))
    return changes


def removed(source: Table, design: Design, name: str) -> list[Change]:
    """Take a body or an object out of a design, with the pairs of contact that name it.

    Raises
    ------
    DesignError
        There is nothing of that name.
    """
    key, index, _ = _found(design, name)
    pairs = (source.get("contact") or {}).get("pairs") or []
    numbers = [number for number, pair in enumerate(pairs) if name in pair.get("of", ())]
    changes: list[Change] = [(["contact", "pairs", number], None) for number in reversed(numbers)]
    if pairs and len(numbers) == len(pairs):
        changes = [(["contact", "pairs"], None)]
    return [*changes, ([key, index], None)]


def length(value: float) -> str | int:
    """Write a length in mm, to a picometer.

    Examples
    --------
    >>> length(0.0125), length(0.0)
    ('12.5 mm', 0)
    """
    shown = round(1e3 * value, 9)
    return f"{shown:.12g} mm" if shown else 0


def point(at: Triple) -> list[str | int]:
    """Write a place."""
    return [length(each) for each in at]


def _found(design: Design, name: str) -> tuple[str, int, Body | Object]:
    both: dict[str, Sequence[Body | Object]] = {"bodies": design.bodies, "objects": design.objects}
    for key, things in both.items():
        for index, each in enumerate(things):
            if each.name == name:
                return key, index, each
    raise DesignError(name, "is no body or object of the design")


def _isometries(way: Way) -> Iterator[Isometry]:
    match way:
        case commands.Beside():
            yield Isometry.move(way.by)
        case commands.InMirror():
            yield Isometry.mirror(way.axis, way.at)
        case commands.Around():
            if not any(way.axis):
                raise DesignError("axis", "has no direction", "give a vector that is not zero")
            for number in range(1, way.count):
                yield Isometry.turn(way.axis, _step(way) * number, way.center)


def _step(way: commands.Around) -> float:
    return 2.0 * np.pi / way.count


def _posed(written: Table, body: Body, isometry: Isometry, way: Way, number: int) -> Table:
    """The entries of a body that say where it is, for its copy."""
    position: Sequence[Any] = written.get("position") or [0, 0, 0]
    match way:
        case commands.Beside():
            moved = zip(position, body.position, way.by, strict=True)
            return {"position": [_plus(*each) for each in moved]}
        case commands.InMirror() if body.rotation is None and body.mirror in (None, way.axis):
            across = "xyz".index(way.axis)
            moved_to = [
                _minus(2 * way.at, each, value) if axis == across else each
                for axis, (each, value) in enumerate(zip(position, body.position, strict=True))
            ]
            mirror = way.axis if body.mirror is None else None
            return {"position": moved_to, "mirror": mirror}
        case commands.Around() if body.rotation is None:
            # x → Q (x - c) + c + p with c + p on the axis.
            centers = zip(way.center, position, body.position, strict=True)
            center = [_minus(*each) for each in centers]
            return {"position": position, "rotation": _rotation(way, number, center)}
        case commands.Around() if (sign := _same_axis(body, way)) is not None:
            turn = dict(written["rotation"])
            by = sign * _step(way) * number
            if is_formula(turn["angle"]):
                turn["angle"] = f"{turn['angle']} + {_angle(by)}"
            else:
                assert body.rotation is not None
                turn["angle"] = _angle(body.rotation.angle + by)
            return {"rotation": turn}
    changes = isometry.changes(body)
    rotation = changes["rotation"]
    if rotation is not None:
        rotation = {"axis": _direction(rotation.axis), "angle": _angle(rotation.angle)}
    return {
        "position": point(changes["position"]),
        "rotation": rotation,
        "mirror": changes["mirror"],
    }


def _same_axis(body: Body, way: commands.Around) -> float | None:
    """Sense, 1 or -1, in which a body is turned about the same axis already, or None."""
    turn = body.rotation
    if turn is None:
        return None
    axis = np.asarray(way.axis) / np.linalg.norm(way.axis)
    own = np.asarray(turn.axis) / np.linalg.norm(turn.axis)
    apart = np.asarray(turn.center) + body.position - way.center
    aside = np.linalg.norm(np.cross(axis, apart))
    if np.linalg.norm(np.cross(axis, own)) > SAME or aside > SAME:
        return None
    return float(np.sign(axis @ own))


def _rotation(way: commands.Around, number: int, center: list[str | int]) -> dict[str, Any]:
    turn = {"axis": _direction(way.axis), "angle": _angle(_step(way) * number)}
    return {**turn, "center": center} if any(center) else turn


def _angle(value: float) -> str:
    return f"{round(np.rad2deg(value), 9):.12g} deg"


def _direction(axis: Triple) -> list[float | int]:
    rounded = [round(float(each), 12) for each in axis]
    return [int(each) if each.is_integer() else each for each in rounded]


def _plus(written: Any, value: float, by: float) -> Any:  # noqa: ANN401 - as a file holds it
    if abs(by) < SAME**2:
        return written
    if is_formula(written):
        return f"{written} {'+' if by > 0 else '-'} {length(abs(by))}"
    return length(value + by)


def _minus(from_: float, written: Any, value: float) -> Any:  # noqa: ANN401
    """Subtract a written value from a place."""
    if not is_formula(written):
        return length(from_ - value)
    inner = written.lstrip().removeprefix("=").strip()
    inner = inner if inner.isidentifier() else f"({inner})"
    return f"= {length(from_)} - {inner}" if from_ else f"= -{inner}"


def _placed_shape(shape: Any, way: Way, number: int) -> dict[str, Any]:  # noqa: ANN401
    """The shape of an object where its copy is."""
    match way:
        case commands.Beside():
            if isinstance(shape, Mapping) and shape.get("kind") == "translate":
                # Moved again and again it is still moved once, where nothing is a formula.
                by = shape["by"]
                if not any(map(is_formula, by)):
                    at = [_si(each) + more for each, more in zip(by, way.by, strict=True)]
                    return {**shape, "by": [length(each) for each in at]}
            return {"kind": "translate", "of": shape, "by": point(way.by)}
        case commands.InMirror():
            across = "xyz".index(way.axis)
            place = [way.at if axis == across else 0.0 for axis in range(3)]
            image = {"kind": "mirror", "of": shape, "normal": way.axis}
            return {**image, "point": [length(each) for each in place]} if way.at else image
        case commands.Around():
            center: list[str | int] = point(way.center)
            return {"kind": "rotate", "of": shape, **_rotation(way, number, center)}


def _si(written: Any) -> float:  # noqa: ANN401
    from voxsoft.units import parse

    return parse(written, "length") if isinstance(written, str) else float(written)


def _motion(written: Table, motion: Motion, isometry: Isometry) -> dict[str, Any]:
    """A motion in the frame of the design, for a copy; unchanged values stay formulas."""
    image = isometry.motion(motion)
    table = copy.deepcopy(dict(written))
    for keys, before, after, write in (
        (("displacement",), motion.displacement, image.displacement, length),
        *(
            ()
            if motion.rotation is None or image.rotation is None
            else (
                (("rotation", "axis"), motion.rotation.axis, image.rotation.axis, _number),
                (("rotation", "center"), motion.rotation.center, image.rotation.center, length),
            )
        ),
    ):
        if np.allclose(before, after, rtol=0.0, atol=SAME**2):
            continue
        here = table
        for key in keys[:-1]:
            here = here[key]
        here[keys[-1]] = [write(each) for each in after]
    return table


def _number(value: float) -> float | int:
    [found] = _direction((value, 0.0, 0.0))[:1]
    return found


def _copy_entries(found: Copying, source: Table, name: str, new: str, way: Way) -> None:
    """Copy the entries that a design has for a body beside it: its parts, clamps, loads, probes."""
    counts: dict[str, int] = {}
    for path, _ in found.changes:
        if path[0] in _LISTS:
            counts[str(path[0])] = counts.get(str(path[0]), 0) + 1
    for key in _LISTS:
        entries = source.get(key) or []
        for index, entry in enumerate(entries):
            if not _mentions(entry, name):
                continue
            if _is_directed(entry, way):
                found.left.append(f"{key}[{index}]")
                continue
            at = len(entries) + counts.get(key, 0)
            counts[key] = counts.get(key, 0) + 1
            found.changes.append(([key, at], _renamed(entry, name, new)))
    for key in _TABLES:
        for inner, entry in (source.get(key) or {}).items():
            if _mentions(entry, name):
                free = free_name(f"{inner} {new}", source[key])
                found.changes.append(([key, free], _renamed(entry, name, new)))


def _is_directed(entry: Table, way: Way) -> bool:
    """Check if an entry holds directions or places that a copy would need to turn or move."""
    if "anchor" in entry:
        return True
    if isinstance(way, commands.Beside):
        return bool((entry.get("motion") or {}).get("rotation"))
    return isinstance(entry.get("value"), list) or any(key in entry for key in _DIRECTED)


def _mentions(value: Any, name: str) -> bool:  # noqa: ANN401
    if isinstance(value, Mapping):
        own = value.get("body") == name or str(value.get("cavity", "")).startswith(f"{name}.")
        return own or any(_mentions(each, name) for each in value.values())
    return isinstance(value, list) and any(_mentions(each, name) for each in value)


def _renamed(value: Any, name: str, new: str) -> Any:  # noqa: ANN401
    """Replace the name of a body."""
    if isinstance(value, list):
        return [_renamed(each, name, new) for each in value]
    if not isinstance(value, Mapping):
        return copy.deepcopy(value)
    table = {key: _renamed(each, name, new) for key, each in value.items()}
    if table.get("body") == name:
        table["body"] = new
    cavity = table.get("cavity")
    if isinstance(cavity, str) and cavity.startswith(f"{name}."):
        table["cavity"] = new + cavity.removeprefix(name)
    return table


def _copy_pairs(found: Copying, source: Table, name: str, new: str) -> None:
    """Let the copy touch as the original does: with the same friction, or bonded."""
    pairs = (source.get("contact") or {}).get("pairs") or []
    there = len(pairs) + sum(path[:2] == ["contact", "pairs"] for path, _ in found.changes)
    for pair in pairs:
        if name in pair.get("of", ()):
            of = [new if each == name else each for each in pair["of"]]
            found.changes.append((["contact", "pairs", there], {**pair, "of": of}))
            there += 1
