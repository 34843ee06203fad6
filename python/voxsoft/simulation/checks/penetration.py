"""Overlaps of a body with itself and its floor, found exactly, with their depth."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.errors import MeshError
from voxsoft.mesh import Mesh

Floats = NDArray[np.float64]
Point = tuple[float, float, float]

#: Numbers of a film and of the floor among the parts of an overlap.
FILM: Final = 0
FLOOR: Final = -1


@dataclass(frozen=True)
class Overlap:
    """Overlap of a body with itself, or with its floor.

    Attributes
    ----------
    depth
        Depth in m: the distance from the deepest point of the surface to the nearest surface of the
        material that it is in.
    at_rest
        The deepest point on the unloaded body, in m.
    against
        The other point of the unloaded body that coincides with it, in m.
    at_now
        Present position of both, in m.
    parts
        Parts of both points, counted from 1; 0 is a film, -1 the floor.
    inverted
        True where nothing overlaps, but the surface is turned inside out at inverted tetrahedra.
    """

    depth: float
    at_rest: Point
    against: Point
    at_now: Point
    parts: tuple[int, int]
    inverted: bool = False

    def summary(self) -> dict[str, Any]:
        """Return plain data in SI units."""
        return {
            "depth": self.depth,
            "at_rest": list(self.at_rest),
            "against": list(self.against),
            "at_now": list(self.at_now),
            "parts": list(self.parts),
        }


@dataclass(frozen=True)
class Penetration:
    """Penetration of a body into itself or its floor.

    Attributes
    ----------
    overlaps
        The overlaps, the deepest first; empty where nothing overlaps.
    pairs
        Numbers of the triangles of the surface that pass through each other, (p, 2).
    covered
        Numbers of each vertex of the surface in other material, of the tetrahedron that it is in,
        and of the overlap, (c, 3).
    """

    overlaps: tuple[Overlap, ...] = ()
    pairs: NDArray[np.uint32] = field(
        default_factory=lambda: np.zeros((0, 2), dtype=np.uint32), repr=False
    )
    covered: NDArray[np.int32] = field(
        default_factory=lambda: np.zeros((0, 3), dtype=np.int32), repr=False
    )

    @cached_property
    def depth(self) -> float:
        """Largest depth in m; 0 where nothing overlaps."""
        return max((overlap.depth for overlap in self.overlaps), default=0.0)


def find_penetration(
    mesh: Mesh,
    positions: Floats,
    *,
    membranes: NDArray[np.int32] | None = None,
    floor: float | None = None,
) -> Penetration:
    """Find where a body overlaps itself at some positions.

    Overlaps are decided without rounding: bodies that touch to the last bit do not overlap.

    Parameters
    ----------
    mesh
        The body, of any number of components.
    positions
        Its vertices now in m, (n, 3).
    membranes
        Triangles of films between vertices of the body, (s, 3), which have no volume and which
        nothing may pass through either.
    floor
        Height of a floor in m that nothing may be below.

    Raises
    ------
    MeshError
        Positions that are not finite, or not one for each vertex.

    Examples
    --------
    >>> from voxsoft.voxels import Voxels
    >>> bar = Voxels.from_array([[[1]], [[0]], [[1]]], voxel_size=0.01).mesh()  # two, 10 mm apart
    >>> find_penetration(bar, bar.vertices).depth
    0.0
    >>> squeezed = bar.vertices * [1, 1, 1]
    >>> squeezed[bar.vertices[:, 0] > 0.015] -= [0.012, 0.002, 0.003]
    >>> round(find_penetration(bar, squeezed).depth, 12)
    0.002
    """
    now = np.ascontiguousarray(positions, dtype=np.float64)
    if now.shape != mesh.vertices.shape:
        expected = f"expected {mesh.vertices.shape}, one row for each vertex"
        raise MeshError("positions", f"have the shape {now.shape}; {expected}")
    if not np.isfinite(now).all():
        raise MeshError("positions", "are not all finite")
    films = np.zeros((0, 3), dtype=np.int32) if membranes is None else membranes
    pairs, found, covered = _core.penetration(
        mesh.vertices, now, mesh.tets, mesh.triangles, np.ascontiguousarray(films, dtype=np.int32)
    )
    overlaps = [_overlap(mesh, *overlap) for overlap in found]
    sunk = None if floor is None else _below(mesh, now, floor)
    if sunk is not None:
        place = sum(overlap.depth > sunk.depth for overlap in overlaps)
        overlaps.insert(place, sunk)
        covered[:, 2] += covered[:, 2] >= place
    return Penetration(tuple(overlaps), pairs, covered)


def _overlap(
    mesh: Mesh,
    depth: float,
    now: list[float],
    rest: list[list[float]],
    tets: list[int],
    inverted: bool,
) -> Overlap:
    own, other = (int(mesh.tet_part[tet]) if tet >= 0 else FILM for tet in tets)
    return Overlap(depth, point(rest[0]), point(rest[1]), point(now), (own, other), inverted)


def _below(mesh: Mesh, now: Floats, floor: float) -> Overlap | None:
    """Find the lowest vertex of a body, if it is below its floor."""
    lowest = int(np.argmin(now[:, 2]))
    depth = floor - float(now[lowest, 2])
    if depth <= 0.0:
        return None
    tet = int(np.flatnonzero((mesh.tets == lowest).any(axis=1))[0])
    rest, there = point(mesh.vertices[lowest]), point(now[lowest])
    return Overlap(depth, rest, rest, there, (int(mesh.tet_part[tet]), FLOOR))


def point(values: Floats | list[float]) -> Point:
    """Convert three numbers to a tuple."""
    x, y, z = values
    return float(x), float(y), float(z)
