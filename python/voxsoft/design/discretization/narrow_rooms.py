"""Chambers so narrow that every cell of them is cut, and would count as material."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design.discretization.cut_cells import CutCells, Ints, filled_parts
from voxsoft.design.model import Design
from voxsoft.shapes.fractions import SUBCELLS

Marks = NDArray[np.bool_]

#: Cells less full than this are empty where a chamber would close otherwise; the first that opens
#: it counts. By one half a flat room opens that is wider than a cell, wherever it lies: of the two
#: cells that share its width one is less than half full. A round bore of the width of a cell leaves
#: up to 1 - π/16 of each of four cells.
FILLED_UP_TO: Final = (0.5, 0.65, 0.81)

#: Material this far around a chamber, in cells, must enclose it.
_AROUND: Final = 2


def with_narrow_rooms(design: Design, cells: CutCells, active: Marks) -> Marks:
    """Leave cells of narrow chambers empty that are full enough to count as voxels.

    Their material goes to the voxels beside them, and the chamber keeps its volume by its voids,
    as with all cut voxels.

    Parameters
    ----------
    design
        The design.
    cells
        Filled parts of its cells.
    active
        Cells full enough to be voxels.

    Returns
    -------
    ndarray of bool
        The mask `active` without those cells.
    """
    from scipy.ndimage import find_objects, label

    for filled in FILLED_UP_TO:
        rooms, count = label(cells.filled < filled)
        if not count:
            continue
        # Rooms with an empty cell, and the outside, are there already.
        known = np.bincount(rooms.ravel(), ~active.ravel(), count + 1) > 0
        known[0] = True
        for number, box in enumerate(find_objects(rooms), start=1):
            if known[number]:
                continue
            box = tuple(slice(max(s.start - _AROUND, 0), s.stop + _AROUND) for s in box)
            room = rooms[box] == number
            if _is_closed(design, cells, room, np.array([s.start for s in box])):
                active = active.copy()
                active[box] &= ~room
    return active


def _is_closed(design: Design, cells: CutCells, room: Marks, start: Ints) -> bool:
    """Check if the void of some cells is one, and ends near them."""
    from scipy.ndimage import binary_dilation, label

    near = binary_dilation(room, np.ones((3, 3, 3), dtype=bool), _AROUND)
    places = np.argwhere(near)
    found, _, _ = filled_parts(design, places + start + cells.low, cells.size, cells.phase)
    void = np.zeros((*room.shape, *[SUBCELLS] * 3), dtype=bool)
    void[tuple(places.T)] = (found < 0.5).reshape(-1, *[SUBCELLS] * 3)
    # Cells farther away count as void, so that a void that goes on there is joined with it.
    void[~near] = True
    fine = np.pad(_fine(void), 1, constant_values=True)
    voids, _ = label(fine)
    own = np.zeros_like(fine)
    own[1:-1, 1:-1, 1:-1] = _fine(np.broadcast_to(room[..., None, None, None], void.shape))
    inside = np.unique(voids[own & fine])
    return len(inside) == 1 and inside[0] != voids[0, 0, 0]


def _fine(blocks: Marks) -> Marks:
    """The small cubes of a box of cells, (n·nx, n·ny, n·nz)."""
    x, y, z, n, _, _ = blocks.shape
    return blocks.transpose(0, 3, 1, 4, 2, 5).reshape(x * n, y * n, z * n)
