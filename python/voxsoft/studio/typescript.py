"""Write the protocol's types as TypeScript: ``python -m voxsoft.studio.typescript``.

The text goes to ``studio/src/protocol.ts``; a test compares the two.
"""

from __future__ import annotations

import inspect
import json
import sys
from collections.abc import Iterator
from typing import Any, Final

from msgspec import inspect as types

from voxsoft.studio.commands import AnyCommand, Command
from voxsoft.studio.events import AnyEvent, Event
from voxsoft.studio.protocol import CREDITS, PROTOCOL

_HEAD: Final = """\
// Written by `python -m voxsoft.studio.typescript`; change python/voxsoft/studio instead.
"""
_SIMPLE: Final[dict[type[types.Type], str]] = {
    types.AnyType: "unknown",
    types.BoolType: "boolean",
    types.FloatType: "number",
    types.IntType: "number",
    types.NoneType: "null",
    types.StrType: "string",
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
        f"export const PROTOCOL = {PROTOCOL};\n",
        "/** Frames that the server sends before it waits for an `ack`. */\n"
        f"export const CREDITS = {CREDITS};\n",
        "export type Triple = [number, number, number];\n",
    ]
    for struct in {**sent, **received}.values():
        blocks.append(_interface(struct, optional=struct.cls not in received))
    blocks.append(_union("AnyCommand", commands))
    blocks.append(_union("AnyEvent", events))
    return "\n".join(blocks)


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
