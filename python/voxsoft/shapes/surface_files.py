"""Reading of triangle surfaces from mesh files."""

from __future__ import annotations

from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError, ShapeError
from voxsoft.formats.contents import CellBlock, Contents
from voxsoft.formats.faces import faces_of
from voxsoft.formats.read import read_contents
from voxsoft.formats.registry import READ
from voxsoft.formats.report import counted_cells, held_by
from voxsoft.records import closest
from voxsoft.shapes.cad_files import HINT, WHAT, is_cad_file

#: Array of labels of images and of arrays of voxels.
LABEL: Final = "label"


class Surface(NamedTuple):
    """Triangles in the file's own unit."""

    points: NDArray[np.float64]
    triangles: NDArray[np.int64]


def read_surface(path: Path, part: str | None = None) -> Surface:
    """Read the triangles of a file, or the boundary of its volume cells.

    Vertices at the same place become one, as STL files repeat them for every triangle. Cells with
    curved edges are taken by their corners.

    Parameters
    ----------
    path
        Path of the file.
    part
        Name of an object, group or solid of a surface file; default: all.

    Raises
    ------
    ShapeError
        For a CAD model, an unknown suffix, an unreadable file, NaN, a file without faces or volume
        cells, and a part that the file does not have.
    """
    if is_cad_file(path.name):
        raise ShapeError("path", f"{path.name} {WHAT}", HINT)
    try:
        contents = read_contents(path)
    except FileError as error:
        raise ShapeError("path", f"{error.where} {error.what}", error.hint) from error
    blocks = contents.blocks if part is None else _blocks_of(contents, part, path.name)
    points, triangles = contents.points, faces_of(contents.points, blocks)
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


def has_own_parts(path: Path) -> bool:
    """Return True for a format of surfaces, whose parts are groups of its triangles.

    Examples
    --------
    >>> has_own_parts(Path("arm.3mf")), has_own_parts(Path("arm.msh"))
    (True, False)
    """
    form = READ.get(path.suffix.lower())
    return form is not None and form.kind == "surface"


def parts_in(contents: Contents) -> tuple[str, ...]:
    """Return the names of parts of a surface file; none where one of them is open, or it is one.

    Examples
    --------
    >>> parts_in(Contents(np.zeros((0, 3)), ()))
    ()
    """
    names = tuple(contents.cell_sets)
    if len(names) < 2:
        return ()
    for name in names:
        faces = faces_of(contents.points, _selected(contents, contents.cell_sets[name]))
        _, index = np.unique(contents.points, axis=0, return_inverse=True)
        edges = np.sort(index.reshape(-1)[faces][:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        _, counts = np.unique(edges, axis=0, return_counts=True)
        if not len(faces) or (counts % 2).any():
            return ()
    return names


def labels_in(contents: Contents) -> tuple[str, ...]:
    """Return the names of parts of an image or an array by its labels; none where it is one.

    Examples
    --------
    >>> cube = CellBlock("hexahedron", np.zeros((3, 8), np.int64))
    >>> labels = {"label": np.array([2.0, 7.0, 2.0])}
    >>> labels_in(Contents(np.zeros((0, 3)), (cube,), arrays=labels))
    ('label 2', 'label 7')
    """
    is_image = [block.kind for block in contents.blocks] == ["hexahedron"]
    if not is_image or contents.arrays.keys() != {LABEL} or contents.cell_sets:
        return ()
    labels = np.unique(contents.arrays[LABEL])
    return tuple(f"{LABEL} {int(label)}" for label in labels) if len(labels) > 1 else ()


def _blocks_of(contents: Contents, part: str, name: str) -> list[CellBlock]:
    if part not in contents.cell_sets:
        hint = closest(part, contents.cell_sets)
        raise ShapeError("part", f'{name} has no part "{part}"', hint)
    return _selected(contents, contents.cell_sets[part])


def _selected(contents: Contents, cells: NDArray[np.int64]) -> list[CellBlock]:
    blocks, first = [], 0
    for block in contents.blocks:
        own = cells[(cells >= first) & (cells < first + len(block.nodes))] - first
        blocks.append(CellBlock(block.kind, block.nodes[own]))
        first += len(block.nodes)
    return blocks
