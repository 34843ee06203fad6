"""Labels of regions for formats that allow letters, digits, ``_`` and ``-`` only.

A region may have any name, ``"tip left"`` or ``"höhe"``; Abaqus and Gmsh get a label for it, and a
comment line in the file maps it to the name, so that reading restores it.
"""

from __future__ import annotations

import json
import re
import unicodedata
from collections.abc import Iterable, Mapping
from typing import Final

from voxsoft.units import parse

_LONGEST: Final = 60  # Abaqus takes 80
#: Labels of the sets that the writers make themselves, in any case.
_RESERVED: Final = re.compile(r"(?:part|cavity)-\d+(?:-s\d)?|all-(?:nodes|elements)", re.IGNORECASE)
_COMMENT: Final = re.compile(r'REGION ([A-Za-z][\w-]*) = (".*")', re.ASCII)
_OBJECT: Final = re.compile(r"OBJECT ([A-Za-z][\w-]*)$", re.ASCII)
_UNIT: Final = re.compile(r"UNIT = ([A-Za-z]+)", re.ASCII)
#: Comment with the unit of our own files.
UNIT_COMMENT: Final = "UNIT = m"


def labels_of(names: Iterable[str]) -> dict[str, str]:
    """Give each name a unique label; a name that is a valid label keeps it.

    Labels are unique also in formats that ignore case.

    Examples
    --------
    >>> labels_of(["probe_tip", "probe_tip left", "probe_tip.left", "höhe", "名前"])
    {'probe_tip': 'probe_tip', 'probe_tip left': 'probe_tip_left', 'probe_tip.left': \
'probe_tip_left-2', 'höhe': 'hohe', '名前': 'region'}
    """
    every = list(names)
    labels: dict[str, str] = {}
    taken: set[str] = set()
    # Valid labels first: they are kept, unless two differ by case alone.
    for name in sorted(every, key=lambda name: _label(name) != name):
        labels[name] = _free(_label(name), taken)
        taken.add(labels[name].lower())
    return {name: labels[name] for name in every}


def _label(name: str) -> str:
    """Return the label of a name, not yet unique."""
    if re.fullmatch(r"[A-Za-z][\w-]{0,63}", name, re.ASCII) and not _RESERVED.fullmatch(name):
        return name
    letters = unicodedata.normalize("NFKD", name)
    base = "".join(letter for letter in letters if not unicodedata.combining(letter))
    label = re.sub(r"[^A-Za-z0-9_-]+", "_", base)[:_LONGEST].strip("_")
    is_free = label[:1].isalpha() and not _RESERVED.fullmatch(label)
    return label if is_free else f"region_{label}".rstrip("_")


def _free(label: str, taken: set[str]) -> str:
    number, found = 2, label
    while found.lower() in taken:
        found = f"{label}-{number}"
        number += 1
    return found


def comments_of(labels: Mapping[str, str]) -> list[str]:
    r"""Write comment lines that map labels to names, in ASCII; none where both are the same.

    Examples
    --------
    >>> comments_of({"tip": "tip", "höhe": "hohe"})
    ['REGION hohe = "h\\u00f6he"']
    """
    return [
        f"REGION {label} = {json.dumps(name)}" for name, label in labels.items() if name != label
    ]


def names_in(lines: Iterable[str]) -> dict[str, str]:
    """Read names by label from such comment lines.

    Examples
    --------
    >>> names_in(comments_of({"höhe": "hohe"}))
    {'hohe': 'höhe'}
    """
    found = (_COMMENT.search(line) for line in lines)
    return {match[1]: str(json.loads(match[2])) for match in found if match}


def objects_in(lines: Iterable[str]) -> list[str]:
    """Read the sets of rigid objects from comments of our own computations.

    Examples
    --------
    >>> objects_in(["** OBJECT object_plate"])
    ['object_plate']
    """
    return [match[1] for match in filter(None, map(_OBJECT.search, lines))]


def unit_in(lines: Iterable[str]) -> float | None:
    """Read a unit of length from comments, in m; None where there is none.

    Examples
    --------
    >>> unit_in(["** UNIT = mm"])
    0.001
    """
    for match in filter(None, map(_UNIT.search, lines)):
        return parse(f"1 {match[1]}", "length", where="UNIT")
    return None
