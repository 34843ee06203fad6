"""Shading of a rasterized surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft.plot.camera import Camera
from voxsoft.plot.raster import Raster

Floats = NDArray[np.float64]

_AMBIENT = 0.62
# Along right, up and toward the reader: the light stands above the reader's left shoulder.
_LIGHT = np.array([-0.4, 0.7, 0.6]) / np.linalg.norm([-0.4, 0.7, 0.6])
# Depth contrast: its reach (share of the picture's longer side), and its darkest brightness.
_REACH = 0.012
_DARKEST = 0.4
# Lines: width in pixels, and the light they remove.
_LINE_WIDTH = 1.1
_MESH_LINE = 0.32
_OUTLINE = 0.75
# Depth of empty pixels, and the jump in depth (share of the longer side) of an outline.
_FAR = 1e9
_JUMP = 0.012


def normals_of(corners: Floats) -> Floats:
    """Return unit normals of triangles (t, 3, 3), (t, 3); zero for a triangle without area."""
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    unit: Floats = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    return unit


def lit(normals: Floats, camera: Camera) -> Floats:
    """Return the brightness of flat faces with these normals, (t,), at most 1."""
    light = _LIGHT @ np.stack([camera.right, camera.up, camera.toward])
    brightness: Floats = _AMBIENT + (1.0 - _AMBIENT) * np.clip(normals @ light, 0.0, 1.0)
    return brightness


def depth_contrast(seen: Raster) -> Floats:
    """Return the brightness of each covered pixel, (p,), less than 1 behind something nearby.

    Computed from the difference between a blurred depth buffer and the depth itself, Luft, Colditz
    and Deussen (2006), doi:10.1145/1141911.1142016. It distinguishes a pore from a bump.
    """
    reach = _REACH * max(seen.width, seen.height)
    # Blurred values change slowly: every second row and column is enough.
    inside = seen.spread(np.ones(len(seen.pixels)), 0.0)[::2, ::2]
    depth = seen.spread(seen.depth, 0.0)[::2, ::2]
    weight = _blurred(inside, reach / 2)
    blurred = _blurred(depth, reach / 2) / np.maximum(weight, 1e-6)
    rows, columns = np.divmod(seen.pixels, seen.width)
    behind = np.clip((seen.depth - blurred[rows // 2, columns // 2]) / (3.0 * reach), 0.0, 1.0)
    brightness: Floats = 1.0 - _DARKEST * behind
    return brightness


def _blurred(image: Floats, spread: float) -> Floats:
    """Blur an image by a Gaussian of a standard deviation in pixels, mirrored at the border."""
    rows, columns = (_gaussian(count, spread) for count in image.shape)
    blurred: Floats = rows @ image @ columns.T
    return blurred


def _gaussian(count: int, spread: float) -> Floats:
    """Weights of the pixels of a row in each blurred pixel, (n, n), up to four deviations away."""
    reach = round(4.0 * spread)
    steps = np.arange(-reach, reach + 1)
    weights = np.exp(-0.5 * (steps / spread) ** 2)
    # Pixels n, n + 1 … beyond the border are n - 1, n - 2 … within.
    places = (np.arange(count)[:, None] + steps) % (2 * count)
    found = np.zeros((count, count))
    rows = np.broadcast_to(np.arange(count)[:, None], places.shape)
    np.add.at(found, (rows, np.minimum(places, 2 * count - 1 - places)), weights / weights.sum())
    return found


def mesh_lines(seen: Raster, flat_corners: Floats) -> Floats:
    """Return the brightness of each covered pixel, (p,), less than 1 along the edges of triangles.

    Parameters
    ----------
    seen
        Raster of the surface.
    flat_corners
        Column and row of the corners of each triangle, (t, 3, 2).
    """
    a, b, c = flat_corners.transpose(1, 0, 2)
    opposite = np.stack([np.linalg.norm(q - p, axis=1) for p, q in ((b, c), (c, a), (a, b))], 1)
    double_area = np.abs(
        (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    )
    heights = double_area[:, None] / np.maximum(opposite, 1e-12)
    distance = (seen.weights * heights[seen.triangle]).min(axis=1)
    brightness: Floats = 1.0 - _MESH_LINE * np.clip(_LINE_WIDTH - distance, 0.0, 1.0)
    return brightness


def outlines(seen: Raster) -> Floats:
    """Return the brightness of covered pixels, (p,), below 1 where the surface ends or jumps."""
    depth = seen.spread(seen.depth, _FAR)
    # A face at a grazing angle changes depth by several pixels a pixel; a jump is more than that.
    jump = _JUMP * max(seen.width, seen.height)
    edge = np.zeros(depth.shape, dtype=bool)
    edge[:, 1:] |= depth[:, :-1] - depth[:, 1:] > jump
    edge[:, :-1] |= depth[:, 1:] - depth[:, :-1] > jump
    edge[1:] |= depth[:-1] - depth[1:] > jump
    edge[:-1] |= depth[1:] - depth[:-1] > jump
    brightness: Floats = np.where(edge.ravel()[seen.pixels], 1.0 - _OUTLINE, 1.0)
    return brightness
