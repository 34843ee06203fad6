"""STL as text and binary, with the solids of a text as cell sets."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import counted
from voxsoft.errors import FileError
from voxsoft.formats.contents import CellBlock, Contents

_SOLID: Final = re.compile(rb"^[ \t]*solid\b[ \t]*([^\r\n]*)", re.MULTILINE | re.IGNORECASE)
_VERTEX: Final = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)
#: A triangle of a binary file: normal and corners, and two bytes that are not used.
FACET: Final = np.dtype([("numbers", "<f4", 12), ("attribute", "<u2")])
_HEAD: Final = 84


def read(path: Path) -> Contents:
    """Read a file; it gives three points for each triangle, as STL shares none.

    Raises
    ------
    FileError
        If it is neither of the two forms, or ends before its last triangle.
    """
    where, data = str(path), path.read_bytes()
    count = int.from_bytes(data[80:_HEAD], "little")
    # Binary files may begin with "solid" too; their length distinguishes them.
    if len(data) == _HEAD + FACET.itemsize * count:
        return _contents(_binary(data, count), {}, ())
    if data.lstrip()[:5].lower() == b"solid" and b"\0" not in data[:_HEAD]:
        return _text(where, data)
    room = (len(data) - _HEAD) // FACET.itemsize
    if 0 < count < room and len(data) >= _HEAD:
        more = len(data) - _HEAD - FACET.itemsize * count
        note = f"{more:,} bytes behind the last triangle are passed over"
        return _contents(_binary(data, count), {}, (note,))
    what = (
        'cannot be read as STL: it neither begins with "solid", as text does, nor has the length '
        "that a binary file of its number of triangles has"
    )
    if 0 < room < count:
        what += f": it says {count:,} and has room for {room:,}"
    raise FileError(where, what, "check that the file is complete, and that its ending is right")


def _binary(data: bytes, count: int) -> NDArray[np.float64]:
    facets = np.frombuffer(data, FACET, count, _HEAD)
    points: NDArray[np.float64] = facets["numbers"][:, 3:].astype(np.float64).reshape(-1, 3)
    return points


def _text(where: str, data: bytes) -> Contents:
    if not re.search(rb"\bendsolid\b[^\r\n]*\s*$", data[-4096:], re.IGNORECASE):
        raise FileError(where, "is cut short: it does not end with endsolid", "copy it again")
    words = _VERTEX.findall(data)
    try:
        points = np.array(words, dtype=np.float64).reshape(-1, 3)
    except ValueError as error:
        raise FileError(where, f"has a vertex that is no number ({error})") from None
    if len(points) % 3:
        what = f"is damaged: {counted(len(points), 'vertex')} are no triangles of three"
        raise FileError(where, what, "save or copy it again")
    starts = [
        (match.start(), match[1].strip().decode("utf-8", "replace"))
        for match in _SOLID.finditer(data)
    ]
    sets: dict[str, list[NDArray[np.int64]]] = {}
    if len(starts) > 1:
        places = np.array([match.start() for match in _VERTEX.finditer(data)])[::3]
        bounds = np.searchsorted(places, [*(start for start, _ in starts), len(data)])
        for number, (_, name) in enumerate(starts):
            cells = np.arange(bounds[number], bounds[number + 1])
            sets.setdefault(name or f"solid {number + 1}", []).append(cells)
    return _contents(points, {name: np.concatenate(each) for name, each in sets.items()}, ())


def _contents(
    points: NDArray[np.float64], sets: dict[str, NDArray[np.int64]], notes: tuple[str, ...]
) -> Contents:
    triangles = np.arange(len(points)).reshape(-1, 3)
    blocks = (CellBlock("triangle", triangles),)
    return Contents(points, blocks, sets, notes=notes, format="STL")
