"""Cells of VTK by their type numbers, as blocks of cells of one kind."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import counted
from voxsoft.errors import FileError
from voxsoft.formats.contents import CellBlock

Indices = NDArray[np.int64]

#: Kind of cell by type number; the nodes of curved edges follow the corners in all of them.
_KINDS: Final = {
    **{1: "vertex", 3: "line", 5: "triangle", 7: "polygon", 8: "quad", 9: "quad"},
    **{10: "tetra", 11: "hexahedron", 12: "hexahedron", 13: "wedge", 14: "pyramid"},
    # Quadratic, by the number of their nodes.
    **{21: "line", 22: "triangle", 34: "triangle", 23: "quad", 28: "quad", 30: "quad"},
    **{24: "tetra", 25: "hexahedron", 29: "hexahedron", 33: "hexahedron", 26: "wedge"},
    **{31: "wedge", 32: "wedge", 27: "pyramid", 37: "pyramid", 35: "line"},
    # Lagrange and Bézier cells of any order.
    **{68: "line", 69: "triangle", 70: "quad", 71: "tetra", 72: "hexahedron", 73: "wedge"},
    **{74: "pyramid", 75: "line", 76: "triangle", 77: "quad", 78: "tetra", 79: "hexahedron"},
    **{80: "wedge", 81: "pyramid"},
}
_LINEAR: Final = {
    **{"vertex": 1, "line": 2, "triangle": 3, "quad": 4, "tetra": 4},
    **{"pyramid": 5, "wedge": 6, "hexahedron": 8},
}
#: Types that are several simple cells each: points, lines, triangles.
_POLY_VERTEX, _POLY_LINE, _STRIP, _POLYGON = 2, 4, 6, 7
#: Lists of cells of polygons with their type, in the order that arrays on cells follow.
POLYGONS: Final = (
    ("Verts", _POLY_VERTEX),
    ("Lines", _POLY_LINE),
    ("Polys", _POLYGON),
    ("Strips", _STRIP),
)
#: Types numbered along x, then y, then z, with the order of the kind.
_TURNED: Final = {8: [0, 1, 3, 2], 11: [0, 1, 3, 2, 4, 5, 7, 6]}
_REFUSED: Final = {
    15: ("pentagonal prism", "pentagonal prisms"),
    16: ("hexagonal prism", "hexagonal prisms"),
    36: ("polygon with curved edges", "polygons with curved edges"),
    41: ("convex set of points", "convex sets of points"),
    42: ("polyhedron", "polyhedra"),
}


def blocks_of(
    types: Indices, offsets: Indices, nodes: Indices
) -> tuple[tuple[CellBlock, ...], Indices]:
    """Return cells as blocks of one kind, and the file's cell of each of them.

    Cells of several lines or triangles, such as strips, become these. Cells of type 0 are dropped.

    Parameters
    ----------
    types
        Type number of VTK of each cell, (k,).
    offsets
        Start of the nodes of each cell, and end of the last, (k + 1,).
    nodes
        Points of all cells, one after the other.

    Examples
    --------
    >>> blocks, order = blocks_of(*map(np.array, ([11], [0, 8], range(8))))
    >>> blocks[0].kind, blocks[0].nodes.tolist(), order.tolist()
    ('hexahedron', [[0, 1, 3, 2, 4, 5, 7, 6]], [0])
    """
    sizes = np.diff(offsets)
    groups: dict[tuple[str, int], list[tuple[Indices, Indices]]] = {}
    for type_, size in np.unique(np.column_stack((types, sizes)), axis=0).tolist():
        cells = np.flatnonzero((types == type_) & (sizes == size))
        rows = nodes[offsets[cells][:, None] + np.arange(size)]
        kind, rows, owners = _simple(type_, rows, cells)
        if len(rows):
            groups.setdefault((kind, rows.shape[1]), []).append((rows, owners))
    blocks, order = [], [np.empty(0, np.int64)]
    # Blocks in the order of their first cells, and cells in the order of the file.
    firsts = {key: min(int(owners.min()) for _, owners in each) for key, each in groups.items()}
    for kind, size in sorted(groups, key=lambda key: firsts[key]):
        owners = np.concatenate([owners for _, owners in groups[kind, size]])
        rows = np.concatenate([rows for rows, _ in groups[kind, size]])
        rank = np.argsort(owners, kind="stable")
        name = kind if _LINEAR.get(kind, size) == size else f"{kind}{size}"
        blocks.append(CellBlock(name, np.ascontiguousarray(rows[rank])))
        order.append(owners[rank])
    return tuple(blocks), np.concatenate(order)


def _simple(type_: int, rows: Indices, cells: Indices) -> tuple[str, Indices, Indices]:
    """Return kind and nodes of cells of one type and size, and the file's cell of each."""
    count, size = rows.shape
    if type_ in (_POLY_VERTEX, _POLY_LINE, _STRIP):
        corners = {_POLY_VERTEX: 1, _POLY_LINE: 2, _STRIP: 3}[type_]
        steps = np.arange(max(0, size + 1 - corners))
        places = steps[:, None] + np.arange(corners)
        if type_ == _STRIP:
            # Every second triangle of a strip is reversed.
            places[1::2] = places[1::2][:, [1, 0, 2]]
        rows = rows[:, places].reshape(-1, corners)
        return ("vertex", "line", "triangle")[corners - 1], rows, np.repeat(cells, len(steps))
    kind = _KINDS.get(type_, "")
    if kind == "polygon" and size in (3, 4):
        kind = "triangle" if size == 3 else "quad"
    if type_ in _TURNED and count:
        rows = rows[:, _TURNED[type_]]
    # Type 0 is an empty cell.
    return kind, rows if kind else rows[:0], cells if kind else cells[:0]


def check_cells(where: str, types: Indices, offsets: Indices, nodes: Indices, points: int) -> None:
    """Refuse invalid cells.

    Parameters
    ----------
    where
        Name of the file, for messages.
    types, offsets, nodes
        See :func:`blocks_of`.
    points
        Number of points.

    Raises
    ------
    FileError
        If cells are of a type that is not read, or name a point that is missing.

    Examples
    --------
    >>> check_cells("a.vtu", *map(np.array, ([10], [0, 4], [0, 1, 2, 9])), points=4)
    Traceback (most recent call last):
        ...
    voxsoft.errors.FileError: a.vtu: is damaged: a cell has point 9, of 4 points
    """
    if len(offsets) != len(types) + 1:
        what = f"has types of {len(types):,} cells and offsets of {len(offsets) - 1:,}"
        raise FileError(where, f"is damaged: it {what}")
    if len(types) and (offsets[0] != 0 or (np.diff(offsets) < 0).any() or offsets[-1] > len(nodes)):
        raise FileError(where, "is damaged: offsets of cells run past their nodes")
    if len(nodes) and (nodes.min() < 0 or nodes.max() >= points):
        wrong = nodes[(nodes < 0) | (nodes >= points)][0]
        raise FileError(where, f"is damaged: a cell has point {wrong}, of {points:,} points")
    refused = []
    found, counts = np.unique(types, return_counts=True)
    for type_, count in zip(found.tolist(), counts.tolist(), strict=True):
        if type_ in _REFUSED:
            refused.append(f"{count:,} {_REFUSED[type_][count > 1]}")
        elif type_ not in (*_KINDS, 0, _POLY_VERTEX, _POLY_LINE, _STRIP):
            refused.append(f"{counted(count, 'cell')} of VTK's type {type_}")
    if refused:
        hint = "cut them in ParaView by Filters, Alphabetical, Tetrahedralize, and save that"
        raise FileError(where, f"holds {', '.join(refused)}, which cannot be followed", hint)
    for type_ in found.tolist():
        least = _LINEAR.get(_KINDS.get(type_, ""), 0)
        if least and (np.diff(offsets)[types == type_] < least).any():
            what = f"is damaged: a {_KINDS[type_]} has fewer than {counted(least, 'point')}"
            raise FileError(where, what)
