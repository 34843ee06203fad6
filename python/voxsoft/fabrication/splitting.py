"""Segments of a part that is larger than the room of its printer, joined by dowels and glue."""

from __future__ import annotations

from itertools import permutations, product
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design.printer import Printer
from voxsoft.fabrication.fields import Box, Common, Field, Floats
from voxsoft.fabrication.inlets import bored
from voxsoft.fabrication.sampled import Grid, Surface, surface_of

Bools = NDArray[np.bool_]

#: Depth of a hole for a dowel in each segment, in diameters.
_DEPTH: Final = 4.0
#: Most dowels of a seam.
_DOWELS: Final = 3
#: Part of the length of a segment by which a seam may be moved to a better place.
_MOVED: Final = 0.15
#: Most segments of a part.
_SEGMENTS: Final = 24
#: Samples around a segment.
_MARGIN: Final = 3


def fits(low: Floats, high: Floats, printer: Printer) -> bool:
    """Return True if a box [m] fits in a printer, turned by right angles if need be.

    Examples
    --------
    >>> fits(np.zeros(3), np.array([0.1, 0.1, 0.3]), Printer(volume=(0.3, 0.2, 0.2)))
    True
    """
    return bool((np.sort(high - low) <= np.sort(np.array(printer.volume))).all())


def segments_of(
    solid: Field, values: Floats, grid: Grid, surface: Surface, printer: Printer
) -> tuple[Surface, ...]:
    """Divide a part in segments that the printer has room for; a part that fits is one segment.

    So is one that would take more than 24.

    Seams are planes across the axes, moved by up to 15 % of a segment to where the part is widest.
    Both sides of a seam have holes for dowels, where there is room for them. A part that is
    hollow between two seams falls into more segments there.

    Parameters
    ----------
    solid
        The part.
    values
        Its samples, negative inside, (nx, ny, nz) [m].
    grid
        Positions of the samples.
    surface
        Its triangles.
    printer
        The printer, with the diameter of its dowels.
    """
    low, high = surface.bounds
    if fits(low, high, printer):
        return (surface,)
    size = high - low
    rooms = [np.array(each) for each in permutations(printer.volume)]
    # A seam lies between samples, up to a sample beside its place.
    counts = [
        np.where(size <= room, 1, np.ceil(size / (room - 2.0 * grid.step))).astype(int)
        for room in rooms
    ]
    best = min(range(len(rooms)), key=lambda k: (int(np.prod(counts[k])), int(counts[k].max())))
    if np.prod(counts[best]) > _SEGMENTS:
        return (surface,)
    seams = [
        _seams(values, grid, axis, (float(low[axis]), float(high[axis])), int(count), float(room))
        for axis, (count, room) in enumerate(zip(counts[best], rooms[best], strict=True))
    ]
    holes = [
        hole
        for axis in range(3)
        for at in seams[axis]
        for hole in _dowels(values, grid, axis, at, printer)
    ]
    ends = [[float(low[k]) - grid.step, *seams[k], float(high[k]) + grid.step] for k in range(3)]
    found = []
    for corner in product(*(range(len(each) - 1) for each in ends)):
        first = tuple(ends[k][corner[k]] for k in range(3))
        last = tuple(ends[k][corner[k] + 1] for k in range(3))
        segment = _segment(solid, values, grid, Box(_three(first), _three(last)), holes)
        found += segment.divided()
    return tuple(found)


def _three(values: tuple[float, ...]) -> tuple[float, float, float]:
    x, y, z = values
    return x, y, z


def _seams(
    values: Floats, grid: Grid, axis: int, ends: tuple[float, float], count: int, room: float
) -> list[float]:
    """Return positions [m] between samples that part a length evenly, where it is widest."""
    length = (ends[1] - ends[0]) / count
    reach = min(_MOVED * length, (room - length) / 2.0)
    middles = grid.along(axis)[:-1] + grid.step / 2.0
    width = (np.moveaxis(values, axis, 0) < 0.0).sum(axis=(1, 2))
    common = np.minimum(width[:-1], width[1:])
    found = []
    for number in range(1, count):
        even = ends[0] + number * length
        near = np.flatnonzero(np.abs(middles - even) <= reach)
        # The widest place, and of equal ones the most even.
        best = min(near, key=lambda k: (-int(common[k]), abs(middles[k] - even)))
        found.append(float(middles[best]))
    return found


def _dowels(
    values: Floats, grid: Grid, axis: int, at: float, printer: Printer
) -> list[_core.Shape]:
    """Return holes for dowels across a seam, far from each other and from all sides."""
    from scipy import ndimage

    radius = printer.dowel / 2.0 + printer.clearance
    depth = _DEPTH * printer.dowel
    along = grid.along(axis)
    near = np.abs(along - at) <= depth + printer.wall
    solid = (np.moveaxis(values, axis, 0)[near] < 0.0).all(axis=0)
    aside = ndimage.distance_transform_edt(np.pad(solid, 1))[1:-1, 1:-1] * grid.step
    spots = np.argwhere(aside >= radius + printer.wall + grid.step)
    chosen: list[NDArray[np.int64]] = []
    for _ in range(min(_DOWELS, len(spots))):
        if chosen:
            away = np.min([np.linalg.norm(spots - each, axis=1) for each in chosen], axis=0)
        else:
            away = aside[tuple(spots.T)]
        if chosen and away.max() * grid.step < 4.0 * radius:
            break
        chosen.append(spots[int(away.argmax())])
    way = [0.0, 0.0, 0.0]
    way[axis] = 1.0
    holes = []
    for spot in chosen:
        base = grid.points(np.insert(spot, axis, 0)[None])[0]
        base[axis] = at - depth
        x, y, z = (float(each) for each in base)
        holes.append(_core.Shape.cylinder((x, y, z), _three(tuple(way)), radius, 2.0 * depth))
    return holes


def _segment(
    solid: Field, values: Floats, grid: Grid, box: Box, holes: list[_core.Shape]
) -> Surface:
    """Return the triangles of the part within a box, without the holes."""
    first = np.array(grid.nearest(np.array(box.low)[None])).ravel() - _MARGIN
    last = np.array(grid.nearest(np.array(box.high)[None])).ravel() + _MARGIN
    first, last = np.maximum(first, 0), np.minimum(last, np.array(grid.shape) - 1)
    window = tuple(slice(a, b + 1) for a, b in zip(first, last, strict=True))
    x, y, z = (float(each) for each in grid.points(first[None])[0])
    nx, ny, nz = (int(each) for each in last - first + 1)
    own = Grid((x, y, z), grid.step, (nx, ny, nz))
    within: Field = Common([solid, box])
    sampled = np.maximum(values[window], own.values(box))
    within, sampled = bored(within, sampled, holes, own)
    return surface_of(within, own, sampled)
