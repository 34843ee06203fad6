"""Phase of the grid of a body: faces of voxels on faces of the body."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from voxsoft.shapes.base import Triple

#: Digits of a phase, in voxels, that are more than rounding.
_DIGITS = 4


def choose_phase(
    bounds: tuple[Sequence[float], Sequence[float]],
    voxel_size: float,
    snap: float,
    look: Callable[[Triple], NDArray[np.bool_]],
    given: Sequence[float | None] = (None, None, None),
) -> Triple:
    """Return the phase of a body's grid along each axis [m], 0 to one voxel.

    The phase along an axis is 0, so that a corner of a voxel lies at the origin, unless

    - the body is a whole number of voxels long and begins elsewhere: then it begins on a face;
    - the body is symmetric and its voxels at 0 are not: then its middle lies on a face of voxels
      or in the middle of them, whichever has the length of the body more nearly. Where one end of
      the body lies on a face, voxels that are symmetric by themselves will do, as those of a box:
      the face stays where it is, for a clamp that holds it.

    Parameters
    ----------
    bounds
        Lowest and highest corner of the body [m].
    voxel_size
        Edge of a cell [m].
    snap
        Tolerance of positions, in voxels.
    look
        Function that returns the filled cells of the body, (nx, ny, nz), for a phase [m].
    given
        Given phases, such as those of planes of symmetry [m].

    Examples
    --------
    >>> nothing = lambda phase: np.zeros((0, 0, 0), dtype=bool)
    >>> choose_phase(((0, -0.003, 0.0005), (0.03, 0.003, 0.0065)), 0.002, 1e-6, nothing)
    (0.0, 0.001, 0.0005)
    """
    phase = [0.0 if each is None else _within(each, voxel_size, snap) for each in given]
    centered: dict[int, float] = {}
    ends: dict[int, bool] = {}
    for axis, (low, high) in enumerate(zip(*bounds, strict=True)):
        if given[axis] is not None or not math.isfinite(low + high):
            continue
        first, last, length = (_is_whole(v / voxel_size, snap) for v in (low, high, high - low))
        if first and last:
            continue
        if length:
            phase[axis] = _within(low, voxel_size, snap)
        elif not _is_whole((low + high) / voxel_size, 2.0 * snap) and high - low > voxel_size / 2.0:
            number = round((high - low) / voxel_size)
            start = (low + high - number * voxel_size) / 2.0
            centered[axis] = _within(start, voxel_size, snap)
            ends[axis] = first or last
    if any(ends.values()):
        cells = look(_triple(phase))
        centered = {a: p for a, p in centered.items() if not (ends[a] and _is_symmetric(cells, a))}
    if centered:
        moved = _triple([centered.get(axis, phase[axis]) for axis in range(3)])
        cells = look(moved)
        for axis, value in centered.items():
            if _is_symmetric(cells, axis):
                phase[axis] = value
    return _triple(phase)


def _is_whole(number: float, snap: float) -> bool:
    return abs(number - round(number)) <= snap


def _within(place: float, size: float, snap: float) -> float:
    """Return the position of a face within the first voxel [m]."""
    part = place / size - math.floor(place / size)
    near = round(part, _DIGITS)
    if abs(part - near) <= snap:
        part = near
    return 0.0 if part >= 1.0 - snap else part * size


def _is_symmetric(cells: NDArray[np.bool_], axis: int) -> bool:
    """Return True if cells are their own mirror image across the middle of the filled ones."""
    filled = np.flatnonzero(cells.any(axis=tuple({0, 1, 2} - {axis})))
    if not len(filled):
        return False
    content = np.moveaxis(cells, axis, 0)[filled[0] : filled[-1] + 1]
    return bool(np.array_equal(content, content[::-1]))


def _triple(values: Sequence[float]) -> Triple:
    x, y, z = values
    return x, y, z
