"""All that a mesh file holds, in numbers, before anything is made of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

#: Vertices of each kind of cell that files hold, under meshio's names, in VTK's order.
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
        Of :data:`CORNERS`, or a name with the number of nodes such as ``tetra10``; the corners
        stand first. ``polygon`` for faces of any number, one block for each number.
    nodes
        Points of each cell, (k, n), indices into the points of the contents.
    """

    kind: str
    nodes: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Contents:
    """What a mesh file holds.

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
        Of the coordinates in m, where the file says it; else None.
    notes
        Sentences on all that the file holds and that these contents do not: cards that were passed
        over, arrays on points, instances, blocks that are left out. Each begins with its subject.
    format
        The format as a person calls it: ``Abaqus input``, ``Gmsh 4.1``.
    sections
        Those cell sets that carry a material by the file's own word; empty where it says none.
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
