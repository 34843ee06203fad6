"""Grids of VTK: cells from the numbers of points, and cells of images by their labels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import counted
from voxsoft.errors import FileError
from voxsoft.formats.vtk_data import GHOSTS, HIDDEN, Array, DataSet, Indices

#: Largest number of labels that can be parts.
_MOST: Final = 255
_HEXAHEDRON, _QUAD, _LINE, _VERTEX = 12, 9, 3, 1
_HINT: Final = (
    "save whole numbers, one for each material and 0 outside, as a threshold or a segmentation "
    "makes them"
)


def curved_grid(
    where: str,
    points: NDArray[np.float64],
    counts: tuple[int, ...],
    cell_arrays: dict[str, Array],
    point_arrays: dict[str, Array],
    notes: tuple[str, ...] = (),
) -> DataSet:
    """Return a grid of given points, x fastest, as cells.

    Parameters
    ----------
    where
        Name of the file, for messages.
    points
        Coordinates, (n, 3).
    counts
        Number of points along each axis; their product is n.
    cell_arrays, point_arrays, notes
        See :class:`~voxsoft.formats.vtk_data.DataSet`.

    Raises
    ------
    FileError
        If there are more or fewer points.

    Examples
    --------
    >>> points = np.array([[x, y, 0] for y in (0, 1) for x in (0, 1, 2)], float)
    >>> grid = curved_grid("a.vts", points, (3, 2, 1), {}, {})
    >>> grid.types.tolist(), grid.nodes.tolist()
    ([9, 9], [0, 1, 4, 3, 1, 2, 5, 4])
    """
    if len(counts) != 3 or len(points) != np.prod(counts):
        shape = " × ".join(f"{n:,}" for n in counts)
        raise FileError(where, f"is damaged: a grid of {shape} has {len(points):,} points")
    rows = _corners(counts)
    size = rows.shape[1]
    type_ = {8: _HEXAHEDRON, 4: _QUAD, 2: _LINE, 1: _VERTEX}[size]
    return DataSet(
        points,
        np.full(len(rows), type_),
        np.arange(len(rows) + 1) * size,
        rows.ravel(),
        cell_arrays,
        point_arrays,
        notes,
    )


def crossed(axes: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
    """Return the points of a grid of given coordinates along x, y and z, x fastest.

    Examples
    --------
    >>> crossed([np.array([0.0, 1.0]), np.array([5.0]), np.array([7.0])]).tolist()
    [[0.0, 5.0, 7.0], [1.0, 5.0, 7.0]]
    """
    z, y, x = np.meshgrid(*axes[::-1], indexing="ij")
    return np.column_stack((x.ravel(), y.ravel(), z.ravel()))


def _corners(counts: tuple[int, ...], is_kept: NDArray[np.bool_] | None = None) -> Indices:
    """Return the points of cells, in VTK's order, in the dimension of the grid; x fastest."""
    steps = np.cumprod([1, *counts[:-1]])
    wide = [axis for axis in range(3) if counts[axis] > 1]
    shape = [max(1, n - 1) if n else 0 for n in counts]
    first = sum(
        np.arange(n).reshape([-1 if a == axis else 1 for a in (2, 1, 0)]) * steps[axis]
        for axis, n in enumerate(shape)
    )
    around = np.zeros(1, np.int64)
    for number, axis in enumerate(wide):
        upper = around + steps[axis]
        # The second side of a face is reversed, so that the corners go around it.
        around = np.concatenate([around, upper[::-1] if number == 1 else upper])
    firsts = np.asarray(first, np.int64).reshape(-1)
    corners: Indices = (firsts if is_kept is None else firsts[is_kept])[:, None] + around
    return corners


@dataclass(frozen=True, eq=False)
class Image:
    """Regular grid with numbers.

    Attributes
    ----------
    counts
        Number of points along each axis.
    origin, steps
        Position of the first point, and the step to the next along each axis as rows, (3, 3).
    cell_arrays, point_arrays
        Names and values, x fastest.
    active
        Array that the file names as its scalars, if any.
    notes
        Sentences on all other contents.
    """

    counts: tuple[int, int, int]
    origin: NDArray[np.float64]
    steps: NDArray[np.float64]
    cell_arrays: dict[str, Array]
    point_arrays: dict[str, Array]
    active: str = ""
    notes: tuple[str, ...] = field(default=())


def cells_of_image(where: str, image: Image) -> DataSet:
    """Return the cells of an image with a label other than 0; a labeled point is one cell.

    Raises
    ------
    FileError
        If no array holds labels: whole numbers from 0, at most 255 of them.

    Examples
    --------
    >>> labels = {"values": np.array([0, 7])}
    >>> found = cells_of_image("a.vti", Image((3, 2, 2), np.zeros(3), np.eye(3), labels, {}))
    >>> found.points.min(axis=0).tolist(), found.cell_arrays["label"].tolist()
    ([1.0, 0.0, 0.0], [7])
    """
    name, on_points = _chosen(where, image)
    values = (image.point_arrays if on_points else image.cell_arrays)[name].reshape(-1)
    counts = np.array(image.counts) if on_points else np.maximum(np.array(image.counts) - 1, 0)
    if not counts.all():
        raise FileError(where, "holds a flat image, whose cells have no volume", "save a 3D image")
    if len(values) != counts.prod():
        what = f'array "{name}" has {len(values):,} numbers for {counts.prod():,} cells'
        raise FileError(where, f"is damaged: {what}")
    _check_labels(where, name, values)
    is_full = values != 0
    if not on_points and GHOSTS in image.cell_arrays:
        is_full &= (image.cell_arrays[GHOSTS].reshape(-1).astype(np.int64) & HIDDEN) == 0
    notes = [*image.notes, *_notes(image, name, on_points)]
    if empty := int((~is_full).sum()):
        notes.append(f"{counted(empty, 'cell')} of label 0: empty")
    nx, ny, nz = (int(n) + 1 for n in counts)
    used, rows = np.unique(_corners((nx, ny, nz), is_full), return_inverse=True)
    place = np.column_stack((used % nx, used // nx % ny, used // (nx * ny))).astype(np.float64)
    # A cell around a point begins half a step before it.
    place -= 0.5 * on_points
    full = int(is_full.sum())
    return DataSet(
        image.origin + place @ image.steps,
        np.full(full, _HEXAHEDRON),
        np.arange(full + 1) * 8,
        rows.reshape(-1).astype(np.int64),
        {"label": values[is_full]},
        {},
        tuple(notes),
    )


def _chosen(where: str, image: Image) -> tuple[str, bool]:
    """Choose the array of labels; return its name, and True if it is on points."""
    for on_points, arrays in ((False, image.cell_arrays), (True, image.point_arrays)):
        whole = [
            name
            for name, values in arrays.items()
            if values.dtype.kind in "biu" and name != GHOSTS and values[:1].size == 1
        ]
        if whole:
            first = [name for name in whole if "label" in name.lower()]
            return (image.active if image.active in whole else (first or whole)[0]), on_points
    held = [
        f'"{name}" ({values.dtype})'
        for arrays in (image.cell_arrays, image.point_arrays)
        for name, values in arrays.items()
        if name != GHOSTS
    ]
    size = " × ".join(f"{n:,}" for n in image.counts)
    what = f"holds an image of {size} points with {', '.join(held) or 'no numbers'}"
    raise FileError(where, f"{what}; a body needs labels that are whole numbers", _HINT)


def _check_labels(where: str, name: str, values: Array) -> None:
    labels = np.unique(values)
    if labels.size and labels[0] < 0:
        what = f'array "{name}" has negative numbers, down to {labels[0]}: these are no labels'
        raise FileError(where, what, _HINT)
    if np.count_nonzero(labels) > _MOST:
        what = f'array "{name}" has {len(labels):,} different numbers; at most {_MOST} are labels'
        raise FileError(where, what, _HINT)
    if not labels.any():
        raise FileError(where, f'array "{name}" is 0 everywhere: the image is empty', _HINT)


def _notes(image: Image, name: str, on_points: bool) -> list[str]:
    """List sentences on how labels were taken, and on the other arrays."""
    at = "points, each the middle of a cell" if on_points else "cells"
    notes = [f'Array "{name}" has the labels, on {at}']
    for arrays, where in ((image.cell_arrays, "cells"), (image.point_arrays, "points")):
        for other in arrays:
            if other != GHOSTS and (other, where == "points") != (name, on_points):
                notes.append(f'Array "{other}" on {where} is not read')
    return notes
