"""XML files of VTK: .vtu, .vtp, .vti, .vts and .vtr with all their components and encodings."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError
from voxsoft.formats.contents import Contents
from voxsoft.formats.region_names import unit_in
from voxsoft.formats.vtk_arrays import Coding, bytes_of_base64, is_number
from voxsoft.formats.vtk_cells import POLYGONS
from voxsoft.formats.vtk_data import Array, DataSet, contents_of
from voxsoft.formats.vtk_grids import Image, cells_of_image, crossed, curved_grid

#: Common name of each type of file.
_CALLED: Final = {
    "UnstructuredGrid": "VTK XML, unstructured grid",
    "PolyData": "VTK XML, polygons",
    "ImageData": "VTK XML, image",
    "StructuredGrid": "VTK XML, structured grid",
    "RectilinearGrid": "VTK XML, rectilinear grid",
}
_END: Final = b"</VTKFile>"
_COMMENT: Final = re.compile(rb"<!--(.*?)-->")
#: Bytes at the beginning, which may hold comments, and at the end with our own comment.
_HEAD, _TAIL = 4096, 256


def read(path: Path) -> Contents:
    """Read a file.

    Raises
    ------
    FileError
        If it has no end, its arrays do not fit their counts, it only lists other files, or its
        cells are invalid.
    """
    where, data = str(path), path.read_bytes()
    root, appended = _parsed(where, data)
    kind = root.get("type", "")
    if kind not in _CALLED:
        raise _of_files(where, kind, root)
    coding = Coding(
        where,
        ">" if root.get("byte_order") == "BigEndian" else "<",
        "u8" if root.get("header_type") == "UInt64" else "u4",
        root.get("compressor", ""),
    )
    body = root.find(kind)
    pieces = [] if body is None else body.findall("Piece")
    if body is None or not pieces:
        raise FileError(where, "holds no cells and no image")
    try:
        arrays = _Arrays(coding, root, appended)
        if kind == "ImageData":
            found = [cells_of_image(where, _image(arrays, body, pieces))]
        else:
            found = [_READERS[kind](arrays, piece) for piece in pieces]
    except (KeyError, ValueError) as error:
        raise coding.damaged(f"an array or extent is missing, or does not fit ({error})") from None
    fields = body.findall("FieldData/*")
    others = [f'Array "{each.get("Name")}" of the whole file is not read' for each in fields]
    found[0] = replace(found[0], notes=(*found[0].notes, *others, *arrays.notes))
    comments = [text.decode("utf-8", "replace") for text in _COMMENT.findall(data[-_TAIL:])]
    return contents_of(where, found, _CALLED[kind], unit_in(comments))


def _parsed(where: str, data: bytes) -> tuple[ET.Element, bytes]:
    """Parse a file; return its root element and the appended data, which may be binary."""
    if b"<VTKFile" not in data[:_HEAD]:
        raise FileError(where, "is no XML file of VTK: it does not begin with <VTKFile>")
    if _END not in data[-_TAIL:]:
        raise FileError(where, f"is cut short: it has no {_END.decode()}", "save or copy it again")
    appended = b""
    start = data.find(b"<AppendedData")
    if start >= 0:
        first = data.find(b"_", data.find(b">", start)) + 1
        last = data.rfind(b"</AppendedData")
        appended = data[first:last]
        data = data[:first] + data[last:]
    try:
        # Entities are safe: expat bounds the text that they expand to.
        root = ET.fromstring(data)
    except ET.ParseError as error:
        raise FileError(where, f"is no XML: {error}", "save or copy it again") from None
    return root, appended


def _of_files(where: str, kind: str, root: ET.Element) -> FileError:
    """Make an error that names the files a file lists, as it has no cells of its own."""
    listed = [
        name for each in root.iter() for key in ("file", "Source") if (name := each.get(key, ""))
    ]
    if listed:
        shown = ", ".join(listed[:4]) + (f" and {len(listed) - 4} more" * (len(listed) > 4))
        return FileError(where, f"holds no cells, but names of files: {shown}", "read these")
    what = f"holds data of type {kind!r}; known are {', '.join(_CALLED)}"
    return FileError(where, what, "save it as .vtu in ParaView")


class _Arrays:
    """Arrays of a file by their elements."""

    def __init__(self, coding: Coding, root: ET.Element, appended: bytes) -> None:
        self.coding = coding
        element = root.find("AppendedData")
        self.is_raw = element is not None and element.get("encoding") == "raw"
        self.appended = appended if self.is_raw else b"".join(appended.split())
        places = {int(each.get("offset") or 0) for each in root.iter() if _is_appended(each)}
        # An array ends at the start of the next one.
        self.places = [*sorted(places), len(self.appended)]
        self.notes: list[str] = []

    def named(self, parent: ET.Element | None) -> dict[str, Array]:
        """Return all arrays of numbers below an element, one row a tuple; texts become notes."""
        found = {}
        for each in parent if parent is not None else ():
            name = each.get("Name", "")
            if is_number(each.get("type", "")):
                found[name] = self.numbers(each)
            else:
                self.notes.append(f'Array "{name}" of texts is not read')
        return found

    def numbers(self, element: ET.Element) -> Array:
        """Return the numbers of an element."""
        kind, how = element.get("type", ""), element.get("format", "ascii")
        if how == "ascii":
            values = self.coding.numbers_of_text(element.text or "", kind)
        else:
            values = self.coding.numbers_of_bytes(self._content(element, how), kind)
        width = int(element.get("NumberOfComponents") or 1)
        if width < 1 or len(values) % width:
            what = f'array "{element.get("Name")}" has {len(values):,} numbers in rows of {width}'
            raise self.coding.damaged(what)
        return values if width == 1 else values.reshape(-1, width)

    def points(self, parent: ET.Element | None) -> NDArray[np.float64]:
        """Return the points of a component."""
        element = None if parent is None else parent.find("DataArray")
        if element is None:
            return np.empty((0, 3))
        points = self.numbers(element)
        if points.shape[1:] != (3,):
            raise self.coding.damaged("its points have not three coordinates each")
        return points.astype(np.float64)

    def _content(self, element: ET.Element, how: str) -> bytes:
        """Return header and data of an array."""
        if how == "appended":
            first = int(element.get("offset") or 0)
            content = self.appended[first : self.places[self.places.index(first) + 1]]
            if self.is_raw:
                return content
        else:
            content = (element.text or "").encode("ascii", "replace")
        try:
            return bytes_of_base64(content)
        except ValueError as error:
            raise self.coding.damaged(f"an array is no base64 ({error})") from None


def _is_appended(element: ET.Element) -> bool:
    return element.get("format") == "appended"


def _grid(arrays: _Arrays, piece: ET.Element) -> DataSet:
    points = arrays.points(piece.find("Points"))
    cells = arrays.named(piece.find("Cells"))
    types = cells["types"].astype(np.int64)
    offsets = np.concatenate([[0], cells["offsets"].astype(np.int64)])
    nodes = cells["connectivity"].astype(np.int64)
    return DataSet(points, types, offsets, nodes, *_data(arrays, piece))


def _polygons(arrays: _Arrays, piece: ET.Element) -> DataSet:
    points = arrays.points(piece.find("Points"))
    types, offsets, nodes = (
        [np.empty(0, np.int64)],
        [np.zeros(1, np.int64)],
        [np.empty(0, np.int64)],
    )
    for name, type_ in POLYGONS:
        cells = arrays.named(piece.find(name))
        if not len(ends := cells.get("offsets", np.empty(0))):
            continue
        types.append(np.full(len(ends), type_))
        offsets.append(ends.astype(np.int64) + offsets[-1][-1])
        nodes.append(cells["connectivity"][: int(ends[-1])].astype(np.int64))
    return DataSet(
        points,
        np.concatenate(types),
        np.concatenate(offsets),
        np.concatenate(nodes),
        *_data(arrays, piece),
    )


def _curved(arrays: _Arrays, piece: ET.Element) -> DataSet:
    low, high = _extent(piece.get("Extent", ""))
    points = arrays.points(piece.find("Points"))
    return curved_grid(arrays.coding.where, points, tuple(high - low + 1), *_data(arrays, piece))


def _rectilinear(arrays: _Arrays, piece: ET.Element) -> DataSet:
    axes = [arrays.numbers(each).astype(np.float64) for each in piece.findall("Coordinates/*")]
    counts = tuple(len(axis) for axis in axes)
    return curved_grid(arrays.coding.where, crossed(axes), counts, *_data(arrays, piece))


_READERS: Final = {
    "UnstructuredGrid": _grid,
    "PolyData": _polygons,
    "StructuredGrid": _curved,
    "RectilinearGrid": _rectilinear,
}


def _data(arrays: _Arrays, piece: ET.Element) -> tuple[dict[str, Array], dict[str, Array]]:
    """Return arrays on cells and on points."""
    return arrays.named(piece.find("CellData")), arrays.named(piece.find("PointData"))


def _extent(text: str) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the first and last point along each axis."""
    numbers = np.array(text.split(), np.int64)
    if numbers.shape != (6,):
        raise ValueError(f"extent {text!r}")
    return numbers[::2], numbers[1::2]


def _image(arrays: _Arrays, body: ET.Element, pieces: list[ET.Element]) -> Image:
    """Join all components of an image."""
    low, high = _extent(body.get("WholeExtent", ""))
    origin, spacing, direction = (
        np.array(body.get(name, default).split(), np.float64)
        for name, default in (
            ("Origin", "0 0 0"),
            ("Spacing", "1 1 1"),
            ("Direction", "1 0 0 0 1 0 0 0 1"),
        )
    )
    steps = spacing[:, None] * direction.reshape(3, 3).T
    whole: tuple[dict[str, Array], dict[str, Array]] = {}, {}
    active = ""
    for piece in pieces:
        first, last = _extent(piece.get("Extent", ""))
        element = piece.find("CellData")
        active = active or (element.get("Scalars", "") if element is not None else "")
        for more, found, given in zip((0, 1), whole, _data(arrays, piece), strict=True):
            size, full = last - first + more, high - low + more
            place = tuple(slice(a, a + n) for a, n in zip(first - low, size, strict=True))[::-1]
            for name, values in given.items():
                if len(values) != size.prod():
                    what = f'array "{name}" has {len(values):,} rows for {size.prod():,}'
                    raise arrays.coding.damaged(what)
                shape = (*full[::-1], *values.shape[1:])
                every = found.setdefault(name, np.zeros(shape, values.dtype))
                every[place] = values.reshape((*size[::-1], *values.shape[1:]))
    cells, points = (
        {name: values.reshape(-1, *values.shape[3:]) for name, values in found.items()}
        for found in whole
    )
    nx, ny, nz = (int(n) for n in high - low + 1)
    return Image((nx, ny, nz), origin + low @ steps, steps, cells, points, active)
