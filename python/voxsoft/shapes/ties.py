"""Ties: cells whose center lies on a surface, and whether they are inside."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.shapes.base import Shape, Triple

Ints = NDArray[np.int64]

#: Codes of :meth:`voxsoft._core.Shape.sample`.
INSIDE: Final = 1
TIED: Final = 2

#: Distance of a center from the surface, in voxels, below which it is a tie.
_TIE = 1e-9
#: Relative rounding of float32, in which STL files keep their corners, is 2⁻²⁴. Four times that is
#: a tie: both ends of a distance are rounded, and programs compute in float32 before they write.
_OF_FLOAT32 = 2.0**-22
#: Distance from the center at which a tie is decided, in voxels and in widths of a tie.
_STEP, _STEPS = 1e-6, 8.0
#: Largest width of a tie, in voxels.
_WIDEST = 1e-3
#: Direction of a step, which leaves every plane through the center across an axis or a diagonal.
_WAY: Final = np.array([1.0, 0.73, 0.41])
#: Rounding of a position on the grid, in voxels.
_ON_GRID = 1e-6


class SampledPart(NamedTuple):
    """Sampled centers of the cells that a part may fill.

    Attributes
    ----------
    shape
        Compiled shape.
    low
        Lowest cell on the grid of the body, (3,).
    codes
        Code of each cell from :meth:`voxsoft._core.Shape.sample`, (nx, ny, nz).
    """

    shape: _core.Shape
    low: Ints
    codes: NDArray[np.uint8]


def tie_width(
    shapes: Iterable[Shape], voxel_size: float, names: Mapping[str, Shape] | None
) -> float:
    """Return the distance from a surface [m] within which a center counts as on it.

    It is a billionth of a voxel; for surfaces from files, the rounding of float32 of their size.

    Examples
    --------
    >>> from voxsoft.shapes import Sphere
    >>> tie_width([Sphere(radius=0.01)], 1.0, None)
    1e-09
    """
    from voxsoft.shapes.triangles import TriangleMesh

    width = _TIE * voxel_size
    for shape in shapes:
        if any(isinstance(each, TriangleMesh) for each in shape.every(names)):
            corners = np.abs(np.asarray(shape.bounds(names)))
            reach = float(corners[np.isfinite(corners)].max(initial=0.0))
            width = max(width, _OF_FLOAT32 * reach)
    return min(width, _WIDEST * voxel_size)


def decided(
    parts: Sequence[SampledPart],
    phase: Triple,
    voxel_size: float,
    tie: float,
    middle: Triple | None = None,
) -> list[NDArray[np.bool_]]:
    """Decide the ties of the parts of one body.

    A tied cell is decided by the value a short step from its center, up along all axes: of two
    opposite faces one takes the cell and the other does not, and of two parts that meet on a center
    one. Where the mirror image of the cell across the middle of the body is tied too, the step is
    toward the middle, so that a symmetric body stays symmetric.

    Parameters
    ----------
    parts
        The parts of the body.
    phase
        Phase of the grid: a corner of a cell [m].
    voxel_size
        Edge of a cell [m].
    tie
        Distance from a surface within which a center counts as on it [m].
    middle
        Middle of the body [m]; None for no mirror images.

    Returns
    -------
    list of ndarray of bool
        Mask of the cells that each part holds.
    """
    found = [part.codes == INSIDE for part in parts]
    tied = [np.argwhere(part.codes == TIED) + part.low for part in parts]
    if not any(len(cells) for cells in tied):
        return found
    step = min(max(_STEP * voxel_size, _STEPS * tie), _STEPS * _WIDEST * voxel_size) * _WAY
    everywhere = np.concatenate(tied)
    for part, held, cells in zip(parts, found, tied, strict=True):
        ways = _ways(cells, everywhere, phase, voxel_size, middle)
        places = np.asarray(phase) + (cells + 0.5) * voxel_size + ways * step
        is_inside = part.shape.evaluate(np.ascontiguousarray(places)) < 0.0
        held[tuple((cells - part.low).T)] = is_inside
    return found


def _ways(
    cells: Ints, everywhere: Ints, phase: Triple, voxel_size: float, middle: Triple | None
) -> NDArray[np.float64]:
    """Return the side on which each cell is decided, above (1) or below (-1) its center."""
    ways = np.ones(cells.shape)
    if middle is None or not len(cells):
        return ways
    for axis in range(3):
        # Cell k has its image at `turn - k`.
        turn = 2.0 * (middle[axis] - phase[axis]) / voxel_size - 1.0
        if abs(turn - np.rint(turn)) > _ON_GRID:
            continue
        images = cells.copy()
        images[:, axis] = int(np.rint(turn)) - cells[:, axis]
        beyond = cells[:, axis] > images[:, axis]
        ways[beyond & _among(images, everywhere), axis] = -1.0
    return ways


def _among(cells: Ints, others: Ints) -> NDArray[np.bool_]:
    """Return True for cells that are among others, (n,)."""
    low = np.minimum(cells.min(axis=0), others.min(axis=0))
    counts = np.maximum(cells.max(axis=0), others.max(axis=0)) - low + 1
    codes = [np.ravel_multi_index(tuple((each - low).T), tuple(counts)) for each in (cells, others)]
    return np.isin(*codes)
