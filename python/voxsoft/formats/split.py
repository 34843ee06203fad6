"""Volume cells of all kinds cut into tetrahedra, so that neighbors cut the face between them alike.

Each cell is coned from its vertex of the smallest number to its faces that do not hold it, and each
quadrilateral is cut by the diagonal from its smallest vertex (Dompierre, Labbé, Vallet and
Camarero, *How to subdivide pyramids, prisms and hexahedra into tetrahedra*, 8th International
Meshing Roundtable, 1999). Convex cells with plane faces are filled exactly: a hexahedron by six
tetrahedra, a wedge by three, a pyramid by two. Cells with curved edges are taken by their corners.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import counted
from voxsoft.errors import FileError
from voxsoft.formats.contents import CORNERS, Contents
from voxsoft.formats.report import counted_cells

#: Faces of volume cells in VTK's numbering, outward.
FACES: Final[dict[str, tuple[tuple[int, ...], ...]]] = {
    "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    "wedge": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    "hexahedron": (
        (0, 3, 2, 1),
        (4, 5, 6, 7),
        (0, 1, 5, 4),
        (1, 2, 6, 5),
        (2, 3, 7, 6),
        (3, 0, 4, 7),
    ),
}

Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Tets:
    """Tetrahedra with the cells they come from.

    Attributes
    ----------
    tets
        Points of each tetrahedron, (m, 4).
    cell
        Cell of the contents that each tetrahedron is a part of, (m,).
    notes
        Sentences on cells that were cut, or taken by their corners.
    """

    tets: Indices
    cell: Indices
    notes: tuple[str, ...]


def tets_of(contents: Contents, where: str) -> Tets:
    """Return the volume cells of a file as tetrahedra.

    Raises
    ------
    FileError
        If cells are of an unknown kind, partly inverted, or cut another way by tetrahedra beside
        them.

    Examples
    --------
    >>> from voxsoft.formats.contents import CellBlock
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    >>> points = np.concatenate([corners, corners + [0, 0, 1]])
    >>> cube = Contents(points, (CellBlock("hexahedron", np.arange(8)[None]),))
    >>> found = tets_of(cube, "cube")
    >>> found.tets.shape, found.notes
    ((6, 4), ('1 hexahedron is cut into 6 tetrahedra',))
    """
    tets: list[Indices] = []
    cell: list[Indices] = []
    cut: dict[str, list[int]] = {}
    corners_only: dict[str, int] = {}
    first = 0
    for block in contents.blocks:
        base = block.kind.rstrip("0123456789")
        numbers = np.arange(first, first + len(block.nodes))
        first += len(block.nodes)
        if base not in FACES or not len(numbers):
            continue
        corners = block.nodes[:, : CORNERS[base]]
        rows, owner = (corners, np.arange(len(corners))) if base == "tetra" else _cut(base, corners)
        if base != "tetra":
            _check_turn(contents.points, rows, owner, block.kind, where)
            count = cut.setdefault(base, [0, 0])
            count[0] += len(numbers)
            count[1] += len(rows)
        if block.kind != base:
            corners_only[block.kind] = corners_only.get(block.kind, 0) + len(numbers)
        tets.append(rows)
        cell.append(numbers[owner])
    if not tets:
        return Tets(np.empty((0, 4), np.int64), np.empty(0, np.int64), ())
    found = np.concatenate(tets)
    if cut:
        _check_neighbors(contents, found, where)
    notes = [
        f"{counted_cells(kind, n)}: only the corners are taken, edges are straight"
        for kind, n in corners_only.items()
    ]
    for kind, (n, made) in cut.items():
        verb = "is" if n == 1 else "are"
        notes.append(f"{counted_cells(kind, n)} {verb} cut into {made:,} tetrahedra")
    return Tets(found, np.concatenate(cell), tuple(notes))


def _be(count: int) -> str:
    return "is" if count == 1 else "are"


def _cut(kind: str, cells: Indices) -> tuple[Indices, Indices]:
    """Cut cells of one kind into tetrahedra; return those and the cell of each."""
    lowest = cells.argmin(axis=1)
    tets: list[Indices] = []
    owner: list[Indices] = []
    for apex in range(cells.shape[1]):
        chosen = np.flatnonzero(lowest == apex)
        for corners in FACES[kind]:
            if apex in corners or not len(chosen):
                continue
            face = cells[chosen][:, list(corners)]
            # Each face begins at its smallest vertex: its fan is the cut by that diagonal.
            turn = (face.argmin(axis=1)[:, None] + np.arange(len(corners))) % len(corners)
            face = np.take_along_axis(face, turn, axis=1)
            for step in range(1, len(corners) - 1):
                apexes = cells[chosen, apex]
                tets.append(np.column_stack((apexes, face[:, 0], face[:, step + 1], face[:, step])))
                owner.append(chosen)
    rows, of = np.concatenate(tets), np.concatenate(owner)
    # A cell that repeats a vertex is a simpler one, as a wedge may be written as a hexahedron.
    ordered = np.sort(rows, axis=1)
    whole = (np.diff(ordered, axis=1) > 0).all(axis=1)
    order = np.argsort(of[whole], kind="stable")
    return rows[whole][order], of[whole][order]


def _check_turn(
    points: NDArray[np.float64], tets: Indices, owner: Indices, kind: str, where: str
) -> None:
    """Refuse cells whose tetrahedra have different orientations: their faces are folded."""
    a, b, c, d = (points[tets[:, corner]] for corner in range(4))
    volumes = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)
    highest, lowest = (np.full(owner.max() + 1, sign * -np.inf) for sign in (1, -1))
    np.maximum.at(highest, owner, volumes)
    np.minimum.at(lowest, owner, volumes)
    folded = int(((highest > 0) & (lowest < 0)).sum())
    if folded:
        what = f"{counted_cells(kind, folded)}, cut into tetrahedra, would overlap themselves"
        raise FileError(where, what, "repair the folded cells, or mesh with tetrahedra")


def _check_neighbors(contents: Contents, tets: Indices, where: str) -> None:
    """Refuse quadrilaterals that tetrahedra of the file cut by the other diagonal."""
    quads: list[Indices] = []
    triangles: list[Indices] = []
    for block in contents.blocks:
        base = block.kind.rstrip("0123456789")
        for corners in FACES.get(base, ()):
            face = np.sort(block.nodes[:, list(corners)], axis=1)
            (quads if len(corners) == 4 else triangles).append(face)
    if not quads or not triangles:
        return
    four, counts = np.unique(np.concatenate(quads), axis=0, return_counts=True)
    outer = four[counts == 1]
    three = {tuple(row) for row in np.concatenate(triangles).tolist()}
    made: Indices = np.concatenate([tets[:, list(face)] for face in FACES["tetra"]])
    own, uses = np.unique(np.sort(made, axis=1), axis=0, return_counts=True)
    alone = {tuple(row) for row in own[uses == 1].tolist()}
    # A triangle of the file within a quadrilateral that no cut triangle meets lies across it.
    across = 0
    for quad in outer.tolist():
        inside = [(*quad[:skip], *quad[skip + 1 :]) for skip in range(4)]
        across += any(each in three and each in alone for each in inside)
    if across:
        faces = counted(across, "quadrilateral face")
        what = f"{faces} of bricks, wedges or pyramids, which tetrahedra cut by the other diagonal"
        raise FileError(where, what, "put pyramids between them, or mesh with tetrahedra alone")
