"""Smooth surface of a body: that of its shapes, carried by its voxels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Contact, Design
from voxsoft.design.discretization.cut_cells import built_parts
from voxsoft.mesh import Mesh


def skin_of(design: Design, mesh: Mesh) -> _core.Skin | None:
    """Put the points of the faces of voxels on the surface of the shapes that filled them.

    Returns
    -------
    _core.Skin or None
        None for a mesh whose voxels are not those that the shapes filled: of other elements, or
        cut into smaller ones. Faces of voxels where no shape has its surface stay as they are.

    Raises
    ------
    ShapeError
        A shape has no value somewhere.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.design.discretization.discretize import mesh_of
    >>> ball = families.sphere().replace(fill="binary")
    >>> skin = skin_of(ball, mesh_of(ball))
    >>> skin is not None and skin.triangles.shape[1]
    3
    >>> skin_of(ball, mesh_of(ball, refine=2)) is None
    True
    """
    if not has_skin(design, mesh):
        return None
    return _core.Skin(built_parts(design), mesh.vertices, corners(mesh))


def has_skin(design: Design, mesh: Mesh) -> bool:
    """Return True if the voxels of a mesh are those that the shapes of a design filled.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.design.discretization.discretize import mesh_of
    >>> ball = families.sphere().replace(fill="binary")
    >>> has_skin(ball, mesh_of(ball)), has_skin(ball, mesh_of(ball, refine=2))
    (True, False)
    """
    size = mesh.voxel_size
    if size is None or mesh.tet_voxel is None:
        return False
    return design.has_cut_voxels or size == design.voxel_size


def touches_with_skin(design: Design, own: Design, mesh: Mesh) -> bool:
    """Return True if contact of a body uses its smooth surface; `own` is the body's own design.

    Examples
    --------
    >>> from voxsoft.design import Contact, families
    >>> from voxsoft.design.discretization.discretize import mesh_of
    >>> ball = families.sphere()
    >>> touching = ball.model_copy(update={"contact": Contact()})
    >>> mesh = mesh_of(ball)
    >>> touches_with_skin(ball, ball, mesh), touches_with_skin(touching, touching, mesh)
    (False, True)
    """
    if design.contact is None and not design.objects and len(design.body_names) == 1:
        return False
    contact = design.contact or Contact()
    return contact.surface == "smooth" and has_skin(own, mesh)


def corners(mesh: Mesh) -> NDArray[np.uint32]:
    """Return the vertices at the corners of each voxel, (n, 8).

    Corner ``c`` is the far one along x where ``c & 4``, along y where ``c & 2``, along z where
    ``c & 1``.

    Examples
    --------
    >>> from voxsoft.voxels import Voxels
    >>> mesh = Voxels.from_array([[[1, 1]]], voxel_size=1.0).mesh()
    >>> mesh.vertices[corners(mesh)[1]][[0, 1, 7]].tolist()
    [[0.0, 0.0, 1.0], [0.0, 0.0, 2.0], [1.0, 1.0, 2.0]]
    """
    of_voxel = mesh.tets.reshape(-1, 20)
    at = mesh.vertices[of_voxel]
    middle = (at.min(axis=1, keepdims=True) + at.max(axis=1, keepdims=True)) / 2.0
    number = (at > middle) @ np.array([4, 2, 1])
    found = np.zeros((len(of_voxel), 8), dtype=np.uint32)
    np.put_along_axis(found, number, of_voxel.astype(np.uint32), axis=1)
    return found
