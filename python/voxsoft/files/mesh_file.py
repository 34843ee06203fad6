"""Contents of a mesh file in any format."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from voxsoft.cavity import MeshCavity
from voxsoft.errors import FileError
from voxsoft.formats.report import ReadReport
from voxsoft.mesh import Mesh


@dataclass(frozen=True, eq=False)
class MeshFile:
    """A mesh with its named regions and data.

    Attributes
    ----------
    mesh : Mesh
        Vertices, tets, parts and cavities.
    regions : mapping of str to ndarray of int, shape (r,)
        Vertices of each named region, ascending.
    point_data : mapping of str to ndarray, shape (n, ...)
        Values at the vertices.
    cell_data : mapping of str to ndarray, shape (m, ...)
        Values of the tets.
    """

    mesh: Mesh
    regions: Mapping[str, NDArray[np.int64]] = field(default_factory=dict)
    point_data: Mapping[str, NDArray[np.generic]] = field(default_factory=dict)
    cell_data: Mapping[str, NDArray[np.generic]] = field(default_factory=dict)

    @property
    def report(self) -> ReadReport | None:
        """Report on the read; None for a mesh that was not read from a file."""
        return self.mesh.report


def with_cavities(mesh: Mesh, surfaces: list[NDArray[np.integer]], path: str) -> Mesh:
    """Return the mesh with the cavities that a file names, in place of the detected ones.

    Raises
    ------
    FileError
        If a triangle of a cavity is not on the boundary of the mesh.
    """
    boundary = {tuple(sorted(triangle)) for triangle in mesh.triangles.tolist()}
    cavities = []
    for number, triangles in enumerate(surfaces, start=1):
        for triangle in triangles.tolist():
            if tuple(sorted(triangle)) not in boundary:
                what = f"cavity {number} has triangle {triangle}, which is not on the boundary"
                raise FileError(path, what, "write the file again from the mesh")
        cavities.append(MeshCavity(triangles.astype(np.int32), *_measure(mesh, triangles)))
    return replace(mesh, cavities=tuple(cavities))


def _measure(mesh: Mesh, triangles: NDArray[np.integer]) -> tuple[float, float]:
    """Return the volume that triangles pointing inward enclose, and their area."""
    origin = mesh.vertices[triangles[0, 0]]
    a, b, c = (mesh.vertices[triangles[:, corner]] - origin for corner in range(3))
    volume = -float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)
    area = float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0)
    return volume, area


def vertex_set(path: str, name: str, vertices: ArrayLike, count: int) -> NDArray[np.int64]:
    """Return the vertices of a region, ascending and each once.

    Raises
    ------
    FileError
        If the region is empty or names a vertex that does not exist.
    """
    array = np.unique(np.asarray(vertices))
    if array.size == 0:
        raise FileError(path, f"region {name!r} has no vertex", "leave it out, or correct it")
    if array.dtype.kind not in "iu" or array[0] < 0 or array[-1] >= count:
        what = f"region {name!r} must hold vertex indices from 0 to {count - 1}"
        raise FileError(path, what, "give indices, not positions or a mask")
    return array.astype(np.int64)
