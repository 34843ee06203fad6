"""Tetrahedral meshes, on which the solvers work.

Long because one immutable value has its attributes, the ways to make it and its quality together.

Enter here with a mesh of your own by :meth:`Mesh.from_tets`; a grid gives one by
:meth:`voxsoft.voxels.Voxels.mesh`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any, Final, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from voxsoft import _core
from voxsoft._arrays import frozen
from voxsoft._memory import memory_limit, shortage
from voxsoft.cavity import MeshCavity
from voxsoft.errors import MeshError
from voxsoft.formats.report import ReadReport
from voxsoft.geometry import grid_phase, tet_volumes


@dataclass(frozen=True, eq=False)
class BodyMesh:
    """One body of a mesh: its own mesh, and where in the joined one it is.

    Attributes
    ----------
    name : str
        Name of the body.
    mesh : Mesh
        In the frame of the body, before it is turned and moved.
    rotation : ndarray of float64, shape (3, 3)
    position : ndarray of float64, shape (3,)
        From there to the joined mesh [m]: ``x = rotation @ own + position``.
    first_vertex, first_tet : int
        Its first vertex and tet among those of the joined mesh; the others follow.
    """

    name: str
    mesh: Mesh
    rotation: NDArray[np.float64] = field(repr=False)
    position: NDArray[np.float64] = field(repr=False)
    first_vertex: int = 0
    first_tet: int = 0

    @property
    def vertices(self) -> slice:
        """Its vertices among those of the joined mesh."""
        return slice(self.first_vertex, self.first_vertex + len(self.mesh.vertices))

    @property
    def is_along_axes(self) -> bool:
        """True if it is moved without a turn."""
        return bool((self.rotation == np.eye(3)).all())

    def placed(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points of the frame of the body where the joined mesh has them [m], (n, 3)."""
        moved: NDArray[np.float64] = points @ self.rotation.T + self.position
        return moved

    def own(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points of the joined mesh in the frame of the body [m], (n, 3)."""
        back: NDArray[np.float64] = (points - self.position) @ self.rotation
        return back

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, BodyMesh):
            return NotImplemented
        return (
            (self.name, self.first_vertex, self.first_tet)
            == (other.name, other.first_vertex, other.first_tet)
            and self.mesh == other.mesh
            and np.array_equal(self.rotation, other.rotation)
            and np.array_equal(self.position, other.position)
        )

    __hash__ = None  # type: ignore[assignment]


@dataclass(frozen=True)
class MeshQuality:
    """Figures that tell whether a mesh is sound, counted from tets and triangles alone.

    Attributes
    ----------
    volume : float
        Sum of the volumes of the tets [m³].
    smallest_tet, largest_tet : float
        Extreme volumes of a tet [m³].
    area : float
        Area of the boundary [m²].
    euler_number : int
        V - E + F - T: 1 for a ball, 0 for a solid ring, 2 for a ball with a cavity.
    conforming : bool
        True if the triangles are exactly the faces held by one tet, outward, and every other face
        is held by two.
    open_edges : int
        Boundary edges that do not have a triangle on both sides; 0 if the surface is watertight.
    nonmanifold_edges : tuple of pairs of int
        Edges where four or more boundary triangles meet: bodies that touch along them.
    """

    volume: float
    smallest_tet: float
    largest_tet: float
    area: float
    euler_number: int
    conforming: bool
    open_edges: int
    nonmanifold_edges: tuple[tuple[int, int], ...]

    @property
    def watertight(self) -> bool:
        """True if the boundary has no holes."""
        return self.open_edges == 0


@dataclass(frozen=True, eq=False, repr=False)
class Mesh:
    """A conforming mesh of tetrahedra with its edges, its boundary and its cavities.

    All arrays are read-only. Make meshes with :meth:`from_tets` or
    :meth:`voxsoft.voxels.Voxels.mesh`; the constructor does not check its arguments.

    Attributes
    ----------
    vertices : ndarray of float64, shape (n, 3)
        Positions [m].
    tets : ndarray of int32, shape (m, 4)
        Vertex indices, with positive volume. The five tets of a voxel come one after the other.
    edges : ndarray of int32, shape (k, 2)
        Pairs of vertices, each once, lower index first, sorted.
    triangles : ndarray of int32, shape (t, 3)
        The boundary, pointing out of the material.
    tet_part : ndarray of uint8, shape (m,)
        The part of each tet.
    tet_voxel : ndarray of int32, shape (m,), or None
        The voxel of each tet, counted in C order of the filled cells; None if not made of voxels.
    voxel_size : float or None
        Side of the voxels [m]; None if not made of voxels.
    cavities : tuple of MeshCavity
        Largest first.
    fractions : ndarray of float64, shape (v,), or None
        The material of each voxel in volumes of a voxel; None where every voxel is full.
    moments : ndarray of float64, shape (v, 9), or None
        Place of the material in each voxel, in halves of an edge: its center along x, y, z,
        counted from that of the voxel, √3 times its standard deviation from there (1 if
        full), and the means of the products yz, zx, xy over it.
    surfaces : ndarray of float64, shape (v, 9), or None
        Surface in each voxel: the rotation vector of three orthogonal axes across it, and its areas
        below and above each of them, in faces of a voxel; zeros without one.
    bodies : tuple of BodyMesh
        Meshes it is joined from, in the order of vertices and tets; empty for a mesh of one body.
        Joined, `voxel_size` is that of the smallest voxels, and `moments` are along their edges.
    report : ReadReport or None
        The file that it was read from beside all that was taken; None if not read. Meshes with
        other reports may be equal.
    regions : mapping of str to ndarray of int, shape (r,)
        Vertices of each region that the file of the mesh names.
    """

    vertices: NDArray[np.float64]
    tets: NDArray[np.int32]
    edges: NDArray[np.int32]
    triangles: NDArray[np.int32]
    tet_part: NDArray[np.uint8]
    tet_voxel: NDArray[np.int32] | None
    voxel_size: float | None
    cavities: tuple[MeshCavity, ...]
    fractions: NDArray[np.float64] | None = None
    moments: NDArray[np.float64] | None = None
    surfaces: NDArray[np.float64] | None = None
    bodies: tuple[BodyMesh, ...] = ()
    report: ReadReport | None = None
    regions: Mapping[str, NDArray[np.integer]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name, dtype in _DTYPES.items():
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, frozen(value, dtype))

    @classmethod
    def from_tets(
        cls, vertices: ArrayLike, tets: ArrayLike, tet_part: ArrayLike | None = None
    ) -> Self:
        """Return a mesh of given tetrahedra.

        Tets of negative volume are turned round (their last two corners swapped). Edges and
        boundary are found; a closed component of the boundary that points inward is a cavity. An
        island that floats in a cavity is not subtracted from its volume.

        Parameters
        ----------
        vertices : array_like, shape (n, 3)
            Positions [m].
        tets : array_like of int, shape (m, 4)
            Vertex indices, counted from 0.
        tet_part : array_like of int, shape (m,), optional
            The part of each tet, 1 to 255; by default all are of part 1.

        Raises
        ------
        MeshError
            Naming the first tet, vertex or face that is wrong: an index out of range, a position
            that is not finite, a tet without volume, tets that overlap, a vertex of no tet.

        Examples
        --------
        >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        >>> Mesh.from_tets(corners, [[0, 1, 2, 3]])
        Mesh(4 vertices, 1 tets, 6 edges, 4 triangles, 0 cavities)
        >>> Mesh.from_tets(corners, [[0, 1, 2, 2]])  # doctest: +ELLIPSIS
        Traceback (most recent call last):
            ...
        voxsoft.errors.MeshError: tets[0]: tetrahedron 0 is flat: its volume is 0e0 m^3. Try: ...
        """
        points = _matrix("vertices", vertices, 3, np.float64)
        corners = _matrix("tets", tets, 4, np.int32)
        parts = np.ones(len(corners), np.uint8) if tet_part is None else _parts(tet_part)
        arrays = _core.mesh_tets(points, corners, parts)
        if len(lone := np.setdiff1d(np.arange(len(points)), corners)):
            what = f"{len(lone):,} belong to no tet, the first is {lone[0]}: nothing holds them"
            hint = "keep only those of np.unique(tets, return_inverse=True)"
            raise MeshError("vertices", what, hint)
        return cls._from_core(arrays, None)

    @classmethod
    def from_voxel_grid(cls, grid: _core.Grid) -> Self:
        """Return the mesh of a grid of the core; call :meth:`voxsoft.voxels.Voxels.mesh`."""
        return cls._from_core(_core.mesh_voxels(grid, memory_limit()), grid.voxel_size)

    @classmethod
    def _from_core(cls, arrays: _core.MeshArrays, voxel_size: float | None) -> Self:
        vertices, tets, edges, triangles, tet_part, cavities = arrays
        tet_voxel = None if voxel_size is None else np.arange(len(tets), dtype=np.int32) // 5
        surfaces = tuple(MeshCavity(*cavity) for cavity in cavities)
        return cls(vertices, tets, edges, triangles, tet_part, tet_voxel, voxel_size, surfaces)

    def with_fractions(
        self,
        fractions: ArrayLike,
        moments: ArrayLike | None = None,
        surfaces: ArrayLike | None = None,
    ) -> Self:
        """Return the mesh with voxels that are partly filled.

        Parameters
        ----------
        fractions : array_like, shape (v,)
            The material of each voxel in volumes of a voxel, positive.
        moments : array_like, shape (v, 9) or (v, 6), optional
            Place of the material in each voxel, see the attribute; default: all over. Of six, the
            means of the products are the products of the means.
        surfaces : array_like, shape (v, 9), optional
            Surface in each voxel, see the attribute; default: none, so that no voxel warps there.

        Raises
        ------
        MeshError
            The mesh is not made of voxels, or the numbers do not fit it.

        Examples
        --------
        >>> from voxsoft.voxels import Voxels
        >>> mesh = Voxels.from_array([[[1, 1]]], voxel_size=0.5).mesh().with_fractions([1, 0.5])
        >>> round(mesh.volume, 12)
        0.1875
        """
        values = np.asarray(fractions, dtype=np.float64)
        if self.tet_voxel is None or self.voxel_size is None:
            raise MeshError("fractions", "need a mesh made of voxels")
        count = len(self.tets) // 5
        if values.shape != (count,) or not (np.isfinite(values) & (values > 0.0)).all():
            raise MeshError("fractions", f"must be {count} positive numbers, one for each voxel")
        where = np.tile(_ALL_OVER, (count, 1)) if moments is None else np.asarray(moments)
        if where.ndim == 2 and where.shape[1] == 6:
            x, y, z = where[:, :3].T
            where = np.column_stack((where, y * z, z * x, x * y))
        where = _matrix("moments", where, len(_ALL_OVER), np.float64)
        if len(where) != count or not (np.isfinite(where).all() and (where[:, 3:6] > 0).all()):
            raise MeshError("moments", f"must be {count} rows of finite numbers, spreads positive")
        across = np.zeros((count, 9)) if surfaces is None else np.asarray(surfaces)
        across = _matrix("surfaces", across, 9, np.float64)
        if len(across) != count or not np.isfinite(across).all():
            raise MeshError("surfaces", f"must be {count} rows of finite numbers")
        return replace(self, fractions=values, moments=where, surfaces=across)

    def with_voids(
        self,
        tets: NDArray[np.integer],
        voids: Sequence[tuple[NDArray[np.integer], NDArray[np.float64]]],
    ) -> Self:
        """Return the mesh with cavities that reach into voxels.

        Parameters
        ----------
        tets : ndarray, shape (t, 4)
            Tets between corners of a voxel; corner c lies at (c >> 2 & 1, c >> 1 & 1, c & 1).
        voids : sequence of pairs, one for each cavity
            Numbers of voxels, (k,), and the factor of each of those tets in them, (k, t).

        Examples
        --------
        >>> from voxsoft.voxels import Voxels
        >>> shell = np.ones((3, 3, 3), dtype=bool)
        >>> shell[1, 1, 1] = False
        >>> mesh = Voxels.from_array(shell, voxel_size=0.01).mesh()
        >>> half = np.array([0]), np.full((1, 1), 3.0)  # of a sixth of the first voxel
        >>> round(mesh.with_voids(np.array([[0, 4, 2, 1]]), [half]).cavities[0].volume * 1e6, 12)
        1.5
        """
        cavities = []
        for cavity, (numbers, parts) in zip(self.cavities, voids, strict=True):
            found = self.voxel_corners(numbers)[:, tets].reshape(-1, 4)
            factors = parts.ravel()
            volume = cavity.volume + float(factors @ tet_volumes(self.vertices, found))
            changed = replace(cavity, volume=volume, void_tets=found, void_parts=factors)
            cavities.append(changed)
        return replace(self, cavities=tuple(cavities))

    def voxel_corners(self, numbers: NDArray[np.integer]) -> NDArray[np.int32]:
        """Return the corners of voxels, (k, 8), in the order of :meth:`with_voids`."""
        blocks = self.tets.reshape(-1, 20)[numbers]
        points = self.vertices[blocks]
        low, high = points.min(axis=1, keepdims=True), points.max(axis=1, keepdims=True)
        places = (2 * points > low + high) @ np.array([4, 2, 1])
        corners = np.empty((len(blocks), 8), dtype=np.int32)
        corners[np.arange(len(blocks))[:, None], places] = blocks
        return corners

    def voxel_gradients(
        self, numbers: NDArray[np.integer]
    ) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """Return gradients of the trilinear functions of voxels, integrated over their material.

        Parameters
        ----------
        numbers : ndarray of int, shape (k,)
            Numbers of the voxels.

        Returns
        -------
        corners : ndarray of int32, shape (k, 8)
            Their corners.
        gradients : ndarray of float64, shape (k, 8, 3)
            ∫ ∇Nₐ dV for each of them [m²].

        Raises
        ------
        MeshError
            The mesh is not made of voxels.

        Examples
        --------
        >>> from voxsoft.voxels import Voxels
        >>> mesh = Voxels.from_array([[[1]]], voxel_size=0.2).mesh()
        >>> corners, gradients = mesh.voxel_gradients(np.array([0]))
        >>> gradients[0, 7].round(12).tolist()
        [0.01, 0.01, 0.01]
        """
        if self.tet_voxel is None or self.voxel_size is None:
            raise MeshError("mesh", "needs to be made of voxels")
        filled = np.ones(len(numbers)) if self.fractions is None else self.fractions[numbers]
        where = _ALL_OVER if self.moments is None else self.moments[numbers]
        where = np.broadcast_to(np.asarray(where, dtype=np.float64), (len(numbers), 9))
        mean, products = where[:, None, :3], where[:, None, 6:]
        sign = _CORNER_SIGNS
        # dN/dξ = s_ξ (1 + s_η η)(1 + s_ζ ζ) / 8 on a cube of side 2, its mean over the material.
        others = [(1, 2), (2, 0), (0, 1)]
        slopes = [
            sign[:, axis]
            * (
                1.0
                + sign[:, b] * mean[..., b]
                + sign[:, c] * mean[..., c]
                + sign[:, b] * sign[:, c] * products[..., axis]
            )
            for axis, (b, c) in enumerate(others)
        ]
        scale = filled[:, None, None] * self.voxel_size**2 / 4.0
        return self.voxel_corners(numbers), scale * np.stack(slopes, axis=-1)

    @property
    def phase(self) -> tuple[float, float, float] | None:
        """Phase of the grid of its voxels [m], as :attr:`Voxels.phase`; None without voxels."""
        if self.voxel_size is None or not len(self.vertices):
            return None
        return grid_phase(self.vertices[0], self.voxel_size)

    @property
    def each_body(self) -> tuple[BodyMesh, ...]:
        """Its bodies; itself where there is only one.

        Examples
        --------
        >>> from voxsoft.voxels import Voxels
        >>> mesh = Voxels.from_array([[[1]]], voxel_size=0.5).mesh()
        >>> mesh.each_body[0].mesh is mesh
        True
        """
        return self.bodies or (BodyMesh("", self, np.eye(3), np.zeros(3)),)

    @property
    def volume(self) -> float:
        """Volume of the material [m³]: of the tets, each as far as its voxel is filled."""
        volumes = self.tet_volumes
        if self.fractions is not None and self.tet_voxel is not None:
            volumes = volumes * self.fractions[self.tet_voxel]
        return float(volumes.sum())

    def __reduce__(self) -> tuple[Any, ...]:
        return Mesh, tuple(getattr(self, each.name) for each in fields(self))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Mesh):
            return NotImplemented
        return (
            self.voxel_size == other.voxel_size
            and self.cavities == other.cavities
            and self.bodies == other.bodies
            and self.regions.keys() == other.regions.keys()
            and all(
                np.array_equal(self.regions[name], other.regions[name]) for name in self.regions
            )
            and all(np.array_equal(getattr(self, name), getattr(other, name)) for name in _DTYPES)
        )

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        counts = f"{len(self.vertices)} vertices, {len(self.tets)} tets, {len(self.edges)} edges"
        return f"Mesh({counts}, {len(self.triangles)} triangles, {len(self.cavities)} cavities)"

    @property
    def tet_volumes(self) -> NDArray[np.float64]:
        """Volume of each tet [m³], shape (m,)."""
        return tet_volumes(self.vertices, self.tets)

    @property
    def surface_volume(self) -> float:
        """Volume that the boundary encloses [m³], cavities left out.

        Divergence theorem: the sum over the triangles of a · (b × c) / 6. In a sound mesh
        it equals the sum of :attr:`tet_volumes`.
        """
        points = self.vertices - self.vertices.mean(axis=0)
        a, b, c = (points[self.triangles[:, corner]] for corner in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)

    @cached_property
    def quality(self) -> MeshQuality:
        """Quality figures, counted on first use (a few times the time of meshing).

        Examples
        --------
        >>> from voxsoft.voxels import Voxels
        >>> Voxels.from_array([[[1, 1]]], voxel_size=0.5).mesh().quality.watertight
        True
        """
        if short := shortage(len(self.tets) * _QUALITY_BYTES_PER_TET):
            what = f"counting the quality of {len(self.tets):,} tets {short}"
            raise MeshError("mesh.quality", what, "make the voxels larger")
        counted = _core.mesh_quality(self.vertices, self.tets, self.edges, self.triangles)
        volume, smallest, largest, area, euler, conforming, open_edges, nonmanifold = counted
        return MeshQuality(
            volume=volume,
            smallest_tet=smallest,
            largest_tet=largest,
            area=area,
            euler_number=euler,
            conforming=conforming,
            open_edges=open_edges,
            nonmanifold_edges=tuple((int(a), int(b)) for a, b in nonmanifold),
        )


#: Measured on a million voxels: 90.
_QUALITY_BYTES_PER_TET = 120

#: Moments of the material of a full voxel.
_ALL_OVER: Final = (0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0)
#: The signs of the corners of a voxel along x, y, z, in the order of :meth:`Mesh.with_voids`.
_CORNER_SIGNS: Final = np.array([[c >> 2 & 1, c >> 1 & 1, c & 1] for c in range(8)]) * 2.0 - 1.0

_DTYPES: dict[str, type[np.generic]] = {
    "vertices": np.float64,
    "tets": np.int32,
    "edges": np.int32,
    "triangles": np.int32,
    "tet_part": np.uint8,
    "tet_voxel": np.int32,
    "fractions": np.float64,
    "moments": np.float64,
    "surfaces": np.float64,
}


def _matrix(place: str, values: ArrayLike, columns: int, dtype: type[np.generic]) -> NDArray[Any]:
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[1] != columns:
        raise MeshError(place, f"has shape {array.shape}; expected (n, {columns})")
    if array.dtype.kind not in ("ui" if dtype is np.int32 else "uif"):
        raise MeshError(place, f"holds {array.dtype}; expected {np.dtype(dtype)}")
    if dtype is np.int32 and array.size and (array.min() < -(2**31) or array.max() >= 2**31):
        raise MeshError(place, "holds an index that does not fit in 32 bits")
    return np.ascontiguousarray(array, dtype=dtype)


def _parts(values: ArrayLike) -> NDArray[np.uint8]:
    array = np.asarray(values)
    if array.ndim != 1 or array.dtype.kind not in "ui":
        what = f"has shape {array.shape} of {array.dtype}; expected (m,) whole numbers"
        raise MeshError("tet_part", what)
    if array.size and not (array.min() >= 1 and array.max() <= 255):
        found = f"holds {array.min()} to {array.max()}"
        raise MeshError("tet_part", f"{found}; parts are numbered 1 to 255")
    return array.astype(np.uint8)
