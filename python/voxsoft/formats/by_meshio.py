"""Reader of other formats, by meshio."""

from __future__ import annotations

import contextlib
import io
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError
from voxsoft.formats.contents import CellBlock, Contents

if TYPE_CHECKING:
    import meshio


def read(path: Path) -> Contents:
    """Read a file by meshio, without its output on the terminal.

    Raises
    ------
    FileError
        If meshio cannot read it, with meshio's message if it has one.
    """
    import meshio

    output = io.StringIO()
    try:
        with (
            warnings.catch_warnings(),
            contextlib.redirect_stdout(output),
            contextlib.redirect_stderr(output),
        ):
            warnings.simplefilter("ignore")
            data = meshio.read(path)
    except ImportError as error:
        what = f"needs the package {error.name} to be read"
        raise FileError(str(path), what, f"pip install {error.name}") from error
    # meshio raises all errors of its parsers, and exits the program in places.
    except (Exception, SystemExit) as error:
        words = "meshio does not understand its content"
        if isinstance(error, SystemExit):
            words = " ".join(output.getvalue().split()).removeprefix("Error: ") or words
        elif isinstance(error, meshio.ReadError):
            words = str(error) or words
        what = f"cannot be read as {path.suffix.lstrip('.').upper()}: {words[:200].strip()}"
        raise FileError(str(path), what, "save it again, or as .vtu, .msh or .inp") from error
    return contents_of(data, path.suffix.lower().lstrip("."))


def contents_of(data: meshio.Mesh, name: str) -> Contents:
    """Return a mesh of meshio as contents.

    Examples
    --------
    >>> import meshio
    >>> flat = meshio.Mesh([[0, 0], [1, 0], [0, 1]], [("triangle", [[0, 1, 2]])])
    >>> contents_of(flat, "mesh").points.shape
    (3, 3)
    """
    # Some files hold colors behind the coordinates, and plane ones two coordinates.
    points = np.asarray(data.points, dtype=np.float64)
    plane = np.zeros((len(points), max(0, 3 - points.shape[1])))
    points = np.ascontiguousarray(np.hstack([points, plane])[:, :3])
    blocks, notes = [], []
    for block in data.cells:
        rows = np.asarray(block.data)
        if rows.dtype.kind not in "iu" or rows.ndim != 2:
            notes.append(f"{len(block.data)} cells of kind {block.type} have no rows of nodes")
            rows = np.empty((0, 1), np.int64)
        blocks.append(CellBlock(block.type, rows.astype(np.int64)))
    firsts = np.cumsum([0, *(len(block.nodes) for block in blocks)])
    whole = [
        len(cells.data) == len(block.nodes) for cells, block in zip(data.cells, blocks, strict=True)
    ]
    arrays: dict[str, NDArray[np.float64]] = {}
    for key, values in data.cell_data.items():
        each = [np.asarray(v) for v, kept in zip(values, whole, strict=True) if kept]
        # VTK files hold numbers as columns of one.
        each = [v[:, 0] if v.ndim == 2 and v.shape[1] == 1 else v for v in each]
        if all(v.ndim == 1 and v.dtype.kind in "biuf" for v in each) and each:
            arrays[key] = np.concatenate(each).astype(np.float64)
        else:
            notes.append(f'Array "{key}" on cells is not of single numbers')
    cell_sets = {
        key: np.unique(np.concatenate([
            np.asarray([] if each is None else each, dtype=np.int64) + first
            for each, first in zip(members, firsts[:-1], strict=False)
        ]))
        for key, members in data.cell_sets.items()
        if key not in arrays
    }  # fmt: skip
    point_sets = {key: np.unique(np.asarray(v, np.int64)) for key, v in data.point_sets.items()}
    notes += [f'Array "{key}" on points is not read' for key in data.point_data]
    return Contents(
        points, tuple(blocks), cell_sets, point_sets, arrays, notes=tuple(notes), format=name
    )
