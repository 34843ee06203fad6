"""From shapes to cells."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from voxsoft._memory import memory_limit, shortage
from voxsoft.errors import ShapeError
from voxsoft.shapes.base import Shape, Triple
from voxsoft.units import to_si
from voxsoft.voxels import Voxels

#: Sides closer to a cell face than this part of a voxel lie on it.
_SNAP = 1e-6
#: Bytes that a cell takes until its grid is made; measured: 3.4 to 4.0 for 10 to 250 million cells.
BYTES_PER_CELL = 4


def inside(
    shape: Shape,
    voxel_size: float | str,
    cells: tuple[int, int, int],
    origin: Triple = (0.0, 0.0, 0.0),
    names: Mapping[str, Shape] | None = None,
) -> NDArray[np.bool_]:
    """Tell which cells of a grid have their center inside a shape.

    A center counts as inside where s < −10⁻⁹ `voxel_size`, in float64: one that lies on the
    surface is outside, whatever rounding does. The answer does not depend on the number of threads.

    Parameters
    ----------
    shape : Shape
        The shape.
    voxel_size : float
        Edge of a cell [m].
    cells : three ints
        Number of cells along x, y, z.
    origin : three floats, default (0, 0, 0)
        Lowest corner of the grid [m].
    names : mapping of str to Shape, optional
        The shapes that operands given by name refer to.

    Returns
    -------
    numpy.ndarray of bool, shape `cells`

    Raises
    ------
    ShapeError
        If the shape cannot be built, has no value (NaN) at some center, or the cells do not fit in
        the memory that is available (said before anything is allocated).

    Examples
    --------
    >>> from voxsoft.shapes import Sphere
    >>> int(inside(Sphere(radius=0.01), 0.005, (4, 4, 4), (-0.01, -0.01, -0.01)).sum())
    32
    """
    built = shape.build(names)
    x, y, z = (to_si(value, "length", "origin") for value in origin)
    size = to_si(voxel_size, "length", "voxel_size")
    try:
        found = built.sample((x, y, z), size, cells, memory_limit())
    except ShapeError as error:
        where = ".".join(part for part in (shape.kind, error.where) if part)
        raise ShapeError(where, error.what, error.hint) from None
    return found.view(np.bool_)


def voxelize(
    shape: Shape,
    voxel_size: float | str,
    bounds: tuple[Sequence[float | str], Sequence[float | str]] | None = None,
    names: Mapping[str, Shape] | None = None,
) -> Voxels:
    """Return the cells whose centers lie inside a shape.

    The lattice passes through the origin of coordinates: cell (i, j, k) of it fills
    ``voxel_size * ([i, i+1] x [j, j+1] x [k, k+1])``. The grid covers the bounds, rounded outward.

    Parameters
    ----------
    shape : Shape
        The shape.
    voxel_size : float
        Edge of a cell [m].
    bounds : pair of corners, optional
        Lowest and highest corner [m] of the part of space to look at; needed where the shape has no
        end. The shape's own bounds by default.
    names : mapping of str to Shape, optional
        The shapes that operands given by name refer to.

    Raises
    ------
    ShapeError
        If the shape has no end and `bounds` is missing, if no cell center is inside, and for all
        that :func:`inside` refuses.

    Examples
    --------
    >>> from voxsoft.shapes import Box
    >>> voxelize(Box(size=(0.1, 0.01, 0.01)), voxel_size=0.005)
    Voxels(20 x 2 x 2 cells of 5 mm, 100 x 10 x 10 mm, 80 filled)
    """
    voxel_size = to_si(voxel_size, "length", "voxel_size")
    if not (math.isfinite(voxel_size) and voxel_size > 0):
        raise ShapeError("voxel_size", f"is {voxel_size}; it must be positive and finite")
    low, high = grid_bounds(shape, voxel_size, bounds, names)
    cells = (high[0] - low[0], high[1] - low[1], high[2] - low[2])
    origin = (low[0] * voxel_size, low[1] * voxel_size, low[2] * voxel_size)
    _refuse_too_many(cells)
    found = inside(shape, voxel_size, cells, origin, names)
    if not found.any():
        raise _empty(shape, voxel_size, names)
    return Voxels.from_array(found, voxel_size, origin)


def _empty(shape: Shape, voxel_size: float, names: Mapping[str, Shape] | None) -> ShapeError:
    """Why nothing is inside: an open surface encloses nothing at any voxel size."""
    from voxsoft.shapes.triangles import TriangleMesh

    for part in shape.every(names):
        if isinstance(part, TriangleMesh) and part.state().holes:
            return ShapeError(
                Path(part.path).name,
                f"{part.state().opening}, so nothing counts as inside",
                "close it in the program that it came from, or make a wall of the surface: "
                '{ kind = "shell", of = ..., thickness = "2 mm" }',
            )
    return ShapeError(
        shape.kind,
        f"is empty: no cell of {voxel_size * 1e3:.6g} mm has its center inside",
        "use a smaller voxel_size, or check the sizes and places of its parts",
    )


def _refuse_too_many(cells: tuple[int, int, int]) -> None:
    if short := shortage(math.prod(cells) * BYTES_PER_CELL):
        grid = f"a grid of {cells[0]:,} x {cells[1]:,} x {cells[2]:,} cells"
        raise ShapeError("voxel_size", f"{grid} {short}", "make the voxels larger")


def grid_bounds(
    shape: Shape,
    voxel_size: float | str,
    bounds: tuple[Sequence[float | str], Sequence[float | str]] | None = None,
    names: Mapping[str, Shape] | None = None,
) -> tuple[tuple[int, int, int], tuple[int, int, int]]:
    """Return the first and last-plus-one cell of the lattice that a shape needs.

    Parameters and errors are those of :func:`voxelize`.

    Examples
    --------
    >>> from voxsoft.shapes import Sphere
    >>> grid_bounds(Sphere(radius=0.012), 0.005)
    ((-3, -3, -3), (3, 3, 3))
    """
    voxel_size = to_si(voxel_size, "length", "voxel_size")
    corners = shape.bounds(names) if bounds is None else bounds
    low, high = ([to_si(v, "length", "bounds") for v in corner] for corner in corners)
    numbers = [*low, *high]
    if any(math.isnan(v) for v in numbers):
        raise ShapeError("bounds", f"{bounds} holds a value that is not a number")
    if any(a > b for a, b in zip(low, high, strict=True)):
        what = "is empty: its parts have nothing in common"
        raise ShapeError(shape.kind, what, "check the sizes and places of its parts")
    if not all(math.isfinite(v) for v in numbers):
        endless = [axis for axis, a, b in zip("xyz", low, high, strict=True) if a - b == -math.inf]
        raise ShapeError(
            shape.kind,
            f"has no end along {', '.join(endless)}",
            "intersect it with a box, or give bounds",
        )
    first = [math.floor(v / voxel_size + _SNAP) for v in low]
    last = [max(math.ceil(v / voxel_size - _SNAP), f + 1) for v, f in zip(high, first, strict=True)]
    return (first[0], first[1], first[2]), (last[0], last[1], last[2])
