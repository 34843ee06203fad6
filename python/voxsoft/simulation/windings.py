"""Wound fibers on a mesh: whether there is a way around their axis everywhere."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import rounded
from voxsoft.design import Design
from voxsoft.errors import DesignError
from voxsoft.materials import Fiber
from voxsoft.mesh import Mesh

Floats = NDArray[np.float64]


def check_windings(design: Design, mesh: Mesh) -> None:
    """Check that no part with wound fibers lies on their axis.

    Within a voxel of the axis the direction around it turns by more than a radian from one end of
    a voxel to the other, and nothing stands for it.

    Parameters
    ----------
    design
        The design, with the parts of all its bodies.
    mesh
        Of its voxels.

    Raises
    ------
    DesignError
        The axis of a family of fibers runs through the part that has them.
    """
    for index, number, fiber in _wound(design):
        for points, size in _material(design, mesh, index):
            near = fiber.distances(points) < size
            if near.any():
                x, y, z = (rounded(1e3 * value) for value in points[near][0])
                raise DesignError(
                    f"parts[{index}].fibers[{number}].axis",
                    f"runs through the part itself, at ({x}, {y}, {z}) mm: there is no way around"
                    " it within a voxel of it",
                    "give what is wound, such as the wall without its ends, a part of its own, "
                    "or move the axis by center",
                )


def _wound(design: Design) -> Iterator[tuple[int, int, Fiber]]:
    for index, part in enumerate(design.parts):
        for number, fiber in enumerate(part.fibers):
            if fiber.is_wound:
                yield index, number, fiber


def _material(design: Design, mesh: Mesh, index: int) -> Iterator[tuple[Floats, float]]:
    """Where in its body the material of each voxel of a part is [m], (n, 3), and their size."""
    tets = slice(0, len(mesh.tets))
    vertices, size = mesh.vertices, mesh.voxel_size
    for body in mesh.bodies:
        if body.name == design.parts[index].body:
            tets = slice(body.first_tet, body.first_tet + len(body.mesh.tets))
            vertices, size = body.own(mesh.vertices), body.mesh.voxel_size
    if size is None:
        return
    own = np.flatnonzero(mesh.tet_part[tets][::5] == index + 1) + tets.start // 5
    corners = vertices[mesh.tets.reshape(-1, 20)[own]]
    middle = (corners.min(axis=1) + corners.max(axis=1)) / 2.0
    if mesh.moments is not None:
        middle = middle + mesh.moments[own, :3] * size / 2.0
    yield middle, size
