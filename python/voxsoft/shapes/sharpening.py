"""Sharpening of edges and corners of a traced surface, which marching cubes cut off."""

from __future__ import annotations

from typing import Final, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Triangles = NDArray[np.int64]

#: Cosine between the normals at the ends of an edge below which it crosses a ridge: 30 degrees,
#: the angle of the finest feature that Kobbelt et al. keep.
_RIDGE: Final = np.cos(np.deg2rad(30.0))
#: Step of finite differences of the shape to both sides, as a part of a step.
_DIFFERENCE: Final = 1e-3
#: Largest distance of a new vertex from the middle of its edge, in steps.
_REACH: Final = 1.5
#: Largest distance of a new vertex from the surface, in steps.
_OFF: Final = 0.02
#: Area, in squares of a step, below which a triangle is a needle: beside a ridge all three corners
#: may come to lie on it.
_NEEDLE: Final = 1e-8
#: Number of Newton's steps of a vertex to the surface.
_TO_SURFACE: Final = 3


class Evaluated(Protocol):
    """Function of points that is negative inside: a built shape, or one like it."""

    def evaluate(self, points: Floats) -> Floats:
        """Return its values [m] at points (n, 3) [m]."""


def sharpened(
    shape: Evaluated,
    vertices: Floats,
    triangles: Triangles,
    step: float,
    settled: float = 0.0,
) -> tuple[Floats, Triangles]:
    """Restore edges and corners of a surface that marching cubes traced.

    Vertices move to the surface. Each edge of the mesh that crosses a ridge is split where the
    planes at its ends meet, nearest to its middle; a triangle of three such edges gets a vertex
    where the three planes at its corners meet. The surface stays closed.

    Parameters
    ----------
    shape
        The shape, built.
    vertices, triangles
        Traced mesh, (n, 3) in m and (t, 3).
    step
        Distance of the samples of the tracing [m].
    settled
        Value of the shape, in steps, up to which a vertex is on the surface and stays.

    References
    ----------
    Kobbelt, Botsch, Schwanecke and Seidel 2001, doi 10.1145/383259.383265: feature-sensitive
    extraction, where the vertex is the least-squares intersection of the planes.

    Examples
    --------
    >>> from voxsoft.shapes import Box, voxelize
    >>> from voxsoft.shapes.tracing import trace
    >>> box = Box(size=(1.0, 1.0, 1.0))
    >>> vertices, triangles, _ = trace([box.build()], voxelize(box, 0.25))
    >>> sharp, _ = sharpened(box.build(), vertices, triangles, 0.25 / 3)
    >>> bool(np.abs(sharp - [1, 1, 1]).max(axis=1).min() < 1e-9)
    True
    """
    moved = to_surface(shape, vertices, step, settled)
    # All corners of a triangle beside a ridge may come to lie on it: such corners are not moved.
    needles = _areas(moved, triangles) < _NEEDLE * step**2
    moved[np.unique(triangles[needles])] = vertices[np.unique(triangles[needles])]
    normals = _normals(shape, moved, step)
    edges = np.sort(triangles[:, [1, 2, 2, 0, 0, 1]].reshape(-1, 2), axis=1).astype(np.int64)
    # One number for each edge sorts faster than a pair.
    keys, of_side = np.unique(edges[:, 0] * len(moved) + edges[:, 1], return_inverse=True)
    edges = np.stack(np.divmod(keys, len(moved)), axis=1)
    of_side = of_side.reshape(-1, 3)  # the edge opposite to each corner
    bent = np.einsum("ij,ij->i", normals[edges[:, 0]], normals[edges[:, 1]]) < _RIDGE
    places = np.zeros((len(edges), 3))
    places[bent], bent[bent] = _meeting(moved[edges[bent]], normals[edges[bent]], shape, step)
    while True:
        made = _split(shape, moved, normals, triangles, of_side, bent, places, step)
        needles = _areas(made.vertices, made.triangles) < _NEEDLE * step**2
        spoiled = np.unique(of_side[made.parents[needles]])
        if not bent[spoiled].any():
            return made.vertices, made.triangles
        bent[spoiled] = False


class _Split(NamedTuple):
    """Mesh after its edges were split, with the parent of each of its triangles."""

    vertices: Floats
    triangles: Triangles
    parents: Triangles


def _split(
    shape: Evaluated,
    vertices: Floats,
    normals: Floats,
    triangles: Triangles,
    of_side: Triangles,
    bent: NDArray[np.bool_],
    places: Floats,
    step: float,
) -> _Split:
    """Split the bent edges at given places, and their triangles."""
    split = np.full(len(bent), -1, dtype=np.int64)
    split[bent] = len(vertices) + np.arange(int(bent.sum()))
    found = np.concatenate([vertices, places[bent]])
    cut = split[of_side]  # (t, 3), -1 where a side is whole
    number = (cut >= 0).sum(axis=1)
    whole, once, twice, thrice = (np.flatnonzero(number == n) for n in range(4))
    corners = triangles[thrice]
    middles, met = _meeting(vertices[corners], normals[corners], shape, step)
    middles = np.where(met[:, None], middles, found[cut[thrice]].mean(axis=1))
    first = len(found)
    found = np.concatenate([found, middles])
    made = [
        (triangles[whole], whole, 1),
        (_halves(triangles[once], cut[once]), once, 2),
        (_thirds(triangles[twice], cut[twice], found), twice, 3),
        (_sixths(corners, cut[thrice], first + np.arange(len(thrice))), thrice, 6),
    ]
    parents = np.concatenate([np.tile(rows, times) for _, rows, times in made])
    return _Split(found, np.concatenate([each for each, _, _ in made]), parents)


def _areas(vertices: Floats, triangles: Triangles) -> Floats:
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    areas: Floats = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2.0
    return areas


def to_surface(shape: Evaluated, points: Floats, step: float, settled: float = 0.0) -> Floats:
    """Move points near a surface onto it, by Newton's steps of at most one `step` [m].

    Points with values up to `settled`, in steps, are on it; by default all of them move on.
    """
    points = points.copy()
    left = np.arange(len(points))
    for _ in range(_TO_SURFACE):
        values = shape.evaluate(np.ascontiguousarray(points[left]))
        if settled > 0.0:
            off = ~(np.abs(values) <= settled * step)
            left, values = left[off], values[off]
        slopes = _slopes(shape, points[left], step)
        squares = np.einsum("ij,ij->i", slopes, slopes)
        good = np.isfinite(values) & (squares > 1e-12)
        moves = np.where(good, values / np.where(good, squares, 1.0), 0.0)[:, None] * slopes
        lengths = np.linalg.norm(moves, axis=1, keepdims=True)
        points[left] -= moves * np.minimum(1.0, step / np.maximum(lengths, 1e-300))
    return points


def _slopes(shape: Evaluated, points: Floats, step: float) -> Floats:
    reach = _DIFFERENCE * step
    ways = reach * np.eye(3)
    sides = np.stack([points[:, None] + ways, points[:, None] - ways], axis=1)
    values = shape.evaluate(np.ascontiguousarray(sides.reshape(-1, 3))).reshape(-1, 2, 3)
    slopes: Floats = np.nan_to_num((values[:, 0] - values[:, 1]) / (2.0 * reach))
    return slopes


def _normals(shape: Evaluated, points: Floats, step: float) -> Floats:
    slopes = _slopes(shape, points, step)
    lengths = np.linalg.norm(slopes, axis=1, keepdims=True)
    normals: Floats = slopes / np.where(lengths > 0.0, lengths, 1.0)
    return normals


def _meeting(
    points: Floats, normals: Floats, shape: Evaluated, step: float
) -> tuple[Floats, NDArray[np.bool_]]:
    """Intersect planes through points (e, k, 3), nearest to their middle; True on a ridge."""
    if not len(points):
        return np.zeros((0, 3)), np.zeros(0, dtype=bool)
    middle = points.mean(axis=1)
    heights = np.einsum("eki,eki->ek", points - middle[:, None], normals)
    # The shortest displacement that satisfies all planes; nearly parallel ones count as one.
    ways = np.einsum("eik,ek->ei", np.linalg.pinv(normals, rcond=0.1), heights)
    places = middle + ways
    off = np.abs(shape.evaluate(np.ascontiguousarray(places)))
    near = np.linalg.norm(ways, axis=1) < _REACH * step
    return places, near & (off < _OFF * step)


def _halves(triangles: Triangles, cut: Triangles) -> Triangles:
    """Return the parts of triangles with one split side."""
    corner = (cut >= 0).argmax(axis=1)
    a, b, c = _turned(triangles, corner)
    new = cut[np.arange(len(cut)), corner]
    return np.concatenate([np.stack([a, b, new], 1), np.stack([a, new, c], 1)])


def _thirds(triangles: Triangles, cut: Triangles, vertices: Floats) -> Triangles:
    """Return the parts of triangles with two split sides: the ridge goes from one to the other."""
    corner = (cut < 0).argmax(axis=1)  # opposite to the whole side
    a, b, c = _turned(triangles, corner)
    on_ca, on_ab = (cut[np.arange(len(cut)), (corner + k) % 3] for k in (1, 2))
    tip = np.stack([a, on_ab, on_ca], 1)
    # The four-sided rest is cut along its shorter diagonal.
    first = np.linalg.norm(vertices[on_ab] - vertices[c], axis=1)
    shorter = (first <= np.linalg.norm(vertices[b] - vertices[on_ca], axis=1))[:, None]
    one = np.where(shorter, np.stack([on_ab, b, c], 1), np.stack([on_ab, b, on_ca], 1))
    other = np.where(shorter, np.stack([on_ab, c, on_ca], 1), np.stack([b, c, on_ca], 1))
    return np.concatenate([tip, one, other])


def _sixths(triangles: Triangles, cut: Triangles, middle: Triangles) -> Triangles:
    """Return the parts of triangles with three split sides, around a vertex in the middle."""
    rows = []
    for corner in range(3):
        after, before = cut[:, (corner + 2) % 3], cut[:, (corner + 1) % 3]
        rows.append(np.stack([triangles[:, corner], after, middle], 1))
        rows.append(np.stack([before, triangles[:, corner], middle], 1))
    return np.concatenate(rows)


def _turned(triangles: Triangles, corner: Triangles) -> tuple[Triangles, Triangles, Triangles]:
    """Return the corners of triangles in their order, beginning with a given one of each."""
    rows = np.arange(len(triangles))
    a, b, c = (triangles[rows, (corner + k) % 3] for k in range(3))
    return a, b, c
