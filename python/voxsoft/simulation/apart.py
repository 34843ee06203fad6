"""Surfaces of the unloaded design: how deep they are in each other, how near, and the way out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

#: How deep surfaces may be in each other, in voxels: rounding of surfaces that touch.
TOUCH: Final = 1e-6
#: How far behind a surface it is looked for what covers it exactly, in voxels.
_INSIDE: Final = 1e-3
#: Moves after which what still overlaps is not separated.
_MOVES: Final = 50


@dataclass(frozen=True)
class Surface:
    """A closed surface: vertices [m], (n, 3), and triangles, outward, (t, 3)."""

    vertices: NDArray[np.float64]
    triangles: NDArray[np.uint32]

    def just_inside(self, depth: float) -> NDArray[np.float64]:
        """Its vertices, and the centers of its triangles so deep [m] behind them, (n + t, 3).

        Behind its own surface nothing is in what only touches it, but all of what covers it is.
        """
        a, b, c = (self.vertices[self.triangles[:, corner]] for corner in range(3))
        normals = np.cross(b - a, c - a)
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = normals / np.where(lengths > 0.0, lengths, 1.0)
        return np.concatenate([self.vertices, (a + b + c) / 3.0 - depth * normals])

    @property
    def middle(self) -> NDArray[np.float64]:
        """Of its box [m], (3,)."""
        middle: NDArray[np.float64] = (self.vertices.min(axis=0) + self.vertices.max(axis=0)) / 2.0
        return middle

    def moved(self, way: NDArray[np.float64]) -> Surface:
        """The same somewhere else."""
        return Surface(self.vertices + way, self.triangles)


@dataclass(frozen=True)
class Overlap:
    """Two surfaces that are in each other, or how far they are apart.

    Attributes
    ----------
    depth
        Of the place that is deepest [m]; negative for the smallest distance.
    place
        Where that is [m], (3,).
    way
        From the first surface the shortest way out there [m], (3,).
    """

    depth: float
    place: NDArray[np.float64]
    way: NDArray[np.float64]


def overlap_of(first: Surface, second: Surface, voxel_size: float) -> Overlap:
    """How deep two surfaces are in each other, or how near.

    Parameters
    ----------
    first, second
        Either may be so small or so thin that no vertex of the other is in it: the centers of
        triangles are looked at too.
    voxel_size
        Of the body [m].
    """
    places, distances, ways = [], [], []
    for of, to, sign in ((first, second, 1.0), (second, first, -1.0)):
        points = of.just_inside(_INSIDE * voxel_size)
        found, nearest = _nearest(to, points)
        places.append(points)
        distances.append(found)
        ways.append(sign * (nearest - points))
    joined = np.concatenate(distances)
    deepest = int(joined.argmin())
    place, way = np.concatenate(places)[deepest], np.concatenate(ways)[deepest]
    return Overlap(-float(joined[deepest]), place, way)


def way_out(surface: Surface, others: list[Surface], voxel_size: float) -> NDArray[np.float64]:
    """The way that takes a surface out of others [m], (3,): from the deepest place on, again.

    Returns
    -------
    array
        After fifty moves as far as these went, which may be in something still.
    """
    way = np.zeros(3)
    for _ in range(_MOVES):
        found = [overlap_of(surface.moved(way), other, voxel_size) for other in others]
        worst = max(found, key=lambda each: each.depth, default=None)
        if worst is None or worst.depth <= TOUCH * voxel_size:
            return way
        # A little more than to the surface, from which rounding might lead back.
        way = way + worst.way * (1.0 + TOUCH * voxel_size / worst.depth)
    return way


def distances_to(surface: Surface, places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distances of places to a surface [m], negative inside."""
    return _nearest(surface, places)[0]


def _nearest(
    surface: Surface, places: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distances of places to a surface [m], negative inside, and the nearest points of it [m]."""
    import igl

    triangles = surface.triangles.astype(np.int64)
    tree, winding = igl.AABB(), igl.FastWindingNumberBVH()
    tree.init(surface.vertices, triangles)
    winding.init(surface.vertices, triangles)
    squared: Any
    nearest: Any
    squared, _, nearest = tree.squared_distance(surface.vertices, triangles, places)
    inside = np.abs(winding.winding_number(places)) > 0.5
    return np.where(inside, -1.0, 1.0) * np.sqrt(squared), nearest
