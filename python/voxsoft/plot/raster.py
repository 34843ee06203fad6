"""Rasterization of triangles: a depth buffer in NumPy.

Sorting whole triangles by depth, as matplotlib does, is slow for a mesh of 100,000 triangles and
wrong where they are of different sizes; a depth buffer decides for each pixel.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# Candidate pixels are tested in portions of about this number, which bounds the memory.
_PORTION = 2_000_000
_NOTHING = np.uint64(0xFFFF_FFFF_FFFF_FFFF)
_DEPTH_STEPS = 2.0**32 - 2
# Largest rounding error of a weight on the edge of a triangle.
_INSIDE = 1e-9


@dataclass(frozen=True)
class Raster:
    """Visible triangle in each pixel that a surface covers.

    Attributes
    ----------
    width, height
        Size of the picture in pixels.
    pixels : ndarray of int64, shape (p,)
        Covered pixels, counted row by row.
    triangle : ndarray of int64, shape (p,)
        Index of the triangle in front.
    weights : ndarray, shape (p, 3)
        Barycentric coordinates in it.
    depth : ndarray, shape (p,)
        Distance along the line of sight.
    """

    width: int
    height: int
    pixels: NDArray[np.int64]
    triangle: NDArray[np.int64]
    weights: Floats
    depth: Floats

    @property
    def covered(self) -> NDArray[np.bool_]:
        """Mask of the covered pixels, (h, w)."""
        seen: NDArray[np.bool_] = self.spread(np.ones(len(self.pixels), dtype=bool), False)
        return seen

    def spread(self, values: NDArray[Any], elsewhere: float) -> NDArray[Any]:
        """Put one value for each covered pixel (p, ...) in a picture (h, w, ...)."""
        picture = np.full((self.height * self.width, *values.shape[1:]), elsewhere, values.dtype)
        picture[self.pixels] = values
        return picture.reshape(self.height, self.width, *values.shape[1:])

    def interpolate(self, corners: Floats) -> Floats:
        """Interpolate values given at the corners of each triangle, (t, 3), to pixels, (p,)."""
        values: Floats = np.einsum("pk,pk->p", self.weights, corners[self.triangle])
        return values


def rasterize(points: Floats, triangles: NDArray[np.integer], width: int, height: int) -> Raster:
    """Find the triangle in front in each pixel.

    Parameters
    ----------
    points
        Column and row in pixels (the center of the first pixel is at 0.5, 0.5) and depth, (n, 3);
        smaller depths are in front.
    triangles
        Vertex indices, (t, 3), of a closed surface, counterclockwise to a reader: those that face
        away are hidden by others and left out.
    width, height
        Size of the picture in pixels.

    Returns
    -------
    Raster
        Raster, equal for any order of the triangles except in pixels where two are equally deep.

    Examples
    --------
    >>> points = np.array([[0.0, 0, 1], [0, 4, 1], [4, 0, 1]])
    >>> seen = rasterize(points, np.array([[0, 1, 2]]), 4, 3)
    >>> seen.covered.astype(int).tolist()
    [[1, 1, 1, 1], [1, 1, 1, 0], [1, 1, 0, 0]]
    """
    low, high = _depth_range(points)
    # Depth in the upper half of a word and the triangle in the lower: the least word is in front.
    front = np.full(width * height, _NOTHING, dtype=np.uint64)
    corners = points[triangles]
    for chosen in _portions(corners, width, height):
        tri, pixel, depth = _covered_by(corners, chosen, width)
        steps = np.round((depth - low) / (high - low) * _DEPTH_STEPS).astype(np.uint64)
        np.minimum.at(front, pixel, (steps << np.uint64(32)) | tri.astype(np.uint64))
    pixels = np.flatnonzero(front != _NOTHING)
    owner = (front[pixels] & np.uint64(0xFFFF_FFFF)).astype(np.int64)
    rows, columns = np.divmod(pixels, width)
    weights = _barycentric(corners[owner], columns + 0.5, rows + 0.5)
    depth = np.einsum("pk,pk->p", weights, corners[owner, :, 2])
    return Raster(width, height, pixels, owner, weights, depth)


def _depth_range(points: Floats) -> tuple[float, float]:
    low, high = float(points[:, 2].min()), float(points[:, 2].max())
    # Rounding may move a weight slightly out of a triangle.
    margin = 1e-3 * (high - low) + 1e-9
    return low - margin, high + margin


@dataclass(frozen=True)
class _Portion:
    """Triangles with the boxes of pixels around them."""

    triangles: NDArray[np.int64]
    first: NDArray[np.int64]  # column and row, (p, 2)
    size: NDArray[np.int64]  # columns and rows, (p, 2)


def _portions(corners: Floats, width: int, height: int) -> list[_Portion]:
    limits = np.array([width, height])
    flat = corners[:, :, :2]
    first = np.clip(np.ceil(flat.min(axis=1) - 0.5), 0, limits).astype(np.int64)
    last = np.clip(np.floor(flat.max(axis=1) - 0.5), -1, limits - 1).astype(np.int64)
    size = np.maximum(last - first + 1, 0)
    counts = size.prod(axis=1)
    a, b, c = flat.transpose(1, 0, 2)
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    # Rows run downwards, so that triangles seen from their front have a negative area.
    useful = np.flatnonzero((counts > 0) & (area < -1e-9))
    total = np.cumsum(counts[useful])
    cuts = np.searchsorted(
        total, np.arange(_PORTION, int(total[-1]) if len(total) else 0, _PORTION)
    )
    return [
        _Portion(chosen, first[chosen], size[chosen])
        for chosen in np.split(useful, cuts)
        if len(chosen)
    ]


def _covered_by(
    corners: Floats, portion: _Portion, width: int
) -> tuple[NDArray[np.int64], NDArray[np.int64], Floats]:
    """List the pixels inside each triangle: triangle, pixel and depth, (p,) each.

    Weights are linear along a row, so that each row of pixels has one span inside a triangle.
    """
    a, b, c = corners[portion.triangles].transpose(1, 0, 2)
    ab, ac = b - a, c - a
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    # Slopes of the weights of a, b and c along x and y, and of the depth.
    of_b, of_c = np.stack([ac[:, 1], -ac[:, 0]]) / area, np.stack([-ab[:, 1], ab[:, 0]]) / area
    slopes = np.stack([-of_b - of_c, of_b, of_c])
    steepness = of_b * ab[:, 2] + of_c * ac[:, 2]

    which, down = _spread_out(portion.size[:, 1])
    row = portion.first[which, 1] + down
    dy = row + 0.5 - a[which, 1]
    at_a = slopes[:, 1, which] * dy + np.array([1.0, 0.0, 0.0])[:, None]
    left, right = _span(slopes[:, 0, which], at_a)
    last = portion.first[which, 0] + portion.size[which, 0] - 1
    # A row that misses the triangle begins, at the latest, where its box has ended.
    start = np.clip(np.ceil(left + a[which, 0] - 0.5), portion.first[which, 0], last + 1)
    stop = np.minimum(np.floor(right + a[which, 0] - 0.5), last)
    first = start.astype(np.int64)

    span, along = _spread_out(np.maximum(stop - start + 1.0, 0.0).astype(np.int64))
    # Depth at the first pixel of a span, and its change along the span.
    edge = a[which, 2] + steepness[1, which] * dy
    edge += steepness[0, which] * (first + 0.5 - a[which, 0])
    depth = edge[span] + steepness[0, which[span]] * along
    pixel = (row * width + first)[span] + along
    return portion.triangles[which[span]], pixel, depth


def _spread_out(counts: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Number the members of groups of some sizes, (g,): return group and place in it, (p,) each."""
    group = np.repeat(np.arange(len(counts)), counts)
    return group, np.arange(len(group)) - np.repeat(np.cumsum(counts) - counts, counts)


def _span(slope: Floats, value: Floats) -> tuple[Floats, Floats]:
    """Find where all of three linear functions, (3, r), are positive: from and to, (r,)."""
    level = value + _INSIDE
    with np.errstate(divide="ignore", invalid="ignore"):
        zero = -level / slope
    left = np.where(slope > 0.0, zero, np.where((slope == 0.0) & (level < 0.0), np.inf, -np.inf))
    right = np.where(slope < 0.0, zero, np.inf)
    return left.max(axis=0), right.min(axis=0)


def _barycentric(corners: Floats, x: NDArray[np.floating], y: NDArray[np.floating]) -> Floats:
    """Return the weights of pixels (p,) in triangles (p, 3, 3), by Cramer's rule."""
    a, b, c = corners[:, :, :2].transpose(1, 0, 2)
    ab, ac = b - a, c - a
    dx, dy = x - a[:, 0], y - a[:, 1]
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    of_b = (dx * ac[:, 1] - dy * ac[:, 0]) / area
    of_c = (ab[:, 0] * dy - ab[:, 1] * dx) / area
    return np.column_stack([1.0 - of_b - of_c, of_b, of_c])
