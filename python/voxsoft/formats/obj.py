"""Wavefront OBJ: faces of any number of corners; objects, groups and materials are cell sets."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np

from voxsoft.errors import FileError
from voxsoft.formats.contents import CellBlock, Contents

#: Kind of cell by keyword and number of vertices; other faces are polygons.
_KINDS: Final = {("f", 3): "triangle", ("f", 4): "quad", ("p", 1): "vertex", ("l", 2): "line"}
#: Keywords without a shape: textures, normals, shading, names of other files.
_SILENT: Final = {
    *("vt", "vn", "vp", "s", "mtllib", "mg", "bevel", "c_interp", "d_interp", "lod", "maplib"),
    *("usemap", "shadow_obj", "trace_obj"),
}
#: Keywords of curved surfaces, which are formulas.
_CURVED: Final = {"curv", "curv2", "surf"}


def read(path: Path) -> Contents:
    """Read a file.

    Raises
    ------
    FileError
        If a face names a vertex that is missing, a word is no number, or surfaces are formulas.
    """
    file = _File(str(path))
    for number, words in _lines(path.read_text(encoding="utf-8", errors="replace")):
        file.take(number, words)
    return file.contents()


def _lines(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the words of each line with its number; lines that a backslash continues are one."""
    words: list[str] = []
    for number, line in enumerate(text.splitlines(), 1):
        bare = line.partition("#")[0].rstrip()
        words += bare.removesuffix("\\").split()
        if not bare.endswith("\\"):
            if words:
                yield number, words
            words = []
    if words:
        yield number, words


class _File:
    """Contents that were read so far."""

    def __init__(self, where: str) -> None:
        self.where = where
        self.points: list[list[float]] = []
        self.cells: dict[tuple[str, int], list[list[int]]] = {}
        #: Names of the sets of each cell, a list in the order of the cells of each kind.
        self.names: dict[tuple[str, int], list[tuple[str, ...]]] = {}
        self.current: dict[str, tuple[str, ...]] = {}
        self.open: tuple[str, ...] = ()
        self.left: Counter[str] = Counter()

    def take(self, number: int, words: list[str]) -> None:
        """Read one line."""
        key, *rest = words
        if key == "v":
            try:
                self.points.append([float(word) for word in rest[:3]])
            except ValueError:
                raise self._wrong(number, f"{' '.join(rest)!r} is no vertex") from None
            if len(rest) < 3:
                raise self._wrong(number, f"a vertex has {len(rest)} coordinates; expected 3")
        elif key in ("f", "p", "l"):
            self._cell(number, key, rest)
        elif key in ("g", "o", "usemtl"):
            # A line of g names all groups of the lines after it.
            self.current[key] = tuple(rest) if key == "g" else (" ".join(rest),) if rest else ()
            self.open = tuple(dict.fromkeys(n for each in self.current.values() for n in each))
        elif key in _CURVED:
            hint = "export the part as triangles"
            raise self._wrong(number, f"holds a curved surface as a formula ({key})", hint)
        elif key not in _SILENT:
            self.left[key] += 1

    def _cell(self, number: int, key: str, words: list[str]) -> None:
        rows = [self._vertex(number, word) for word in words]
        least = {"f": 3, "l": 2, "p": 1}[key]
        if len(rows) < least:
            raise self._wrong(number, f"{key} has {len(rows)} vertices; expected {least} or more")
        each = [rows]
        if key == "p":
            each = [[row] for row in rows]
        elif key == "l":
            each = [list(pair) for pair in pairwise(rows)]
        for cell in each:
            of = (_KINDS.get((key, len(cell)), "polygon"), len(cell))
            self.cells.setdefault(of, []).append(cell)
            self.names.setdefault(of, []).append(self.open)

    def _vertex(self, number: int, word: str) -> int:
        """Return the index from 0: numbers count from 1, or back from the last vertex so far."""
        try:
            index = int(word.partition("/")[0])
        except ValueError:
            raise self._wrong(number, f"{word!r} names no vertex") from None
        found = index - 1 if index > 0 else len(self.points) + index
        # Vertices may follow the faces that name them by positive numbers.
        if index == 0 or found < 0:
            what = f"names vertex {index} of {len(self.points):,} vertices so far"
            raise self._wrong(number, what)
        return found

    def _wrong(self, number: int, what: str, hint: str = "") -> FileError:
        return FileError(f"{self.where}, line {number:,}", what, hint)

    def contents(self) -> Contents:
        """Return all as contents."""
        blocks = [CellBlock(kind, np.array(rows)) for (kind, _), rows in self.cells.items()]
        highest = max((int(block.nodes.max()) for block in blocks), default=-1)
        if highest >= len(self.points):
            what = f"names vertex {highest + 1:,} of {len(self.points):,} vertices"
            raise FileError(self.where, f"is damaged: a face {what}", "save or copy it again")
        sets: dict[str, list[int]] = {}
        for cell, names in enumerate(names for each in self.names.values() for names in each):
            for name in names:
                sets.setdefault(name, []).append(cell)
        return Contents(
            np.array(self.points, np.float64).reshape(-1, 3),
            tuple(blocks),
            {name: np.array(cells) for name, cells in sets.items()},
            notes=tuple(f"{n:,} lines of {word} are passed over" for word, n in self.left.items()),
            format="Wavefront OBJ",
        )
