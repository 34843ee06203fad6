"""TOML output: one line for each entry, tables in a fixed, diffable order."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from voxsoft.errors import DesignError

_BARE_KEY: Final = re.compile(r"[A-Za-z0-9_-]+")
_LINE: Final = 100
_ESCAPES: Final = {
    "\\": "\\\\",
    '"': '\\"',
    "\b": "\\b",
    "\t": "\\t",
    "\n": "\\n",
    "\f": "\\f",
    "\r": "\\r",
}


def write_toml(document: Mapping[str, object]) -> str:
    """Write nested dicts and lists as TOML text.

    Scalars come first, then each table as a section whose entries are inline, then each list of
    tables as repeated sections: the form in which the examples are written.

    Parameters
    ----------
    document
        Text, numbers, booleans, lists and dicts.

    Returns
    -------
    str
        The text, which ``tomllib`` reads back to an equal document.

    Raises
    ------
    DesignError
        A value that TOML has no form for.

    Examples
    --------
    >>> print(write_toml({"name": "ball", "shapes": {"body": {"kind": "sphere"}}}), end="")
    name = "ball"
    <BLANKLINE>
    [shapes]
    body = { kind = "sphere" }
    """
    scalars = {k: v for k, v in document.items() if not _is_section(v)}
    sections = {k: v for k, v in document.items() if k not in scalars}
    blocks = [list(_entries(scalars))] if scalars else []
    for key, value in sections.items():
        if isinstance(value, Mapping):
            blocks.append([f"[{_key(key)}]", *_entries(value)])
        else:
            blocks.extend([f"[[{_key(key)}]]", *_entries(table)] for table in _tables(value))
    return "\n\n".join("\n".join(block) for block in blocks) + "\n" if blocks else ""


def line_of(text: str, path: Sequence[str | int]) -> int | None:
    r"""Find the line of a key in TOML text.

    Parameters
    ----------
    text
        The text of the file.
    path
        Keys and indices, as in ``("parts", 0, "material")``.

    Returns
    -------
    int or None
        The line, from 1, of the key or of the innermost table around it that is found.

    Examples
    --------
    >>> line_of('name = "a"\n[[parts]]\nshape = "b"', ("parts", 0, "shape"))
    3
    """
    lines = dict(reversed(list(_keys_with_lines(text))))
    for length in range(len(path), 0, -1):
        if (number := lines.get(tuple(path[:length]))) is not None:
            return number
    return None


def _is_section(value: object) -> bool:
    return isinstance(value, Mapping) or bool(_tables(value))


def _tables(value: object) -> list[Mapping[str, object]]:
    """Return the entries of a list of nothing but tables; none for any other value."""
    if not isinstance(value, Sequence) or isinstance(value, str):
        return []
    tables = [entry for entry in value if isinstance(entry, Mapping)]
    return tables if len(tables) == len(value) else []


def _entries(table: Mapping[str, object]) -> Iterator[str]:
    for key, value in table.items():
        line = f"{_key(key)} = {_value(value)}"
        yield line if len(line) <= _LINE else f"{_key(key)} = {_broken_value(value)}"


def _broken_value(value: object) -> str:
    """Write a long list with one entry on each line; inline tables must stay on theirs."""
    if not isinstance(value, Sequence) or isinstance(value, str):
        return _value(value)
    return "\n".join(["[", *(f"  {_value(entry)}," for entry in value), "]"])


def _key(key: str) -> str:
    return key if _BARE_KEY.fullmatch(key) else _text(key)


def _value(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return _number(value)
    if isinstance(value, Mapping):
        inner = ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items())
        return f"{{ {inner} }}" if inner else "{}"
    if isinstance(value, Sequence):
        return f"[{', '.join(map(_value, value))}]"
    raise DesignError(f"{value!r}", "has no form in a TOML file")


def _number(value: float) -> str:
    if math.isinf(value):
        return "inf" if value > 0 else "-inf"
    return "nan" if math.isnan(value) else repr(value)


def _text(text: str) -> str:
    escaped = (
        _ESCAPES.get(c) or (f"\\u{ord(c):04x}" if ord(c) < 0x20 or ord(c) == 0x7F else c)
        for c in text
    )
    return f'"{"".join(escaped)}"'


_SECTION: Final = re.compile(r"\s*(\[\[?)\s*([^\[\]]+?)\s*\]\]?\s*(?:#.*)?")
_ENTRY: Final = re.compile(r"""\s*((?:[\w-]+|"[^"]*"|'[^']*')(?:\s*\.\s*[\w"'-]+)*)\s*=""")
_PIECE: Final = re.compile(r"""[\w-]+|"[^"]*"|'[^']*'""")


def _keys_with_lines(text: str) -> Iterator[tuple[tuple[str | int, ...], int]]:
    """Pair the keys that begin a line, and section heads, with their lines.

    Simple scan for the line numbers of messages; ``tomllib`` keeps no positions.
    """
    counts: dict[tuple[str | int, ...], int] = {}
    section: tuple[str | int, ...] = ()
    for number, line in enumerate(text.splitlines(), start=1):
        if head := _SECTION.fullmatch(line):
            section = tuple(_names(head.group(2)))
            if head.group(1) == "[[":
                counts[section] = counts.get(section, -1) + 1
                section = (*section, counts[section])
            yield section, number
        elif entry := _ENTRY.match(line):
            yield (*section, *_names(entry.group(1))), number


def _names(dotted: str) -> list[str]:
    return [piece.strip("\"'") for piece in _PIECE.findall(dotted)]
