"""Outer surface of each body of a design: smooth where its voxels are those of the shapes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.mesh import BodyMesh, Mesh
from voxsoft.simulation.loads.surface import OuterSurface, outward
from voxsoft.simulation.setup.other_split import OtherSplit
from voxsoft.simulation.setup.skin import skin_of


def outer_surfaces(design: Design, split: OtherSplit) -> tuple[OuterSurface, ...]:
    """Return the outer surface of each body.

    Parameters
    ----------
    design
        The design, its bodies assembled.
    split
        The other split of the faces of its mesh.

    Notes
    -----
    Walls of closed cavities are left out. With layers, which may close a chamber that the shapes
    leave open, the surface is the faces of voxels.
    """
    found = []
    for body in split.mesh.each_body:
        skin = None if design.layers else skin_of(design.alone(body.name), body.mesh)
        if skin is None:
            faces = _faces(split.mesh, body)
            both = np.concatenate([faces, split.triangles(faces)]).astype(np.uint32)
            found.append(OuterSurface(both, None, 0, 0.5))
        else:
            kept = skin.triangles[outward(skin.points, skin.triangles)]
            found.append(OuterSurface(kept, skin, body.first_vertex, 1.0))
    return tuple(found)


def _faces(mesh: Mesh, body: BodyMesh) -> NDArray[np.int32]:
    """Return the triangles of a body that are no wall of a closed cavity, (t, 3)."""
    first, count = body.first_vertex, len(body.mesh.vertices)
    own = (mesh.triangles[:, 0] >= first) & (mesh.triangles[:, 0] < first + count)
    triangles = mesh.triangles[own]
    if not mesh.cavities:
        return triangles
    walls = np.concatenate([cavity.triangles for cavity in mesh.cavities])
    outer: NDArray[np.int32] = triangles[~np.isin(_keys(triangles), _keys(walls))]
    return outer


def _keys(triangles: NDArray[np.int32]) -> NDArray[np.void]:
    """Return a key for each triangle, whatever the order of its corners, (t,)."""
    corners = np.ascontiguousarray(np.sort(triangles, axis=1), dtype=np.int32)
    return corners.view([(name, np.int32) for name in "abc"]).ravel()
