"""The surface of a body as the page draws it: its own vertices, triangles, and edges of voxels."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import MeshError
from voxsoft.mesh import Mesh
from voxsoft.studio.wire import CAVITY, MAGIC, MessageKind, TopologyFlag

Floats = NDArray[np.float64]
Indices = NDArray[np.uint32]

#: Three indices of a vertex fit in one number of 64 bits up to here.
MOST_VERTICES: Final = 1 << 21
#: Length of an edge of a shrunk tetrahedron over that of the whole one, as in the core's frames.
SHRINKAGE: Final = 0.85
#: More tetrahedra than this are not drawn one by one; only the outermost are then.
MOST_TETS: Final = 20_000


@dataclass(frozen=True, eq=False)
class Surface:
    """What is drawn of a mesh.

    Attributes
    ----------
    vertices
        Which vertices of the mesh are drawn, (n,), in ascending order.
    triangles
        Of drawn vertices, (t, 3).
    edges
        Of the voxels, without the diagonals of their faces, (e, 2).
    tags
        For each triangle its part from 0, or its cavity with the bit :data:`CAVITY`.
    """

    vertices: Indices = field(repr=False)
    triangles: Indices = field(repr=False)
    edges: Indices = field(repr=False)
    tags: NDArray[np.uint8] = field(repr=False)

    @classmethod
    def of(cls, mesh: Mesh) -> Surface:
        """Find the surface of a mesh.

        Raises
        ------
        MeshError
            More vertices than can be drawn.

        Examples
        --------
        >>> from voxsoft.voxels import Voxels
        >>> surface = Surface.of(Voxels.from_array([[[1]], [[1]]], voxel_size=0.01).mesh())
        >>> len(surface.vertices), len(surface.triangles), len(surface.edges)
        (12, 20, 20)
        """
        if len(mesh.vertices) >= MOST_VERTICES:
            raise MeshError(
                "body",
                f"has {len(mesh.vertices):,} vertices; up to {MOST_VERTICES:,} can be drawn",
                "make the voxels larger",
            )
        drawn, triangles = _compact(mesh.triangles)
        return cls(drawn, triangles, _edges(mesh, drawn, triangles), _tags(mesh))

    def index_of(self, vertices: NDArray[np.integer[Any]]) -> Indices:
        """Which of some vertices of the mesh are drawn, as indices among the drawn ones."""
        at = np.searchsorted(self.vertices, vertices)
        at = np.minimum(at, len(self.vertices) - 1)
        found: Indices = at[self.vertices[at] == vertices].astype(np.uint32)
        return found


@dataclass(frozen=True, eq=False)
class ShrunkTets:
    """Tetrahedra drawn one by one, each with four vertices of its own.

    Attributes
    ----------
    corners
        Vertices of the mesh, (m, 4).
    tags
        Part of each of the 4 m triangles, from 0.
    """

    corners: Indices = field(repr=False)
    tags: NDArray[np.uint8] = field(repr=False)

    @classmethod
    def of(cls, mesh: Mesh, surface: Surface) -> ShrunkTets:
        """Take all tetrahedra of a mesh, or only those at its surface where there are too many."""
        chosen = np.arange(len(mesh.tets))
        if len(mesh.tets) > MOST_TETS:
            drawn = np.zeros(len(mesh.vertices), dtype=bool)
            drawn[surface.vertices] = True
            chosen = np.flatnonzero(drawn[mesh.tets].sum(axis=1) >= 3)
        part = (mesh.tet_part[chosen] - 1).astype(np.uint8)
        return cls(mesh.tets[chosen].astype(np.uint32), np.repeat(part, 4))

    @property
    def triangles(self) -> Indices:
        """Faces of the tetrahedra, (4 m, 3), pointing outward."""
        faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], dtype=np.uint32)
        first = 4 * np.arange(len(self.corners), dtype=np.uint32)
        return (first[:, None, None] + faces).reshape(-1, 3)

    def points(self, positions: Floats) -> Floats:
        """Corners of the shrunk tetrahedra, (4 m, 3), where the vertices of the mesh are."""
        corners = positions[self.corners]
        center = corners.mean(axis=1, keepdims=True)
        shrunk: Floats = (center + SHRINKAGE * (corners - center)).reshape(-1, 3)
        return shrunk


def pack_surface(surface: Surface, mesh: Mesh, topology: int) -> bytes:
    """Write the topology of a surface as the page reads it."""
    return _pack(
        topology,
        TopologyFlag.SURFACE,
        mesh.voxel_size or 0.0,
        mesh.vertices[surface.vertices],
        surface.triangles,
        surface.edges,
        surface.tags,
    )


def pack_tets(tets: ShrunkTets, mesh: Mesh, topology: int) -> bytes:
    """Write the topology of shrunk tetrahedra as the page reads it."""
    edges = np.zeros((0, 2), dtype=np.uint32)
    points = tets.points(mesh.vertices)
    size = mesh.voxel_size or 0.0
    return _pack(topology, TopologyFlag.SHRUNK_TETS, size, points, tets.triangles, edges, tets.tags)


def _pack(
    topology: int,
    flags: int,
    voxel_size: float,
    points: Floats,
    triangles: Indices,
    edges: Indices,
    tags: NDArray[np.uint8],
) -> bytes:
    head = struct.pack(
        "<IBBHIIdIII28x",
        MAGIC,
        MessageKind.TOPOLOGY,
        flags,
        0,
        topology,
        0,
        voxel_size,
        len(points),
        len(triangles),
        len(edges),
    )
    blocks = (points.astype("<f4"), triangles.astype("<u4"), edges.astype("<u4"), tags)
    body = b"".join(block.tobytes() for block in blocks)
    return head + body + bytes(-len(body) % 4)


def _compact(triangles: NDArray[np.int32]) -> tuple[Indices, Indices]:
    drawn, inverse = np.unique(triangles, return_inverse=True)
    return drawn.astype(np.uint32), inverse.reshape(-1, 3).astype(np.uint32)


def _edges(mesh: Mesh, drawn: Indices, triangles: Indices) -> Indices:
    pairs = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    keys = np.unique(pairs[:, 0].astype(np.int64) * MOST_VERTICES + pairs[:, 1])
    pairs = np.column_stack(np.divmod(keys, MOST_VERTICES))
    if mesh.voxel_size is not None:
        points = mesh.vertices[drawn]
        along = np.abs(points[pairs[:, 1]] - points[pairs[:, 0]]) > 1e-3 * mesh.voxel_size
        pairs = pairs[along.sum(axis=1) == 1]
    return pairs.astype(np.uint32)


def _tags(mesh: Mesh) -> NDArray[np.uint8]:
    """The part of the tetrahedron behind each triangle, or the cavity before it."""
    wanted = _keys(mesh.triangles)
    parts = mesh.tet_part[_tets_behind(mesh, wanted)] if np.ptp(mesh.tet_part) else mesh.tet_part[0]
    tags = np.full(len(wanted), parts - 1).astype(np.uint8) & np.uint8(CAVITY - 1)
    for index, cavity in enumerate(mesh.cavities):
        inside = np.isin(wanted, _keys(cavity.triangles))
        tags[inside] = CAVITY | min(index, CAVITY - 1)
    return tags


def _tets_behind(mesh: Mesh, wanted: NDArray[np.int64]) -> NDArray[np.int64]:
    """The tetrahedron of each triangle that is wanted by its key."""
    faces = mesh.tets[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]].reshape(-1, 3)
    of_faces = _keys(faces)
    order = np.argsort(of_faces)
    behind: NDArray[np.int64] = order[np.searchsorted(of_faces, wanted, sorter=order)] // 4
    return behind


def _keys(triangles: NDArray[np.int32]) -> NDArray[np.int64]:
    """One number for each triangle, whatever the order of its vertices."""
    corners = triangles.T.astype(np.int64)  # far quicker than to sort rows of three
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle = corners.sum(axis=0) - low - high
    keys: NDArray[np.int64] = (low * MOST_VERTICES + middle) * MOST_VERTICES + high
    return keys
