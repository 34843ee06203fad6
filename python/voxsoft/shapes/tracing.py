"""Smooth surface of shapes as triangles, traced as near to their voxels as possible."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.voxels import Voxels

Floats = NDArray[np.float64]

#: Samples along a voxel, the finer first: a slit or wall of one voxel has two in any position.
SAMPLES: Final = (3, 2)
#: Most samples of the shapes, and cells of the sample grid, for a smooth surface.
MOST_SAMPLES: Final = 2_000_000
LARGEST_GRID: Final = 16_000_000
#: Distance from a surface, in steps between samples, within which samples count as outside.
_ON_SURFACE: Final = 1e-5
#: Corners of a cube in the order of marching cubes, as (i, j, k).
_CORNERS: Final = (
    ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)),
    ((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)),
)


def trace(
    shapes: Sequence[_core.Shape], voxels: Voxels
) -> tuple[Floats, NDArray[np.int64], NDArray[np.uint8]] | None:
    """Trace the surface of shapes by marching cubes on samples finer than the voxels.

    The shapes are sampled within a voxel of the surface of the voxels; elsewhere the voxels are
    used, so that parts without a voxel are not shown. Samples lie off the faces of voxels, where
    the sides of shapes often are and the sign of a sample would be random.

    Parameters
    ----------
    shapes
        Shapes of the parts, in their order.
    voxels
        Voxels of the shapes.

    Returns
    -------
    tuple or None
        Vertices [m], (n, 3); triangles, (t, 3); part of each triangle, from 0, (t,). None where the
        grid would be too large.
    """
    from scipy import ndimage

    filled = np.pad(voxels.array > 0, 2)
    cube = np.ones((3, 3, 3), dtype=bool)
    near = ndimage.binary_dilation(filled, cube) & ~ndimage.binary_erosion(filled, cube)
    count = int(near.sum())
    fits = (n for n in SAMPLES if count * n**3 <= MOST_SAMPLES and near.size * n**3 <= LARGEST_GRID)
    if count == 0 or (along := next(fits, None)) is None:
        return None
    step = voxels.voxel_size / along
    first = np.asarray(voxels.origin) - 2 * voxels.voxel_size + step / 2
    values = np.where(_refined(filled, along), -step, step).astype(np.float32)
    asked = np.argwhere(_refined(near, along))
    found = _union(shapes, first + step * asked, step)
    values[tuple(asked.T)] = found
    vertices, triangles = contour(values, first, step)
    if len(triangles) == 0:
        return None
    return vertices, triangles, _owners(shapes, vertices[triangles].mean(axis=1), step)


def contour(
    values: NDArray[np.floating[Any]], first: Floats, step: float | Floats
) -> tuple[Floats, NDArray[np.int64]]:
    """Return the surface on which samples are zero, by marching cubes.

    Parameters
    ----------
    values
        Samples of a shape on a grid, (nx, ny, nz), negative inside.
    first
        Position of the first sample [m].
    step
        Distance from one sample to the next [m], along all axes or along each.

    Returns
    -------
    tuple
        Vertices [m], (n, 3), and triangles, (t, 3), outward; none where all samples have one sign.

    Examples
    --------
    >>> x, y, z = np.mgrid[-2:3, -2:3, -2:3].astype(float)
    >>> vertices, _ = contour(np.sqrt(x**2 + y**2 + z**2) - 1.5, np.array([-2.0, -2, -2]), 1.0)
    >>> vertices.max(axis=0)
    array([1.5, 1.5, 1.5])
    """
    import igl

    cubes = np.argwhere(_mixed(values < 0))
    if len(cubes) == 0:
        return np.zeros((0, 3)), np.zeros((0, 3), np.int64)
    corners = np.array([corner for ring in _CORNERS for corner in ring])
    at = cubes[:, None, :] + corners
    flat = np.ravel_multi_index(tuple(np.moveaxis(at, -1, 0)), values.shape)
    used, index = np.unique(flat, return_inverse=True)
    places = first + step * np.column_stack(np.unravel_index(used, values.shape))
    vertices, triangles, _ = igl.marching_cubes(
        values.ravel()[used].astype(np.float64),
        np.ascontiguousarray(places),
        np.ascontiguousarray(index.reshape(flat.shape)),
        0.0,
    )
    return vertices, triangles


def _refined(cells: NDArray[np.bool_], along: int) -> NDArray[np.bool_]:
    """Repeat each cell as several samples along each axis."""
    for axis in range(3):
        cells = cells.repeat(along, axis)
    return cells


def _union(shapes: Sequence[_core.Shape], points: Floats, step: float) -> Floats:
    values: Floats = np.min([shape.evaluate(points) for shape in shapes], axis=0)
    # A side that goes through samples: random signs would leave holes, and triangles without area.
    values[np.abs(values) < _ON_SURFACE * step] = _ON_SURFACE * step
    return np.nan_to_num(values, nan=step, posinf=step, neginf=-step)


def _mixed(inside: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return True for cubes whose eight corners are not all on one side."""
    some = every = inside
    for axis in range(3):
        low = [slice(None)] * 3
        high = [slice(None)] * 3
        low[axis], high[axis] = slice(None, -1), slice(1, None)
        some = some[tuple(low)] | some[tuple(high)]
        every = every[tuple(low)] & every[tuple(high)]
    mixed: NDArray[np.bool_] = some & ~every
    return mixed


def _owners(shapes: Sequence[_core.Shape], points: Floats, step: float) -> NDArray[np.uint8]:
    """Find the first part on whose surface each point of the common surface lies."""
    values = np.array([shape.evaluate(points) for shape in shapes])
    close = values <= values.min(axis=0) + step / 4
    owners: NDArray[np.uint8] = close.argmax(axis=0).astype(np.uint8)
    return owners
