"""Write the protocol's types and constants as TypeScript.

``python -m voxsoft.studio.typescript``.

The text goes to ``studio/src/protocol.ts``; a test compares the two.
"""

from __future__ import annotations

import inspect
import json
import sys
from collections.abc import Iterator
from enum import IntEnum, IntFlag
from typing import Any, Final

from msgspec import inspect as types

from voxsoft.design.features import FEATURES
from voxsoft.formats.registry import HEADINGS, WRITTEN
from voxsoft.shapes import KINDS as SHAPES
from voxsoft.shapes.cad_files import CAD_SUFFIXES, HINT, WHAT
from voxsoft.studio.documents.uploads import MESHES
from voxsoft.studio.protocol.commands import AnyCommand, Command
from voxsoft.studio.protocol.events import AnyEvent, Event
from voxsoft.studio.protocol.wire import (
    CAVITY,
    CREDITS,
    HEADER,
    LARGEST_UPLOAD,
    MAGIC,
    PACES,
    PROTOCOL,
    STILL_OBJECTS,
    CloseCode,
    FrameFlag,
    MessageKind,
    TopologyFlag,
)
from voxsoft.units import COMMON_UNITS, KINDS, parse_any
from voxsoft.units.kinds import describe_dimension

_HEAD: Final = """\
// Written by `python -m voxsoft.studio.typescript`; change python/voxsoft/studio instead.
// Long because all messages of the studio stand in one file.
"""
_SIMPLE: Final[dict[type[types.Type], str]] = {
    types.AnyType: "unknown",
    types.BoolType: "boolean",
    types.FloatType: "number",
    types.IntType: "number",
    types.NoneType: "null",
    types.StrType: "string",
}
#: Numbers of the page by name, with their comments.
_NUMBERS: Final = {
    "PROTOCOL": (PROTOCOL, "Page and server must speak the same."),
    "CREDITS": (CREDITS, "Frames that the server sends before it waits for an `ack`."),
    "LARGEST_UPLOAD": (LARGEST_UPLOAD, "Largest file that the server takes, bytes."),
    "MAGIC": (MAGIC, "First four bytes of a binary message."),
    "HEADER": (HEADER, "Length of the head of a binary message, bytes."),
    "STILL_OBJECTS": (STILL_OBJECTS, "Topology of the objects around a body at rest."),
    "CAVITY": (CAVITY, "Bit of a triangle's tag that says that it faces a cavity."),
}


def typescript() -> str:
    """Return the whole module.

    Examples
    --------
    >>> "export interface StepCommand" in typescript()
    True
    """
    commands, events = _members(AnyCommand), _members(AnyEvent)
    sent = _reachable(commands)
    received = _reachable(events)
    blocks = [
        _HEAD,
        *(_constant(name, value, about) for name, (value, about) in _NUMBERS.items()),
        _constant("MESHES", MESHES, "Endings of mesh files that are read."),
        _constant("WRITTEN", _written(), "Formats of files that the server writes, by ending."),
        _constant("CAD_SUFFIXES", CAD_SUFFIXES, "Endings of files of CAD programs."),
        _constant("CAD_WHAT", WHAT, "Why they are not read."),
        _constant("CAD_HINT", HINT, "Remedy for them."),
        _constant("PACES", PACES, "Speeds of time: simulated seconds for each of the clock."),
        *(_codes(each) for each in (CloseCode, MessageKind, FrameFlag, TopologyFlag)),
        _constant("KINDS", _kinds(), "Kinds: SI unit, unit of bare numbers, exponents."),
        _constant("SHAPE_KINDS", _shape_kinds(), "Kinds of shapes that a design file can hold."),
        _constant("FEATURES", _features(), "Ready features by name, and how each is built."),
        _constant("COMMON_UNITS", _units(), "Units of daily use: SI units in one, and exponents."),
        "export type Triple = [number, number, number];\n",
    ]
    for struct in {**sent, **received}.values():
        blocks.append(_interface(struct, optional=struct.cls not in received))
    blocks.append(_union("AnyCommand", commands))
    blocks.append(_union("AnyEvent", events))
    return "\n".join(blocks)


def _constant(name: str, value: object, about: str) -> str:
    end = " as const" if isinstance(value, dict | tuple) else ""
    if isinstance(value, dict):  # one entry a line
        rows = "".join(f"  {json.dumps(key)}: {json.dumps(row)},\n" for key, row in value.items())
        return f"/** {about} */\nexport const {name} = {{\n{rows}}}{end};\n"
    return f"/** {about} */\nexport const {name} = {json.dumps(value)}{end};\n"


def _codes(codes: type[IntEnum] | type[IntFlag]) -> str:
    about = inspect.cleandoc(codes.__doc__ or "").splitlines()[0]
    return _constant(codes.__name__, {code.name: code.value for code in codes}, about)


def _written() -> dict[str, dict[str, object]]:
    return {
        suffix: {
            "title": HEADINGS[form.kind],
            "purpose": form.purpose,
            "asksUnit": form.unit is None,
            "asksShape": form.kind == "surface",
        }
        for suffix, form in WRITTEN.items()
        if suffix == form.suffix
    }


def _kinds() -> dict[str, dict[str, object]]:
    """Each kind with its SI unit, the one its numbers are completed with, and its article."""
    found: dict[str, dict[str, object]] = {}
    for kind in KINDS.values():
        si = [unit for unit in kind.units if parse_any(f"1 {unit}").value == 1.0]
        found[kind.name] = {
            "si": si[0] if si else "1",
            "written": kind.units[0] if kind.units else "",
            "called": describe_dimension(kind.dimension),
            "dimension": list(kind.dimension),
        }
    return found


def _shape_kinds() -> tuple[str, ...]:
    """All kinds but functions of Python, which have no form in a file."""
    return tuple(kind for kind, shape in SHAPES.items() if "function" not in shape.model_fields)


def _features() -> dict[str, str]:
    return {feature.name: feature.sentence for feature in FEATURES}


def _units() -> dict[str, list[object]]:
    return {
        unit: [parse_any(f"1 {unit}").value, list(dimension)]
        for unit, dimension in COMMON_UNITS.items()
    }


def _members(union: Any) -> list[types.StructType]:  # noqa: ANN401 - a union is no type to mypy
    found = types.type_info(union)
    assert isinstance(found, types.UnionType)
    return [member for member in found.types if isinstance(member, types.StructType)]


def _reachable(roots: list[types.StructType]) -> dict[type, types.StructType]:
    """All structs that the roots hold, the held before the holders."""
    found: dict[type, types.StructType] = {}

    def visit(node: types.Type) -> None:
        if isinstance(node, types.StructType):
            if node.cls in found:
                return
            for field in node.fields:
                visit(field.type)
            found[node.cls] = node
        for inner in _inner(node):
            visit(inner)

    for root in roots:
        visit(root)
    return found


def _inner(node: types.Type) -> Iterator[types.Type]:
    if isinstance(node, types.UnionType):
        yield from node.types
    elif isinstance(node, types.ListType):
        yield node.item_type
    elif isinstance(node, types.TupleType):
        yield from node.item_types
    elif isinstance(node, types.DictType):
        yield node.value_type


def _name(cls: type) -> str:
    """Name of an interface; a command and an event may share that of their class."""
    if issubclass(cls, Command):
        return f"{cls.__name__}Command"
    return f"{cls.__name__}Event" if issubclass(cls, Event) else cls.__name__


def _interface(struct: types.StructType, *, optional: bool) -> str:
    about = inspect.cleandoc(struct.cls.__doc__ or "").splitlines()
    if len(about) == 1:
        lines = [f"/** {about[0]} */"]
    else:
        lines = ["/**", *(f" * {line}".rstrip() for line in about), " */"]
    lines.append(f"export interface {_name(struct.cls)} {{")
    if struct.tag_field is not None:
        lines.append(f"  {struct.tag_field}: {json.dumps(struct.tag)};")
    for field in struct.fields:
        mark = "?" if optional and not field.required else ""
        lines.append(f"  {field.encode_name}{mark}: {_type(field.type)};")
    return "\n".join([*lines, "}\n"])


def _type(node: types.Type) -> str:
    if (simple := _SIMPLE.get(type(node))) is not None:
        return simple
    if isinstance(node, types.StructType):
        return _name(node.cls)
    if isinstance(node, types.LiteralType):
        return " | ".join(json.dumps(value) for value in node.values)
    if isinstance(node, types.UnionType):
        return " | ".join(map(_type, node.types))
    if isinstance(node, types.TupleType):
        items = [_type(item) for item in node.item_types]
        return "Triple" if items == ["number"] * 3 else f"[{', '.join(items)}]"
    if isinstance(node, types.ListType):
        item = _type(node.item_type)
        return f"({item})[]" if " | " in item else f"{item}[]"
    if isinstance(node, types.DictType):
        return f"Record<string, {_type(node.value_type)}>"
    raise TypeError(f"{node} has no form in TypeScript yet")


def _union(name: str, members: list[types.StructType]) -> str:
    names = [_name(member.cls) for member in members]
    return "\n".join([f"export type {name} =", *(f"  | {each}" for each in names)]) + ";\n"


if __name__ == "__main__":
    sys.stdout.write(typescript())
