"""Triangles from cells of every kind: faces as they are, volume cells by their boundary."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

#: Faces by the number of their corners; the nodes of curved edges follow the corners.
_FACES: Final = {"triangle": 3, "quad": 4}

#: Faces of volume cells in VTK's numbering, outward where the volume is positive.
_VOLUMES: Final = {
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


def faces_of(points: NDArray[np.float64], cells: Sequence[tuple[str, Any]]) -> Indices:
    """Return the triangles (t, 3) of blocks of cells, as meshio names their types.

    Where there are volume cells, their boundary counts and separate faces do not: those mark parts
    of it. Faces of more corners are split into triangles.

    Examples
    --------
    >>> corners = np.array([[i, j, k] for k in (0, 1) for j in (0, 1) for i in (0, 1)], float)
    >>> faces_of(corners, [("hexahedron", [[0, 1, 3, 2, 4, 5, 7, 6]])]).shape
    (12, 3)
    """
    volumes: dict[int, list[Indices]] = {}
    faces: list[Indices] = []
    for kind, data in cells:
        name = kind.rstrip("0123456789")
        if name in _VOLUMES:
            for corners, own in _volume_faces(points, name, np.asarray(data, dtype=np.int64)):
                volumes.setdefault(corners, []).append(own)
        elif name in _FACES or name == "polygon":
            faces.append(_fans(np.asarray(data, dtype=np.int64)[:, : _FACES.get(name)]))
    if volumes:
        faces = [_fans(_once(np.concatenate(alike))) for alike in volumes.values()]
    return np.concatenate(faces) if faces else np.empty((0, 3), np.int64)


def _volume_faces(
    points: NDArray[np.float64], name: str, cells: Indices
) -> list[tuple[int, Indices]]:
    """The faces of volume cells, with the number of their corners, all pointing outward."""
    middle = points[cells[:, : 1 + max(map(max, _VOLUMES[name]))]].mean(axis=1)
    found = []
    for corners in _VOLUMES[name]:
        face = cells[:, corners]
        # The cross product of the diagonals; of two sides where there are three corners.
        sides = points[face[:, 2]] - points[face[:, 0]], points[face[:, -1]] - points[face[:, 1]]
        outward = points[face].mean(axis=1) - middle
        is_turned = np.einsum("ij,ij->i", np.cross(*sides), outward) < 0
        found.append((len(corners), np.where(is_turned[:, None], face[:, ::-1], face)))
    return found


def _once(faces: Indices) -> Indices:
    """Those of faces (f, k) that belong to one cell only."""
    _, first, uses = np.unique(
        np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
    )
    outer: Indices = faces[first[uses == 1]]
    return outer


def _fans(faces: Indices) -> Indices:
    """Split faces (f, k) into f (k − 2) triangles around their first corner."""
    steps = range(1, faces.shape[1] - 1)
    return np.concatenate([faces[:, [0, i, i + 1]] for i in steps]).astype(np.int64)
