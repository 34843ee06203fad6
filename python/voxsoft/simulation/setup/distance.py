"""Penetration depth, distance and separation of surfaces in the unloaded design."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

#: Penetration depth up to which surfaces only touch, in voxels: rounding.
TOUCH: Final = 1e-6
#: Depth of test points behind a surface, in voxels: they detect a surface that coincides with it.
_INSIDE: Final = 1e-3
#: Largest number of moves that separate a surface from others.
_MOVES: Final = 50


@dataclass(frozen=True)
class Surface:
    """A closed surface: vertices [m], (n, 3), and triangles, outward, (t, 3)."""

    vertices: NDArray[np.float64]
    triangles: NDArray[np.uint32]

    def just_inside(self, depth: float) -> NDArray[np.float64]:
        """Return its vertices, and the centers of its triangles moved inward [m], (n + t, 3).

        Centers moved inward are outside a surface that only touches, and inside one that coincides.
        """
        a, b, c = (self.vertices[self.triangles[:, corner]] for corner in range(3))
        normals = np.cross(b - a, c - a)
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = normals / np.where(lengths > 0.0, lengths, 1.0)
        return np.concatenate([self.vertices, (a + b + c) / 3.0 - depth * normals])

    @property
    def middle(self) -> NDArray[np.float64]:
        """Middle of its bounding box [m], (3,)."""
        middle: NDArray[np.float64] = (self.vertices.min(axis=0) + self.vertices.max(axis=0)) / 2.0
        return middle

    def moved(self, way: NDArray[np.float64]) -> Surface:
        """Return the surface translated by a vector [m], (3,)."""
        return Surface(self.vertices + way, self.triangles)


@dataclass(frozen=True)
class Overlap:
    """Deepest penetration of two surfaces, or the smallest distance between them.

    Attributes
    ----------
    depth
        Penetration depth at the deepest place [m]; negative for the smallest distance.
    place
        Position of this place [m], (3,).
    way
        Shortest translation of the first surface out of the second there [m], (3,).
    """

    depth: float
    place: NDArray[np.float64]
    way: NDArray[np.float64]


def overlap_of(first: Surface, second: Surface, voxel_size: float) -> Overlap:
    """Measure the penetration depth of two surfaces, or their distance.

    Parameters
    ----------
    first, second
        Either may be so small or so thin that no vertex of the other is in it: the centers of
        triangles are tested too.
    voxel_size
        Voxel size of the body [m].
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
    """Find the translation that takes a surface out of others [m], (3,), deepest place first.

    Returns
    -------
    array
        The translation; after fifty moves the surface may still penetrate another one.
    """
    way = np.zeros(3)
    for _ in range(_MOVES):
        found = [overlap_of(surface.moved(way), other, voxel_size) for other in others]
        worst = max(found, key=lambda each: each.depth, default=None)
        if worst is None or worst.depth <= TOUCH * voxel_size:
            return way
        # Move a little beyond the surface, from which rounding might lead back.
        way = way + worst.way * (1.0 + TOUCH * voxel_size / worst.depth)
    return way


def distances_to(surface: Surface, places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Measure distances of places to a surface [m], negative inside."""
    return _nearest(surface, places)[0]


def _nearest(
    surface: Surface, places: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Measure distances of places to a surface [m], negative inside, and find nearest points."""
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
