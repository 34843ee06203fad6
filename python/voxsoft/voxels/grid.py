"""Grid of cells, each empty or of one part.

The file is long because every method documents its arguments, errors and an example; none has
more than a few lines of its own, the work is done in Rust.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from voxsoft import _core
from voxsoft._memory import memory_limit
from voxsoft.errors import VoxelError
from voxsoft.geometry import grid_phase
from voxsoft.mesh import Mesh
from voxsoft.voxels.arguments import (
    Axis,
    Triple,
    axis_vector,
    length,
    margins,
    part_id,
    point,
    positive_length,
    triple,
    whole,
)
from voxsoft.voxels.regions import (
    Cavity,
    Component,
    Hinge,
    Leak,
    Wall,
    WallThickness,
    region_fields,
)

Contact = Literal["face", "edge", "corner"]

#: Width of an opening in cells up to which it is a leak; wider ones are meant to be open.
_WIDEST_LEAK = 2
_CONTACTS: dict[str, int] = {"face": 1, "edge": 2, "corner": 3}


@dataclass(frozen=True, eq=False, repr=False)
class Voxels:
    """A box of cubic cells, each empty (0) or of part 1 to 255.

    Cell ``(i, j, k)`` fills ``origin + voxel_size * ([i, i+1] x [j, j+1] x [k, k+1])``. Grids are
    immutable: every change gives a new one. Make them with :meth:`empty` or :meth:`from_array`,
    or by sampling a shape.

    A grid knows its position on the infinite integer grid of its voxel size, so padding, cropping
    and shifting change neither positions nor the mesh. One byte per cell: 512³ cells take 128 MiB.
    """

    _grid: _core.Grid

    @classmethod
    def empty(
        cls,
        shape: Sequence[int],
        voxel_size: float | str,
        origin: Sequence[float | str] = (0.0, 0.0, 0.0),
    ) -> Self:
        """Return an empty grid.

        Parameters
        ----------
        shape : three ints
            Number of cells along x, y and z, each 1 to 65,000.
        voxel_size : float
            Side of a cell [m].
        origin : three floats, default (0, 0, 0)
            Lower corner of the grid [m].

        Raises
        ------
        VoxelError
            If a size is not positive, or the cells do not fit in the memory that is available
            (raised before anything is allocated).

        Examples
        --------
        >>> Voxels.empty((2, 3, 4), voxel_size=0.005)
        Voxels(2 x 3 x 4 cells of 5 mm, 10 x 15 x 20 mm, 0 filled)
        """
        nx, ny, nz = (whole("shape", n, 1, 2**31) for n in triple("shape", shape))
        place = point("origin", origin)
        return cls(
            _core.Grid.empty((nx, ny, nz), place, length("voxel_size", voxel_size), memory_limit())
        )

    @classmethod
    def from_array(
        cls,
        array: ArrayLike,
        voxel_size: float | str,
        origin: Sequence[float | str] = (0.0, 0.0, 0.0),
    ) -> Self:
        """Return a grid of given cells, for instance a segmented CT scan.

        Parameters
        ----------
        array : array_like, shape (nx, ny, nz)
            Part of each cell: bool (True is part 1) or whole numbers 0 (empty) to 255.
        voxel_size : float
            Side of a cell [m].
        origin : three floats, default (0, 0, 0)
            Lower corner of the grid [m].

        Raises
        ------
        VoxelError
            If the array is not three-dimensional, is empty, or holds anything else.

        Examples
        --------
        >>> import numpy as np
        >>> Voxels.from_array(np.ones((2, 2, 2), dtype=bool), voxel_size=0.01).count
        8
        """
        cells = np.asarray(array)
        if cells.ndim != 3:
            raise VoxelError("array", f"has {cells.ndim} dimensions; a grid has 3", "reshape it")
        if cells.dtype.kind not in "bui":
            hint = "compare with a threshold to get booleans, or cast to numpy.uint8"
            raise VoxelError("array", f"holds {cells.dtype}; parts are whole numbers", hint)
        if cells.size and not (cells.min() >= 0 and cells.max() <= 255):
            found = f"holds {cells.min()} to {cells.max()}"
            raise VoxelError("array", f"{found}; parts are numbered 0 (empty) to 255")
        place = point("origin", origin)
        return cls(
            _core.Grid.from_array(cells.astype(np.uint8), place, length("voxel_size", voxel_size))
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return Voxels.from_array, (self.array, self.voxel_size, self.origin)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Voxels):
            return NotImplemented
        return (
            self.voxel_size == other.voxel_size
            and self.origin == other.origin
            and np.array_equal(self.array, other.array)
        )

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        size = self.voxel_size * 1e3
        cells = " x ".join(str(n) for n in self.shape)
        extent = " x ".join(f"{n * size:g}" for n in self.shape)
        return f"Voxels({cells} cells of {size:g} mm, {extent} mm, {self.count} filled)"

    @cached_property
    def array(self) -> NDArray[np.uint8]:
        """Part of each cell, shape (nx, ny, nz), read-only."""
        array = self._grid.array()
        array.setflags(write=False)
        return array

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of cells along x, y and z."""
        return self._grid.shape

    @property
    def voxel_size(self) -> float:
        """Side of a cell [m]."""
        return self._grid.voxel_size

    @property
    def origin(self) -> Triple:
        """Lower corner of the grid [m]."""
        return self._grid.origin

    @property
    def phase(self) -> Triple:
        """Phase of the grid along each axis [m]: the position of a corner within one voxel.

        Examples
        --------
        >>> Voxels.empty((2, 2, 2), voxel_size=0.002, origin=(0, -0.003, 0.004)).phase
        (0.0, 0.001, 0.0)
        """
        return grid_phase(self.origin, self.voxel_size)

    @cached_property
    def count(self) -> int:
        """Number of filled cells."""
        return self._grid.count()

    @property
    def volume(self) -> float:
        """Volume of the filled cells [m³]."""
        return self.count * self.voxel_size**3

    @cached_property
    def part_counts(self) -> dict[int, int]:
        """Number of cells of each part that has any.

        Examples
        --------
        >>> Voxels.from_array([[[1, 7, 7]]], voxel_size=0.01).part_counts
        {1: 1, 7: 2}
        """
        counts = self._grid.part_counts()
        return {part: n for part, n in enumerate(counts) if n and part}

    @cached_property
    def center_of_mass(self) -> Triple:
        """Center of mass of the filled cells for equal densities [m]."""
        center = self._grid.center_of_mass()
        if center is None:
            raise self._is_empty("center_of_mass")
        return center

    @cached_property
    def bounds(self) -> NDArray[np.float64]:
        """Lower and upper corner of the box around the filled cells [m], shape (2, 3)."""
        content = self._grid.content()
        if content is None:
            raise self._is_empty("bounds")
        return np.asarray(self.origin) + self.voxel_size * np.asarray(content)

    def _is_empty(self, place: str) -> VoxelError:
        return VoxelError(place, "the grid has no filled cell", "fill some cells first")

    def with_cell(self, cell: Sequence[int], part: int = 1) -> Voxels:
        """Return a grid with one cell given to a part, or emptied with ``part=0``.

        Raises
        ------
        VoxelError
            If the cell lies outside the grid.

        Examples
        --------
        >>> Voxels.empty((2, 2, 2), voxel_size=0.01).with_cell((0, 1, 1), part=3).count
        1
        """
        i, j, k = (int(n) for n in triple("cell", cell))
        if not all(0 <= index < n for index, n in zip((i, j, k), self.shape, strict=True)):
            raise VoxelError("cell", f"{(i, j, k)} lies outside the grid of {self.shape} cells")
        return Voxels(self._grid.with_cell((i, j, k), part_id(part)))

    def fill_box(
        self, lower: Sequence[float | str], upper: Sequence[float | str], part: int = 1
    ) -> Voxels:
        """Return a grid with the cells of a box given to a part, or emptied with ``part=0``.

        A cell belongs to a fill if its center lies strictly inside; cells outside the grid are left
        out.

        Parameters
        ----------
        lower, upper : three floats
            Opposite corners [m].
        part : int, default 1
            The part, 0 to 255.

        Examples
        --------
        >>> grid = Voxels.empty((4, 4, 4), voxel_size=0.01)
        >>> grid.fill_box((0, 0, 0), (0.04, 0.02, 0.01)).count
        8
        """
        corners = np.sort([point("lower", lower), point("upper", upper)], axis=0)
        low, high = (triple("box", corner) for corner in corners)
        return Voxels(self._grid.fill_box(low, high, part_id(part)))

    def fill_sphere(
        self, center: Sequence[float | str], radius: float | str, part: int = 1
    ) -> Voxels:
        """Return a grid with the cells of a sphere given to a part, or emptied with ``part=0``.

        Examples
        --------
        >>> grid = Voxels.empty((7, 7, 7), voxel_size=0.01)
        >>> grid.fill_sphere((0.035, 0.035, 0.035), radius=0.02).count
        27
        """
        place = point("center", center)
        return Voxels(
            self._grid.fill_sphere(place, positive_length("radius", radius), part_id(part))
        )

    def fill_cylinder(
        self,
        base: Sequence[float | str],
        radius: float | str,
        height: float | str,
        axis: Axis = "z",
        part: int = 1,
    ) -> Voxels:
        """Return a grid with the cells of a cylinder given to a part, or emptied with ``part=0``.

        Parameters
        ----------
        base : three floats
            Center of the end it starts from [m].
        radius, height : float
            Dimensions of the cylinder [m].
        axis : {"x", "y", "z"} or three floats, default "z"
            Direction from the base to the other end; any length.
        part : int, default 1
            The part, 0 to 255.

        Examples
        --------
        >>> grid = Voxels.empty((10, 4, 4), voxel_size=0.01)
        >>> grid.fill_cylinder((0, 0.02, 0.02), radius=0.02, height=0.1, axis="x").count
        120
        """
        return self._fill_tube(base, radius, 0.0, height, axis, part)

    def fill_tube(
        self,
        base: Sequence[float | str],
        outer_radius: float | str,
        inner_radius: float | str,
        height: float | str,
        axis: Axis = "z",
        part: int = 1,
    ) -> Voxels:
        """Return a grid with the cells between two coaxial cylinders given to a part.

        Parameters are those of :meth:`fill_cylinder`; ``inner_radius`` is the radius of the bore
        [m].

        Examples
        --------
        >>> grid = Voxels.empty((10, 4, 4), voxel_size=0.01)
        >>> grid.fill_tube((0, 0.02, 0.02), 0.02, 0.01, height=0.1, axis="x").count
        80
        """
        inner = positive_length("inner_radius", inner_radius)
        outer = length("outer_radius", outer_radius)
        if not inner < outer:
            what = f"{inner:g} m is not less than outer_radius = {outer:g} m"
            raise VoxelError("inner_radius", what)
        return self._fill_tube(base, outer_radius, inner, height, axis, part)

    def _fill_tube(
        self,
        base: Sequence[float | str],
        outer: float | str,
        inner: float,
        height: float | str | str,
        axis: Axis,
        part: int,
    ) -> Voxels:
        place, along = point("base", base), axis_vector(axis)
        radius, high = positive_length("radius", outer), positive_length("height", height)
        return Voxels(self._grid.fill_tube(place, along, radius, inner, high, part_id(part)))

    def fill_random(self, density: float, seed: int, part: int = 1) -> Voxels:
        """Return a grid where each cell was given to a part with a probability.

        Parameters
        ----------
        density : float
            Probability, 0 to 1. Other cells keep their part.
        seed : int
            Seed, 0 to 2**64 - 1; the same seed gives the same cells.
        part : int, default 1
            The part, 0 to 255.

        Examples
        --------
        >>> grid = Voxels.empty((10, 10, 10), voxel_size=0.01)
        >>> grid.fill_random(0.5, seed=1) == grid.fill_random(0.5, seed=1)
        True
        """
        if not 0.0 <= density <= 1.0:
            raise VoxelError("density", f"{density} is not a probability from 0 to 1")
        if not 0 <= seed < 2**64:
            raise VoxelError("seed", f"{seed} is not a whole number from 0 to 2**64 - 1")
        return Voxels(self._grid.fill_random(float(density), int(seed), part_id(part)))

    def __or__(self, other: Voxels) -> Voxels:
        """Cells of either grid, in a box that holds both; where both are filled, the first wins."""
        return Voxels(self._grid.union(other._grid, memory_limit()))

    def __and__(self, other: Voxels) -> Voxels:
        """Cells of the first grid that are filled in the second too."""
        return Voxels(self._grid.intersection(other._grid))

    def __sub__(self, other: Voxels) -> Voxels:
        """Cells of the first grid that are empty in the second."""
        return Voxels(self._grid.difference(other._grid))

    def flip(self, axis: Literal["x", "y", "z"]) -> Voxels:
        """Return the mirror image of the cells inside the same box.

        Examples
        --------
        >>> Voxels.from_array([[[1, 2, 3]]], voxel_size=0.01).flip("z").array.tolist()
        [[[3, 2, 1]]]
        """
        if axis not in ("x", "y", "z"):
            raise VoxelError("axis", f"got {axis!r}; allowed are 'x', 'y' and 'z'")
        return Voxels(self._grid.flipped("xyz".index(axis)))

    def shift(self, cells: Sequence[int]) -> Voxels:
        """Return the grid moved in space by whole cells along x, y and z.

        Examples
        --------
        >>> Voxels.empty((2, 2, 2), voxel_size=0.5).shift((1, 0, -2)).origin
        (0.5, 0.0, -1.0)
        """
        steps = [whole("shift", n, -(2**30), 2**30) for n in triple("shift", cells)]
        return Voxels(self._grid.shifted((steps[0], steps[1], steps[2])))

    def pad(self, before: int | Sequence[int], after: int | Sequence[int] | None = None) -> Voxels:
        """Return the grid with empty cells around it; the filled ones stay in place.

        Parameters
        ----------
        before : int or three ints
            Cells to add at the lower side of each axis.
        after : int or three ints, optional
            Cells to add at the upper side; by default as many as ``before``.

        Examples
        --------
        >>> Voxels.empty((2, 2, 2), voxel_size=0.5).pad(1, after=(0, 0, 3)).shape
        (3, 3, 6)
        """
        low, high = (
            margins("before", before),
            margins("after", before if after is None else after),
        )
        return Voxels(self._grid.padded(low, high, memory_limit()))

    def crop(self) -> Voxels:
        """Return the smallest grid that holds all filled cells; they stay in place.

        Raises
        ------
        VoxelError
            If no cell is filled.

        Examples
        --------
        >>> Voxels.from_array([[[0, 1, 0]]], voxel_size=0.5).crop().shape
        (1, 1, 1)
        """
        return Voxels(self._grid.cropped())

    def refine(self, times: int) -> Voxels:
        """Return the same body with every cell cut into ``times`` cells along each axis.

        Raises
        ------
        VoxelError
            If ``times`` is not a whole number from 1, or the grid would not fit in memory.

        Examples
        --------
        >>> fine = Voxels.from_array([[[1, 0]]], voxel_size=0.01).refine(2)
        >>> fine.shape, fine.voxel_size, fine.count
        ((2, 2, 4), 0.005, 8)
        """
        if times < 1 or times != int(times):
            raise VoxelError("times", f"{times} is not a whole number from 1", "use 2 or 3")
        needed = self.array.size * int(times) ** 3
        if needed > memory_limit():
            raise VoxelError(
                "times", f"{times} would need {needed:.3g} bytes of memory", "use a smaller number"
            )
        cells = self.array
        for axis in range(3):
            cells = np.repeat(cells, times, axis=axis)
        return Voxels.from_array(cells, self.voxel_size / times, self.origin)

    def components(self, contact: Contact = "face") -> tuple[Component, ...]:
        """Return the connected components of the filled cells, largest first.

        Parameters
        ----------
        contact : {"face", "edge", "corner"}, default "face"
            Contact that connects cells. Cells that touch only at an edge or a corner make a hinge,
            not a solid joint.

        Examples
        --------
        >>> diagonal = Voxels.from_array([[[1, 0], [0, 1]]], voxel_size=0.01)
        >>> len(diagonal.components()), len(diagonal.components("edge"))
        (2, 1)
        """
        if contact not in _CONTACTS:
            raise VoxelError("contact", f"got {contact!r}; allowed are {', '.join(_CONTACTS)}")
        components = self._grid.components(_CONTACTS[contact])
        return tuple(Component(*self._region(*component)) for component in components)

    @cached_property
    def cavities(self) -> tuple[Cavity, ...]:
        """Enclosed empty regions, largest first.

        A region is enclosed if no path of empty cells through faces leads out of the grid.

        Examples
        --------
        >>> block = Voxels.empty((3, 3, 3), voxel_size=0.01).fill_box((0, 0, 0), (1, 1, 1))
        >>> [cavity.cells.tolist() for cavity in block.with_cell((1, 1, 1), part=0).cavities]
        [[[1, 1, 1]]]
        """
        return tuple(
            Cavity(*self._region(*component), area=area)
            for component, _, area in self._grid.cavities()
        )

    @cached_property
    def leaks(self) -> tuple[Leak, ...]:
        """Chambers that are open to the outside by openings of one or two cells, largest first.

        A chamber is found if a cube of two cells a side (three for openings of two cells) fits
        into it but cannot get out by steps of one cell. So a chamber must be wider than its
        openings, and a chamber with an opening of three cells or more counts as outside. Cells that
        touch at an edge or a corner let no air through.

        Examples
        --------
        >>> block = Voxels.empty((6, 6, 6), voxel_size=0.01).fill_box((0, 0, 0), (1, 1, 1))
        >>> chamber = block.fill_box((0.02, 0.02, 0.02), (0.04, 0.04, 0.04), part=0)
        >>> chamber.leaks
        ()
        >>> bored = chamber.fill_box((0, 0.02, 0.02), (0.02, 0.03, 0.03), part=0)
        >>> [leak.openings for leak in bored.leaks]
        [((1, 2, 2),)]
        """
        return tuple(
            Leak(*self._region(*component), width=width, openings=tuple(openings))
            for component, width, openings in self._grid.leaks(_WIDEST_LEAK)
        )

    @cached_property
    def hinges(self) -> tuple[Hinge, ...]:
        """Places where cells touch only along an edge or at a corner.

        Examples
        --------
        >>> Voxels.from_array([[[1, 0], [0, 1]]], voxel_size=0.01).hinges
        (Hinge(cells=((0, 0, 0), (0, 1, 1)), contact='edge'),)
        """
        found = []
        for i, j, k, p, q, r in self._grid.hinges().tolist():
            is_corner = i != p and j != q and k != r
            found.append(Hinge(((i, j, k), (p, q, r)), "corner" if is_corner else "edge"))
        return tuple(found)

    @cached_property
    def wall_thickness(self) -> WallThickness:
        """Thickness of the material at each cell, in voxels.

        Examples
        --------
        >>> beam = Voxels.empty((20, 3, 2), voxel_size=0.01).fill_box((0, 0, 0), (1, 1, 1))
        >>> beam.wall_thickness.thinnest
        Wall(thickness=2, cell=(0, 0, 0))
        """
        cells, histogram, thinnest = self._grid.wall_thickness()
        cells.setflags(write=False)
        place = None if thinnest is None else Wall(*thinnest)
        return WallThickness(cells, tuple(histogram), place)

    @cached_property
    def cavity_walls(self) -> tuple[Wall, ...]:
        """Thinnest wall around each cavity, in the order of :attr:`cavities`.

        A wall is a row of filled cells along an axis that has this cavity at one end, and the
        outside or another cavity at the other.

        Examples
        --------
        >>> block = Voxels.empty((5, 6, 7), voxel_size=0.01).fill_box((0, 0, 0), (1, 1, 1))
        >>> block.with_cell((2, 3, 3), part=0).cavity_walls
        (Wall(thickness=2, cell=(1, 3, 3)),)
        """
        return tuple(Wall(*wall) for wall in self._grid.cavity_walls())

    def _region(
        self, runs: NDArray[np.uint32], count: int
    ) -> tuple[NDArray[np.int32], int, float, NDArray[np.float64]]:
        return region_fields(runs, count, self.voxel_size, np.asarray(self.origin))

    def mesh(self) -> Mesh:
        """Return the conforming mesh of the filled cells, five tetrahedra each.

        Cells that touch share their vertices there, also where they touch only at an edge or a
        corner. ``mesh.cavities`` come in the order of :attr:`cavities`.

        Raises
        ------
        MeshError
            If no cell is filled, or the mesh does not fit in the available memory (raised
            before it is allocated).

        Examples
        --------
        >>> mesh = Voxels.from_array([[[1, 1]]], voxel_size=0.01).mesh()
        >>> mesh.vertices.shape, mesh.tets.shape
        ((12, 3), (10, 4))
        """
        return Mesh.from_voxel_grid(self._grid)
