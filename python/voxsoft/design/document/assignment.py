"""Change single values of a design document: ``parts.0.material=ecoflex-00-50``."""

from __future__ import annotations

import copy
import re
import tomllib
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Any, Final

from voxsoft.design.document.resolution import Document
from voxsoft.errors import DesignError
from voxsoft.records import closest, steps_of

#: A key, in which quoted names may hold "=", and the value it is set to.
_ASSIGNMENT: Final = re.compile(r"""((?:[^="']|"[^"]*"|'[^']*')+)=(.*)""", re.DOTALL)


def set_values(document: Mapping[str, Any], assignments: Iterable[str]) -> Document:
    """Apply assignments ``key=value`` to a copy of a document.

    Parameters
    ----------
    document
        A design document; it is not changed.
    assignments
        Texts ``key=value``. A bare name sets the parameter of that name, or else a top-level
        key; a path as errors write it, ``parts[0].material``, or with dots alone,
        ``parts.0.material``, sets any key and makes tables that are
        missing; a name that holds dots or spaces stands in quotes. The value is read as
        TOML (a number, ``true``, a list, a quoted text) or, failing that, taken as text.

    Returns
    -------
    dict
        The changed copy.

    Raises
    ------
    DesignError
        No ``=``, or a path that leads nowhere.

    Examples
    --------
    >>> document = {"parameters": {"radius": {"value": "5 mm"}}, "parts": [{"material": "a"}]}
    >>> changed = set_values(document, ["radius=20 mm", "parts[0].material=b"])
    >>> changed["parameters"]["radius"]["value"], changed["parts"][0]["material"]
    ('20 mm', 'b')
    """
    changed = copy.deepcopy(dict(document))
    for assignment in assignments:
        found = _ASSIGNMENT.fullmatch(assignment)
        if found is None or not steps_of(found[1]):
            raise DesignError(assignment, "is not an assignment", 'write "radius=20 mm"')
        _assign(changed, found[1].strip(), _read_value(found[2].strip()))
    return changed


def _read_value(text: str) -> object:
    try:
        read = tomllib.loads(f"value = {text}")
    except (tomllib.TOMLDecodeError, RecursionError):
        return text
    value = read.get("value")
    simple = len(read) == 1 and isinstance(value, (bool, int, float, str, list, dict))
    return value if simple else text


def _assign(document: Document, key: str, value: object) -> None:
    parameters = document.get("parameters")
    if isinstance(parameters, dict) and key in parameters:
        if isinstance(parameters[key], dict):
            parameters[key]["value"] = value
        else:
            parameters[key] = value
        return
    names = list(parameters) if isinstance(parameters, dict) else []
    *path, last = steps_of(key)
    if not path and last not in document and get_close_matches(key, names, n=1):
        raise DesignError(key, "is not a parameter of this design", closest(key, names))
    table = _descend(document, path, key)
    if isinstance(table, dict):
        table[str(last)] = value
    else:
        table[_index(table, last, key)] = value


def _descend(document: Document, path: list[str | int], key: str) -> Any:  # noqa: ANN401
    """Follow a path to a table or list, making tables that are not there yet."""
    here: Any = document
    for step in path:
        if isinstance(here, list):
            here = here[_index(here, step, key)]
        else:
            here = here.setdefault(str(step), {})
        if not isinstance(here, (dict, list)):
            raise DesignError(key, f'"{step}" holds {here!r}, nothing below it can be set')
    return here


def _index(items: list[Any], step: str | int, key: str) -> int:
    number = str(step)
    if not number.isascii() or not number.isdigit() or int(number) >= len(items):
        last = f"use a number from 0 to {len(items) - 1}" if items else "the list is empty"
        raise DesignError(key, f'there is no entry "{step}"', last)
    return int(number)
