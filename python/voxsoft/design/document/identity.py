"""The identity of a design: a hash over all that decides the numbers it gives."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from voxsoft.design.document.documents import is_mesh
from voxsoft.units import round_significant

if TYPE_CHECKING:
    from voxsoft.design.model import Design

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
    # A key that is younger than the records of studies: full voxels are not written down.
    if physics.get("fill") == "binary":
        del physics["fill"]
    text = json.dumps(_canonical(physics), sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def with_fill(document: Mapping[str, Any], design: Design) -> dict[str, Any]:
    """Write down in the document of an assembled design which bodies have cut voxels by default.

    So a design that says it has the same hash, and one with full voxels has another.
    """
    found = dict(document)
    if design.fill is not None or design.mesh is not None:
        return found
    if not design.bodies:
        found["fill"] = "fraction" if design.has_cut_voxels else "binary"
        return found
    open_ones = [body.name for body in design.bodies if body.fill is None]
    cut = [name for name in open_ones if design.alone(name).has_cut_voxels]
    if cut and cut == open_ones:
        found["fill"] = "fraction"
    else:
        tables = found.get("bodies", [])
        found["bodies"] = [
            {**table, "fill": "fraction"} if table["name"] in cut else table for table in tables
        ]
    return found


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
