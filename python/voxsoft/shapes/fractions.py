"""Fill fractions of cells: small cubes, each cut by the plane that fits the surface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core

Floats = NDArray[np.float64]

#: Number of small cubes of edge w along each edge of a cell. Any number of them meets a plane
#: exactly; the plane at a sphere of radius R lies w²/(12 R) too far out, its neglected curvature.
SUBCELLS: Final = _core.SUBCELLS


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
    return _core.fill_cells(shapes, np.ascontiguousarray(corners, dtype=np.float64), size)
