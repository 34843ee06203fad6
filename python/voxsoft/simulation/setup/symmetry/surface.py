"""Surfaces made symmetric: cut at planes, and one side mirrored to the other."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design.symmetry import Symmetry
from voxsoft.simulation.setup.distance import Surface

Floats = NDArray[np.float64]
Triangles = NDArray[np.uint32]

#: Distance from a plane within which vertices are moved into it, in steps of the grid that a
#: surface was traced on: cuts beside them would leave slivers.
_SNAP: Final = 1e-3


def symmetric(surface: Surface, planes: Iterable[Symmetry], step: float) -> Surface:
    """Make a closed surface its own mirror image, from its positive side.

    The triangulation of a traced surface is not symmetric, even where its shape is.

    Parameters
    ----------
    surface
        A closed surface, symmetric up to tracing.
    planes
        Planes in which it is symmetric.
    step
        Step of the grid that it was traced on [m].

    Returns
    -------
    Surface
        A closed surface, its vertices and triangles mirror images of each other.

    Examples
    --------
    >>> corners = np.array([(0, 0, 1), (2, 0, 0), (-1, 2, 0), (-1, -2, 0)], dtype=float)
    >>> faces = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)], dtype=np.uint32)
    >>> found = symmetric(Surface(corners, faces), [Symmetry(plane="y")], 0.1)
    >>> len(found.vertices), len(found.triangles)
    (5, 6)
    """
    planes = list(planes)
    for plane in planes:
        surface = _cut(surface, plane, _SNAP * step)
    for plane in planes:
        surface = _with_image(surface, plane)
    return surface


def image_of(surface: Surface, plane: Symmetry) -> Surface:
    """Return the mirror image of a surface, outward as before."""
    vertices = surface.vertices.copy()
    vertices[:, plane.axis] = 2.0 * plane.at - vertices[:, plane.axis]
    return Surface(vertices, np.ascontiguousarray(surface.triangles[:, ::-1]))


def _cut(surface: Surface, plane: Symmetry, snap: float) -> Surface:
    """Keep the positive side of a surface at a plane, with an open rim in it."""
    vertices = surface.vertices.copy()
    across = vertices[:, plane.axis] - plane.at
    near = np.abs(across) <= snap
    vertices[near, plane.axis] = plane.at
    side = np.where(near, 0, np.sign(across)).astype(np.int64)
    sides = side[surface.triangles]
    above, below = (sides > 0).any(axis=1), (sides < 0).any(axis=1)
    points = [vertices]
    numbers: dict[tuple[int, int], int] = {}
    pieces: list[list[int]] = []

    def crossing(a: int, b: int) -> int:
        """Return the point of an edge in the plane, one for both of its triangles."""
        key = min(a, b), max(a, b)
        if key not in numbers:
            numbers[key] = len(vertices) + len(numbers)
            first, second = key
            part = across[first] / (across[first] - across[second])
            point = (1.0 - part) * vertices[first] + part * vertices[second]
            point[plane.axis] = plane.at
            points.append(point[None])
        return numbers[key]

    for triangle in surface.triangles[above & below].tolist():
        rim: list[int] = []
        for a, b in zip(triangle, triangle[1:] + triangle[:1], strict=True):
            if side[a] >= 0:
                rim.append(a)
            if side[a] * side[b] < 0:
                rim.append(crossing(a, b))
        pieces += [[rim[0], rim[i], rim[i + 1]] for i in range(1, len(rim) - 1)]
    kept = surface.triangles[above & ~below].astype(np.int64)
    triangles = np.concatenate([kept, np.array(pieces, dtype=np.int64).reshape(-1, 3)])
    used, numbered = np.unique(triangles, return_inverse=True)
    found = numbered.reshape(-1, 3).astype(np.uint32)
    return Surface(np.concatenate(points)[used], found)


def _with_image(surface: Surface, plane: Symmetry) -> Surface:
    """Join a surface on one side of a plane with its image at the vertices in the plane."""
    image = image_of(surface, plane)
    on = surface.vertices[:, plane.axis] == plane.at
    numbers = np.arange(len(on))
    numbers[~on] = len(on) + np.arange(int((~on).sum()))
    vertices = np.concatenate([surface.vertices, image.vertices[~on]])
    mirrored: Triangles = numbers[image.triangles].astype(np.uint32)
    return Surface(vertices, np.concatenate([surface.triangles, mirrored]))
