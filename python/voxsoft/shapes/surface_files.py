"""Reading of triangle surfaces from mesh files."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError, ShapeError
from voxsoft.formats.faces import faces_of
from voxsoft.formats.read import read_contents
from voxsoft.formats.report import counted_cells, held_by
from voxsoft.shapes.cad_files import HINT, WHAT, is_cad_file


class Surface(NamedTuple):
    """Triangles in the file's own unit."""

    points: NDArray[np.float64]
    triangles: NDArray[np.int64]


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
    try:
        contents = read_contents(path)
    except FileError as error:
        raise ShapeError("path", f"{error.where} {error.what}", error.hint) from error
    points, triangles = contents.points, faces_of(contents.points, contents.blocks)
    if not len(triangles):
        kinds = held_by(contents)["cells"].items()
        held = ", ".join(counted_cells(kind, count) for kind, count in kinds) or "no cells"
        raise ShapeError("path", f"{path} holds neither faces nor volume cells, but {held}")
    if triangles.min() < 0 or triangles.max() >= len(points):
        raise ShapeError("path", f"{path} is damaged: a triangle names a vertex that is missing")
    if not np.isfinite(points[np.unique(triangles)]).all():
        raise ShapeError("path", f"{path} holds coordinates that are not finite")
    merged, index = np.unique(points, axis=0, return_inverse=True)
    joined = index.reshape(-1)[triangles].astype(np.int64)
    a, b, c = joined.T
    return Surface(merged, np.ascontiguousarray(joined[(a != b) & (b != c) & (c != a)]))
