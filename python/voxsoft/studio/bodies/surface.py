"""The surface of a body as the page draws it, and the owner of each of its triangles."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.errors import MeshError
from voxsoft.mesh import Mesh
from voxsoft.studio.protocol.wire import CAVITY

Indices = NDArray[np.uint32]

#: Three indices of a vertex fit in one number of 64 bits up to here.
MOST_VERTICES: Final = 1 << 21
#: More tetrahedra than this are not drawn one by one; only the outermost are then.
MOST_TETS: Final = 20_000


@dataclass(frozen=True, eq=False)
class Surface:
    """Drawn surface of a mesh.

    Attributes
    ----------
    outline
        Its vertices, triangles and edges of voxels, as the core packs them.
    vertices
        Vertices of the mesh that are drawn, (n,), in ascending order.
    tags
        For each triangle of the mesh its part from 0, or its cavity with the bit :data:`CAVITY`.
    """

    outline: _core.Outline = field(repr=False)
    vertices: Indices = field(repr=False)
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
        >>> outline = surface.outline
        >>> len(surface.vertices), len(outline.triangles), len(outline.edges)
        (12, 20, 20)
        """
        if len(mesh.vertices) >= MOST_VERTICES:
            raise MeshError(
                "body",
                f"has {len(mesh.vertices):,} vertices; up to {MOST_VERTICES:,} can be drawn",
                "make the voxels larger",
            )
        triangles, tags = mesh.triangles.astype(np.uint32), _tags(mesh)
        size = mesh.voxel_size or 0.0
        outline = _core.Outline.surface(mesh.vertices, triangles, tags, size)
        return cls(outline, outline.vertices, tags)

    def index_of(self, vertices: NDArray[np.integer[Any]]) -> Indices:
        """Which of some vertices of the mesh are drawn, as indices among the drawn ones."""
        at = np.searchsorted(self.vertices, vertices)
        at = np.minimum(at, len(self.vertices) - 1)
        found: Indices = at[self.vertices[at] == vertices].astype(np.uint32)
        return found


def tets_to_draw(mesh: Mesh, surface: Surface) -> tuple[Indices, NDArray[np.uint8]]:
    """Tetrahedra that are drawn one by one: all, or the outermost where there are too many.

    Returns
    -------
    tuple
        Their vertices in the mesh, (m, 4), and the part of each, from 0, (m,).
    """
    chosen = np.arange(len(mesh.tets))
    if len(mesh.tets) > MOST_TETS:
        drawn = np.zeros(len(mesh.vertices), dtype=bool)
        drawn[surface.vertices] = True
        chosen = np.flatnonzero(drawn[mesh.tets].sum(axis=1) >= 3)
    return mesh.tets[chosen].astype(np.uint32), (mesh.tet_part[chosen] - 1).astype(np.uint8)


def voxels_to_cut(mesh: Mesh) -> Indices:
    """The voxels that a section goes through, by their corners, (k, 8); none of other meshes."""
    if mesh.voxel_size is None:
        return np.zeros((0, 8), np.uint32)
    # Turned voxels have their corners by the axes of their own body.
    alone = [(body.mesh, body.first_vertex) for body in mesh.bodies] or [(mesh, 0)]
    corners = [
        each.voxel_corners(np.arange(len(each.tets) // 5)) + first
        for each, first in alone
        if each.voxel_size is not None
    ]
    return np.concatenate(corners).astype(np.uint32)


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
