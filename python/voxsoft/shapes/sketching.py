"""Preview surface of one shape by itself, in a fraction of a second and as fine as that allows."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.shapes.base import Triple
from voxsoft.shapes.tracing import contour

Floats = NDArray[np.float64]

#: Most samples of one shape: the slowest, a gyroid, takes some 3 µs for each.
MOST_SAMPLES: Final = 250_000
#: Most triangles of one shape: more would take the page too long to read.
MOST_TRIANGLES: Final = 150_000
#: Number of steps between samples along the longest side, and the least along each one.
_ALONG: Final = 48
_ACROSS: Final = 8
#: Distance from a surface, in steps, within which samples count as outside: signs would be random.
_ON_SURFACE: Final = 1e-5


class Sketch(NamedTuple):
    """Preview surface of a shape.

    Attributes
    ----------
    vertices
        Vertices [m], (n, 3).
    triangles
        Triangles, outward, (t, 3); none where no sample is inside.
    step
        Longest distance from one sample to the next [m]: thinner walls may be missing.
    clipped
        Axes, of ``"xyz"``, along which the shape continues beyond the sketch.
    """

    vertices: Floats
    triangles: NDArray[np.int64]
    step: float
    clipped: str


def sketch(shape: _core.Shape, room: tuple[Triple, Triple], detail: float) -> Sketch:
    """Trace the surface of one shape.

    Flat sides along the axes at the ends of the shape are met exactly, as samples lie half a step
    to both sides of them. A shape without end is cut off where the room ends.

    Parameters
    ----------
    shape
        Compiled shape.
    room
        Lowest and highest corner [m] of the sketch of a shape without end.
    detail
        Size of the smallest detail [m], as far as the samples allow it; such as half a voxel.

    Examples
    --------
    >>> from voxsoft.shapes import Box, Gyroid
    >>> room = ((-0.02, -0.02, -0.02), (0.02, 0.02, 0.02))
    >>> box = sketch(Box(size=(0.03, 0.02, 0.01)).build(), room, 0.001)
    >>> box.vertices.max(axis=0).round(9), box.clipped
    (array([0.03, 0.02, 0.01]), '')
    >>> sketch(Gyroid(period=0.02, thickness=0.002).build(), room, 0.001).clipped
    'xyz'
    """
    bounds = np.array(shape.bounds(), dtype=np.float64)
    endless = ~np.isfinite(bounds)
    low, high = np.where(endless, np.array(room), bounds)
    clipped = "".join("xyz"[axis] for axis in np.flatnonzero(endless.any(axis=0)))
    size = high - low
    if not (size > 0.0).all():
        return Sketch(np.zeros((0, 3)), np.zeros((0, 3), np.int64), 0.0, clipped)
    step = min(size.max() / _ALONG, detail)
    found = _traced(shape, low, high, endless, _counts(size, step))
    while len(found.triangles) > MOST_TRIANGLES:
        step = 1.1 * found.step * (len(found.triangles) / MOST_TRIANGLES) ** 0.5
        found = _traced(shape, low, high, endless, _counts(size, step))
    return found._replace(clipped=clipped)


def _traced(
    shape: _core.Shape,
    low: Floats,
    high: Floats,
    endless: NDArray[np.bool_],
    counts: NDArray[np.intp],
) -> Sketch:
    """Trace a shape between two corners in some steps; it is closed where it is clipped."""
    step = (high - low) / counts
    first = low - step / 2
    points = first + step * np.indices(tuple(counts + 2)).reshape(3, -1).T
    values = shape.evaluate(points)
    # The larger of two distances is the distance of the intersection.
    for end, (corner, sign) in enumerate(((low, -1.0), (high, 1.0))):
        for axis in np.flatnonzero(endless[end]):
            values = np.maximum(values, sign * (points[:, axis] - corner[axis]))
    least = float(step.min())
    values[np.abs(values) < _ON_SURFACE * least] = _ON_SURFACE * least
    values = np.nan_to_num(values, nan=least, posinf=least, neginf=-least)
    vertices, triangles = contour(values.reshape(tuple(counts + 2)), first, step)
    return Sketch(vertices, triangles, float(step.max()), "")


def _counts(size: Floats, step: float) -> NDArray[np.intp]:
    """Return the number of steps of about some length along each side, as far as samples allow."""
    step = max(step, (float(np.prod(size)) / MOST_SAMPLES) ** (1 / 3))
    while True:
        counts: NDArray[np.intp] = np.maximum(np.ceil(size / step), _ACROSS).astype(np.intp)
        if np.prod(counts + 2) <= MOST_SAMPLES:
            return counts
        step *= 1.02
