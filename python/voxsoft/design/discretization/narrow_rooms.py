"""Chambers so narrow that every cell of them is cut, and would count as material."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design.discretization.cut_cells import SIDES, CutCells, Ints
from voxsoft.shapes.fractions import SUBCELLS

Marks = NDArray[np.bool_]

#: Cells less full than this are empty where a chamber would close otherwise; the first that opens
#: it counts. By one half a flat room opens that is wider than a cell, wherever it lies: of the two
#: cells that share its width one is less than half full. A round bore of the width of a cell leaves
#: up to 1 - π/16 of each of four cells.
FILLED_UP_TO: Final = (0.5, 0.65, 0.81)

# States of cells without a mask.
_FULL: Final = -1
_OPEN: Final = -2


def with_narrow_rooms(cells: CutCells, active: Marks) -> Marks:
    """Leave cells of narrow chambers empty that are full enough to count as voxels.

    Their material goes to the voxels beside them, and the chamber keeps its volume by its voids,
    as with all cut voxels. A chamber is a void of small cubes that share faces and touch no empty
    cell. One that would open to another, or to the outside, stays closed.

    Parameters
    ----------
    cells
        Filled parts of the cells of a design.
    active
        Cells full enough to be voxels.

    Returns
    -------
    ndarray of bool
        The mask `active` without those cells.
    """
    room = np.where(active, 0, -1)
    opened = list(_opened_of_each_void(cells, active))
    for number, own in enumerate(opened, start=1):
        room[tuple(own.T)] = number
    found = active.copy()
    for number, own in enumerate(opened, start=1):
        # The surface passes through them, so that each has cells all around.
        beside = room[tuple(np.moveaxis(own[:, None] + SIDES.reshape(6, 3), -1, 0))]
        if np.isin(beside, (0, number)).all():
            found[tuple(own.T)] = False
    return found


def _opened_of_each_void(cells: CutCells, active: Marks) -> Iterator[Ints]:
    """Yield the cells that each closed void without an empty cell leaves empty, (k, 3)."""
    is_cut = active[tuple(cells.near.T)] & (cells.voids > 0)
    at, masks = cells.near[is_cut], cells.voids[is_cut]
    states = np.where(active, _FULL, _OPEN).astype(np.int32)
    states[tuple(at.T)] = np.arange(len(at))
    all_of_cell = np.unpackbits(masks.view(np.uint8)).reshape(-1, SUBCELLS**3).sum(axis=1)
    for numbers, cubes in _core.closed_voids(states, masks):
        own = at[numbers]
        # Voids of others, beyond a wall in the cell, count as full.
        filled = cells.filled[tuple(own.T)] + (all_of_cell[numbers] - cubes) / SUBCELLS**3
        limit = next((limit for limit in FILLED_UP_TO if filled.min() < limit), 0.0)
        yield own[filled < limit]
