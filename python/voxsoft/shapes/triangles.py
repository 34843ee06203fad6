"""Shapes from triangle meshes: closed or broken, by generalized winding numbers.

The winding number counts how often a surface wraps around a point: 1 inside a closed surface, 0
outside, −1 inside one whose faces are turned, and a fraction near a hole. A point is inside if
its size exceeds one half [1]_. Neighbors that disagree on which side is outside are turned to
agree first; then :mod:`voxsoft.shapes.nesting` decides which closed shells enclose material.

References
----------
.. [1] Barill, Dickson, Schmidt, Levin, Jacobson: Fast winding numbers for soups and clouds,
   ACM Transactions on Graphics 37 (2018), doi:10.1145/3197517.3201337
"""

from __future__ import annotations

import atexit
import os
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from voxsoft import _core
from voxsoft.errors import FileError, ShapeError
from voxsoft.formats.read import read_contents
from voxsoft.formats.unit import length_of, sizes
from voxsoft.records import Name
from voxsoft.shapes.base import Scope, Shape, Triple
from voxsoft.shapes.mesh_bodies import MeshBody, read_body
from voxsoft.shapes.nesting import Nest, Nested, taken_once, unnested
from voxsoft.shapes.shells import Hole, holes_of, in_one_sense
from voxsoft.shapes.surface_files import has_own_parts, read_surface
from voxsoft.units import format_quantity

__all__ = [
    "TriangleMesh",
]

#: Part of the edges that belong to one triangle only, above which nothing is enclosed.
_MOST_OPEN = 0.5

#: Excess thickness of the box around a flat sheet, as a part of its length.
_ROOM = 1e-6


class SurfaceState(NamedTuple):
    """Doubtful features of a surface.

    Attributes
    ----------
    turned
        Number of triangles that had to be turned to agree with their neighbors.
    holes
        Holes, the widest first, in m.
    doubled
        Number of triangles of bodies that occur twice with opposite sense, and were taken once.
    nest
        Shells that lie in others, in m and m³.
    nested
        Reading of nested shells set by the shape; None where it is not set.
    """

    turned: int
    holes: tuple[Hole, ...]
    doubled: int = 0
    nest: Nest = Nest()
    nested: Nested | None = None

    @property
    def opening(self) -> str:
        """Holes in words; empty where there are none.

        Examples
        --------
        >>> SurfaceState(0, (Hole(4, 0.012, (0.0, 0.0, 0.03)),)).opening
        'is open: a hole of 4 edges, 12 mm wide, near (0, 0, 30) mm'
        """
        if not self.holes:
            return ""
        hole = self.holes[0]
        width = format_quantity(float(f"{hole.width:.3g}"), "length")
        place = ", ".join(f"{1e3 * value:.4g}" for value in hole.center)
        number = len(self.holes)
        first = "a hole" if number == 1 else f"{number:,} holes, the widest"
        return f"is open: {first} of {hole.edges:,} edges, {width} wide, near ({place}) mm"


def _is_length_unit(unit: str) -> str:
    length_of(unit)
    return unit


def _whole_path(path: object) -> object:
    """Make a path absolute, so that it leads to the file from everywhere."""
    if isinstance(path, (str, os.PathLike)) and os.fspath(path):
        return os.path.abspath(path)  # noqa: PTH100 - as text, and without asking the disk
    return path


class TriangleMesh(Shape):
    """The inside of a mesh from a file: STL, OBJ, PLY, OFF, or anything that meshio reads.

    The boundary of tetrahedra and other volume cells counts, of the whole or of a `part`. Small
    holes and turned faces do not spoil the inside; ``voxsoft check`` tells of both. Distances are
    those to the triangles.

    Outermost closed shells enclose material, whichever side their faces are on. A shell within
    another is a chamber where it faces the other way than the outermost one around it; where it
    faces likewise it is filled, with a warning. ``nested="void"`` makes shells chambers and bodies
    by turns, whichever way they face; ``nested="solid"`` says that the filled ones are meant.

    Examples
    --------
    >>> TriangleMesh(path="part.stl", unit="mm").kind
    'mesh'
    """

    kind: Literal["mesh"] = "mesh"
    path: Annotated[str, BeforeValidator(_whole_path)] = Field(
        description="File: .stl, .obj, .3mf, .ply, .off, .msh, .mesh, .vtk, .vtu, .npy and others."
    )
    unit: Annotated[str, AfterValidator(_is_length_unit)] | None = Field(
        None,
        description="Length unit of the file, such as mm, or of an array of voxels the side of "
        "one, such as 0.5 mm; default: as it says. 3MF, GLB and files of VoxSoft do, most others "
        "do not.",
    )
    part: Name | None = Field(
        None,
        description="Name of a part of a file of tetrahedra, or of an object, group or solid of a "
        "surface; default: all of it.",
    )
    region: Name | None = Field(
        None,
        description="Name of a region of a file of tetrahedra, for a region of the design: all "
        "within half a voxel of it.",
    )
    nested: Nested | None = Field(
        None,
        description="Closed shells within others: void where material and voids alternate by "
        "depth; solid where those of the same sense are meant to be filled.",
    )

    @model_validator(mode="after")
    def _says_one(self) -> TriangleMesh:
        if self.part is not None and self.region is not None:
            raise ShapeError("region", "there is a part too", "make two shapes of them")
        return self

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        if self.region is not None:
            path = Path(self.path)
            return _body(path).distance_to(self.region, path.name, self._meter)
        solid = self._solid
        return _core.Shape.sampled(solid.distances, solid.low, solid.high, solid.is_closed)

    def state(self) -> SurfaceState:
        """Return the doubtful features of the surface: turned faces and holes [m].

        Raises
        ------
        ShapeError
            The file cannot be read, or encloses nothing.
        """
        return self._solid.state

    @property
    def _solid(self) -> _Solid:
        path = Path(self.path)
        return _solid(path, _changed(path), self._meter, self.part, self.nested)

    @property
    def _meter(self) -> float:
        if self.unit is not None:
            return length_of(self.unit)
        path = Path(self.path)
        return _stated(path, _changed(path))


def _changed(path: Path) -> int:
    try:
        return path.stat().st_mtime_ns
    except OSError as error:
        raise ShapeError("path", f"{path} cannot be read: {error.strerror}") from None


@lru_cache(maxsize=8)
def _stated(path: Path, changed: int) -> float:
    """Return meters in the unit that a file says, cached until it changes."""
    del changed
    try:
        contents = read_contents(path)
    except FileError as error:
        raise ShapeError("path", f"{path.name}: {error.what}", error.hint) from None
    if contents.unit is None:
        raise ShapeError("unit", *sizes(np.ptp(contents.points, axis=0), "unit", path.name))
    return contents.unit


@lru_cache(maxsize=8)
def _solid(
    path: Path, changed: int, factor: float, part: str | None, nested: Nested | None
) -> _Solid:
    """Read a file, cached until it changes."""
    if part is None or has_own_parts(path):
        surface = read_surface(path, part)
    else:
        surface = _body(path).surface_of(part, path.name)
    return _Solid(surface.points * factor, surface.triangles, str(path), nested)


def _body(path: Path) -> MeshBody:
    try:
        return read_body(path)
    except FileError as error:
        raise ShapeError("path", f"{path.name}: {error.what}", error.hint) from None


# Objects of libigl must go before its module does, or it reports them as leaked.
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
        Name in error messages.
    nested
        Reading of shells within others.
    """

    def __init__(
        self,
        points: NDArray[np.float64],
        triangles: NDArray[np.int64],
        name: str,
        nested: Nested | None = None,
    ) -> None:
        import igl

        triangles, doubled = taken_once(triangles)
        _refuse_soup(triangles, name)
        triangles, turned = in_one_sense(points, triangles)
        holes = holes_of(points, triangles)
        triangles, nest = unnested(points, triangles, nested)
        self.state = SurfaceState(turned, holes, doubled, nest, nested)
        self.is_closed = _is_closed(triangles)
        used = points[np.unique(triangles)]
        low, high = used.min(axis=0), used.max(axis=0)
        # A flat sheet has no volume in its box; a wall can still be made of it.
        room = _ROOM * float((high - low).max()) * (high == low)
        self.low: Triple = tuple((low - room).tolist())
        self.high: Triple = tuple((high + room).tolist())
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


def _refuse_soup(triangles: NDArray[np.int64], name: str) -> None:
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, uses = np.unique(edges, axis=0, return_counts=True)
    bare = int(np.count_nonzero(uses == 1))
    if bare > _MOST_OPEN * len(uses):
        raise ShapeError(
            "path",
            f"{name} encloses nothing: {bare} of {len(uses)} edges belong to one triangle",
            "export a closed surface, or merge vertices that coincide",
        )


def _is_closed(triangles: NDArray[np.int64]) -> bool:
    """Check that each edge is run through as often in one direction as in the other.

    Then the winding number is whole and jumps at triangles only, so the signed distance changes by
    no more than the distance moved, and whole blocks can be decided from their middle. In a broken
    mesh the sign also flips across holes, far from any triangle: every cell must be sampled.
    """
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    forward = edges[:, 0] < edges[:, 1]
    _, index = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    balance = np.bincount(index.reshape(-1), weights=np.where(forward, 1, -1))
    return not balance.any()
