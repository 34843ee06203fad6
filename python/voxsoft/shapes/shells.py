"""Defects of a triangle surface: turned faces, and holes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft._components import components

Indices = NDArray[np.int64]


class Hole(NamedTuple):
    """Loop of edges that belong to one triangle only.

    Attributes
    ----------
    edges
        Number of edges.
    width
        Length of the longest side of the box around them.
    center
        Center of that box.
    """

    edges: int
    width: float
    center: tuple[float, float, float]


def in_one_sense(points: NDArray[np.float64], triangles: Indices) -> tuple[Indices, int]:
    """Turn triangles so that neighbors agree on which side is outside.

    A patch is a component connected by edges of two triangles. Within it, the sense of most of its
    area stays: an inner shell that was turned against the outer one is a cavity, and remains one.

    Parameters
    ----------
    points
        Vertices, (n, 3).
    triangles
        Vertices of each triangle, (t, 3).

    Returns
    -------
    triangles : ndarray, shape (t, 3)
    turned : int
        Number of turned triangles.

    Examples
    --------
    >>> corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> in_one_sense(corners, np.array([[0, 1, 2], [0, 3, 2]]))[1]
    1
    """
    import igl

    alike, patch = igl.bfs_orient(np.ascontiguousarray(triangles, dtype=np.int64))
    # An even permutation of the corners is the same triangle.
    is_turned = ~(_rolled(alike) == _rolled(triangles)).all(axis=1)
    area = _areas(points, triangles)
    balance = np.bincount(patch, weights=np.where(is_turned, -area, area))
    is_turned ^= (balance < 0)[patch]
    found = np.where(is_turned[:, None], triangles[:, ::-1], triangles)
    return np.ascontiguousarray(found, dtype=np.int64), int(is_turned.sum())


def _rolled(triangles: Indices) -> Indices:
    """Rotate the corners of each triangle so that the least comes first."""
    first = triangles.argmin(axis=1)[:, None]
    return np.take_along_axis(triangles, (first + np.arange(3)) % 3, axis=1)


def _areas(points: NDArray[np.float64], triangles: Indices) -> NDArray[np.float64]:
    a, b, c = (points[triangles[:, i]] for i in range(3))
    areas: NDArray[np.float64] = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    return areas


def holes_of(points: NDArray[np.float64], triangles: Indices) -> tuple[Hole, ...]:
    """Return the holes of a surface, the widest first.

    Examples
    --------
    >>> corners = np.array([[0.0, 0, 0], [3, 0, 0], [0, 4, 0]])
    >>> holes_of(corners, np.array([[0, 1, 2]]))
    (Hole(edges=3, width=4.0, center=(1.5, 2.0, 0.0)),)
    """
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, uses = np.unique(edges, axis=0, return_counts=True)
    bare = edges[uses == 1]
    if not len(bare):
        return ()
    label = components(bare[:, 0], bare[:, 1], len(points))
    found = []
    for each in np.unique(label[bare[:, 0]]):
        rim = points[label == each]
        low, high = rim.min(axis=0), rim.max(axis=0)
        x, y, z = ((low + high) / 2).tolist()
        number = int(np.count_nonzero(label[bare[:, 0]] == each))
        found.append(Hole(number, float((high - low).max()), (x, y, z)))
    return tuple(sorted(found, key=lambda hole: -hole.width))
