"""Shapes from triangle meshes: closed or broken, by generalized winding numbers.

The winding number tells how often a surface wraps around a point: 1 inside a closed surface, 0
outside, −1 inside one whose faces are turned, and something between near a hole. Inside is where
its size exceeds one half [1]_. An inner shell of opposite orientation is a cavity.

References
----------
.. [1] Barill, Dickson, Schmidt, Levin, Jacobson: Fast winding numbers for soups and clouds,
   ACM Transactions on Graphics 37 (2018), doi:10.1145/3197517.3201337
"""

from __future__ import annotations

import atexit
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, Field

from voxsoft import _core
from voxsoft.errors import ShapeError
from voxsoft.shapes.base import Scope, Shape, Triple
from voxsoft.shapes.surface_files import read_surface
from voxsoft.units import parse

#: Where more than this part of the edges belong to one triangle only, nothing is enclosed.
_MOST_OPEN = 0.5


def _is_length_unit(unit: str) -> str:
    parse(f"1 {unit}", "length")
    return unit


class TriangleMesh(Shape):
    """The inside of a triangle mesh from a file: STL, OBJ, PLY, or the surface of a VTK or VTU.

    Holes and turned faces do not spoil the inside. Distances are those to the triangles.

    Examples
    --------
    >>> TriangleMesh(path="part.stl", unit="mm").kind
    'mesh'
    """

    kind: Literal["mesh"] = "mesh"
    path: str = Field(description="File: .stl, .obj, .ply, .vtk or .vtu.")
    unit: Annotated[str, AfterValidator(_is_length_unit)] = Field(
        description="Length unit of the file, such as mm; mesh files do not say it."
    )

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        solid = self._solid
        return _core.Shape.sampled(solid.distances, solid.low, solid.high, solid.is_closed)

    def open_edges(self) -> tuple[int, int]:
        """Return how many edges belong to one triangle only, and how many there are.

        Raises
        ------
        ShapeError
            The file cannot be read.
        """
        return self._solid.open_edges

    @property
    def _solid(self) -> _Solid:
        path = Path(self.path)
        try:
            changed = path.stat().st_mtime_ns
        except OSError as error:
            raise ShapeError("path", f"{path} cannot be read: {error.strerror}") from None
        return _solid(path, changed, parse(f"1 {self.unit}", "length"))


@lru_cache(maxsize=8)
def _solid(path: Path, changed: int, factor: float) -> _Solid:
    """Read a file once for as long as it does not change."""
    surface = read_surface(path)
    return _Solid(surface.points * factor, surface.triangles, str(path))


# libigl's objects must go before its module does, or it reports them as leaked.
atexit.register(_solid.cache_clear)


class _Solid:
    """Signed distances from a triangle mesh.

    Parameters
    ----------
    points
        Vertices [m], shape (n, 3).
    triangles
        Vertices of each triangle, shape (t, 3).
    name
        What error messages call it.
    """

    def __init__(
        self, points: NDArray[np.float64], triangles: NDArray[np.int64], name: str
    ) -> None:
        import igl

        self.open_edges = open_edges(triangles)
        _refuse_soup(*self.open_edges, name)
        self.is_closed = _is_closed(triangles)
        used = points[np.unique(triangles)]
        self.low: Triple = tuple(used.min(axis=0).tolist())
        self.high: Triple = tuple(used.max(axis=0).tolist())
        self._points, self._triangles = points, triangles
        self._winding = igl.FastWindingNumberBVH()
        self._winding.init(points, triangles)
        self._nearest = igl.AABB()
        self._nearest.init(points, triangles)

    def distances(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the distance of places (n, 3) to the surface [m], negative inside."""
        squared, _, _ = self._nearest.squared_distance(self._points, self._triangles, places)
        is_inside = np.abs(self._winding.winding_number(places)) > 0.5
        distance: NDArray[np.float64] = np.sqrt(np.atleast_1d(squared))
        distance[np.atleast_1d(is_inside)] *= -1
        return distance


def _is_closed(triangles: NDArray[np.int64]) -> bool:
    """Tell whether each edge is run through as often in one direction as in the other.

    Then the winding number is whole and jumps at triangles only, so the signed distance changes by
    no more than the distance moved, and whole blocks can be decided from their middle. In a broken
    mesh the sign also flips across holes, far from any triangle: every cell must be asked.
    """
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    forward = edges[:, 0] < edges[:, 1]
    _, index = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    balance = np.bincount(index.reshape(-1), weights=np.where(forward, 1, -1))
    return not balance.any()


def open_edges(triangles: NDArray[np.int64]) -> tuple[int, int]:
    """Return how many edges of triangles (t, 3) belong to one only, and how many there are."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, uses = np.unique(edges, axis=0, return_counts=True)
    return int(np.count_nonzero(uses == 1)), len(uses)


def _refuse_soup(bare: int, edges: int, name: str) -> None:
    if bare > _MOST_OPEN * edges:
        raise ShapeError(
            "path",
            f"{name} encloses nothing: {bare} of {edges} edges belong to one triangle",
            "export a closed surface, or merge vertices that coincide",
        )
