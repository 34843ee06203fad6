"""Contents of a mesh file as numbers, before they become a mesh or a surface."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

#: Number of vertices of each kind of cell in files, by meshio's names, in VTK's order.
CORNERS: Mapping[str, int] = {
    "vertex": 1,
    "line": 2,
    "triangle": 3,
    "quad": 4,
    "tetra": 4,
    "pyramid": 5,
    "wedge": 6,
    "hexahedron": 8,
}


@dataclass(frozen=True, eq=False)
class CellBlock:
    """Cells of one kind.

    Attributes
    ----------
    kind
        Kind in :data:`CORNERS`, or a name with the number of nodes such as ``tetra10``; the corners
        come first. ``polygon`` for faces of any number, one block for each number.
    nodes
        Points of each cell, (k, n), indices into the points of the contents.
    """

    kind: str
    nodes: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Contents:
    """Contents of a mesh file.

    Attributes
    ----------
    points
        Coordinates in the file's own unit, (n, 3).
    blocks
        Cells in the order of the file. Cells are numbered through all blocks.
    cell_sets
        Names and cells of groups, sets and parts of cells: numbers of cells, ascending. Groups
        without a name are called by their number.
    point_sets
        Names and points of groups of points: indices of points, ascending.
    arrays
        Names and values of arrays on cells, one value a cell of all blocks; NaN or 0 where a block
        has none.
    unit
        Length of a unit of the coordinates in m, if the file gives it; else None.
    notes
        Sentences on parts of the file that these contents lack: cards that were skipped, arrays on
        points, instances, blocks that are left out. Each begins with its subject.
    format
        Common name of the format: ``Abaqus input``, ``Gmsh 4.1``.
    sections
        Names of the cell sets that carry a material in the file; empty where it has none.
    instances
        Names of instances of an assembly.
    """

    points: NDArray[np.float64]
    blocks: tuple[CellBlock, ...]
    cell_sets: Mapping[str, NDArray[np.int64]] = field(default_factory=dict)
    point_sets: Mapping[str, NDArray[np.int64]] = field(default_factory=dict)
    arrays: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)
    unit: float | None = None
    notes: tuple[str, ...] = ()
    format: str = ""
    sections: tuple[str, ...] = ()
    instances: tuple[str, ...] = ()
