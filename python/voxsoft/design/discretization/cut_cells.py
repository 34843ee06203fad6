"""The filled part of every cell of a design, and the part that it is of."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import product
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design.discretization.grid import phase_of
from voxsoft.design.model import Design
from voxsoft.errors import ShapeError
from voxsoft.shapes import Shape, inside
from voxsoft.shapes.base import Triple
from voxsoft.shapes.fractions import SUBCELLS, fill
from voxsoft.shapes.sampling import Body, refuse_too_many

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
#: Filled part, (k, n³), and normal, (k, n³, 3), of each small cube of some cells.
Cubes = tuple[Floats, Floats]

#: Sampled at once: small cubes of a slab, and cells that are cut into small cubes.
_SLAB = 2**26
_CHUNK = 4096

#: Cells near the surface whose small cubes are kept, of 2 kB each.
_KEPT = 2**16

#: Steps to the cells at the faces of a cell, below and above along the axes, (3, 2, 3).
SIDES: Final[Ints] = np.eye(3, dtype=np.intp)[:, None, :] * np.array([-1, 1])[:, None]

#: Result of :func:`measures_of` for a full cell.
WHOLE: Final[Floats] = np.array([1.0, 0.0, 0.0, 0.0, 1 / 3, 1 / 3, 1 / 3, 0.0, 0.0, 0.0])

# Distance from the faces of a cell, in edges, within which a surface is on them: files hold 32-bit
# numbers, and so does the winding number, which are good to 6e-6 of a voxel in a hundred.
_RIM = 1e-5

_BITS = 2 ** np.arange(SUBCELLS**3, dtype=np.uint64)

# A cell that is full or empty up to rounding is full or empty.
_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class CutCells:
    """Filled parts of the cells of a grid.

    Attributes
    ----------
    low
        The lowest cell of the grid counted from the phase, (3,).
    phase
        Place of the grid: a corner of a cell [m].
    size
        Edge of a cell [m].
    filled
        The filled part of each cell, (nx, ny, nz), between 0 and 1.
    part
        The part (from 0) with the largest share of each cell, (nx, ny, nz).
    near
        Array indices of the cells that the surface may touch, (k, 3), in C order.
    voids
        For each of these the small cubes that are less than half full, as bits in C order, (k,).
    cubes
        For each of these the filled part and the normal of each small cube, as :func:`filled_parts`
        gives them; None where they would take much memory.
    """

    low: Ints
    phase: Triple
    size: float
    filled: Floats
    part: NDArray[np.uint8]
    near: Ints
    voids: NDArray[np.uint64]
    cubes: Cubes | None = field(default=None, repr=False)

    @property
    def origin(self) -> tuple[float, float, float]:
        """The lowest corner of the grid [m]."""
        x, y, z = (np.asarray(self.phase) + self.low * self.size).tolist()
        return x, y, z


def cut_cells(design: Design, size: float) -> CutCells:
    """Measure how full the cells of a grid are.

    Parameters
    ----------
    design
        The design.
    size
        Edge of a cell [m].

    Raises
    ------
    ShapeError
        A shape without end or without value somewhere, a part of which nothing is inside, or a
        grid that would not fit in memory.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> cells = cut_cells(families.sphere(), 0.005)
    >>> bool(cells.filled.min() == 0.0), bool(cells.filled.max() == 1.0)
    (True, True)
    """
    phase = phase_of(design)
    shapes = [_shape(design, part.shape) for part in design.parts]
    body = Body(shapes, size, design.shapes, phase)
    bounds = [body.cells_of(index, phase) for index in range(len(shapes))]
    low = np.min([corner for corner, _ in bounds], axis=0) - 1
    high = np.max([corner for _, corner in bounds], axis=0) + 1
    counts = high - low
    _refuse_too_many(counts, len(shapes))
    near = np.zeros(counts, dtype=bool)
    filled = np.zeros(counts)
    part = np.zeros(counts, dtype=np.uint8)
    for index in range(len(shapes) - 1, -1, -1):
        state = _state(shapes[index], design, size, np.asarray(phase) + low * size, counts)
        if not state.any():
            hint = "use a smaller voxel_size, or check its sizes and place"
            raise ShapeError(f"parts[{index}]", "is empty: it fills no part of any voxel", hint)
        near |= beside_others(state) | (state == 1)
        filled[state == 2] = 1.0
        part[state == 2] = index
    cells = np.argwhere(near)
    voids = np.zeros(len(cells), dtype=np.uint64)
    kept: list[Cubes] = []
    for start in range(0, len(cells), _CHUNK):
        chunk = cells[start : start + _CHUNK]
        found, normals, shares = filled_parts(design, chunk + low, size, phase)
        if len(cells) <= _KEPT:
            kept.append((found, normals))
        filled[tuple(chunk.T)] = _whole(found.mean(axis=1))
        voids[start : start + _CHUNK] = (found < 0.5) @ _BITS
        part[tuple(chunk.T)] = np.argmax(shares > shares.max(axis=1, keepdims=True) - 1e-9, axis=1)
    cubes = None
    if kept:
        cubes = (np.concatenate([one for one, _ in kept]), np.concatenate([one for _, one in kept]))
    return CutCells(low, phase, size, filled, part, cells, voids, cubes)


def cuts_cells(design: Design, size: float) -> bool:
    """Return True if the surface of a design, or that between its parts, cuts a cell of the grid.

    A cell near the surface is whole where all its small cubes are of one part, or of none, and
    points at its faces, edges and corners toward cells of other parts too. Parameters and errors
    are those of :func:`cut_cells`.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> cuts_cells(families.beam(), 0.005), cuts_cells(families.beam(length=0.0999), 0.005)
    (False, True)
    """
    phase = np.asarray(phase_of(design))
    shapes = [_shape(design, part.shape) for part in design.parts]
    body = Body(shapes, size, design.shapes, _triple(phase))
    bounds = [body.cells_of(index, _triple(phase)) for index in range(len(shapes))]
    low = np.min([corner for corner, _ in bounds], axis=0) - 1
    counts = np.max([corner for _, corner in bounds], axis=0) + 1 - low
    _refuse_too_many(counts, len(shapes))
    owner = np.zeros(counts, dtype=np.uint8)
    for index in range(len(shapes), 0, -1):  # the first part wins
        state = _state(shapes[index - 1], design, size, phase + low * size, counts)
        if (state == 1).any() or not state.any():
            return True
        owner[state == 2] = index
    built = built_parts(design)
    cells, padded = np.argwhere(beside_others(owner)), np.pad(owner, 1)
    for start in range(0, len(cells), _CHUNK):
        chunk = cells[start : start + _CHUNK]
        own = owner[tuple(chunk.T)]
        beyond = padded[tuple(np.moveaxis(chunk[:, None] + 1 + _AROUND, -1, 0))]
        differs = (beyond != own[:, None]).astype(np.float32)
        rows, places = np.nonzero(differs @ _TOWARD)
        points = phase + (chunk[rows] + low) * size + size * _ALL_OVER[places]
        expected, left = own[rows], np.arange(len(points))
        for index, shape in enumerate(built, 1):  # points of a part are outside all before it
            is_inside = shape.evaluate(points[left]) < 0.0
            if (is_inside != (expected[left] == index)).any():
                return True
            left = left[~is_inside]
    return False


def filled_parts(
    design: Design, cells: Ints, size: float, phase: Triple
) -> tuple[Floats, Floats, Floats]:
    """Return the filled part of each small cube of some cells of the grid.

    Parameters and results are those of :func:`voxsoft.shapes.fractions.fill`, for cells given by
    their integers on the grid, (k, 3), and its phase [m].
    """
    corners: Floats = np.asarray(phase) + cells * np.float64(size)
    return fill(built_parts(design), corners, size)


def built_parts(design: Design) -> list[_core.Shape]:
    """Return the shapes of a design's parts in the form that the core evaluates."""
    return [_shape(design, part.shape).build(design.shapes) for part in design.parts]


def measures_of(
    design: Design,
    cells: Ints,
    size: float,
    phase: Triple,
    behind: Ints,
    gives: NDArray[np.bool_],
    cubes: Cubes | None = None,
) -> tuple[Floats, Floats]:
    """Return integrals over the material of some cells, (k, 10), and over its surface, (k, 25).

    The integrands are 1, ξ, η, ζ, ξ², η², ζ², ηζ, ζξ, ξη, in volumes of a cell. The coordinates
    count from the center of a cell in halves of its edge. A full cell gives :data:`WHOLE`. Those
    over the surface are of :mod:`~voxsoft.design.discretization.cut_surfaces`.

    Parameters
    ----------
    design
        The design.
    cells
        Their integers on the grid, (k, 3).
    size
        Edge of a cell [m].
    phase
        Place of the grid: a corner of a cell [m].
    behind
        Cells that take the facets in front of material of their own, below and above along the
        axes, (k, 3, 2), -1 for none: a facet belongs to its cell by the depth of the material
        behind it there, and with the rest to the cell behind.
    gives
        Marks of cells that give facets to those behind them, (k,); the others keep all.
    cubes
        Small cubes of the cells, where they are known.
    """
    corners: Floats = np.asarray(phase) + cells * np.float64(size)
    low = cells.min(axis=0) - 1
    number = np.full(cells.max(axis=0) - low + 2, -1, dtype=np.int32)
    number[tuple((cells - low).T)] = np.arange(len(cells))
    beyond = number[tuple(np.moveaxis((cells - low)[:, None, None] + SIDES, -1, 0))]
    found, surface = _core.cut_measures(
        built_parts(design), corners, size, beyond, behind.astype(np.int32), gives, cubes
    )
    found[found[:, 0] > 1.0 - _ROUNDING] = WHOLE
    found[found[:, 0] < _ROUNDING] = 0.0
    return found, surface


_INSET = np.array([_RIM, 0.25, 0.5, 0.75, 1.0 - _RIM])
#: Points in a cell, as parts of its edge.
_ALL_OVER = np.stack(np.meshgrid(_INSET, _INSET, _INSET, indexing="ij"), axis=-1).reshape(-1, 3)
#: Steps to the cells around one, (26, 3).
_AROUND = np.array([step for step in product((-1, 0, 1), repeat=3) if any(step)])
#: Points of a cell that lie at the face, edge or corner toward each of them, (26, 125).
_TOWARD = np.all(
    (_AROUND[:, None] == 0) | (np.where(_AROUND < 0, _RIM, 1.0 - _RIM)[:, None] == _ALL_OVER),
    axis=2,
).astype(np.float32)


def _triple(values: Floats) -> Triple:
    x, y, z = values.tolist()
    return x, y, z


def _shape(design: Design, shape: str | Shape) -> Shape:
    return design.shapes[shape] if isinstance(shape, str) else shape


def _refuse_too_many(counts: Ints, parts: int) -> None:
    """Refuse a grid whose states and filled parts do not fit in memory."""
    nx, ny, nz = counts.tolist()
    refuse_too_many((nx, ny, nz), parts + 16)


def _whole(filled: Floats) -> Floats:
    found: Floats = np.where(
        filled > 1.0 - _ROUNDING, 1.0, np.where(filled < _ROUNDING, 0.0, filled)
    )
    return found


def _state(
    shape: Shape, design: Design, size: float, corner: Floats, counts: Ints
) -> NDArray[np.uint8]:
    """Classify each cell: 0 no small cube has its center inside, 2 all have, 1 some have."""
    n = SUBCELLS
    state = np.zeros(counts, dtype=np.uint8)
    step = max(1, _SLAB // int(counts[1] * counts[2] * n**3))
    for start in range(0, int(counts[0]), step):
        thick = min(step, int(counts[0]) - start)
        x, y, z = (corner + np.array([start * size, 0.0, 0.0])).tolist()
        fine = (thick * n, int(counts[1]) * n, int(counts[2]) * n)
        found = inside(shape, size / n, fine, (x, y, z), design.shapes)
        sums = found.reshape(thick, n, counts[1], n, counts[2], n).sum(axis=(1, 3, 5))
        state[start : start + thick] = np.where(sums == n**3, 2, np.where(sums == 0, 0, 1))
    return state


def beside_others(values: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Cells with one of another value at a face, edge or corner; beyond the grid lie zeros."""
    lowest, highest = values, values
    for axis in range(3):
        lowest, highest = around(lowest, axis, np.minimum), around(highest, axis, np.maximum)
    unlike: NDArray[np.bool_] = lowest != highest
    return unlike


def around(values: NDArray[Any], axis: int, extreme: np.ufunc) -> NDArray[Any]:
    """Return the extreme of each cell and its two neighbors along an axis; beyond lie zeros."""
    low, high = beside(values, axis)
    found: NDArray[Any] = extreme(extreme(low, values), high)
    return found


def beside(cells: NDArray[Any], axis: int) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the neighbors of each cell on the two sides of an axis, zero beyond the grid."""
    width = [(int(n == axis), int(n == axis)) for n in range(3)]
    padded = np.moveaxis(np.pad(cells, width), axis, 0)
    return np.moveaxis(padded[:-2], 0, axis), np.moveaxis(padded[2:], 0, axis)
