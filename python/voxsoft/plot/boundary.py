"""Surface of a body in a picture: all of it, or the part that a cut leaves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from voxsoft.mesh import Mesh

Axis = Literal["x", "y", "z"]

# Four faces of a tetrahedron of positive volume, outward.
_FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


@dataclass(frozen=True)
class Boundary:
    """Triangles that enclose material.

    Attributes
    ----------
    triangles : ndarray of int64, shape (t, 3)
        Vertex indices, outward.
    part : ndarray of uint8, shape (t,)
        Part behind each triangle.
    cavity : ndarray of int64, shape (t,)
        Cavity in front of each triangle, counted from 0; -1 where it is the outside.
    """

    triangles: NDArray[np.int64]
    part: NDArray[np.uint8]
    cavity: NDArray[np.int64]


def boundary_of(mesh: Mesh, kept: NDArray[np.bool_]) -> Boundary:
    """Return the boundary of some of a mesh's tetrahedra.

    Parameters
    ----------
    mesh
        The mesh.
    kept
        Mask of the tetrahedra, (m,).

    Examples
    --------
    >>> from voxsoft.voxels import Voxels
    >>> mesh = Voxels.from_array([[[1, 1]]], voxel_size=0.005).mesh()
    >>> len(boundary_of(mesh, mesh.tet_voxel == 0).triangles)
    12
    """
    tets = mesh.tets[kept].astype(np.int64)
    faces = tets[:, _FACES].reshape(-1, 3)
    surfaces = [cavity.triangles.astype(np.int64) for cavity in mesh.cavities]
    labels = _labels(np.concatenate([faces, *surfaces]), len(mesh.vertices))
    of_face, of_cavity = labels[: len(faces)], labels[len(faces) :]
    single = np.bincount(of_face, minlength=len(labels))[of_face] == 1
    cavity_of_label = np.full(len(labels), -1, dtype=np.int64)
    cavity_of_label[of_cavity] = np.repeat(np.arange(len(surfaces)), [len(s) for s in surfaces])
    owner = np.repeat(np.flatnonzero(kept), len(_FACES))[single]
    return Boundary(faces[single], mesh.tet_part[owner], cavity_of_label[of_face[single]])


def beyond(mesh: Mesh, axis: Axis, position: float, side: int) -> NDArray[np.bool_]:
    """Select the tetrahedra on one side of a plane; voxels stay whole.

    Parameters
    ----------
    mesh
        The mesh.
    axis
        Normal of the plane.
    position
        Position of the plane on the axis, in m.
    side
        Side to select: 1 for beyond the plane along the axis, -1 for before it.

    Returns
    -------
    ndarray of bool, shape (m,)
    """
    centers = mesh.vertices[mesh.tets, "xyz".index(axis)].mean(axis=1)
    if mesh.tet_voxel is not None:
        # The corners of a voxel's five tetrahedra, as often as they come, average to its center.
        sums = np.bincount(mesh.tet_voxel, weights=centers)
        centers = (sums / np.bincount(mesh.tet_voxel))[mesh.tet_voxel]
    kept: NDArray[np.bool_] = side * (centers - position) > 0.0
    return kept


def _labels(faces: NDArray[np.int64], vertices: int) -> NDArray[np.int64]:
    """Give faces with the same corners the same number.

    Two corners are numbered first, as three do not fit in 64 bits.
    """
    a, b, c = np.sort(faces, axis=1).T
    _, pair = np.unique(a * vertices + b, return_inverse=True)
    _, label = np.unique(pair * vertices + c, return_inverse=True)
    numbers: NDArray[np.int64] = label.astype(np.int64)
    return numbers
