"""The identity of a design: a hash over all that decides the numbers it gives."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from operator import is_
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from voxsoft.design.document.documents import is_mesh
from voxsoft.materials import is_card_path
from voxsoft.records import Record
from voxsoft.units import round_significant

if TYPE_CHECKING:
    from voxsoft.design.model import Design

# Words about the design, ways to vary it, and goals of a study: the answer of a
# simulation depends on none of them. Probes stay in, because results are recorded at them.
NOT_PHYSICS: Final = frozenset(
    {"schema", "name", "description", "parameters", "objectives", "constraints", "molds"}
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
    return hash_of_texts(
        {key: text_of(key, value) for key, value in document.items() if key not in NOT_PHYSICS}
    )


def text_of(key: str, value: object) -> str:
    """Write an entry of a resolved design document as canonical JSON; empty if it does not count.

    Examples
    --------
    >>> text_of("voxel_size", 0.1 + 0.2), text_of("fill", "binary")
    ('0.3', '')
    """
    # A key that is younger than the records of studies: full voxels are not written down.
    if value is None or (key == "fill" and value == "binary"):
        return ""
    return json.dumps(_canonical(value, key), sort_keys=True, separators=(",", ":"))


def hash_of_texts(texts: Mapping[str, str]) -> str:
    """Hash the entries of a document, each as :func:`text_of` wrote it; see :func:`hash_of`."""
    entries = (f"{json.dumps(key)}:{texts[key]}" for key in sorted(texts) if texts[key])
    return hashlib.sha256(f"{{{','.join(entries)}}}".encode()).hexdigest()


class Hashes:
    """Hashes of designs of a family, most entries of which are the same objects in all of them.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> beam, hashes = families.beam(), Hashes()
    >>> longer = beam.with_parameters(length="110 mm")
    >>> [hashes.of(each) == each.hash for each in (beam, longer)]
    [True, True]
    """

    def __init__(self) -> None:
        self._texts: dict[str, tuple[object, str]] = {}

    def of(self, design: Design) -> str:
        """Hash a design as :attr:`voxsoft.design.Design.hash` does.

        Raises
        ------
        DesignError
            A shape is made of a Python function.
        """
        whole = design.assembled
        texts = {
            key: text
            for key, (entry, text) in self._texts.items()
            if _are_same(getattr(whole, key), entry)
        }
        document = with_fill(whole.physics({*texts}), whole)
        for key, value in document.items():
            texts[key] = text_of(key, value)
            entry = getattr(whole, key)
            # Entries that a file decides are written anew, and those that `with_fill` writes.
            if (
                isinstance(entry, (tuple, Mapping, Record))
                and '"path"' not in texts[key]
                and key != "bodies"
                and not (key == "parts" and _names_card_file(whole))
            ):
                self._texts[key] = (entry, texts[key])
        return hash_of_texts(texts)


def _are_same(entry: object, other: object) -> bool:
    """Check if entries are one object, or hold the same ones: reading copies tuples and tables."""
    if isinstance(entry, tuple) and isinstance(other, tuple):
        return len(entry) == len(other) and all(map(is_, entry, other))
    if isinstance(entry, Mapping) and isinstance(other, Mapping):
        return entry.keys() == other.keys() and all(map(is_, entry.values(), other.values()))
    return entry is other


def _names_card_file(design: Design) -> bool:
    return any(
        isinstance(each.material, str) and is_card_path(each.material) for each in design.parts
    )


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
