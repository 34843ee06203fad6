"""Outer surface of a body, for forces that a fluid around it exerts."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core


@dataclass(frozen=True, eq=False)
class OuterSurface:
    """Surface of a body without the walls of closed cavities.

    Attributes
    ----------
    triangles
        Outward, (t, 3): of points of the skin, or of vertices of the whole mesh.
    skin
        The smooth surface of the voxels; None where it is their faces.
    first
        First vertex of the whole mesh that carries the skin.
    share
        Part of its area with which each triangle counts: faces may come in both of their splits.
    """

    triangles: NDArray[np.uint32] = field(repr=False)
    skin: _core.Skin | None
    first: int
    share: float


def outward(points: NDArray[np.float64], triangles: NDArray[np.uint32]) -> NDArray[np.bool_]:
    """Tell which triangles belong to a closed piece of a surface that has its body inside, (t,).

    Parameters
    ----------
    points
        In m, (n, 3).
    triangles
        Outward, (t, 3). Pieces are those that hang together by edges of two triangles.

    Examples
    --------
    >>> tet = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], np.uint32)
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    >>> both = np.concatenate([tet, 4 + tet[:, ::-1]])
    >>> outward(np.concatenate([corners, 0.1 + 0.1 * corners]), both).tolist()
    [True, True, True, True, False, False, False, False]
    """
    from scipy.sparse import coo_array  # slow to load
    from scipy.sparse.csgraph import connected_components

    count = len(triangles)
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    keys = edges[:, 0].astype(np.int64) * len(points) + edges[:, 1]
    order = np.argsort(keys, kind="stable")
    starts = np.flatnonzero(np.diff(keys[order], prepend=-1))
    twice = np.diff(starts, append=len(keys)) == 2
    first, second = order[starts[twice]] // 3, order[starts[twice] + 1] // 3
    joined = coo_array((np.ones(len(first)), (first, second)), shape=(count, count))
    pieces, piece = connected_components(joined, directed=False)
    a, b, c = points[triangles].transpose(1, 0, 2) - points.mean(axis=0)
    volumes = np.bincount(piece, np.einsum("ij,ij->i", a, np.cross(b, c)), minlength=pieces)
    found: NDArray[np.bool_] = volumes[piece] > 0.0
    return found
