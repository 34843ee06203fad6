"""Parts and regions of a file of tetrahedra: as a mesh, and as surfaces for shapes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.errors import FileError, ShapeError
from voxsoft.records import closest
from voxsoft.shapes.surface_files import Surface
from voxsoft.units import format_quantity, parse

if TYPE_CHECKING:
    from voxsoft.mesh import Mesh

Floats = NDArray[np.float64]

#: Corners of the faces of a tetrahedron, outward.
_FACES: Final = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
#: Excess thickness of the box around a flat region, as a part of its length.
_ROOM: Final = 1e-6


@dataclass(frozen=True, eq=False)
class MeshBody:
    """Tetrahedra of a file, in the file's own unit.

    Attributes
    ----------
    mesh
        Tetrahedra of the file.
    parts
        Names of its parts, with their numbers in the mesh.
    regions
        Names of its regions, with the vertices of each.
    """

    mesh: Mesh
    parts: Mapping[str, int]
    regions: Mapping[str, NDArray[np.int64]]

    def surface_of(self, part: str, name: str) -> Surface:
        """Return the boundary of a part, outward; faces to other parts belong to it.

        Raises
        ------
        ShapeError
            The file, called `name` in messages, has no such part.
        """
        if part not in self.parts:
            raise ShapeError("part", f'{name} has no part "{part}"', closest(part, self.parts))
        tets = self.mesh.tets[self.mesh.tet_part == self.parts[part]]
        faces = np.concatenate([tets[:, corners] for corners in _FACES]).astype(np.int64)
        _, first, counts = np.unique(
            np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
        )
        return Surface(self.mesh.vertices, faces[first[counts == 1]])

    def distance_to(self, region: str, name: str, meter: float) -> _core.Shape:
        """Return the distance to a region [m] as a shape, which has no inside.

        Faces of the surface between vertices of the region belong to it.

        Raises
        ------
        ShapeError
            The file, called `name` in messages, has no such region.
        """
        if region not in self.regions:
            hint = closest(region, self.regions)
            raise ShapeError("region", f'{name} has no region "{region}"', hint)
        import igl
        from scipy.spatial import KDTree

        points, vertices = self.mesh.vertices * meter, self.regions[region]
        faces = self.mesh.triangles[np.isin(self.mesh.triangles, vertices).all(axis=1)]
        corners, nearest = KDTree(points[vertices]), igl.AABB()
        if len(faces):
            nearest.init(points, faces.astype(np.int64))

        def distances(places: Floats) -> Floats:
            found: Floats = np.asarray(corners.query(places)[0], dtype=np.float64)
            if len(faces):
                squared, _, _ = nearest.squared_distance(points, faces.astype(np.int64), places)
                found = np.minimum(found, np.sqrt(np.atleast_1d(squared)))
            return found

        low, high = points[vertices].min(axis=0), points[vertices].max(axis=0)
        room = _ROOM * float(np.ptp(points, axis=0).max())
        return _core.Shape.sampled(
            distances, tuple((low - room).tolist()), tuple((high + room).tolist()), True
        )


def sizes_in_units(longest: float) -> str:
    """List the length of a body [m] in each unit that its numbers may be in.

    Examples
    --------
    >>> sizes_in_units(40.0)
    'in mm: 40 mm long, cm: 400 mm long, inch: 1.02 m long, m: 40 m long'
    """
    lengths = {unit: longest * parse(f"1 {unit}", "length") for unit in ("mm", "cm", "inch", "m")}
    return "in " + ", ".join(
        f"{unit}: {format_quantity(float(f'{length:.3g}'), 'length')} long"
        for unit, length in lengths.items()
    )


def read_body(file: Path) -> MeshBody:
    """Read a file of tetrahedra, cached until it changes.

    Raises
    ------
    FileError
        It cannot be read, or holds no valid tetrahedra.
    """
    try:
        status = file.stat()
    except OSError as error:
        what = f'"{file}" cannot be read: {error.strerror}'
        raise FileError("path", what, "check the path; it begins at the design's folder") from None
    return _read(file, (status.st_mtime_ns, status.st_size))


@lru_cache(maxsize=8)
def _read(file: Path, changed: tuple[int, int]) -> MeshBody:
    """Read a file; `changed` differs where its content may."""
    del changed
    # `files` lies above shapes: a shape or a design reaches up for its mesh, when it is read.
    from voxsoft.files.meshes import read_mesh_file

    # Read as if in m: the numbers of the file stay as they are, and users add the unit.
    found = read_mesh_file(file, unit="m")
    names = {} if found.report is None else found.report.parts
    numbers = np.unique(found.mesh.tet_part).tolist()
    parts = {f"part-{number}": number for number in numbers}
    parts |= {name: number for number, name in names.items()}
    return MeshBody(found.mesh, parts, found.regions)
