"""3MF: the objects that its build places, each at its place, as parts with names.

The reader follows the core specification of the 3MF Consortium, version 1.3, and the production
extension, by which objects lie in further model files. Objects that no item places, and supports,
are no part of the body.
"""

from __future__ import annotations

import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Final
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import counted
from voxsoft.errors import FileError
from voxsoft.formats.contents import CellBlock, Contents
from voxsoft.formats.threemf_model import SOLID, Floats, Key, Model, Object, Placed
from voxsoft.formats.threemf_names import MODEL_PATH, RELATIONSHIPS

Ints = NDArray[np.int64]

#: Most triangles of all placed objects together.
MOST_TRIANGLES: Final = 20_000_000
#: Largest unpacked model file [bytes], and how many times its packed size it may have above the
#: size from which that counts.
LARGEST_MODEL: Final = 4 * 1024**3
_RATIO, _ANY_RATIO = 200, 16 * 1024**2
#: Most levels of components.
_DEEPEST: Final = 64
_MODEL_TYPE: Final = "/3dmodel"
_ENCRYPTED: Final = 1


def read(path: Path) -> Contents:
    """Read the placed objects of a file.

    Raises
    ------
    FileError
        It is no archive, is encrypted, or unpacks to far more than it holds; its model is invalid,
        or has no object that is placed and has triangles.
    """
    where = str(path)
    try:
        with zipfile.ZipFile(path) as archive:
            return _Package(where, archive).contents()
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, EOFError, RuntimeError) as error:
        what = f"is no archive, which 3MF is, or is damaged: {error}"
        raise FileError(where, what, "save or copy it again") from None


class _Package:
    """Model files of an archive, each read when it is first named."""

    def __init__(self, where: str, archive: zipfile.ZipFile) -> None:
        self._where, self._archive = where, archive
        self._entries = {entry.filename.lstrip("/"): entry for entry in archive.infolist()}
        self._models: dict[str, Model] = {}
        self._counts: dict[Key, int] = {}
        self._notes: dict[str, int] = {}

    def contents(self) -> Contents:
        """Return all placed triangles."""
        main = self._model("")
        if not main.items:
            what = "places no object: its build has no items"
            raise FileError(self._where, what, "put the objects on the plate, and save it again")
        total = sum(self._triangles(item.key, []) for item in main.items)
        if total > MOST_TRIANGLES:
            what = f"places {total:,} triangles; at most {MOST_TRIANGLES:,} are read"
            raise FileError(self._where, what, "simplify the surface")
        points: list[Floats] = []
        triangles: list[Ints] = []
        sets: dict[str, list[Ints]] = {}
        count = first = 0
        for place in main.items:
            for leaf, turn, shift, key, name in self._leaves(place, "", np.eye(3), np.zeros(3)):
                faces = leaf.triangles if np.linalg.det(turn) > 0.0 else leaf.triangles[:, ::-1]
                points.append(leaf.points @ turn + shift)
                triangles.append(faces + count)
                for called, members in _parts_of(leaf, name or f"object {key[1]}"):
                    sets.setdefault(called, []).append(members + first)
                count, first = count + len(leaf.points), first + len(faces)
        if not first:
            raise self._empty()
        passed = [f"{counted(n, 'object')} of type {kind}: no material of the body, left out"
                  for kind, n in self._notes.items() if kind != "beams"]  # fmt: skip
        if "beams" in self._notes:
            passed.append("Lattices of beams are left out: triangles alone are read")
        unplaced = sum(len(m.objects) for m in self._models.values()) - len(self._counts)
        if unplaced:
            passed.append(f"{counted(unplaced, 'object')} that no item places: left out")
        named = {name: np.concatenate(each) for name, each in sets.items()}
        block = CellBlock("triangle", np.concatenate(triangles))
        return Contents(
            np.concatenate(points), (block,), named if len(named) > 1 else {},
            unit=main.unit, notes=tuple(passed), format="3MF",
        )  # fmt: skip

    def _empty(self) -> FileError:
        if "beams" in self._notes:
            what = "holds a lattice of beams alone, of the beam lattice extension of 3MF"
            return FileError(self._where, what, "export the beams as triangles")
        kinds = ", ".join(self._notes)
        what = f"holds no solid: its placed objects are of type {kinds}" if kinds else (
            "holds no triangles"
        )  # fmt: skip
        return FileError(self._where, what, "save the body itself")

    def _model(self, path: str) -> Model:
        if path not in self._models:
            name = path or self._main_path()
            self._models[path] = Model(self._where, path, self._unpacked(name))
        return self._models[path]

    def _main_path(self) -> str:
        """Return the path of the main model, by the relationships of the package."""
        found: list[str] = []

        def on_start(tag: str, entries: dict[str, str]) -> None:
            if tag.endswith("Relationship") and entries.get("Type", "").endswith(_MODEL_TYPE):
                found.append(entries.get("Target", "").lstrip("/"))

        if RELATIONSHIPS in self._entries:
            parser = expat.ParserCreate()
            parser.StartElementHandler = on_start
            parser.StartDoctypeDeclHandler = self._on_doctype
            try:
                parser.Parse(self._unpacked(RELATIONSHIPS), True)
            except expat.ExpatError as error:
                what = f"is damaged: its relationships are no XML ({error})"
                raise FileError(self._where, what, "save or copy it again") from None
        return found[0] if found else MODEL_PATH

    def _on_doctype(self, *_: object) -> None:
        raise FileError(self._where, "has a document type, which 3MF does not allow")

    def _unpacked(self, name: str) -> bytes:
        entry = self._entries.get(name)
        if entry is None:
            what = f"holds no {name}: it is another kind of archive, or has lost its model"
            raise FileError(self._where, what, "save or copy it again")
        if entry.flag_bits & _ENCRYPTED:
            raise FileError(self._where, f"is encrypted: {name}", "save it without a password")
        size = entry.file_size
        is_bomb = size > _ANY_RATIO and size > _RATIO * max(entry.compress_size, 1)
        if is_bomb or size > LARGEST_MODEL:
            what = f"unpacks {name} of {entry.compress_size:,} bytes to {size:,}: it is no model"
            raise FileError(self._where, what, "save it again by the program that it came from")
        return self._archive.read(entry)

    def _object(self, key: Key) -> Object:
        found = self._model(key[0]).objects.get(key[1])
        if found is None:
            what = f"is damaged: it places object {key[1]}, which is missing"
            raise FileError(self._where, what, "save or copy it again")
        return found

    def _triangles(self, key: Key, above: list[Key]) -> int:
        """Count the triangles of an object with its components, before any is copied."""
        if key in above:
            what = f"is damaged: object {key[1]} is a component of itself"
            raise FileError(self._where, what, "save it again by the program that it came from")
        if len(above) > _DEEPEST:
            raise FileError(self._where, f"nests components more than {_DEEPEST} deep")
        if key not in self._counts:
            made = self._object(key)
            inner = [self._triangles(each.key, [*above, key]) for each in made.components]
            self._counts[key] = len(made.triangles) + sum(inner)
        return self._counts[key]

    def _leaves(
        self, place: Placed, name: str, turn: Floats, shift: Floats
    ) -> Iterator[tuple[Object, Floats, Floats, Key, str]]:
        """Yield meshes with their transform to the build, ``x @ turn + shift``, and their names."""
        made = self._object(place.key)
        if made.kind != SOLID:
            self._notes[made.kind] = self._notes.get(made.kind, 0) + 1
            return
        if made.has_beams:
            self._notes["beams"] = self._notes.get("beams", 0) + 1
        if not self._counts[place.key]:
            return  # however often it is placed, there is nothing
        turn, shift = place.turn @ turn, place.shift @ turn + shift
        name = made.name or name
        if len(made.triangles):
            yield made, turn, shift, place.key, name
        for each in made.components:
            yield from self._leaves(each, name, turn, shift)


def _parts_of(leaf: Object, name: str) -> list[tuple[str, Ints]]:
    """Return names and triangles of an object's parts: by materials where each encloses a body."""
    everything = np.arange(len(leaf.triangles))
    titles = list(dict.fromkeys(leaf.materials))
    if not titles or titles == [""]:
        return [(name, everything)]
    if len(titles) == 1:
        return [(leaf.name or titles[0], everything)]
    number = np.array([titles.index(each) for each in leaf.materials])
    groups = [np.flatnonzero(number == index) for index in range(len(titles))]
    # Paint on one body divides it into sheets, which are no bodies.
    if not all(_is_closed(leaf.triangles[members]) for members in groups):
        return [(name, everything)]
    return [(title or name, members) for title, members in zip(titles, groups, strict=True)]


def _is_closed(triangles: Ints) -> bool:
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, counts = np.unique(edges, axis=0, return_counts=True)
    return bool((counts % 2 == 0).all())
