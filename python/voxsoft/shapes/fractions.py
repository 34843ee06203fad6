"""Fill fractions of cells: small cubes, each cut by the plane that fits the surface."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core

Floats = NDArray[np.float64]

#: Number of small cubes of edge w along each edge of a cell. Any number of them meets a plane
#: exactly; the plane at a sphere of radius R lies w²/(12 R) too far out, its neglected curvature.
SUBCELLS = 4

#: Normals with a smaller component (of a sum of one) count as parallel to a face.
_PARALLEL = 1e-7


def below_plane(level: Floats, normal: Floats) -> Floats:
    """Return the fraction of a unit cube in which ``level + normal · x`` is negative.

    The cube is centered at the origin. The part depends continuously on level and normal, and has a
    continuous derivative wherever the plane is not parallel to a face.

    Parameters
    ----------
    level : ndarray, shape (...)
        Value of the function at the center.
    normal : ndarray, shape (..., 3)
        Gradient of the function; where it is zero, the sign of the level decides.

    Returns
    -------
    ndarray, shape (...)
        Fraction between 0 and 1.

    References
    ----------
    Scardovelli and Zaleski 2000, doi 10.1006/jcph.2000.6567, Eq. 15 onward: the volume of a cut
    cube in closed form.

    Examples
    --------
    >>> below_plane(np.array([-0.25, 0.0]), np.array([[1.0, 0, 0], [1, 2, 3]])).tolist()
    [0.75, 0.5]
    """
    total = np.abs(normal).sum(axis=-1)
    steep = np.isfinite(total) & (total > 0.0)
    scale = np.where(steep, total, 1.0)
    # The least corner is at 0 and the greatest at 1; heights above 1/2 are mirror images.
    with np.errstate(invalid="ignore"):
        height = np.clip(0.5 - np.where(steep, level / scale, 0.0), 0.0, 1.0)
    a = np.minimum(height, 1.0 - height)
    m1, m2, m3 = np.moveaxis(np.sort(np.abs(np.where(steep[..., None], normal, 1.0)), -1), -1, 0)
    scale = np.where(steep, scale, 3.0)
    m1, m2, m3 = m1 / scale, m2 / scale, m3 / scale
    m1 = np.where(m1 < _PARALLEL, 0.0, m1)
    m2 = np.where(m2 < _PARALLEL, 0.0, m2)
    corner = 6.0 * np.maximum(m1 * m2 * m3, 1e-300)
    # Cut off: one corner, one edge, three corners, four corners or all of the lower face.
    one = a**3 / corner
    edge = a * (a - m1) / np.maximum(2.0 * m2 * m3, 1e-300) + m1**2 / np.maximum(
        6.0 * m2 * m3, 1e-300
    )
    three = (
        a * a * (3.0 * (m1 + m2) - a) + m1**2 * (m1 - 3.0 * a) + m2**2 * (m2 - 3.0 * a)
    ) / corner
    four = (
        a * a * (3.0 - 2.0 * a)
        + m1**2 * (m1 - 3.0 * a)
        + m2**2 * (m2 - 3.0 * a)
        + m3**2 * (m3 - 3.0 * a)
    ) / corner
    face = (2.0 * a - m1 - m2) / (2.0 * m3)
    cases = [a < m1, a < m2, a < np.minimum(m1 + m2, m3), m3 < m1 + m2]
    small = np.select(cases, [one, edge, three, four], face)
    part = np.where(height <= 0.5, small, 1.0 - small)
    return np.where(steep, part, (level <= 0.0).astype(np.float64))


def fill(
    shapes: Sequence[_core.Shape], corners: Floats, size: float
) -> tuple[Floats, Floats, Floats]:
    """Return the filled fraction of each small cube of some cells, and the share of each shape.

    Parameters
    ----------
    shapes
        Built shapes; the first wins where they overlap.
    corners : ndarray, shape (k, 3)
        Lowest corners of the cells [m].
    size
        Edge of a cell [m].

    Returns
    -------
    filled : ndarray, shape (k, SUBCELLS**3)
        Filled fraction of each small cube, in C order.
    normals : ndarray, shape (k, SUBCELLS**3, 3)
        Outward normal of the surface nearest to each small cube.
    shares : ndarray, shape (k, len(shapes))
        Fraction of each cell that each shape takes; they sum to the mean of `filled`.

    Notes
    -----
    In each small cube a shape is taken as the plane with its value at the center and its mean
    slopes between the centers of opposite faces. The common part of two shapes in a cube that
    both cut does not follow from two fractions: it is interpolated with the cosine of the angle
    between their planes, and is exact where they share a surface, abut, or meet at a right angle
    along the axes.

    Examples
    --------
    >>> from voxsoft.shapes import HalfSpace
    >>> top = HalfSpace(point=(0, 0, 0.7), normal=(0, 0, 1))
    >>> filled, _, shares = fill([top.build()], np.zeros((1, 3)), 1.0)
    >>> round(float(filled.mean()), 12), round(float(shares[0, 0]), 12)
    (0.7, 0.7)
    """
    filled = np.zeros((len(corners), SUBCELLS**3))
    shares = np.zeros((len(corners), len(shapes)))
    nearest = np.full(filled.shape, np.inf)
    normals = np.zeros((*filled.shape, 3))
    for index, shape in enumerate(shapes):
        level, normal = _planes(shape, corners, size)
        own = below_plane(level, normal)
        added = own - _common(filled, normals, own, normal) if index else own
        filled = filled + added
        shares[:, index] = added.mean(axis=1)
        closer = level < nearest
        nearest = np.where(closer, level, nearest)
        normals = np.where(closer[..., None], normal, normals)
    return filled, normals, shares


def _common(first: Floats, normal: Floats, second: Floats, other: Floats) -> Floats:
    """Return the part of each small cube in both shapes, by the angle between their planes."""
    lengths = np.linalg.norm(normal, axis=-1) * np.linalg.norm(other, axis=-1)
    products = np.einsum("...i,...i->...", normal, other)
    cosine = np.divide(products, lengths, out=np.zeros_like(products), where=lengths > 0.0)
    along = np.where(cosine > 0.0, np.minimum(first, second), np.maximum(first + second - 1.0, 0.0))
    common: Floats = np.abs(cosine) * along + (1.0 - np.abs(cosine)) * first * second
    return common


def _planes(shape: _core.Shape, corners: Floats, size: float) -> tuple[Floats, Floats]:
    """Return level (k, n³) and slopes (k, n³, 3) of a shape in each small cube."""
    n, count = SUBCELLS, len(corners)
    points = corners[:, None, :] + (size / (2 * n)) * _STEPS
    values = shape.evaluate(np.ascontiguousarray(points.reshape(-1, 3))).reshape(count, -1)
    center, x, y, z = np.split(values, np.cumsum([n**3, *2 * [n * n * (n + 1)]]), axis=1)
    x = x.reshape(count, n + 1, n, n)
    y = y.reshape(count, n, n + 1, n)
    z = z.reshape(count, n, n, n + 1)
    with np.errstate(invalid="ignore"):
        slopes = (np.diff(x, axis=1), np.diff(y, axis=2), np.diff(z, axis=3))
    normal = np.stack([slope.reshape(count, -1) for slope in slopes], axis=-1)
    normal = np.where(np.isfinite(normal), normal, 0.0)
    # A seam of two bodies exactly through the center has neither level nor slope; its sides do.
    sides = (x[:, 1:] + x[:, :-1] + y[:, :, 1:] + y[:, :, :-1] + z[..., 1:] + z[..., :-1]).reshape(
        count, -1
    ) / 6.0
    blind = np.abs(normal).sum(axis=-1) <= 1e-9 * np.abs(sides)
    normal = np.where(blind[..., None], 0.0, normal)
    return np.where(blind, sides, center), normal


def _steps() -> Floats:
    """List centers of the small cubes, then of their faces across x, y, z, in halves of a cube."""
    odd, even = np.arange(1, 2 * SUBCELLS, 2), np.arange(0, 2 * SUBCELLS + 1, 2)
    grids = [(odd, odd, odd), (even, odd, odd), (odd, even, odd), (odd, odd, even)]
    rows = [np.stack(np.meshgrid(*g, indexing="ij"), axis=-1).reshape(-1, 3) for g in grids]
    return np.concatenate(rows).astype(np.float64)


_STEPS = _steps()
