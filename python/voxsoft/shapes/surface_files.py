"""Reading of triangle surfaces from mesh files."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError, ShapeError
from voxsoft.formats.read import READERS, read_contents
from voxsoft.shapes.cad_files import HINT, WHAT, is_cad_file
from voxsoft.shapes.faces import faces_of

#: What trimesh reads too, and takes some dialects of that meshio does not.
_BY_TRIMESH = (".stl", ".obj", ".ply", ".off")

#: Formats of meshio that are drawings.
_DRAWINGS = {".svg", ".wkt"}


class Surface(NamedTuple):
    """Triangles in the file's own unit."""

    points: NDArray[np.float64]
    triangles: NDArray[np.int64]


@cache
def known_suffixes() -> tuple[str, ...]:
    """Return the endings of the files that can be read: all that meshio reads meshes from.

    Examples
    --------
    >>> {".stl", ".obj", ".ply", ".off", ".mesh", ".msh", ".vtu"} <= set(known_suffixes())
    True
    """
    import meshio

    return tuple(sorted(set(meshio.extension_to_filetypes) - _DRAWINGS))


def read_surface(path: Path) -> Surface:
    """Read the triangles of a file, or the boundary of its volume cells.

    Vertices at the same place become one, as STL files repeat them for every triangle. Cells with
    curved edges are taken by their corners.

    Raises
    ------
    ShapeError
        For a CAD model, an unknown suffix, an unreadable file, NaN, and a file without faces or
        volume cells.
    """
    if is_cad_file(path.name):
        raise ShapeError("path", f"{path.name} {WHAT}", HINT)
    if not path.name.lower().endswith(known_suffixes()):
        what = f"{path.name} is none of {' '.join(known_suffixes())}"
        raise ShapeError("path", what, "export the part as STL or OBJ")
    points, triangles = _first_that_reads(path)
    # Some files hold colors behind the coordinates, and plane ones two coordinates.
    plane = np.zeros((len(points), max(0, 3 - points.shape[1])))
    points = np.ascontiguousarray(np.hstack([points, plane])[:, :3], dtype=np.float64)
    if not len(triangles):
        raise ShapeError("path", f"{path} holds neither triangles nor volume cells")
    if triangles.min() < 0 or triangles.max() >= len(points):
        raise ShapeError("path", f"{path} is damaged: a triangle names a vertex that is missing")
    if not np.isfinite(points[np.unique(triangles)]).all():
        raise ShapeError("path", f"{path} holds coordinates that are not finite")
    merged, index = np.unique(points, axis=0, return_inverse=True)
    joined = index.reshape(-1)[triangles].astype(np.int64)
    a, b, c = joined.T
    return Surface(merged, np.ascontiguousarray(joined[(a != b) & (b != c) & (c != a)]))


def _first_that_reads(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Try meshio, then trimesh."""
    readers: list[Callable[[Path], tuple[NDArray[np.float64], NDArray[np.int64]]]]
    readers = [_read_contents if path.suffix.lower() in READERS else _read_by_meshio]
    if path.suffix.lower() in _BY_TRIMESH:
        readers.append(_read_by_trimesh)
    reasons: list[BaseException] = []
    for read in readers:
        try:
            return read(path)
        # meshio ends the program on some unreadable files; the readers fail in many other ways.
        except (Exception, SystemExit) as error:
            reasons.append(error)
    raise _unreadable(path, reasons)


def _unreadable(path: Path, reasons: list[BaseException]) -> ShapeError:
    """Say why, as far as the readers' own words can be understood."""
    if not path.is_file():
        return ShapeError("path", f"{path}: there is no such file", "check the path")
    first = reasons[0]
    if isinstance(first, ImportError) and first.name:
        what = f"{path} needs the package {first.name} to be read"
        return ShapeError("path", what, f"pip install {first.name}, or export the part as STL")
    if isinstance(first, FileError):
        return ShapeError("path", str(first).partition(". Try: ")[0], first.hint)
    why = str(first) if isinstance(first, (ShapeError, _ReportedError)) else ""
    if path.suffix.lower() == ".stl" and not _looks_like_stl(path):
        why = (
            'it neither begins with "solid", as text does, nor has the length that a binary file '
            "of its number of triangles has"
        )
    kind = path.suffix.lstrip(".").upper()
    what = f"{path} cannot be read as {kind}: {why or 'its content is damaged or cut short'}"
    return ShapeError("path", what, "check that the file is complete, and that its ending is right")


def _looks_like_stl(path: Path) -> bool:
    """80 bytes of anything, the number of triangles, and 50 bytes for each; or text."""
    with path.open("rb") as file:
        head = file.read(84)
    count = int.from_bytes(head[80:84], "little")
    return head.lstrip()[:5].lower() == b"solid" or path.stat().st_size == 84 + 50 * count


class _ReportedError(Exception):
    """What a reader printed before it ended the program."""


def _read_contents(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    contents = read_contents(path)
    cells = [(block.kind, block.nodes) for block in contents.blocks]
    return contents.points, faces_of(contents.points, cells)


def _read_by_meshio(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    import contextlib
    import io

    import meshio

    # Some programs write the XML format of VTU under the older suffix.
    is_xml = path.suffix.lower() == ".vtk" and path.read_bytes()[:64].lstrip().startswith(b"<")
    output = io.StringIO()
    with (
        warnings.catch_warnings(),
        contextlib.redirect_stdout(output),
        contextlib.redirect_stderr(output),
    ):
        warnings.simplefilter("ignore")
        try:
            mesh = meshio.read(path, file_format="vtu" if is_xml else None)
        except SystemExit:
            words = " ".join(output.getvalue().split()).removeprefix("Error: ")
            raise _ReportedError(words[:200]) from None
    points = np.asarray(mesh.points, dtype=np.float64)
    triangles = faces_of(points, [(block.type, block.data) for block in mesh.cells])
    if not len(triangles):
        kinds = ", ".join(sorted({block.type for block in mesh.cells})) or "no cells"
        raise ShapeError("path", f"it holds neither faces nor volume cells, but {kinds}")
    return points, triangles


def _read_by_trimesh(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    import trimesh

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mesh = trimesh.load_mesh(path, process=False)
    if not isinstance(mesh, trimesh.Trimesh):
        mesh = mesh.to_mesh()
    return np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces, dtype=np.int64)
