"""Voxels of one part, and the centers of their material."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.mesh import Mesh


class PartVoxels(NamedTuple):
    """Voxels of a part.

    Attributes
    ----------
    numbers
        Numbers of the voxels in the mesh, (n,).
    centers
        Centers of their material, in the frame of the body, in m, (n, 3).
    size
        Edge length in m.
    """

    numbers: NDArray[np.intp]
    centers: NDArray[np.float64]
    size: float


def part_voxels(design: Design, mesh: Mesh, index: int) -> PartVoxels | None:
    """Return the voxels of a part; None where the mesh is not one of voxels.

    Parameters
    ----------
    design
        The design, with the parts of all its bodies.
    mesh
        The mesh of its voxels.
    index
        Index of the part.
    """
    tets = slice(0, len(mesh.tets))
    vertices, size = mesh.vertices, mesh.voxel_size
    for body in mesh.bodies:
        if body.name == design.parts[index].body:
            tets = slice(body.first_tet, body.first_tet + len(body.mesh.tets))
            vertices, size = body.own(mesh.vertices), body.mesh.voxel_size
    if size is None:
        return None
    own = np.flatnonzero(mesh.tet_part[tets][::5] == index + 1) + tets.start // 5
    corners = vertices[mesh.tets.reshape(-1, 20)[own]]
    centers = (corners.min(axis=1) + corners.max(axis=1)) / 2.0
    if mesh.moments is not None:
        centers = centers + mesh.moments[own, :3] * size / 2.0
    return PartVoxels(own, centers, size)
