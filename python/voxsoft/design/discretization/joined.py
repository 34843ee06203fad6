"""Meshes of several bodies as one mesh."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from voxsoft.cavity import MeshCavity
from voxsoft.mesh import BodyMesh, Mesh

Floats = NDArray[np.float64]
#: The name of a body, its mesh, its rotation and its position.
Placed = tuple[str, Mesh, tuple[Floats, Floats], NDArray[np.uint8]]


def joined(placed: Iterable[Placed]) -> Mesh:
    """Join meshes of voxels, each in a pose of its own; they share no vertex.

    Parameters
    ----------
    placed
        For each body its name, its mesh, rotation matrix (3, 3) and position [m], (3,), and the
        numbers of its parts among all, for those of its mesh, which count from 1.

    Returns
    -------
    Mesh
        With :attr:`~voxsoft.Mesh.bodies`.

    Examples
    --------
    >>> from voxsoft.voxels import Voxels
    >>> cube = Voxels.from_array([[[1]]], voxel_size=0.01).mesh()
    >>> poses = [(np.eye(3), np.zeros(3)), (np.eye(3), np.array([0.1, 0.0, 0.0]))]
    >>> numbers = [np.array([0, 1], np.uint8), np.array([0, 2], np.uint8)]
    >>> mesh = joined(zip(["left", "right"], [cube, cube], poses, numbers))
    >>> len(mesh.vertices), np.unique(mesh.tet_part).tolist(), mesh.bodies[1].first_vertex
    (16, [1, 2], 8)
    """
    bodies: list[BodyMesh] = []
    parts: list[NDArray[np.uint8]] = []
    vertex = tet = 0
    for name, mesh, (rotation, position), numbers in placed:
        bodies.append(BodyMesh(name, mesh, rotation, position, vertex, tet))
        parts.append(numbers[mesh.tet_part])
        vertex, tet = vertex + len(mesh.vertices), tet + len(mesh.tets)
    meshes = [body.mesh for body in bodies]
    shifted = zip(meshes, (body.first_vertex for body in bodies), strict=True)
    voxels = [(body.mesh.tet_voxel, body.first_tet // 5) for body in bodies]
    cut = any(mesh.fractions is not None for mesh in meshes)
    indices = [(m.tets + first, m.edges + first, m.triangles + first) for m, first in shifted]
    cavities = [of_body(each, body) for body in bodies for each in body.mesh.cavities]
    return Mesh(
        vertices=np.concatenate([body.placed(body.mesh.vertices) for body in bodies]),
        tets=np.concatenate([tets for tets, _, _ in indices]),
        edges=np.concatenate([edges for _, edges, _ in indices]),
        triangles=np.concatenate([triangles for _, _, triangles in indices]),
        tet_part=np.concatenate(parts),
        tet_voxel=np.concatenate([each + first for each, first in voxels if each is not None]),
        voxel_size=min(mesh.voxel_size for mesh in meshes if mesh.voxel_size is not None),
        cavities=tuple(sorted(cavities, key=lambda cavity: -cavity.volume)),
        fractions=np.concatenate([_fractions(mesh) for mesh in meshes]) if cut else None,
        moments=np.concatenate([_moments(mesh) for mesh in meshes]) if cut else None,
        surfaces=np.concatenate([_surfaces(mesh) for mesh in meshes]) if cut else None,
        bodies=tuple(bodies),
    )


def edge_directions(mesh: Mesh) -> Floats | None:
    """The directions of the edges of each voxel, (v, 9): x, y and z of its body in turn.

    None where all are along the axes.
    """
    if all(body.is_along_axes for body in mesh.bodies):
        return None
    rows = [np.tile(body.rotation.T.ravel(), (len(body.mesh.tets) // 5, 1)) for body in mesh.bodies]
    return np.concatenate(rows)


def of_body(cavity: MeshCavity, body: BodyMesh) -> MeshCavity:
    """A cavity of the own mesh of a body among those of the joined mesh."""
    first = np.int32(body.first_vertex)
    names = ("triangles", "void_tets", "other_triangles")
    arrays = {name: getattr(cavity, name) for name in names}
    moved = {name: array + first for name, array in arrays.items() if array is not None}
    return replace(cavity, body=body.name, **moved)


def own_cavities(mesh: Mesh, body: BodyMesh) -> tuple[MeshCavity, ...]:
    """The cavities of a body among those of the joined mesh, as cavities of its own mesh."""
    back = replace(body, first_vertex=-body.first_vertex)
    return tuple(of_body(each, back) for each in mesh.cavities if each.body == body.name)


def _fractions(mesh: Mesh) -> Floats:
    return np.ones(len(mesh.tets) // 5) if mesh.fractions is None else mesh.fractions


def _moments(mesh: Mesh) -> Floats:
    full = [0.0] * 3 + [1.0] * 3 + [0.0] * 3
    return np.tile(full, (len(mesh.tets) // 5, 1)) if mesh.moments is None else mesh.moments


def _surfaces(mesh: Mesh) -> Floats:
    return np.zeros((len(mesh.tets) // 5, 9)) if mesh.surfaces is None else mesh.surfaces
