"""Sampling of shapes to cells."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft._memory import memory_limit, shortage
from voxsoft.errors import ShapeError
from voxsoft.shapes.base import Shape, Triple
from voxsoft.shapes.phase import choose_phase
from voxsoft.shapes.ties import SampledPart, decided, tie_width
from voxsoft.units import to_si
from voxsoft.voxels import Voxels

#: Distance, in voxels, within which a side lies on a cell face.
_SNAP = 1e-6
#: Memory of a cell in bytes until its grid is made; measured: 3.4 to 4.0 for 10 to 250 million
#: cells.
BYTES_PER_CELL = 4


def inside(
    shape: Shape,
    voxel_size: float | str,
    cells: tuple[int, int, int],
    origin: Triple = (0.0, 0.0, 0.0),
    names: Mapping[str, Shape] | None = None,
) -> NDArray[np.bool_]:
    """Test which cells of a grid have their center inside a shape.

    A center that lies on the surface, to rounding, is decided half-open: of two opposite faces of
    a body one takes such cells and the other does not (see :mod:`voxsoft.shapes.ties`). The answer
    does not depend on the number of threads.

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
        Shapes that operands given by name refer to.

    Returns
    -------
    numpy.ndarray of bool, shape `cells`

    Raises
    ------
    ShapeError
        If the shape cannot be built, has no value (NaN) at some center, or the cells do not fit in
        the memory that is available (raised before anything is allocated).

    Examples
    --------
    >>> from voxsoft.shapes import Sphere
    >>> int(inside(Sphere(radius=0.01), 0.005, (4, 4, 4), (-0.01, -0.01, -0.01)).sum())
    32
    """
    built = shape.build(names)
    corner = _triple([to_si(value, "length", "origin") for value in origin])
    size = to_si(voxel_size, "length", "voxel_size")
    tie = tie_width([shape], size, names)
    codes = _codes(shape, built, corner, size, cells, tie)
    part = SampledPart(built, np.zeros(3, dtype=np.int64), codes)
    return decided([part], corner, size, tie)[0]


def _codes(
    shape: Shape,
    built: _core.Shape,
    origin: Triple,
    voxel_size: float,
    cells: tuple[int, int, int],
    tie: float,
) -> NDArray[np.uint8]:
    try:
        return built.sample(origin, voxel_size, cells, tie, memory_limit())
    except ShapeError as error:
        where = ".".join(part for part in (shape.kind, error.where) if part)
        raise ShapeError(where, error.what, error.hint) from None


def voxelize(
    shape: Shape,
    voxel_size: float | str,
    bounds: tuple[Sequence[float | str], Sequence[float | str]] | None = None,
    names: Mapping[str, Shape] | None = None,
    phase: Sequence[float | str] | None = None,
) -> Voxels:
    """Return the cells whose centers lie inside a shape.

    Cell (i, j, k) of the grid fills ``phase + voxel_size * ([i, i+1] x [j, j+1] x [k, k+1])``.
    The grid covers the bounds, rounded outward.

    Parameters
    ----------
    shape : Shape
        The shape.
    voxel_size : float
        Edge of a cell [m].
    bounds : pair of corners, optional
        Lowest and highest corner [m] of the sampled space; needed where the shape has no
        end. The shape's own bounds by default.
    names : mapping of str to Shape, optional
        Shapes that operands given by name refer to.
    phase : three floats, optional
        Corner of a cell [m]. By default chosen along each axis as for the body of a design
        (:func:`voxsoft.shapes.phase.choose_phase`): 0 unless a body of whole voxels lies elsewhere,
        or a symmetric one would lose its symmetry; and 0 where `bounds` are given.

    Raises
    ------
    ShapeError
        If the shape has no end and `bounds` is missing, if no cell center is inside, and for all
        errors of :func:`inside`.

    Examples
    --------
    >>> from voxsoft.shapes import Box
    >>> voxelize(Box(size=(0.1, 0.01, 0.01)), voxel_size=0.005)
    Voxels(20 x 2 x 2 cells of 5 mm, 100 x 10 x 10 mm, 80 filled)
    >>> voxelize(Box(size=("30 mm", "6 mm", "6 mm"), corner=(0, "-3 mm", "-3 mm")), "2 mm").count
    135
    """
    voxel_size = to_si(voxel_size, "length", "voxel_size")
    if not (math.isfinite(voxel_size) and voxel_size > 0):
        raise ShapeError("voxel_size", f"is {voxel_size}; it must be positive and finite")
    given: Sequence[float | None] = (None, None, None) if bounds is None else (0.0, 0.0, 0.0)
    if phase is not None:
        given = [to_si(each, "length", "phase") for each in phase]
    return Body([shape], voxel_size, names or {}, given, bounds).voxels()


class _Cells(NamedTuple):
    """Part of each cell (from 1, 0 for none), lowest cell on the grid, mask of empty parts."""

    parts: NDArray[np.uint8]
    low: NDArray[np.int64]
    is_empty: list[bool]


class Body:
    """Shapes that fill one grid, the first where they overlap.

    Parameters
    ----------
    shapes
        Shapes of the parts.
    voxel_size
        Edge of a cell [m].
    names
        Shapes that operands given by name refer to.
    given
        Given phases along the axes [m], None where they are chosen.
    bounds
        Lowest and highest corner of the sampled space [m]; default: those of the shapes.
    """

    def __init__(
        self,
        shapes: Sequence[Shape],
        voxel_size: float,
        names: Mapping[str, Shape],
        given: Sequence[float | None] = (None, None, None),
        bounds: tuple[Sequence[float | str], Sequence[float | str]] | None = None,
    ) -> None:
        self.shapes, self.voxel_size, self.names = shapes, voxel_size, names
        self._tie = tie_width(shapes, voxel_size, names)
        self._snap = max(_SNAP, 4.0 * self._tie / voxel_size)
        self._boxes = [corners_of(shape, bounds, names) for shape in shapes]
        self._bounds = (
            np.min([low for low, _ in self._boxes], axis=0).tolist(),
            np.max([high for _, high in self._boxes], axis=0).tolist(),
        )
        self._found: dict[Triple, _Cells] = {}
        self.phase = choose_phase(
            self._bounds, voxel_size, self._snap, lambda p: self._cells(p).parts > 0, given
        )

    @cached_property
    def _built(self) -> list[_core.Shape]:
        return [shape.build(self.names) for shape in self.shapes]

    def voxels(self) -> Voxels:
        """Return the cells of the parts, numbered from 1.

        Raises
        ------
        ShapeError
            No cell center is inside one of them.
        """
        cells, low, is_empty = self._cells(self.phase)
        for shape, none in zip(self.shapes, is_empty, strict=True):
            if none:
                raise _empty(shape, self.voxel_size, self.names)
        origin = np.asarray(self.phase) + low * self.voxel_size
        return Voxels.from_array(cells, self.voxel_size, _triple(origin.tolist()))

    def cells_of(self, index: int, phase: Triple) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the first and last-plus-one cell of the grid that a part needs, (3,) each."""
        low, high = (
            (np.asarray(corner) - phase) / self.voxel_size for corner in self._boxes[index]
        )
        first = np.floor(low + self._snap).astype(np.int64)
        last = np.ceil(high - self._snap).astype(np.int64)
        return first, np.maximum(last, first + 1)

    def _cells(self, phase: Triple) -> _Cells:
        if phase not in self._found:
            self._found[phase] = self._sampled(phase)
        return self._found[phase]

    def _sampled(self, phase: Triple) -> _Cells:
        parts = []
        for index, (shape, built) in enumerate(zip(self.shapes, self._built, strict=True)):
            low, high = self.cells_of(index, phase)
            nx, ny, nz = (high - low).tolist()
            refuse_too_many((nx, ny, nz))
            origin = _triple((np.asarray(phase) + low * self.voxel_size).tolist())
            codes = _codes(shape, built, origin, self.voxel_size, (nx, ny, nz), self._tie)
            parts.append(SampledPart(built, low, codes))
        middle = _triple([(low + high) / 2.0 for low, high in zip(*self._bounds, strict=True)])
        found = decided(parts, phase, self.voxel_size, self._tie, middle)
        return _together([part.low for part in parts], found)


def _together(lows: list[NDArray[np.int64]], parts: list[NDArray[np.bool_]]) -> _Cells:
    """Merge cells of parts on one grid, the first part where they overlap."""
    is_empty = [not held.any() for held in parts]
    if len(parts) == 1:
        return _Cells(parts[0].view(np.uint8), lows[0], is_empty)
    low = np.min(lows, axis=0)
    high = np.max([a + held.shape for a, held in zip(lows, parts, strict=True)], axis=0)
    cells = np.zeros(high - low, dtype=np.uint8)
    for index in range(len(parts) - 1, -1, -1):
        first = lows[index] - low
        window = tuple(map(slice, first, first + parts[index].shape))
        cells[window][parts[index]] = index + 1
    return _Cells(cells, low, is_empty)


def _empty(shape: Shape, voxel_size: float, names: Mapping[str, Shape] | None) -> ShapeError:
    """Make the error of an empty shape: an open surface encloses nothing at any voxel size."""
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


def refuse_too_many(cells: tuple[int, int, int], bytes_per_cell: float = BYTES_PER_CELL) -> None:
    """Raise a ShapeError if a grid of so many cells does not fit in memory.

    Examples
    --------
    >>> refuse_too_many((10, 10, 10))
    """
    if short := shortage(math.prod(cells) * bytes_per_cell):
        grid = f"a grid of {cells[0]:,} x {cells[1]:,} x {cells[2]:,} cells"
        raise ShapeError("voxel_size", f"{grid} {short}", "make the voxels larger")


def corners_of(
    shape: Shape,
    bounds: tuple[Sequence[float | str], Sequence[float | str]] | None,
    names: Mapping[str, Shape] | None,
) -> tuple[list[float], list[float]]:
    """Return the lowest and highest corner [m] of given bounds, or else of a shape.

    Raises
    ------
    ShapeError
        They are no numbers, empty, or without end.
    """
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
    return low, high


def _triple(values: Sequence[float]) -> Triple:
    x, y, z = values
    return x, y, z
