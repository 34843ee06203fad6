"""Surfaces between labeled samples as one net, which the regions on its two sides share.

The method is dual contouring: each cell of eight samples that are not all alike gets a point, and
each pair of neighboring samples with different labels a quadrilateral between the four cells around
it. The point lies where the planes through the crossings of the cell's edges meet best, so that
edges and corners of shapes are kept.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Labels = NDArray[np.uint8]
#: Function of pairs of samples that differ: their positions, (k, 3) each, and labels, (k,) each. It
#: returns where the surface passes between them, (k, 3), and its normals, zero where unknown.
Crossings = Callable[[Floats, Floats, Labels, Labels], tuple[Floats, Floats]]

#: Part of the largest eigenvalue below which planes do not fix a point along an axis.
_FLAT: Final = 0.02
#: Distance of a point from the faces of its cell, in steps.
_INSIDE: Final = 0.02
#: Steps of :func:`with_volumes`, and the relative error of a volume at which it ends.
_MOVES, _EXACT = 40, 1e-5


#: Corners of a cube of samples.
_CORNERS: Final[Ints] = np.array([[c >> 2 & 1, c >> 1 & 1, c & 1] for c in range(8)])
#: Pairs of corners that may touch alone, and the corners between them: across a face, or the cube.
_TOUCHING: Final[list[tuple[tuple[int, int], list[int]]]] = [
    *(
        ((a, b), [c for c in range(8) if c not in (a, b) and (c & keep) == (a & keep)])
        for keep in (4, 2, 1)
        for a in range(8)
        for b in range(a + 1, 8)
        if (a ^ b) == 7 - keep
    ),
    *(((a, 7 - a), [c for c in range(8) if c not in (a, 7 - a)]) for a in range(4)),
]


class Net(NamedTuple):
    """Points (n, 3), triangles (t, 3), and the labels behind and before each triangle, (t, 2)."""

    points: Floats
    triangles: Ints
    sides: Labels

    def around(self, label: int) -> Ints:
        """Return the triangles around a region, pointing out of it, (t, 3)."""
        behind, before = (self.triangles[self.sides[:, side] == label] for side in (0, 1))
        return np.concatenate([behind, before[:, ::-1]])


def measures(net: Net, count: int) -> tuple[Floats, Floats]:
    """Return the volume of each region but 0, and the areas between regions.

    Parameters
    ----------
    net
        The net.
    count
        Largest label.

    Returns
    -------
    tuple
        Volumes, (count,), and areas, (count + 1, count + 1), in units of the points.
    """
    points = net.points - net.points.mean(axis=0)
    a, b, c = (points[net.triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a) / 2.0
    volumes = np.einsum("ij,ij->i", a, normals) / 3.0
    behind, before = net.sides.astype(np.int64).T
    held: Floats = np.bincount(behind, volumes, count + 1).astype(np.float64)
    held -= np.bincount(before, volumes, count + 1)
    at = behind * (count + 1) + before
    areas: Floats = np.bincount(at, np.linalg.norm(normals, axis=1), (count + 1) ** 2).astype(float)
    square = areas.reshape(count + 1, count + 1)
    return held[1:], square + square.T


def with_volumes(net: Net, volumes: Floats) -> Net:
    """Move the surface along its normals until each region but 0 has a given volume.

    Each region pushes on all sides alike, and gives way to others that push more. The best of the
    steps is returned where the volumes are not reached.

    Parameters
    ----------
    net
        The net.
    volumes
        Volume of the regions 1, 2, ..., (p,), in units of the points.

    Examples
    --------
    >>> labels = np.zeros((4, 4, 4), dtype=np.uint8)
    >>> labels[1:3, 1:3, 1:3] = 1
    >>> net = net_of(labels, np.zeros(3), 1.0, lambda a, b, _, __: ((a + b) / 2, b - a))
    >>> found, _ = measures(with_volumes(net, np.array([8.1])), 1)
    >>> found.round(3).tolist()
    [8.1]
    """
    count = len(volumes)
    behind, before = net.sides.astype(np.int64).T
    best, least = net, np.inf
    for _ in range(_MOVES):
        held, areas = measures(net, count)
        there = areas.sum(axis=1)[1:] > 0.0
        error = np.where(there, volumes - held, 0.0)
        worst = float(np.max(np.abs(error) / np.maximum(np.abs(volumes), 1e-300), initial=0.0))
        if worst < least:
            best, least = net, worst
        if least < _EXACT:
            break
        matrix = np.diag(np.where(there, areas.sum(axis=1)[1:], 1.0)) - areas[1:, 1:]
        push = np.concatenate([[0.0], np.linalg.lstsq(matrix, error, rcond=None)[0]])
        net = net._replace(points=_moved(net, push[behind] - push[before]))
    return best


def _moved(net: Net, ways: Floats) -> Floats:
    """Move points by the mean way of the triangles around each, along their normals."""
    a, b, c = (net.points[net.triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    owner, count = net.triangles.ravel(), len(net.points)
    sizes = np.linalg.norm(normals, axis=1)
    total = np.bincount(owner, np.repeat(sizes, 3), count)
    moves = [np.bincount(owner, np.repeat(ways * normals[:, axis], 3), count) for axis in range(3)]
    found: Floats = net.points + np.stack(moves, axis=1) / np.maximum(total, 1e-300)[:, None]
    return found


def closed(labels: Labels) -> Labels:
    """Change labels of samples until each region has a surface without edges or points in common.

    Two samples of one region that touch along an edge, or at a corner, between others, would give
    an edge of four triangles, or a point of two fans. A sample then takes a label that comes
    earlier: 1, 2, ..., and 0 at last.

    Parameters
    ----------
    labels
        Labels of the samples, (nx, ny, nz).

    Examples
    --------
    >>> closed(np.array([[[1], [0]], [[0], [1]]], dtype=np.uint8)).ravel().tolist()
    [1, 1, 0, 1]
    """
    ranks = np.pad((labels - 1).astype(np.uint8), 1, mode="edge")  # 0 comes last
    flat = ranks.reshape(-1)
    way = np.array([ranks.shape[1] * ranks.shape[2], ranks.shape[2], 1])
    while True:
        cubes = np.flatnonzero(_mixed(ranks))
        at = cubes[:, None] + _CORNERS @ way
        found = flat[at]
        places, values = [], []
        for pair, others in _TOUCHING:
            own = found[:, pair[0]]
            beside = found[:, others]
            rows = np.flatnonzero((own == found[:, pair[1]]) & (beside != own[:, None]).all(axis=1))
            own, beside = own[rows], beside[rows]
            # The latest of the others joins, else the pair is given up.
            latest = beside.argmax(axis=1)
            joins = beside.max(axis=1, initial=0) > own
            places.append(at[rows, np.where(joins, np.array(others)[latest], pair[0])])
            values.append(np.where(joins, own, beside.min(axis=1, initial=255)))
        changed = np.concatenate(places)
        if not len(changed):
            return (ranks[1:-1, 1:-1, 1:-1] + 1).astype(np.uint8)
        np.minimum.at(flat, changed, np.concatenate(values).astype(np.uint8))


def _mixed(values: Labels) -> NDArray[np.bool_]:
    """Return True for the first sample of each cube of eight that are not alike."""
    low = high = values
    for axis in range(3):
        after = np.roll(low, -1, axis), np.roll(high, -1, axis)
        low, high = np.minimum(low, after[0]), np.maximum(high, after[1])
    mixed: NDArray[np.bool_] = low != high
    mixed[-1], mixed[:, -1], mixed[:, :, -1] = False, False, False
    return mixed


def net_of(labels: Labels, first: Floats, step: float, crossings: Crossings) -> Net:
    """Return the surface between regions of samples.

    Parameters
    ----------
    labels
        Labels of the samples, (nx, ny, nz), alike on all sides of the grid.
    first
        Position of the first sample [m].
    step
        Distance from one sample to the next [m].
    crossings
        Places of the surface between samples.

    Examples
    --------
    >>> labels = np.zeros((4, 4, 4), dtype=np.uint8)
    >>> labels[1:3, 1:3, 1:3] = 1
    >>> def middles(a, b, _, __):
    ...     return (a + b) / 2, b - a
    >>> net = net_of(labels, np.zeros(3), 1.0, middles)
    >>> net.points.min(axis=0).tolist(), len(net.around(1))
    ([0.5, 0.5, 0.5], 48)
    """
    quads, sides, ends = [], [], []
    for axis in range(3):
        low, high = _pair(labels, axis)
        at = np.argwhere(low != high)
        step_up = np.eye(3, dtype=np.int64)[axis]
        b, c = (np.eye(3, dtype=np.int64)[(axis + k) % 3] for k in (1, 2))
        corners = np.stack([at - b - c, at - c, at, at - b], axis=1)
        quads.append(np.ravel_multi_index(tuple(np.moveaxis(corners, -1, 0)), labels.shape))
        sides.append(np.stack([labels[tuple(at.T)], labels[tuple((at + step_up).T)]], axis=1))
        ends.append(np.stack([at, at + step_up], axis=1))
    side, end = np.concatenate(sides), np.concatenate(ends)
    cells, index = np.unique(np.concatenate(quads), return_inverse=True)
    quad = index.reshape(-1, 4)
    places, normals = crossings(
        first + step * end[:, 0], first + step * end[:, 1], side[:, 0], side[:, 1]
    )
    corner = first + step * np.column_stack(np.unravel_index(cells, labels.shape))
    points = _points(places, normals, quad, corner, step)
    return Net(points, *_halved(points, quad, side))


def _pair(values: NDArray[Any], axis: int) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return each sample but the last along an axis, and the one after it."""
    turned = np.moveaxis(values, axis, 0)
    return np.moveaxis(turned[:-1], 0, axis), np.moveaxis(turned[1:], 0, axis)


def _points(places: Floats, normals: Floats, quad: Ints, corner: Floats, step: float) -> Floats:
    """Return the point of each cell: of all at the mean of its crossings, nearest to its planes."""
    count = len(corner)
    owner = quad.ravel()

    def summed(values: Floats) -> Floats:
        return np.bincount(owner, np.repeat(values, 4), count).astype(np.float64)

    number = summed(np.ones(len(places)))
    mean = np.stack([summed(places[:, i]) for i in range(3)], axis=1) / number[:, None]
    matrix, right = np.empty((count, 3, 3)), np.empty((count, 3))
    heights = np.einsum("ij,ij->i", normals, places)
    for i in range(3):
        right[:, i] = summed(normals[:, i] * heights)
        for j in range(i, 3):
            matrix[:, i, j] = matrix[:, j, i] = summed(normals[:, i] * normals[:, j])
    values, vectors = np.linalg.eigh(matrix)
    rest = np.einsum("nji,nj->ni", vectors, right - np.einsum("nij,nj->ni", matrix, mean))
    firm = values > np.maximum(_FLAT * values[:, -1:], 1e-12)
    way = np.einsum("nij,nj->ni", vectors, np.where(firm, rest / np.where(firm, values, 1.0), 0.0))
    # A point outside its cell would cross others: it stays on the way there.
    low, high = corner + _INSIDE * step, corner + (1.0 - _INSIDE) * step
    mean = np.clip(mean, low, high)
    with np.errstate(divide="ignore", invalid="ignore"):
        room = np.where(way > 0.0, (high - mean) / way, np.where(way < 0.0, (low - mean) / way, 1))
    found: Floats = mean + np.clip(room.min(axis=1), 0.0, 1.0)[:, None] * way
    return found


def _halved(points: Floats, quad: Ints, side: Labels) -> tuple[Ints, Labels]:
    """Cut quadrilaterals along their shorter diagonal."""
    a, b, c, d = (points[quad[:, k]] for k in range(4))
    shorter = (np.linalg.norm(c - a, axis=1) <= np.linalg.norm(d - b, axis=1))[:, None]
    one = np.where(shorter, quad[:, [0, 1, 2]], quad[:, [0, 1, 3]])
    other = np.where(shorter, quad[:, [0, 2, 3]], quad[:, [1, 2, 3]])
    return np.concatenate([one, other]).astype(np.int64), np.concatenate([side, side])
