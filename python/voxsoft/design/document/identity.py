"""The identity of a design: a hash over all that decides the numbers it gives."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from voxsoft.design.document.documents import is_mesh
from voxsoft.units import round_significant

# Words about the design, ways to vary it, and goals of a study: the answer of a
# simulation depends on none of them. Probes stay in, because results are recorded at them.
NOT_PHYSICS: Final = frozenset(
    {"schema", "name", "description", "parameters", "objectives", "constraints"}
)

# Remarks about the constants of a material, beside them.
_ABOUT_CONSTANTS: Final = frozenset({"tested_stretch"})


def hash_of(document: Mapping[str, Any]) -> str:
    """Hash a resolved design document: SHA-256 of canonical JSON, in hexadecimal.

    Every number is rounded once, to 12 significant digits, so that the last bits of a formula
    do not make another design. A mesh file counts by its content.

    Examples
    --------
    >>> hash_of({"voxel_size": 0.1 + 0.2}) == hash_of({"voxel_size": 0.3, "name": "other"})
    True
    """
    physics = {key: value for key, value in document.items() if key not in NOT_PHYSICS}
    # A key that is younger than the records of studies: its default is not written down.
    if physics.get("fill") == "binary":
        del physics["fill"]
    text = json.dumps(_canonical(physics), sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def _canonical(value: object, key: str = "") -> object:
    if isinstance(value, str):
        return value
    if isinstance(value, Mapping):
        if is_mesh(key, value):
            value = {**value, "path": _content(str(value.get("path")))}
        return {
            str(name): _canonical(entry, str(name))
            for name, entry in value.items()
            if entry is not None and name not in _ABOUT_CONSTANTS
        }
    if isinstance(value, (list, tuple)):
        return [_canonical(entry) for entry in value]
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return round_significant(float(value)) + 0.0  # -0.0 + 0.0 is 0.0
    return value


def _content(path: str) -> str:
    """Stand in for a mesh file: its content counts, not its place."""
    try:
        with Path(path).open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except (OSError, ValueError):
        return path
