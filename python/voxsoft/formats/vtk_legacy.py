"""Legacy files of VTK, .vtk of versions 1 to 5.1, as text and binary."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

import numpy as np

from voxsoft.errors import FileError
from voxsoft.formats import vtk_xml
from voxsoft.formats.contents import Contents
from voxsoft.formats.vtk_cells import POLYGONS
from voxsoft.formats.vtk_data import Array, DataSet, Indices, contents_of
from voxsoft.formats.vtk_grids import Image, cells_of_image, crossed, curved_grid
from voxsoft.formats.vtk_text import Cursor

_CALLED: Final = {
    "unstructured_grid": "unstructured grid",
    "polydata": "polygons",
    "structured_points": "image",
    "structured_grid": "structured grid",
    "rectilinear_grid": "rectilinear grid",
}
#: Lists of cells of polygons by their keywords here.
_LISTS: Final = {
    "vertices": POLYGONS[0],
    "lines": POLYGONS[1],
    "polygons": POLYGONS[2],
    "triangle_strips": POLYGONS[3],
}
#: Numbers in a row of each kind of attribute; 0 where the width is given in another way.
_WIDTHS: Final = {
    **{"vectors": 3, "normals": 3, "tensors": 9, "tensors6": 6, "global_ids": 1},
    **{"pedigree_ids": 1, "edge_flags": 1, "texture_coordinates": 0, "scalars": 0},
    **{"color_scalars": 0, "lookup_table": 0, "field": 0},
}


def read(path: Path) -> Contents:
    """Read a file; XML is read as such.

    Raises
    ------
    FileError
        If it ends within its numbers, has an unexpected word, or its cells are invalid.
    """
    where, data = str(path), path.read_bytes()
    if data[:64].lstrip().startswith(b"<"):
        return vtk_xml.read(path)
    head = re.match(rb"#\s*vtk\s+DataFile\s+Version\s+([\d.]+)[^\n]*\n[^\n]*\n", data, re.I)
    if head is None:
        raise FileError(where, 'does not begin with "# vtk DataFile Version" and a line of title')
    cursor = Cursor(where, data, head.end())
    form = cursor.words()[:1]
    if form not in (["ASCII"], ["BINARY"]):
        raise FileError(
            where, f"line 3: is {' '.join(form) or 'missing'}; expected ASCII or BINARY"
        )
    cursor.is_binary = form == ["BINARY"]
    file = _File(cursor)
    file.run()
    found = file.data_set()
    return contents_of(where, [found], f"VTK {head[1].decode()}, {_CALLED[file.kind]}")


class _File:
    """Contents of all sections of a file."""

    def __init__(self, cursor: Cursor) -> None:
        self.cursor = cursor
        self.kind = ""
        self.points = np.empty((0, 3))
        self.axes: dict[str, Array] = {}
        self.numbers: dict[str, tuple[float, ...]] = {}
        self.cells: dict[str, tuple[Indices, Indices]] = {}
        self.types: Indices = np.empty(0, np.int64)
        self.arrays: dict[str, dict[str, Array]] = {"cell_data": {}, "point_data": {}, "": {}}
        self.place = ""
        self.rows = 0
        self.active = ""
        self.notes: list[str] = []

    def run(self) -> None:
        """Read section after section."""
        while words := self.cursor.words():
            key = words[0].lower()
            if key == "dataset":
                self.kind = words[1].lower() if len(words) > 1 else ""
                if self.kind not in _CALLED:
                    what = f"DATASET {' '.join(words[1:])}; known are {', '.join(_CALLED).upper()}"
                    raise self.cursor.wrong(what, "save it as an unstructured grid in ParaView")
            elif key in ("dimensions", "origin", "spacing", "aspect_ratio"):
                name = "spacing" if key == "aspect_ratio" else key
                self.numbers[name] = self.cursor.parsed(words[1:4], float, 3)
            elif key == "points":
                self.points = self._values(words[1:], 3).reshape(-1, 3).astype(np.float64)
            elif key.endswith("_coordinates") and key[0] in "xyz":
                self.axes[key[0]] = self._values(words[1:], 1).astype(np.float64)
            elif key == "cells" or key in _LISTS:
                self.cells[key] = self._cells(words[1:])
            elif key == "cell_types":
                (count,) = self.cursor.parsed(words[1:2], int, 1)
                self.types = self.cursor.numbers(count, "int").astype(np.int64)
            elif key in ("cell_data", "point_data"):
                self.place = key
                (self.rows,) = self.cursor.parsed(words[1:2], int, 1)
            elif key == "metadata":
                self.cursor.skip_to_blank()
            elif key in _WIDTHS:
                self._attribute(key, words[1:])
            else:
                raise self.cursor.wrong(f"the word {words[0][:40]!r} is not known here")

    def _values(self, words: list[str], width: int) -> Array:
        (count,) = self.cursor.parsed(words[:1], int, 1)
        return self.cursor.numbers(count * width, words[1] if len(words) > 1 else "")

    def _cells(self, words: list[str]) -> tuple[Indices, Indices]:
        """Read start and end of the nodes of each cell, and all nodes."""
        count, size = self.cursor.parsed(words[:2], int, 2)
        if self.cursor.peek().lower() == "offsets":
            # Version 5.1 and later; the count is of offsets, one more than cells.
            offsets = self.cursor.numbers(count, self.cursor.words()[-1])
            if self.cursor.peek().lower() != "connectivity":
                raise self.cursor.wrong("OFFSETS are not followed by CONNECTIVITY")
            nodes = self.cursor.numbers(size, self.cursor.words()[-1])
            starts = offsets.astype(np.int64) if count else np.zeros(1, np.int64)
            return starts, nodes.astype(np.int64)
        numbers = self.cursor.numbers(size, "int").astype(np.int64)
        starts, place = np.zeros(count + 1, np.int64), 0
        is_node = np.ones(size, bool)
        for cell in range(count):
            if place >= size or numbers[place] < 0:
                raise self.cursor.wrong(f"cell {cell} has no number of points within {size:,}")
            starts[cell + 1] = starts[cell] + numbers[place]
            is_node[place] = False
            place += int(numbers[place]) + 1
        if place != size:
            raise self.cursor.wrong(f"{count:,} cells have {place:,} numbers, not {size:,}")
        return starts, numbers[is_node]

    def _attribute(self, key: str, words: list[str]) -> None:
        """Read one array on cells or points, or a field of several."""
        cursor, rows, width = self.cursor, self.rows, _WIDTHS[key]
        if key == "field":
            (count,) = cursor.parsed(words[1:2], int, 1)
            for _ in range(count):
                self._array_of_field()
            return
        name = words[0] if words else ""
        if key == "lookup_table":
            (count,) = cursor.parsed(words[1:2], int, 1)
            cursor.numbers(4 * count, "unsigned_char" if cursor.is_binary else "float")
            return
        kind = words[1] if len(words) > 1 else ""
        if key == "color_scalars":
            (width,) = cursor.parsed(words[1:2], int, 1)
            kind = "unsigned_char" if cursor.is_binary else "float"
        elif key == "texture_coordinates":
            (width,) = cursor.parsed(words[1:2], int, 1)
            kind = words[2] if len(words) > 2 else ""
        elif key == "scalars":
            (width,) = cursor.parsed(words[2:3] or ["1"], int, 1)
            if cursor.peek().lower() == "lookup_table":
                cursor.words()
            if self.place == "cell_data":
                self.active = cursor.named(name)
        values = cursor.numbers(rows * width, kind)
        if key == "color_scalars" and not cursor.is_binary:
            # Texts store bytes as parts of 255; VTK writes any numbers of one byte so.
            whole = np.rint(255.0 * np.nan_to_num(values.astype(np.float64)))
            values = np.clip(whole, 0, 255).astype(np.uint8)
        self._keep(cursor.named(name), values, rows, width)

    def _array_of_field(self) -> None:
        words = self.cursor.words()
        if words[:1] == ["METADATA"]:
            self.cursor.skip_to_blank()
            words = self.cursor.words()
        if len(words) < 4:
            raise self.cursor.wrong(f"{' '.join(words)!r} is no array of a field")
        width, rows = self.cursor.parsed(words[1:3], int, 2)
        name, kind = self.cursor.named(words[0]), words[3]
        if kind.lower() == "string":
            self.cursor.skip_texts(width * rows)
            self.notes.append(f'Array "{name}" of texts is not read')
            return
        self._keep(name, self.cursor.numbers(width * rows, kind), rows, width)

    def _keep(self, name: str, values: Array, rows: int, width: int) -> None:
        shape = (rows,) if width == 1 else (rows, width)
        self.arrays[self.place][name] = values.reshape(shape)

    def data_set(self) -> DataSet:
        """Return the cells of the file."""
        where = self.cursor.where
        data = self.arrays["cell_data"], self.arrays["point_data"]
        whole = [f'Array "{name}" of the whole file is not read' for name in self.arrays[""]]
        notes = (*self.notes, *whole)
        if not self.kind:
            raise FileError(where, "is cut short: it has no DATASET", "save or copy it again")
        counts = tuple(map(int, self.numbers.get("dimensions", (0, 0, 0))))
        if self.kind == "structured_points":
            nx, ny, nz = counts
            origin = np.array(self.numbers.get("origin", (0, 0, 0)), np.float64)
            steps = np.diag(self.numbers.get("spacing", (1, 1, 1)))
            image = Image((nx, ny, nz), origin, steps, *data, self.active, notes)
            return cells_of_image(where, image)
        if self.kind == "rectilinear_grid":
            axes = [self.axes.get(axis, np.empty(0)).astype(np.float64) for axis in "xyz"]
            return curved_grid(where, crossed(axes), counts, *data, notes)
        if self.kind == "structured_grid":
            return curved_grid(where, self.points, counts, *data, notes)
        types, offsets, nodes = [self.types], [np.zeros(1, np.int64)], [np.empty(0, np.int64)]
        for key in ("cells", *_LISTS):
            if key in self.cells:
                starts, rows = self.cells[key]
                offsets.append(starts[1:] + offsets[-1][-1:])
                nodes.append(rows)
                if key in _LISTS:
                    types.append(np.full(len(starts) - 1, _LISTS[key][1]))
        return DataSet(
            self.points,
            np.concatenate(types),
            np.concatenate(offsets),
            np.concatenate(nodes),
            *data,
            notes,
        )
