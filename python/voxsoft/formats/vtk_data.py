"""Data sets of VTK in both formats, and their conversion to contents."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import counted
from voxsoft.errors import FileError
from voxsoft.formats.contents import Contents
from voxsoft.formats.vtk_cells import blocks_of, check_cells

Array = NDArray[np.generic]
Indices = NDArray[np.int64]

#: Array that marks cells of other components and hidden ones, and its bit for hidden ones.
GHOSTS: Final = "vtkGhostType"
HIDDEN: Final = 32
_MARKS: Final = ((1, "that another component has"), (HIDDEN, "that are hidden"))


@dataclass(frozen=True, eq=False)
class DataSet:
    """Points and cells as VTK stores them.

    Attributes
    ----------
    points
        Coordinates, (n, 3).
    types, offsets, nodes
        Type number of VTK of each cell, start and end of its nodes, and the nodes of all.
    cell_arrays, point_arrays
        Names and values, one row for each cell or point.
    notes
        Sentences on all other contents.
    """

    points: NDArray[np.float64]
    types: Indices
    offsets: Indices
    nodes: Indices
    cell_arrays: dict[str, Array] = field(default_factory=dict)
    point_arrays: dict[str, Array] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def contents_of(
    where: str, pieces: Sequence[DataSet], called: str, unit: float | None = None
) -> Contents:
    """Join the cells of all components of a file to contents; points where they meet become one.

    Parameters
    ----------
    where
        Name of the file, for messages.
    pieces
        Components of the file.
    called
        Common name of the format.
    unit
        Length of a unit of the coordinates in m, if the file gives it.

    Raises
    ------
    FileError
        If cells are invalid, or an array has not one row for each cell.

    Examples
    --------
    >>> side = DataSet(np.eye(3), *map(np.array, ([5], [0, 3], [0, 1, 2])))
    >>> found = contents_of("a.vtu", [side, side], "VTU")
    >>> found.blocks[0].nodes.tolist(), len(found.points), found.notes
    ([[0, 1, 2], [0, 1, 2]], 3, ('3 points where components meet become one with their doubles',))
    """
    for piece in pieces:
        check_cells(where, piece.types, piece.offsets, piece.nodes, len(piece.points))
    points, new, notes = _joined([piece.points for piece in pieces])
    firsts = np.cumsum([0, *(len(piece.points) for piece in pieces)])
    nodes = [new[p.nodes[: p.offsets[-1]] + f] for p, f in zip(pieces, firsts, strict=False)]
    starts = np.cumsum([0, *(piece.offsets[-1] for piece in pieces)])
    offsets = [p.offsets[:-1] + start for p, start in zip(pieces, starts, strict=False)]
    types = np.concatenate([piece.types for piece in pieces]).astype(np.int64)
    arrays, more = _single_numbers(where, pieces)
    marks: Indices = arrays.pop(GHOSTS, np.zeros(len(types))).astype(np.int64)
    for bit, which in _MARKS:
        if count := int(((marks & bit) > 0).sum()):
            notes.append(f"{counted(count, 'cell')} {which}: left out")
            types[(marks & bit) > 0] = 0
    ends = np.concatenate([*offsets, starts[-1:]])
    blocks, order = blocks_of(types, ends, np.concatenate(nodes))
    notes += [note for piece in pieces for note in piece.notes]
    notes += more
    notes += [f'Array "{n}" on points is not read' for piece in pieces for n in piece.point_arrays]
    return Contents(
        points,
        blocks,
        arrays={name: values[order] for name, values in arrays.items()},
        unit=unit,
        notes=tuple(dict.fromkeys(notes)),
        format=called,
    )


def _joined(
    pieces: Sequence[NDArray[np.float64]],
) -> tuple[NDArray[np.float64], Indices, list[str]]:
    """Join the points of all components; return points, new numbers, and a note on joined ones.

    Points of one place within a component stay apart: they may be the two sides of a cut.
    """
    points = np.concatenate(pieces)
    if len(pieces) == 1:
        return points, np.arange(len(points)), []
    _, place = np.unique(points, axis=0, return_inverse=True)
    place = place.reshape(-1)
    piece = np.repeat(np.arange(len(pieces)), [len(each) for each in pieces])
    pair, uses = np.unique(np.column_stack((place, piece)), axis=0, return_counts=True)
    is_cut = np.zeros(len(points) + 1, bool)
    is_cut[pair[uses > 1, 0]] = True
    # Each point of a cut gets a place of its own.
    place = np.where(is_cut[place], len(points) + np.arange(len(points)), place)
    _, kept, new = np.unique(place, return_index=True, return_inverse=True)
    order = np.argsort(kept, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    joined = len(points) - len(kept)
    note = f"{counted(joined, 'point')} where components meet become one with their doubles"
    return points[kept[order]], rank[new.reshape(-1)], [note] if joined else []


def _single_numbers(
    where: str, pieces: Sequence[DataSet]
) -> tuple[dict[str, NDArray[np.float64]], list[str]]:
    """Return arrays with one number a cell, through all components; sentences on the others."""
    for piece in pieces:
        for name, values in piece.cell_arrays.items():
            count = len(piece.types)
            if len(values) != count:
                what = f'array "{name}" has {len(values):,} rows for {count:,} cells'
                raise FileError(where, f"is damaged: {what}")
    found, notes = {}, []
    for name in dict.fromkeys(_names(pieces)):
        each = [piece.cell_arrays.get(name, np.zeros(len(piece.types))) for piece in pieces]
        # VTK stores single numbers as columns too.
        each = [v[:, 0] if v.ndim == 2 and v.shape[1] == 1 else v for v in each]
        if all(v.ndim == 1 and v.dtype.kind in "biuf" for v in each):
            found[name] = np.concatenate(each).astype(np.float64)
        else:
            notes.append(f'Array "{name}" on cells is not of single numbers')
    return found, notes


def _names(pieces: Sequence[DataSet]) -> Iterator[str]:
    for piece in pieces:
        yield from piece.cell_arrays
