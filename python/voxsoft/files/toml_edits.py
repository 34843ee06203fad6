"""Edits of a design's text by path, which keep its comments and its layout."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import tomlkit
from tomlkit.container import Container
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import AoT, InlineTable, Table, Trivia

from voxsoft.errors import DesignError
from voxsoft.files.toml_text import write_toml
from voxsoft.records import place

Path = Sequence[str | int]


class _InlineTable(InlineTable):
    """Inline table with a blank inside of its braces, as all files of VoxSoft have them."""

    def as_string(self) -> str:
        """Return the text of the table."""
        inside = super().as_string()[1:-1].strip()
        return f"{{ {inside} }}" if inside else "{}"


def with_value(text: str, path: Path, value: object) -> str:
    r"""Set one value of a text in TOML.

    Parameters
    ----------
    text
        The text of a design.
    path
        Keys and indices; tables on the way are made, and an index one past the last appends.
    value
        Text, a number, a boolean, a list or a table; None removes the key.

    Raises
    ------
    DesignError
        The text is not TOML, the path leads nowhere, or TOML has no form for the value.

    Examples
    --------
    >>> print(with_value('wall = "5 mm"  # thin', ["wall"], "6 mm"))
    wall = "6 mm"  # thin
    """
    with _refusing(path, "set"):
        document = tomlkit.parse(text)
        _set(document, list(path), value)
        return tomlkit.dumps(document)


def with_swapped(text: str, path: Path, first: int, second: int) -> str:
    r"""Exchange two entries of a list of a text in TOML, with their comments.

    Parameters
    ----------
    text
        The text of a design.
    path
        Keys and indices of the list.
    first, second
        Indices of the entries.

    Raises
    ------
    DesignError
        The text is not TOML, or the path leads to no list with both entries.

    Examples
    --------
    >>> print(with_swapped('of = ["rod", "ball"]', ["of"], 0, 1))
    of = ["ball", "rod"]
    """
    with _refusing(path, "reordered"):
        document = tomlkit.parse(text)
        here: Any = document
        for step in path:
            here = here[step]
        if not isinstance(here, list):
            raise TypeError("it is no list")
        if not all(0 <= index < len(here) for index in (first, second)):
            raise IndexError(f"it has {len(here)} entries")
        here[first], here[second] = here[second], here[first]
        return tomlkit.dumps(document)


@contextmanager
def _refusing(path: Path, done: str) -> Iterator[None]:
    """Report an edit that cannot be made by its place."""
    try:
        yield
    except (TOMLKitError, RecursionError) as error:
        hint = "fix the text first, then use the form"
        raise DesignError(place(path), f"cannot be {done}: {error}", hint) from None
    except (KeyError, IndexError, TypeError, AttributeError, ValueError) as error:
        raise DesignError(place(path), f"cannot be {done}: {error}") from None


def with_document(text: str, document: Mapping[str, Any]) -> str:
    """Change a text so that it holds another document, with as much of its layout as can stay.

    Examples
    --------
    >>> print(with_document('wall = "5 mm"  # thin', {"wall": "6 mm"}))
    wall = "6 mm"  # thin
    """
    try:
        changed = text
        for path, value in _changes(tomllib.loads(text), document, ()):
            changed = with_value(changed, path, value)
        if tomllib.loads(changed) == document:
            return changed
    except (DesignError, tomllib.TOMLDecodeError):
        pass  # written anew, then
    return write_toml(document)


def _changes(before: object, after: object, path: Path) -> Iterator[tuple[Path, object]]:
    """Yield the values that differ; an entry that is gone is not among them."""
    if isinstance(before, Mapping) and isinstance(after, Mapping):
        for key, value in after.items():
            if key in before:
                yield from _changes(before[key], value, (*path, key))
            else:
                yield (*path, key), value
    elif isinstance(before, list) and isinstance(after, list) and len(before) == len(after):
        for index, pair in enumerate(zip(before, after, strict=True)):
            yield from _changes(*pair, (*path, index))
    elif type(before) is not type(after) or before != after:
        yield path, after


def _set(document: tomlkit.TOMLDocument, path: list[str | int], value: object) -> None:
    above: Any = None
    here: Any = document
    if path[0] not in document and (len(path) > 1 or _is_section(value)):
        _part_from_above(document)
    for at, step in enumerate(path[:-1]):
        above, here = here, _inside(here, step, path[: at + 1], follower=path[at + 1])
    last = path[-1]
    if value is None:
        del here[last]
        if isinstance(here, AoT) and not here:
            # An empty list would be written as a key of the section before it.
            del above[path[-2]]
    elif isinstance(last, int):
        _set_entry(here, last, value, path)
    elif len(path) == 1:
        here[last] = _kept(here.get(last), _item(value, top=True))
    else:
        here[last] = _kept(here.get(last), _item(value))


def _inside(here: Any, step: str | int, path: list[str | int], follower: str | int) -> Any:  # noqa: ANN401
    """Go one step down, making missing tables and lists."""
    if isinstance(step, str) and step not in here:
        if isinstance(follower, int):
            here[step] = tomlkit.aot() if len(path) == 1 else tomlkit.array()
        else:
            here[step] = (
                tomlkit.table() if len(path) == 1 else _InlineTable(Container(), Trivia(), new=True)
            )
    elif isinstance(step, int) and step == len(here):
        here.append(
            tomlkit.table()
            if isinstance(here, AoT)
            else _InlineTable(Container(), Trivia(), new=True)
        )
    inner = here[step]
    if not isinstance(inner, (Mapping, list)):
        raise TypeError(f"{place(path)} holds {inner!r}, nothing below it can be set")
    return inner


def _set_entry(here: Any, index: int, value: object, path: list[str | int]) -> None:  # noqa: ANN401
    if not isinstance(here, list) or not 0 <= index <= len(here):
        raise IndexError(f"{place(path)} is past the end")
    if isinstance(here, AoT):
        if not isinstance(value, Mapping):
            raise TypeError("expected a table")
        table = tomlkit.table()
        for key, inner in value.items():
            table[key] = _item(inner)
        if index == len(here):
            _part_sections(here, table)
            here.append(table)
        else:
            here[index] = table
    elif index == len(here):
        here.append(_item(value))
    else:
        here[index] = _item(value)


def _is_section(value: object) -> bool:
    """Return True for a table, and for a list of nothing but tables."""
    if isinstance(value, list):
        return bool(value) and all(isinstance(each, Mapping) for each in value)
    return isinstance(value, Mapping)


def _part_from_above(document: tomlkit.TOMLDocument) -> None:
    """Put an empty line between the end of a text and a section that follows."""
    text = document.as_string()
    for end in ("\n", "\n\n"):
        if text.strip() and not text.endswith(end):
            document.add(tomlkit.nl())
            text += "\n"


def _part_sections(sections: AoT, added: Table) -> None:
    """Put an empty line between an added section of a list and its neighbors.

    Sections without empty lines between them get none before the new one.
    """
    ends = [section.as_string().endswith("\n\n") for section in sections]
    if ends and ends[-1]:
        added.add(tomlkit.nl())
    elif len(ends) == 1 or any(ends):
        sections[-1].add(tomlkit.nl())


def _item(value: object, *, top: bool = False) -> Any:  # noqa: ANN401
    """Convert a value to TOML: tables inline, except at the top, which lists repeat."""
    if isinstance(value, Mapping):
        table = tomlkit.table() if top else _InlineTable(Container(), Trivia(), new=True)
        for key, inner in value.items():
            table[key] = _item(inner)
        return table
    if isinstance(value, list):
        if top and all(isinstance(each, Mapping) for each in value):
            sections = tomlkit.aot()
            for each in value:
                sections.append(_item(each, top=True))
            return sections
        array = tomlkit.array()
        for each in value:
            array.append(_item(each))
        return array
    return tomlkit.item(value)


def _kept(before: Any, after: Any) -> Any:  # noqa: ANN401
    """Keep the comment and the blanks behind a replaced value."""
    trivia = getattr(before, "trivia", None)
    if trivia is not None and hasattr(after, "trivia"):
        after.trivia.comment, after.trivia.comment_ws = trivia.comment, trivia.comment_ws
        after.trivia.trail = trivia.trail
    return after
