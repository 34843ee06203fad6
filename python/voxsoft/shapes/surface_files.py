"""Reading of triangle surfaces from mesh files."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import ShapeError

_SUFFIXES = (".stl", ".obj", ".ply", ".vtk", ".vtu")

#: The four faces of a tet, outward where the tet's volume is positive.
_TET_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))


class Surface(NamedTuple):
    """Triangles in the file's own unit."""

    points: NDArray[np.float64]
    triangles: NDArray[np.int64]


def read_surface(path: Path) -> Surface:
    """Read the triangles of a file, or the boundary of its tets.

    Vertices at the same place become one, as STL files repeat them for every triangle.

    Raises
    ------
    ShapeError
        For an unknown suffix, an unreadable file, NaN, and a file without triangles or tets.
    """
    if path.suffix.lower() not in _SUFFIXES:
        what = f"{path.name} is none of {' '.join(_SUFFIXES)}"
        raise ShapeError("path", what, "convert it, for instance with meshio")
    points, triangles = _first_that_reads(path)
    points = np.ascontiguousarray(points[:, :3], dtype=np.float64)
    if not len(triangles):
        raise ShapeError("path", f"{path} holds neither triangles nor tets")
    if triangles.min() < 0 or triangles.max() >= len(points):
        raise ShapeError("path", f"{path} is damaged: a triangle names a vertex that is missing")
    if not np.isfinite(points[np.unique(triangles)]).all():
        raise ShapeError("path", f"{path} holds coordinates that are not finite")
    merged, index = np.unique(points, axis=0, return_inverse=True)
    joined = index.reshape(-1)[triangles].astype(np.int64)
    a, b, c = joined.T
    return Surface(merged, np.ascontiguousarray(joined[(a != b) & (b != c) & (c != a)]))


def _first_that_reads(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Try meshio, then trimesh, which takes some STL, OBJ and PLY dialects that meshio does not."""
    readers: tuple[Callable[[Path], tuple[NDArray[np.float64], NDArray[np.int64]]], ...]
    is_vtk = path.suffix.lower() in (".vtk", ".vtu")
    readers = (_read_by_meshio,) if is_vtk else (_read_by_meshio, _read_by_trimesh)
    reasons = []
    for read in readers:
        try:
            return read(path)
        except ShapeError:
            raise
        # meshio ends the program on some unreadable files; the readers fail in many other ways.
        except (Exception, SystemExit) as error:
            reasons.append(str(error) or type(error).__name__)
    what = f"{path} cannot be read ({'; '.join(reasons)})"
    raise ShapeError("path", what, "check that the file is complete")


def _read_by_meshio(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    import contextlib
    import io

    import meshio

    # Some programs write the XML format of VTU under the older suffix.
    is_xml = path.suffix.lower() == ".vtk" and path.read_bytes()[:64].lstrip().startswith(b"<")
    with (
        warnings.catch_warnings(),
        contextlib.redirect_stdout(io.StringIO()),
        contextlib.redirect_stderr(io.StringIO()),
    ):
        warnings.simplefilter("ignore")
        mesh = meshio.read(path, file_format="vtu" if is_xml else None)
    points = np.asarray(mesh.points, dtype=np.float64)
    faces = [block.data for block in mesh.cells if block.type == "triangle"]
    for quads in (block.data for block in mesh.cells if block.type == "quad"):
        faces += [quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]
    tets = [block.data for block in mesh.cells if block.type == "tetra"]
    if tets:
        return points, _boundary(points, np.concatenate(tets).astype(np.int64))
    if not faces:
        raise ShapeError("path", f"{path} holds neither triangles nor tets")
    return points, np.concatenate(faces).astype(np.int64)


def _read_by_trimesh(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    import trimesh

    mesh = trimesh.load_mesh(path, process=False)
    if not isinstance(mesh, trimesh.Trimesh):
        mesh = mesh.to_mesh()
    return np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces, dtype=np.int64)


def _boundary(points: NDArray[np.float64], tets: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the faces that belong to one tet only, pointing outward."""
    a, b, c, d = (points[tets[:, i]] for i in range(4))
    is_turned = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    tets = np.where(is_turned[:, None], tets[:, [0, 2, 1, 3]], tets)
    faces = tets[:, np.array(_TET_FACES)].reshape(-1, 3)
    _, first, uses = np.unique(
        np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
    )
    outer: NDArray[np.int64] = faces[first[uses == 1]]
    return outer
