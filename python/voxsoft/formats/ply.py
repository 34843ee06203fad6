"""PLY as text and binary: vertices and faces of any number of corners."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError
from voxsoft.formats.contents import CellBlock, Contents

_TYPES: Final = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2"},
    **{"int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8"},
}
_ORDERS: Final = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_KINDS: Final = {3: "triangle", 4: "quad"}
#: Names of the list of vertices of a face.
_CORNERS: Final = ("vertex_indices", "vertex_index")


@dataclass(frozen=True)
class _Property:
    name: str
    #: NumPy types of the count of a list and of the values; an empty count for one value.
    count: str
    value: str


@dataclass
class _Element:
    name: str
    count: int
    properties: list[_Property] = field(default_factory=list)


def read(path: Path) -> Contents:
    """Read a file.

    Raises
    ------
    FileError
        If its header is invalid, or it ends before its last face.
    """
    where, data = str(path), path.read_bytes()
    head, mark, _ = data.partition(b"end_header")
    if not data.startswith(b"ply") or not mark:
        raise FileError(where, "cannot be read as PLY: it has no head from ply to end_header")
    order, elements = _head(where, head.decode("ascii", "replace"))
    body = data[data.find(b"\n", len(head)) + 1 or len(data) :]
    values = _Text(where, body) if order == "" else _Bytes(where, body, order)
    points = np.empty((0, 3))
    faces: dict[int, list[NDArray[np.generic]]] = {}
    notes: list[str] = []
    for element in elements:
        names = [each.name for each in element.properties]
        columns = values.rows(element)
        if element.name == "vertex":
            if not {"x", "y", "z"} <= set(names):
                raise FileError(where, "is damaged: its vertices have not x, y and z")
            points = np.column_stack([columns[names.index(axis)] for axis in "xyz"])
            others = [name for name in names if name not in "xyz"]
            notes += [f'Array "{name}" on points is not read' for name in others]
        elif element.name == "face" and (key := next((n for n in _CORNERS if n in names), None)):
            for corners in columns[names.index(key)]:
                faces.setdefault(corners.size, []).append(corners)
            notes += [f'Array "{n}" on cells is not read' for n in names if n != key]
        elif element.count:
            notes.append(f"{element.count:,} elements of {element.name} are not read")
    blocks = [
        CellBlock(_KINDS.get(size, "polygon"), np.array(rows, np.int64))
        for size, rows in faces.items()
        if size >= 3
    ]
    for block in blocks:
        if block.nodes.min() < 0 or block.nodes.max() >= len(points):
            what = f"is damaged: a face names a vertex beyond its {len(points):,}"
            raise FileError(where, what, "save or copy it again")
    if few := sum(len(rows) for size, rows in faces.items() if size < 3):
        notes.append(f"{few:,} faces of fewer than three vertices: left out")
    points = points.astype(np.float64)
    return Contents(points, tuple(blocks), notes=tuple(notes), format="PLY")


def _head(where: str, text: str) -> tuple[str, list[_Element]]:
    """Read the order of bytes, empty for text, and the elements."""
    order: str | None = None
    elements: list[_Element] = []
    for line in text.splitlines()[1:]:
        words = line.split()
        try:
            match words:
                case [] | ["comment" | "obj_info", *_]:
                    continue
                case ["format", form, _]:
                    order = _ORDERS[form]
                case ["element", name, count] if int(count) >= 0:
                    elements.append(_Element(name, int(count)))
                case ["property", "list", count, value, name]:
                    each = _Property(name, _TYPES[count], _TYPES[value])
                    elements[-1].properties.append(each)
                case ["property", value, name]:
                    elements[-1].properties.append(_Property(name, "", _TYPES[value]))
                case _:
                    raise ValueError
        except (KeyError, IndexError, ValueError):
            what = f"cannot be read as PLY: its head has the line {line.strip()[:60]!r}"
            raise FileError(where, what) from None
    if order is None:
        raise FileError(where, "cannot be read as PLY: its head has no format")
    return order, elements


class _Text:
    """Numbers of a text file."""

    def __init__(self, where: str, body: bytes) -> None:
        self.where, self.place = where, 0
        try:
            self.numbers = np.array(body.split(), np.float64)
        except ValueError as error:
            raise FileError(where, f"has a word that is no number ({error})") from None

    def rows(self, element: _Element) -> list[list[NDArray[np.generic]] | NDArray[np.generic]]:
        """Return each property of an element, a list for each row where they are lists."""
        width = len(element.properties)
        if not any(each.count for each in element.properties):
            table = self._next(element.count * width, element).reshape(element.count, width)
            return list(table.T)
        columns: list[list[NDArray[np.generic]]] = [[] for _ in element.properties]
        for _ in range(element.count):
            for each, column in zip(element.properties, columns, strict=True):
                size = int(self._next(1, element)[0]) if each.count else 1
                column.append(self._next(size, element).astype(np.int64))
        return list(columns)

    def _next(self, count: int, element: _Element) -> NDArray[np.float64]:
        found = self.numbers[self.place : self.place + count]
        if count < 0 or len(found) < count:
            raise _cut_short(self.where, element)
        self.place += count
        return found


class _Bytes:
    """Numbers of a binary file."""

    def __init__(self, where: str, body: bytes, order: str) -> None:
        self.where, self.body, self.order, self.place = where, body, order, 0

    def rows(self, element: _Element) -> list[list[NDArray[np.generic]] | NDArray[np.generic]]:
        """Return each property of an element, a list for each row where they are lists."""
        if not any(each.count for each in element.properties):
            names = [str(number) for number in range(len(element.properties))]
            kinds = [self.order + each.value for each in element.properties]
            row = np.dtype(list(zip(names, kinds, strict=True)))
            table = self._next(row, element.count, element)
            return [table[name] for name in names]
        columns: list[list[NDArray[np.generic]]] = [[] for _ in element.properties]
        for _ in range(element.count):
            for each, column in zip(element.properties, columns, strict=True):
                size = 1
                if each.count:
                    size = int(self._next(np.dtype(self.order + each.count), 1, element)[0])
                column.append(self._next(np.dtype(self.order + each.value), size, element))
        return list(columns)

    def _next(self, kind: np.dtype[np.generic], count: int, element: _Element) -> NDArray[np.void]:
        size = kind.itemsize * count
        if count < 0 or self.place + size > len(self.body):
            raise _cut_short(self.where, element)
        found = np.frombuffer(self.body, kind, count, self.place)
        self.place += size
        return found


def _cut_short(where: str, element: _Element) -> FileError:
    what = f"is cut short: it ends before the last {element.name} of {element.count:,}"
    return FileError(where, what, "save or copy it again")
