"""Regions found in a grid: components, cavities, leaks, hinges and walls."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Cell = tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class Component:
    """Connected set of cells.

    Attributes
    ----------
    runs : ndarray of int, shape (r, 4)
        Cells as runs along z: ``(i, j, first k, last k)``, in C order. A compact form for
        regions of millions of cells.
    count : int
        Number of cells.
    volume : float
        Volume of the cells [m³].
    bounds : ndarray, shape (2, 3)
        Lower and upper corner of the bounding box [m].
    """

    runs: NDArray[np.int32] = field(repr=False)
    count: int
    volume: float
    bounds: NDArray[np.float64] = field(repr=False)

    @property
    def cells(self) -> NDArray[np.int32]:
        """Array indices (i, j, k) of the cells, shape (count, 3), in C order.

        Examples
        --------
        >>> from voxsoft.voxels import Voxels
        >>> component = Voxels.from_array([[[1, 1], [0, 1]]], voxel_size=0.005).components()[0]
        >>> component.cells.tolist()
        [[0, 0, 0], [0, 0, 1], [0, 1, 1]]
        """
        lengths = self.runs[:, 3] - self.runs[:, 2] + 1
        ij = np.repeat(self.runs[:, :2], lengths, axis=0)
        # Within a run k counts up from its first cell.
        starts = np.repeat(np.cumsum(lengths) - lengths, lengths)
        k = np.arange(self.count) - starts + np.repeat(self.runs[:, 2], lengths)
        return np.column_stack((ij, k)).astype(np.int32)


@dataclass(frozen=True, eq=False)
class Cavity(Component):
    """Empty region that no path through faces connects with the outside.

    Attributes
    ----------
    area : float
        Area of the faces it shares with filled cells [m²].
    """

    area: float


@dataclass(frozen=True, eq=False)
class Leak(Component):
    """Chamber that is open to the outside by narrow openings.

    Its cells extend up to the openings.

    Attributes
    ----------
    width : int
        Largest width of the openings in cells, in one direction.
    openings : tuple of (i, j, k)
        One cell of each opening, at its end toward the chamber. Filling the openings there closes
        the chamber.
    """

    width: int
    openings: tuple[Cell, ...]


@dataclass(frozen=True)
class Hinge:
    """Two filled cells whose only contact, here, is an edge or a corner.

    The mesh is stitched there, so that the cells stay connected, but nothing resists their rotation
    about the edge or the corner, and it cannot be manufactured.

    Attributes
    ----------
    cells : pair of (i, j, k)
        Indices of the two cells.
    contact : {"edge", "corner"}
        Shared edge or corner.
    """

    cells: tuple[Cell, Cell]
    contact: Literal["edge", "corner"]


@dataclass(frozen=True)
class Wall:
    """Place where the material is thin.

    Attributes
    ----------
    thickness : int
        Thickness in voxels, along an axis.
    cell : (i, j, k)
        Filled cell of the wall.
    """

    thickness: int
    cell: Cell


@dataclass(frozen=True, eq=False)
class WallThickness:
    """Thickness of the material at each cell, in voxels.

    Attributes
    ----------
    cells : ndarray of uint16, shape (nx, ny, nz)
        Length, at each cell, of the shortest of the three rows of filled cells along the axes
        through it; 0 where empty. A wall that is inclined to the axes can be thinner than that, by
        a factor of √3 at most.
    histogram : tuple of int
        Number of cells of each thickness; entry 0 is 0.
    thinnest : Wall or None
        First of the thinnest cells that are no bumps; None if no cell is filled. A bump is a row
        of one cell at whose face lies a block of 2 × 2 × 2 cells: the rim of a disk, a ball's pole.
    """

    cells: NDArray[np.uint16] = field(repr=False)
    histogram: tuple[int, ...]
    thinnest: Wall | None


def region_fields(
    runs: NDArray[np.uint32], count: int, voxel_size: float, origin: NDArray[np.float64]
) -> tuple[NDArray[np.int32], int, float, NDArray[np.float64]]:
    """Return the fields of a :class:`Component` from its runs in the core's form."""
    signed = runs.astype(np.int32)
    signed.setflags(write=False)
    lower = signed[:, [0, 1, 2]].min(axis=0)
    upper = signed[:, [0, 1, 3]].max(axis=0) + 1
    bounds = origin + voxel_size * np.stack((lower, upper))
    bounds.setflags(write=False)
    return signed, count, count * voxel_size**3, bounds
