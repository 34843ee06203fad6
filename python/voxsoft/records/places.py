"""Places in a document as they are read aloud, written and typed: ``parts[0].material``."""

from __future__ import annotations

import difflib
import json
import re
from collections.abc import Iterable
from typing import Final

_BARE: Final = re.compile(r"[^\s.\[\]\"'=]+")
_STEP: Final = re.compile(r"""\[(\d+)\]|"((?:[^"\\]|\\.)*)"|'([^']*)'|([^.\[\]"']+)""")


def place(path: Iterable[str | int]) -> str:
    """Write a path of keys and indices as it is read aloud: ``parts[0].material``.

    A key that holds dots, brackets, quotes or spaces stands in quotes.

    Examples
    --------
    >>> place(["parts", 0, "material"])
    'parts[0].material'
    >>> place(["probes", "tip left", "point"])
    'probes."tip left".point'
    """
    text = ""
    for key in path:
        if isinstance(key, int):
            text += f"[{key}]"
            continue
        key = str(key)
        written = key if _BARE.fullmatch(key) else json.dumps(key, ensure_ascii=False)
        text += f".{written}" if text else written
    return text


def steps_of(where: str) -> list[str | int]:
    """Read a place as keys and indices, as :func:`place` writes it, or with dots alone.

    Examples
    --------
    >>> steps_of("parts[0].material"), steps_of("parts.0.material")
    (['parts', 0, 'material'], ['parts', '0', 'material'])
    >>> steps_of('probes."tip left".point[2]')
    ['probes', 'tip left', 'point', 2]
    """
    steps: list[str | int] = []
    for index, quoted, literal, bare in _STEP.findall(where):
        if index:
            steps.append(int(index))
        elif quoted:
            steps.append(_unquoted(quoted))
        else:
            steps.append(literal or bare.strip())
    return steps


def _unquoted(text: str) -> str:
    try:
        return str(json.loads(f'"{text}"'))
    except ValueError:  # an escape that is none
        return text


def closest(name: str, known: Iterable[str]) -> str:
    """Suggest the known name closest to a wrong one, or list the known names.

    Examples
    --------
    >>> closest("materal", ["shape", "material"])
    'did you mean "material"?'
    >>> closest("color", ["shape", "material"])
    'known are material, shape'
    """
    names = sorted({*known} - {name})  # a name known elsewhere does not help here
    matches = difflib.get_close_matches(name, names, n=1)
    if matches:
        return f'did you mean "{matches[0]}"?'
    return f"known are {', '.join(names)}" if names else ""
