"""Interpolation of points of a body: vertices and weights that move a point with the material."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.mesh import Mesh

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

#: Largest distance of a point outside of the voxels, in voxels: a true surface lies up to half a
#: voxel beyond the voxels that stand for it. The nearest point of a voxel carries it then.
_REACH: Final = 0.5 * (1 + 1e-6)
#: Largest number of points along the radius of a ball: about 4,000 in all.
_MOST_ACROSS: Final = 10


@dataclass(frozen=True, eq=False)
class Carrier(ABC):
    """A mesh that carries points."""

    mesh: Mesh

    @property
    @abstractmethod
    def size(self) -> float:
        """Size of its elements [m]."""

    @abstractmethod
    def nearest(self, point: Floats) -> tuple[Integers, Floats, float]:
        """Find vertices and weights of the nearest material point, and its distance [m].

        The distance from the point (3,) is infinite where no element is near.
        """

    def distance(self, point: Floats) -> float:
        """Measure the distance of a point from the body [m], infinite where it is far."""
        return self.nearest(point)[2]

    def place(self, point: Floats, radius: float | None = None) -> tuple[Integers, Floats] | None:
        """Find vertices and weights that carry a point [m], (3,); None for one outside.

        With a radius [m] they average over the part of a ball around the point in the body.
        """
        found = [self.nearest(point)]
        if found[0][2] > _REACH * self.size:
            return None
        if radius is not None:
            inside = [self.nearest(each) for each in self._ball(point, radius)]
            found = [each for each in inside if each[2] == 0.0] or found
        vertices, which = np.unique(
            np.concatenate([vertices for vertices, _, _ in found]), return_inverse=True
        )
        weights = np.bincount(which, weights=np.concatenate([each[1] for each in found]))
        kept = np.abs(weights) > 1e-12
        return vertices[kept], weights[kept] / len(found)

    def _ball(self, point: Floats, radius: float) -> Floats:
        """Return evenly spaced points in a ball, by half an element or a quarter radius, (n, 3)."""
        step = min(0.5 * self.size, 0.25 * radius)
        count = int(radius / step)
        if count > _MOST_ACROSS:
            step, count = radius / _MOST_ACROSS, _MOST_ACROSS
        along = step * np.arange(-count, count + 1)
        grid = np.stack(np.meshgrid(along, along, along, indexing="ij"), axis=-1).reshape(-1, 3)
        within: Floats = point + grid[np.linalg.norm(grid, axis=1) <= radius * (1 + 1e-9)]
        return within


@dataclass(frozen=True, eq=False)
class _Voxels(Carrier):
    """Voxels, in which a displacement is linear along each axis."""

    @property
    def size(self) -> float:
        assert self.mesh.voxel_size is not None
        return float(self.mesh.voxel_size)

    @cached_property
    def _low(self) -> Floats:
        return np.asarray(self.mesh.vertices.min(axis=0))

    @cached_property
    def _cells(self) -> dict[tuple[int, ...], Integers]:
        """Corners of each voxel, z fastest, by its cell of the grid."""
        mesh = self.mesh
        assert mesh.tet_voxel is not None
        # The corners of five tets, each several times: sorted by voxel, then taken once.
        order = np.argsort(mesh.tet_voxel, kind="stable")
        corners = mesh.tets[order].reshape(-1, 20).astype(np.int64)
        where = np.rint((mesh.vertices - self._low) / self.size).astype(np.int64)
        lowest = where[corners].min(axis=1)
        step = where[corners] - lowest[:, None]
        found = np.zeros((len(corners), 8), np.int64)
        rows = np.arange(len(corners))[:, None]
        found[rows, 4 * step[..., 0] + 2 * step[..., 1] + step[..., 2]] = corners
        return dict(zip(map(tuple, lowest.tolist()), found, strict=True))

    def nearest(self, point: Floats) -> tuple[Integers, Floats, float]:
        at = (point - self._low) / self.size
        middle = np.floor(at).astype(int)
        best: tuple[Integers, Floats, float] = np.zeros(0, int), np.zeros(0), np.inf
        for step in sorted(product((0, -1, 1), repeat=3), key=lambda way: sum(map(abs, way))):
            cell = middle + step
            corners = self._cells.get(tuple(cell.tolist()))
            if corners is None:
                continue
            inner = np.clip(at - cell, 0.0, 1.0)
            distance = float(np.linalg.norm(at - cell - inner)) * self.size
            if distance < best[2]:
                x, y, z = (np.array([1.0 - part, part]) for part in inner)
                weights = (x[:, None, None] * y[:, None] * z).ravel()
                best = corners, weights, distance
            if distance == 0.0:
                break
        return best


@dataclass(frozen=True, eq=False)
class _Tets(Carrier):
    """Tetrahedra of any mesh."""

    @cached_property
    def size(self) -> float:
        """The edge of a cube with five mean tetrahedra [m]."""
        return float(np.cbrt(5.0 * self.mesh.quality.volume / len(self.mesh.tets)))

    @cached_property
    def _frames(self) -> tuple[Floats, Floats]:
        corners: Floats = self.mesh.vertices[self.mesh.tets]
        edges = np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2)
        inverse: Floats = np.asarray(np.linalg.inv(edges), dtype=np.float64)
        return corners, inverse

    def nearest(self, point: Floats) -> tuple[Integers, Floats, float]:
        corners, inverse = self._frames
        inner = np.einsum("tij,tj->ti", inverse, point - corners[:, 0])
        weights = np.column_stack([1.0 - inner.sum(axis=1), inner])
        best = int(np.argmax(weights.min(axis=1)))
        clipped = np.clip(weights[best], 0.0, None)
        clipped /= clipped.sum()
        distance = float(np.linalg.norm(clipped @ corners[best] - point))
        if distance < 1e-9 * self.size:
            distance = 0.0
        return self.mesh.tets[best].astype(np.int64), clipped, distance


def carrier_of(mesh: Mesh) -> Carrier:
    """Return the carrier of points of a mesh: by voxels, or else by tetrahedra.

    Examples
    --------
    >>> from voxsoft.voxels import Voxels
    >>> carrier = carrier_of(Voxels.from_array([[[1]]], voxel_size=0.5).mesh())
    >>> vertices, weights = carrier.place(np.array([0.25, 0.25, 0.5]))
    >>> len(vertices), float(weights.sum())
    (4, 1.0)
    >>> carrier.place(np.array([0.25, 0.25, 1.0])) is None
    True
    """
    return _Tets(mesh) if mesh.voxel_size is None or mesh.tet_voxel is None else _Voxels(mesh)
