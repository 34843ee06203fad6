"""Change single values of a design document: ``parts.0.material=ecoflex-00-50``."""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Any

from voxsoft.design.resolution import Document
from voxsoft.errors import DesignError
from voxsoft.records import closest


def set_values(document: Mapping[str, Any], assignments: Iterable[str]) -> Document:
    """Apply assignments ``key=value`` to a copy of a document.

    Parameters
    ----------
    document
        A design document; it is not changed.
    assignments
        Texts ``key=value``. A bare name sets the parameter of that name, or else a top-level
        key; a dotted path sets any key, with list indices as numbers, and makes tables that are
        missing. The value is read as
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
    >>> changed = set_values(document, ["radius=20 mm", "parts.0.material=b"])
    >>> changed["parameters"]["radius"]["value"], changed["parts"][0]["material"]
    ('20 mm', 'b')
    """
    changed = copy.deepcopy(dict(document))
    for assignment in assignments:
        key, separator, text = assignment.partition("=")
        if not separator or not key.strip():
            raise DesignError(assignment, "is not an assignment", 'write "radius=20 mm"')
        _assign(changed, key.strip(), _read_value(text.strip()))
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
    if "." not in key and key not in document and get_close_matches(key, names, n=1):
        raise DesignError(key, "is not a parameter of this design", closest(key, names))
    *path, last = key.split(".")
    table = _descend(document, path, key)
    if isinstance(table, dict):
        table[last] = value
    else:
        table[_index(table, last, key)] = value


def _descend(document: Document, path: list[str], key: str) -> Any:  # noqa: ANN401
    """Follow a path to a table or list, making tables that are not there yet."""
    here: Any = document
    for step in path:
        here = (
            here[_index(here, step, key)] if isinstance(here, list) else here.setdefault(step, {})
        )
        if not isinstance(here, (dict, list)):
            raise DesignError(key, f'"{step}" holds {here!r}, nothing below it can be set')
    return here


def _index(items: list[Any], step: str, key: str) -> int:
    if not step.isascii() or not step.isdigit() or int(step) >= len(items):
        last = f"use a number from 0 to {len(items) - 1}" if items else "the list is empty"
        raise DesignError(key, f'there is no entry "{step}"', last)
    return int(step)
