"""Samples of a solid on a regular grid, and triangles of its surface."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.fabrication.fields import Field, Floats
from voxsoft.shapes.sharpening import sharpened
from voxsoft.shapes.tracing import contour

Ints = NDArray[np.int64]

#: Distance of the first sample from a corner of the body, in steps. Samples on a plane side would
#: have a random sign, and sides lie on round numbers more often than anywhere else.
_OFFSET: Final = 0.5 + 0.0137
#: Points that are evaluated at once, which bounds the memory.
_PORTION: Final = 1_000_000
#: Distance from a surface, in steps, from which the nearest sample stands for its neighborhood: a
#: function whose slope is at most one changes by less than a step from there to the sample.
_NEAR: Final = 3.0
#: Divisions of a cell along each axis where volumes are counted.
_DIVISIONS: Final = 2
#: Distance from a surface, in steps, within which samples count as outside.
_ON_SURFACE: Final = 1e-5
#: Distance from a surface, in steps, within which a vertex stays: flat sides are there at once.
_SETTLED: Final = 1e-6


@dataclass(frozen=True)
class Grid:
    """Regular grid of samples.

    Attributes
    ----------
    first
        Position of the first sample [m].
    step
        Distance of samples [m].
    shape
        Number of samples along each axis.
    """

    first: tuple[float, float, float]
    step: float
    shape: tuple[int, int, int]

    @classmethod
    def around(cls, low: Floats, high: Floats, step: float, margin: float) -> Grid:
        """Return a grid over a box [m] and a margin [m] around it.

        Examples
        --------
        >>> Grid.around(np.zeros(3), np.array([1.0, 1.0, 2.0]), 0.5, 0.0).shape
        (5, 5, 7)
        """
        before = np.ceil(margin / step) + 1
        first = low - (before - _OFFSET) * step
        count = np.ceil((high + margin - first) / step).astype(int) + 2
        x, y, z = (int(n) for n in count)
        return cls((float(first[0]), float(first[1]), float(first[2])), step, (x, y, z))

    def along(self, axis: int) -> Floats:
        """Return positions [m] of the samples along an axis."""
        return self.first[axis] + self.step * np.arange(self.shape[axis], dtype=np.float64)

    def points(self, where: Ints | Floats) -> Floats:
        """Return positions (n, 3) [m] of samples given by their indices (n, 3)."""
        found: Floats = np.array(self.first) + self.step * where
        return found

    def values(self, solid: Field) -> Floats:
        """Return the values of a solid at all samples, (nx, ny, nz) [m]."""
        total = int(np.prod(self.shape))
        values = np.empty(total)
        for start in range(0, total, _PORTION):
            flat = np.arange(start, min(start + _PORTION, total))
            where = np.column_stack(np.unravel_index(flat, self.shape))
            values[flat] = solid.evaluate(self.points(where))
        return values.reshape(self.shape)

    def padded(self, before: Ints, after: Ints) -> Grid:
        """Return the grid with more samples before the first and after the last, (3,) each."""
        first = np.array(self.first) - self.step * before
        nx, ny, nz = (int(n) for n in np.array(self.shape) + before + after)
        return Grid((float(first[0]), float(first[1]), float(first[2])), self.step, (nx, ny, nz))

    def nearest(self, points: Floats) -> tuple[Ints, Ints, Ints]:
        """Return indices of the samples nearest to points (n, 3)."""
        where = np.rint((points - np.array(self.first)) / self.step).astype(np.int64)
        i, j, k = np.clip(where, 0, np.array(self.shape) - 1).T
        return i, j, k


@dataclass(frozen=True, eq=False)
class Sampled:
    """Solid that is evaluated near its surface alone; farther away the nearest sample will do.

    Attributes
    ----------
    of
        The solid.
    grid
        Samples.
    values
        Its values there, (nx, ny, nz) [m].
    """

    of: Field
    grid: Grid
    values: Floats = field(repr=False)

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]; their signs are exact."""
        values: Floats = self.values[self.grid.nearest(points)]
        near = np.abs(values) < _NEAR * self.grid.step
        values[near] = self.of.evaluate(points[near])
        return values


def counted_volume(solid: Sampled) -> tuple[float, float]:
    """Return the volume [m³] of a sampled solid and its noise, from signs and not from triangles.

    Cells that the surface may cross are divided in eight; each of these counts by the sign at a
    point that is drawn in it, always alike for one grid. So no side that lies along the grid is
    favored, and the noise is half a division for each one that the surface crosses, added as
    squares.

    Examples
    --------
    >>> from voxsoft.fabrication.fields import Box
    >>> cube = Box((0.0, 0.0, 0.0), (0.01, 0.01, 0.01))
    >>> grid = Grid.around(np.zeros(3), np.full(3, 0.01), 0.0005, 0.001)
    >>> volume, noise = counted_volume(Sampled(cube, grid, grid.values(cube)))
    >>> bool(abs(volume - 1e-6) < 4 * noise < 1e-8)
    True
    """
    grid, fine = solid.grid, solid.grid.step / _DIVISIONS
    near = np.abs(solid.values) < grid.step
    count = int(((solid.values < 0.0) & ~near).sum()) * _DIVISIONS**3
    crossed = 0
    drawn = np.random.default_rng(0)
    corners = np.stack(np.meshgrid(*[np.arange(_DIVISIONS)] * 3), axis=-1).reshape(-1, 3)
    cells = np.argwhere(near)
    for start in range(0, len(cells), _PORTION // len(corners)):
        centers = grid.points(cells[start : start + _PORTION // len(corners)])
        places = corners + drawn.random((len(centers), len(corners), 3))
        points = centers[:, None] + places * fine - grid.step / 2.0
        values = solid.of.evaluate(points.reshape(-1, 3))
        count += int((values < 0.0).sum())
        crossed += int((np.abs(values) < fine).sum())
    return count * fine**3, 0.5 * fine**3 * float(np.sqrt(crossed))


@dataclass(frozen=True, eq=False)
class Surface:
    """Closed surface of triangles.

    Attributes
    ----------
    vertices : ndarray, shape (n, 3)
        In m.
    triangles : ndarray, shape (t, 3)
        Outward.
    """

    vertices: Floats = field(repr=False)
    triangles: Ints = field(repr=False)

    @property
    def volume(self) -> float:
        """Enclosed volume [m³]."""
        a, b, c = (self.vertices[self.triangles[:, k]] for k in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)

    @property
    def is_closed(self) -> bool:
        """True where each side of a triangle belongs to exactly one other, in the other sense."""
        sides = self.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        count = len(self.vertices)
        there = np.sort(sides[:, 0] * count + sides[:, 1])
        back = np.sort(sides[:, 1] * count + sides[:, 0])
        return bool(len(there) > 0 and np.array_equal(there, back))

    def divided(self) -> list[Surface]:
        """Return its connected sets of triangles."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        sides = self.triangles[:, [0, 1, 1, 2]].reshape(-1, 2)
        count = len(self.vertices)
        graph = coo_array((np.ones(len(sides)), (sides[:, 0], sides[:, 1])), shape=(count, count))
        _, labels = connected_components(graph, directed=False)
        of = labels[self.triangles[:, 0]]
        found = []
        for label in np.unique(of):
            used, corners = np.unique(self.triangles[of == label], return_inverse=True)
            found.append(Surface(self.vertices[used], corners.reshape(-1, 3).astype(np.int64)))
        return found

    @property
    def components(self) -> int:
        """Number of its connected sets of triangles."""
        return len(self.divided())

    @property
    def bounds(self) -> tuple[Floats, Floats]:
        """Lowest and highest corner [m]."""
        return self.vertices.min(axis=0), self.vertices.max(axis=0)


def extents(values: Floats, grid: Grid) -> tuple[Floats, Floats]:
    """Return the lowest and highest corner [m] of a sampled solid.

    Flat sides are exact to a micrometer; a sharp edge or tip is cut by part of a step.
    """
    vertices, _ = contour(_off_zero(values, grid.step), np.array(grid.first), grid.step)
    low, high = (np.round(each, 6) for each in (vertices.min(axis=0), vertices.max(axis=0)))
    return low, high


def _off_zero(values: Floats, step: float) -> Floats:
    moved: Floats = np.where(np.abs(values) < _ON_SURFACE * step, _ON_SURFACE * step, values)
    return moved


def surface_of(solid: Field, grid: Grid, values: Floats | None = None) -> Surface:
    """Return the surface of a solid: traced by marching cubes, with its edges restored.

    Parameters
    ----------
    solid
        The solid.
    grid
        Samples, which reach beyond it on all sides.
    values
        Its values at the samples, where they are known, (nx, ny, nz) [m].

    Examples
    --------
    >>> from voxsoft.fabrication.fields import Box
    >>> cube = Box((0.0, 0.0, 0.0), (0.01, 0.01, 0.01))
    >>> found = surface_of(cube, Grid.around(np.zeros(3), np.full(3, 0.01), 0.001, 0.001))
    >>> found.is_closed, round(found.volume * 1e6, 6)
    (True, 1.0)
    """
    values = grid.values(solid) if values is None else values
    blunt = traced(grid, values)
    if not len(blunt.triangles):
        return blunt
    sharp, corners = sharpened(solid, blunt.vertices, blunt.triangles, grid.step, _SETTLED)
    return Surface(sharp, corners.astype(np.int64))


def traced(grid: Grid, values: Floats) -> Surface:
    """Return the surface that marching cubes trace between samples, whose edges are cut."""
    vertices, triangles = contour(_off_zero(values, grid.step), np.array(grid.first), grid.step)
    if not len(triangles):
        return Surface(np.zeros((0, 3)), np.zeros((0, 3), np.int64))
    return Surface(vertices, triangles.astype(np.int64))
