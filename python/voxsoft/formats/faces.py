"""Triangles from cells of every kind: faces as they are, volume cells by their boundary."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from voxsoft.formats.contents import CORNERS, CellBlock
from voxsoft.formats.split import FACES

Indices = NDArray[np.int64]


def faces_of(points: NDArray[np.float64], blocks: Iterable[CellBlock]) -> Indices:
    """Return the triangles (t, 3) of cells.

    If there are volume cells, their boundary counts and separate faces do not: those mark parts
    of it. It is the boundary of the tetrahedra that the cells are cut into, as quadrilaterals are
    cut from their smallest vertex there too. Other faces are fans around their first corner.

    Examples
    --------
    >>> corners = np.array([[i, j, k] for k in (0, 1) for j in (0, 1) for i in (0, 1)], float)
    >>> cube = CellBlock("hexahedron", np.array([[0, 1, 3, 2, 4, 5, 7, 6]]))
    >>> faces_of(corners, [cube]).shape
    (12, 3)
    """
    volumes: dict[int, list[Indices]] = {3: [], 4: []}
    faces: list[Indices] = []
    for block in blocks:
        base = block.kind.rstrip("0123456789")
        if base in FACES:
            for face in _volume_faces(points, base, block.nodes):
                volumes[face.shape[1]].append(face)
        elif base in ("triangle", "quad", "polygon"):
            faces.append(_fans(block.nodes[:, : CORNERS.get(base)]))
    triangles, quads = ([np.empty((0, n), np.int64), *volumes[n]] for n in (3, 4))
    if len(triangles) + len(quads) == 2:
        return np.concatenate([np.empty((0, 3), np.int64), *faces])
    outer = _once(np.concatenate(quads))
    turn = (outer.argmin(axis=1)[:, None] + np.arange(4)) % 4
    halves = _fans(np.take_along_axis(outer, turn, axis=1))
    # Bricks that repeat a vertex have faces without area.
    a, b, c = halves.T
    halves = halves[(a != b) & (b != c) & (c != a)]
    # A half may meet a tetrahedron's face.
    return _once(np.concatenate([*triangles, halves]))


def _volume_faces(points: NDArray[np.float64], name: str, cells: Indices) -> list[Indices]:
    """Return the faces of volume cells, all pointing outward."""
    middle = points[cells[:, : CORNERS[name]]].mean(axis=1)
    found = []
    for corners in FACES[name]:
        face = cells[:, corners]
        # Cross product of the diagonals; of two sides where there are three corners.
        sides = points[face[:, 2]] - points[face[:, 0]], points[face[:, -1]] - points[face[:, 1]]
        outward = points[face].mean(axis=1) - middle
        is_turned = np.einsum("ij,ij->i", np.cross(*sides), outward) < 0
        found.append(np.where(is_turned[:, None], face[:, ::-1], face))
    return found


def _once(faces: Indices) -> Indices:
    """Select the faces (f, k) that belong to one cell only."""
    _, first, uses = np.unique(
        np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
    )
    outer: Indices = faces[first[uses == 1]]
    return outer


def _fans(faces: Indices) -> Indices:
    """Split faces (f, k) into f (k − 2) triangles around their first corner."""
    steps = range(1, faces.shape[1] - 1)
    return np.concatenate([faces[:, [0, i, i + 1]] for i in steps]).astype(np.int64)
