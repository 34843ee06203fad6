"""Sections of Gmsh files and the numbers in them, text and binary alike."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError

#: Kind and number of nodes of each element type of Gmsh.
_TYPES: Final[dict[int, tuple[str, int]]] = {
    **{1: ("line", 2), 2: ("triangle", 3), 3: ("quad", 4), 4: ("tetra", 4)},
    **{5: ("hexahedron", 8), 6: ("wedge", 6), 7: ("pyramid", 5), 8: ("line3", 3)},
    **{9: ("triangle6", 6), 10: ("quad9", 9), 11: ("tetra10", 10), 12: ("hexahedron27", 27)},
    **{13: ("wedge18", 18), 14: ("pyramid14", 14), 15: ("vertex", 1), 16: ("quad8", 8)},
    **{17: ("hexahedron20", 20), 18: ("wedge15", 15), 19: ("pyramid13", 13)},
    **{20: ("triangle9", 9), 21: ("triangle10", 10), 23: ("triangle15", 15)},
    **{25: ("triangle21", 21), 26: ("line4", 4), 27: ("line5", 5), 28: ("line6", 6)},
    **{29: ("tetra20", 20), 30: ("tetra35", 35), 31: ("tetra56", 56), 36: ("quad16", 16)},
    **{37: ("quad25", 25), 90: ("wedge40", 40), 92: ("hexahedron64", 64)},
}


class Cells(NamedTuple):
    """Cells of one kind with the physical groups of all of them; nodes by their tags."""

    kind: str
    nodes: NDArray[np.int64]
    groups: tuple[int, ...]


@dataclass
class Section:
    """Section, from which numbers are taken one after the other."""

    path: Path
    name: str
    data: bytes
    is_binary: bool
    order: str
    place: int = 0

    def text(self) -> str:
        """Return the section as text."""
        return self.data.decode("utf-8", errors="replace")

    def __post_init__(self) -> None:
        self._words = None if self.is_binary else self.data.split()

    def take(self, count: int, kind: str) -> NDArray[np.int64]:
        """Take whole numbers, of type ``i4`` or ``u8`` in binary files."""
        return self._next(count, kind).astype(np.int64)

    def floats(self, count: int) -> NDArray[np.float64]:
        """Take numbers."""
        return self._next(count, "f8").astype(np.float64)

    def _next(self, count: int, kind: str) -> NDArray[np.generic]:
        if count < 0:
            raise ValueError(f"a count of {count} in ${self.name}")
        if self._words is not None:
            words = self._words[self.place : self.place + count]
            self.place += count
            if len(words) < count:
                raise ValueError(f"${self.name} ends early")
            return np.array(words).astype(np.float64 if kind == "f8" else np.int64)
        dtype = np.dtype(self.order + kind)
        if self.place + count * dtype.itemsize > len(self.data):
            raise ValueError(f"${self.name} ends early")
        found = np.frombuffer(self.data, dtype, count, self.place)
        self.place += count * dtype.itemsize
        return found

    def line(self) -> int:
        """Take the count that is alone in a line, text in binary files too."""
        if self._words is not None:
            return int(self.take(1, "u8")[0])
        end = self.data.index(b"\n", self.place)
        count = int(self.data[self.place : end])
        self.place = end + 1
        return count


def split(path: Path, data: bytes, is_binary: bool, order: str) -> Iterator[Section]:
    """Yield the sections of a file.

    Raises
    ------
    FileError
        If a section has no end: the file is cut short.
    """
    start = 0
    while found := re.compile(rb"^\$(\w+)[ \t]*\r?\n", re.MULTILINE).search(data, start):
        name = found[1].decode()
        end = data.find(b"$End" + found[1], found.end())
        if end < 0:
            raise FileError(str(path), f"is cut short: ${name} has no end", "write it again")
        binary = is_binary and name in ("Entities", "Nodes", "Elements", "PartitionedEntities")
        yield Section(path, name, data[found.end() : end], binary, order)
        start = end + len(name) + 4


def nodes_2(section: Section) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Return tags and points of version 2.2."""
    count = section.line()
    if not section.is_binary:
        rows = section.floats(4 * count).reshape(-1, 4)
        return rows[:, 0].astype(np.int64), np.ascontiguousarray(rows[:, 1:])
    row = np.dtype([("tag", section.order + "i4"), ("x", section.order + "f8", 3)])
    if section.place + count * row.itemsize > len(section.data):
        raise ValueError("$Nodes ends early")
    found = np.frombuffer(section.data, row, count, section.place)
    return found["tag"].astype(np.int64), found["x"].astype(np.float64)


def cells_2(section: Section) -> Iterator[Cells]:
    """Yield the cells of version 2.2, equal neighbors together; a cell in two groups twice."""
    total, seen = section.line(), 0
    if not section.is_binary:
        each = (_cell_2(section) for _ in range(total))
        for (kind, group), run in groupby(each, key=lambda cell: cell[:2]):
            yield Cells(kind, np.array([nodes for *_, nodes in run]), (group,) if group else ())
        return
    while seen < total:
        code, count, tags = section.take(3, "i4").tolist()
        kind, size = _kind(section, code)
        rows = section.take(count * (1 + tags + size), "i4").reshape(count, -1)[:, 1:]
        seen += count
        groups = abs(rows[:, 0]) if tags else np.zeros(count, np.int64)
        starts = np.flatnonzero(np.diff(groups, prepend=-1))
        for chosen in np.split(np.arange(count), starts[1:]):
            group = int(groups[chosen[0]])
            yield Cells(kind, rows[chosen, tags:], (group,) if group else ())


def _cell_2(section: Section) -> tuple[str, int, NDArray[np.int64]]:
    """Read one line of text: kind, group, nodes."""
    _, code, tags = section.take(3, "i4").tolist()
    kind, size = _kind(section, code)
    row = section.take(tags + size, "i4")
    return kind, abs(int(row[0])) if tags else 0, row[tags:]


def nodes_4(section: Section) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Return tags and points of version 4.1."""
    blocks, total, _, _ = section.take(4, "u8").tolist()
    tags, points = [np.empty(0, np.int64)], [np.empty((0, 3))]
    for _ in range(blocks):
        dimension, _, parametric = section.take(3, "i4").tolist()
        (count,) = section.take(1, "u8").tolist()
        tags.append(section.take(count, "u8"))
        # On a curve or surface its parameters may follow the coordinates.
        width = 3 + (dimension if parametric else 0)
        points.append(section.floats(count * width).reshape(-1, width)[:, :3])
    found = np.concatenate(tags)
    if len(found) != total:
        raise ValueError(f"{total} nodes announced, {len(found)} found")
    return found, np.concatenate(points)


def groups_4(section: Section) -> dict[tuple[int, int], tuple[int, ...]]:
    """Return the physical groups of each entity, by its dimension and tag."""
    found = {}
    for dimension, count in enumerate(section.take(4, "u8").tolist()):
        for _ in range(count):
            (tag,) = section.take(1, "i4").tolist()
            section.floats(6 if dimension else 3)
            (groups,) = section.take(1, "u8").tolist()
            # The sign of a group's number gives the orientation of its entity.
            found[dimension, tag] = tuple(abs(section.take(groups, "i4")).tolist())
            if dimension:
                (bounding,) = section.take(1, "u8").tolist()
                section.take(bounding, "i4")
    return found


def cells_4(section: Section, groups: dict[tuple[int, int], tuple[int, ...]]) -> Iterator[Cells]:
    """Yield the cells of version 4.1, entity by entity."""
    blocks, total, _, _ = section.take(4, "u8").tolist()
    seen = 0
    for _ in range(blocks):
        dimension, entity, code = section.take(3, "i4").tolist()
        (count,) = section.take(1, "u8").tolist()
        kind, size = _kind(section, code)
        rows = section.take(count * (1 + size), "u8").reshape(count, 1 + size)
        seen += count
        yield Cells(kind, rows[:, 1:], groups.get((dimension, entity), ()))
    if seen != total:
        raise ValueError(f"{total} elements announced, {seen} found")


def _kind(section: Section, code: int) -> tuple[str, int]:
    if code not in _TYPES:
        what = f"holds elements of type {code} of Gmsh, which is not read"
        raise FileError(str(section.path), what, "save it with elements of order 1 or 2")
    return _TYPES[code]
