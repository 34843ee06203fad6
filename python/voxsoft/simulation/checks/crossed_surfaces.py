"""Surfaces that contact should keep apart and that pass through each other."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.mesh import Mesh
from voxsoft.simulation.diagnostic import Diagnostic, near
from voxsoft.simulation.setup.contact import Touching, has_contact
from voxsoft.simulation.setup.places import voxel_size

#: Distance along the unloaded surface, in voxels, below which crossing faces of one body are a
#: crease of crushed voxels: contact does not look at neighbors. The warning says so.
CREASE: Final = 1.5
#: Penetration of two faces up to which there is no warning, in voxels: fifty times the gap that
#: contact keeps, and far less than voxels resolve.
GRAZING: Final = 0.01

#: Pairs whose paths along the surface are searched at once: each takes memory for every point.
_AT_ONCE: Final = 64

Floats = NDArray[np.float64]


def crossed_surfaces(design: Design, mesh: Mesh, positions: Floats) -> Iterator[Diagnostic]:
    """Find where bodies pass through themselves or each other in spite of contact.

    Surfaces are tested face by face with exact predicates: an edge may pierce a face without any
    vertex that is deep inside.

    Parameters
    ----------
    design, mesh
        The body.
    positions
        Its vertices in m, (n, 3).

    Yields
    ------
    Diagnostic
        One, at the deepest place.
    """
    if not has_contact(design) or not np.isfinite(positions).all():
        return
    touching = _touching(design, mesh)
    count = len(design.body_names)
    if np.isnan(touching.friction[:count, :count]).all():
        return
    now, triangles, body_of = _faces(touching, positions)
    none = np.zeros((0, 4), dtype=np.int32)
    pairs, _, _ = _core.penetration(now, now, none, none[:, :3], triangles)
    if not len(pairs):
        return
    size = voxel_size(mesh)
    first, second = np.moveaxis(triangles[pairs.astype(np.int64)], 1, 0)
    bodies = body_of[first[:, 0]], body_of[second[:, 0]]
    depths = np.minimum(_depths(now[first], now[second]), _depths(now[second], now[first]))
    # Some pairs are let through each other, or are bonded.
    deep = (depths > GRAZING * size) & ~np.isnan(touching.friction[bodies])
    pairs, first, depths = pairs[deep], first[deep], depths[deep]
    if not len(pairs):
        return
    rest, _, _ = _faces(touching, mesh.vertices)
    apart = are_apart(rest, triangles, pairs, CREASE * size)
    worst = int(np.argmax(np.where(apart, depths, -1.0) if apart.any() else depths))
    at_x, at_y, at_z = rest[first[worst]].mean(axis=0).tolist()
    place = (at_x, at_y, at_z)
    what = f"surfaces pass through each other {near(place)}, which contact has not kept apart"
    if not apart.any():
        how = f"{depths[worst] / size:.2f} voxels deep, in a crease of crushed voxels"
        what = f"the surface is folded into itself {near(place)}, {how}"
    yield Diagnostic("warning", "contact", what, "lower the load, or take smaller voxels", place)


def are_apart(
    points: Floats, triangles: NDArray[np.int32], pairs: NDArray[np.uint32], distance: float
) -> NDArray[np.bool_]:
    """Find the pairs of faces that are farther apart than a distance along the surface.

    Parameters
    ----------
    points, triangles
        The unloaded surface: points in m, (p, 3), and triangles of them, (t, 3).
    pairs
        Numbers of triangles, (n, 2).
    distance
        Distance in m along edges from a corner of the one to the nearest corner of the other.

    Returns
    -------
    apart
        (n,); true where no path of this length along the surface joins the two.
    """
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra

    first, second = np.moveaxis(triangles[pairs.astype(np.int64)], 1, 0)
    # No path along the surface is shorter than the straight line.
    between = points[second][:, None, :] - points[first][:, :, None]
    apart: NDArray[np.bool_] = (np.linalg.norm(between, axis=3) > distance).all(axis=(1, 2))
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    lengths = np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1)
    count = len(points)
    # A sparse graph takes 0 for no edge.
    ways = csr_array((np.maximum(lengths, 1e-300), tuple(edges.T)), shape=(count, count))
    near = np.flatnonzero(~apart)
    for at in range(0, len(near), _AT_ONCE):
        some = near[at : at + _AT_ONCE]
        starts, row = np.unique(first[some], return_inverse=True)
        reached = dijkstra(ways, directed=False, indices=starts, limit=distance)
        ends = reached[row.reshape(-1, 3)[:, :, None], second[some][:, None, :]]
        apart[some] = np.isinf(ends).all(axis=(1, 2))
    return apart


def _depths(faces: Floats, others: Floats) -> Floats:
    """Measure how far each face has to move along the normal of the other to be on one side."""
    normals = np.cross(others[:, 1] - others[:, 0], others[:, 2] - others[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    heights = np.einsum("pcx,px->pc", faces - others[:, :1], normals)
    depths: Floats = np.minimum(heights.max(axis=1), -heights.min(axis=1))
    return depths


def _faces(
    touching: Touching, positions: Floats
) -> tuple[Floats, NDArray[np.int32], NDArray[np.int64]]:
    """Return points of all surfaces of bodies in m, triangles, and the body of each point."""
    points, triangles, body_of, first = list[Floats](), [], [], 0
    for index, (body, skin) in enumerate(zip(touching.mesh.each_body, touching.skins, strict=True)):
        own = positions[body.vertices]
        points.append(own if skin is None else skin.at(own))
        faces = body.mesh.triangles if skin is None else skin.triangles
        triangles.append(faces.astype(np.int32) + np.int32(first))
        body_of.append(np.full(len(points[-1]), index))
        first += len(points[-1])
    return np.concatenate(points), np.concatenate(triangles), np.concatenate(body_of)


#: Cache of the last surfaces: the frames of one run are checked one after the other.
_latest: list[Touching] = []


def _touching(design: Design, mesh: Mesh) -> Touching:
    """Return the surfaces in contact of a design, with their skins, from the cache if possible."""
    for found in _latest:
        if found.design is design and found.mesh is mesh:
            return found
    made = Touching(design, mesh)
    _latest[:] = [made]
    return made
