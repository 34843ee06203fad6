"""Voxels that the surface cuts: each carries the part of it that is filled."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Self

import numpy as np
from numpy.typing import NDArray

from voxsoft.design.discretization.cut_cells import (
    SIDES,
    WHOLE,
    Cubes,
    CutCells,
    Floats,
    Ints,
    beside,
    cut_cells,
    measures_of,
)
from voxsoft.design.discretization.cut_surfaces import obliquity, surfaces
from voxsoft.design.discretization.narrow_rooms import with_narrow_rooms
from voxsoft.design.discretization.rooms import ROOM_TETS
from voxsoft.design.discretization.voids import Film, Spread, Void, Zones, voids
from voxsoft.design.model import Design
from voxsoft.errors import DesignError, ShapeError
from voxsoft.mesh import Mesh
from voxsoft.shapes.base import Triple
from voxsoft.voxels import Voxels

#: A cell less full than this gives its material to its neighbors: a sliver would bound the load
#: and the conditioning by its own strength. It lies between a fifth and a quarter, which round
#: measures give and which should not stand at an edge.
LEAST_FILLED = 0.22

#: Measurement error of a part with a sharp edge in it.
_ALIKE = 0.02


@dataclass(frozen=True, eq=False)
class _Topology:
    """Part that stays while fractions vary: the cells that are voxels, and receivers of the rest.

    `places` are the cells near the surface on the grid at `phase`, (k, 3). `voxel` is the number
    of each as a voxel, -1 for the others; `whole` is the number of voxels. `donors`, `receivers`
    are pairs of such a cell and a neighboring one that takes its material. `beside` are the cells
    of voxels of the own part below and above each along the axes, (k, 3, 2), -1 for none.
    `zones` are the cavities that their empty parts belong to.
    """

    size: float
    phase: Triple
    whole: int
    places: Ints = field(repr=False)
    voxel: Ints = field(repr=False)
    donors: Ints = field(repr=False)
    receivers: Ints = field(repr=False)
    beside: Ints = field(repr=False)
    zones: Zones = field(repr=False)


@dataclass(frozen=True, eq=False)
class CutVoxels:
    """Voxels of a design with ``fill = "fraction"``.

    Attributes
    ----------
    voxels
        The cells that count: at least :data:`LEAST_FILLED` full.
    fractions
        The material of each, counted in C order, (n,), in volumes of a cell. It may exceed 1:
        a cell less full gives its material to the voxels at its faces.
    moments
        Position of the material of each voxel, (n, 9): see :attr:`voxsoft.Mesh.moments`. Material
        that a neighbor gave lies outside the voxel, and counts there.
    surfaces
        Surface in each voxel, (n, 9): see :attr:`voxsoft.Mesh.surfaces`.
    voids
        For each cavity the voxels (their numbers, and parts of the tetrahedra of
        :data:`~voxsoft.design.discretization.rooms.ROOM_TETS`) by which it is larger than the
        empty cells it is made of.
    lost
        Volume [m³] of material in walls too thin to hold a voxel.
    """

    voxels: Voxels
    fractions: Floats = field(repr=False)
    moments: Floats = field(repr=False)
    surfaces: Floats = field(repr=False)
    voids: tuple[Void, ...] = field(repr=False)
    lost: float
    _topology: _Topology = field(repr=False)

    @classmethod
    def of(cls, design: Design, refine: int = 1) -> Self:
        """Find the voxels of a design and how full they are.

        Parameters
        ----------
        design
            The design.
        refine
            Cells along the edge of one of the design's own.

        Raises
        ------
        ShapeError
            No cell is full enough, a shape has no end, or the grid would not fit in memory.

        Examples
        --------
        >>> from voxsoft.design import families
        >>> ball = CutVoxels.of(families.sphere())
        >>> ball.voxels.count == len(ball.fractions)
        True
        """
        cells = cut_cells(design, design.voxel_size / refine)
        active = with_narrow_rooms(cells, _without_braces(cells.filled))
        if not active.any():
            raise ShapeError(
                "parts",
                f"no cell is {LEAST_FILLED:.0%} full: every wall is much thinner than a voxel",
                "use a smaller voxel_size, or check the sizes of the shapes",
            )
        numbers = np.where(active, cells.part + 1, 0).astype(np.uint8)
        voxels = Voxels.from_array(numbers, cells.size, cells.origin)
        topology = _topology(cells, active, voxels)
        return cls(voxels, *_spread(design, topology, cells.cubes), topology)

    def resampled(self, design: Design) -> Self:
        """Return the same voxels with the fractions of another design: its parameters changed.

        The set of voxels is kept, and so is the receiver of each cell's material. So fractions and
        voids depend continuously on the parameters: differences of them are the derivative of a
        shape.

        Parameters
        ----------
        design
            A design with slightly other parameters; its surface must stay in the cells near
            the surface of this one.

        Raises
        ------
        DesignError
            It has another voxel size.

        Examples
        --------
        >>> from voxsoft.design import families
        >>> beam = families.beam()
        >>> cut = CutVoxels.of(beam)
        >>> longer = cut.resampled(beam.with_parameters(length=0.101))
        >>> round(float((longer.fractions - cut.fractions).sum()), 1)  # 1 mm of 5 mm, 4 cells
        0.8
        """
        times = design.voxel_size / self.voxels.voxel_size
        if abs(times - round(times)) > 1e-9:
            what = "differs: the voxels of the first design cannot hold the second"
            raise DesignError("voxel_size", what, "keep it, and vary other parameters")
        return type(self)(self.voxels, *_spread(design, self._topology), self._topology)

    def voids_of(
        self, design: Design, cavities: Sequence[Ints], films: Sequence[Film]
    ) -> tuple[Void, ...]:
        """Return the voids of other cavities than those of the voxels alone.

        Parameters
        ----------
        design
            The design of the voxels, or one with slightly other parameters, as for
            :meth:`resampled`.
        cavities
            The empty cells of each cavity, (c, 3), in the array of the voxels.
        films
            Planes of layers that close them.
        """
        t = self._topology
        low = np.rint((np.asarray(self.voxels.origin) - np.asarray(t.phase)) / t.size)
        near = t.places - low.astype(np.intp)
        zones = Zones.of(self.voxels.array > 0, cavities, near, t.voxel, films)
        return voids(design, _material(design, t)[0], zones)

    def mesh(self) -> Mesh:
        """Return the mesh: five tetrahedra for each voxel, with fractions and voids."""
        mesh = self.voxels.mesh().with_fractions(self.fractions, self.moments, self.surfaces)
        return mesh.with_voids(ROOM_TETS, self.voids)


def fractions_of(design: Design, cells: CutVoxels) -> Floats:
    """Return the fractions of given voxels for a design with other parameters, (n,).

    See :meth:`CutVoxels.resampled`, which gives the voids of the cavities as well.
    """
    return cells.resampled(design).fractions


def _without_braces(filled: Floats) -> NDArray[np.bool_]:
    """Return the cells that are full enough, except inner edges between slivers.

    Slivers of the parts p and q, which are given away, fill 1 - (1 - p)(1 - q) of the cell in
    which they meet, and three of them a corner likewise. That may exceed the least part, and the
    cell would brace the edge as a voxel. It is given away too: edges first, corners after them.
    """
    active = filled >= LEAST_FILLED
    for _ in range(2):
        alone, void = np.zeros(filled.shape, dtype=int), np.ones(filled.shape)
        for axis in range(3):
            low, high = beside(active, axis)
            one = low != high
            part_low, part_high = beside(filled, axis)
            alone += one
            void *= np.where(one, 1.0 - np.where(low, part_high, part_low), 1.0)
        active &= ~((alone >= 2) & (filled <= 1.0 - void + _ALIKE))
    return active


def _topology(cells: CutCells, active: NDArray[np.bool_], voxels: Voxels) -> _Topology:
    count = np.cumsum(active).reshape(active.shape) - 1
    near = cells.near
    at = tuple(near.T)
    voxel = np.where(active[at], count[at], -1)
    donors, receivers = _gifts(cells, active, voxel)
    cavities = [cavity.cells for cavity in voxels.cavities]
    return _Topology(
        size=cells.size,
        phase=cells.phase,
        whole=voxels.count,
        places=near + cells.low,
        voxel=voxel,
        donors=donors,
        receivers=receivers,
        beside=_own_neighbors(cells, active, voxel),
        zones=Zones.of(active, cavities, near, voxel),
    )


def _gifts(cells: CutCells, active: NDArray[np.bool_], voxel: Ints) -> tuple[Ints, Ints]:
    """Pairs (donor, receiver) of cells near the surface, by their numbers in ``cells.near``.

    Receivers are the voxels at the donor's faces, of its own part if there are such; else those
    at its edges and corners.
    """
    number = np.full(active.shape, -1)
    number[tuple(cells.near.T)] = np.arange(len(cells.near))
    number = np.pad(np.where(active, number, -1), 1, constant_values=-1)
    parts = np.pad(cells.part, 1)
    giving = np.flatnonzero(voxel < 0)
    at = cells.near[giving] + 1
    filled, own = cells.filled[tuple((at - 1).T)], cells.part[tuple((at - 1).T)]
    neighbors = at[:, None, :] + _AROUND
    found = number[tuple(np.moveaxis(neighbors, -1, 0))]
    same = parts[tuple(np.moveaxis(neighbors, -1, 0))] == own[:, None]
    face = (np.abs(_AROUND).sum(axis=1) == 1) & (found >= 0)
    alike = face & same & (filled > 0.0)[:, None]
    best = np.where(alike.any(axis=1)[:, None], alike, face)
    best = np.where(best.any(axis=1)[:, None], best, found >= 0)
    row, column = np.nonzero(best)
    return giving[row], found[row, column]


def _own_neighbors(cells: CutCells, active: NDArray[np.bool_], voxel: Ints) -> Ints:
    """Return voxels of the own part at the faces of each cell near the surface, (k, 3, 2)."""
    numbers = np.full(active.shape, -1)
    numbers[tuple(cells.near.T)] = np.where(voxel >= 0, np.arange(len(voxel)), -1)
    numbers, parts = np.pad(numbers, 1, constant_values=-1), np.pad(cells.part, 1)
    at = cells.near[:, None, None, :] + 1 + SIDES
    places = tuple(np.moveaxis(at, -1, 0))
    own = parts[tuple((cells.near + 1).T)]
    return np.where(parts[places] == own[:, None, None], numbers[places], -1)


def _spread(
    design: Design, t: _Topology, cubes: Cubes | None = None
) -> tuple[Floats, Floats, Floats, tuple[Void, ...], float]:
    """Fractions, moments, surfaces of the voxels, voids of the cavities, lost volume [m³].

    `cubes` are those of the cells near the surface, where they are known.
    """
    spread, around, lost = _material(design, t, cubes)
    own = t.voxel >= 0
    held = np.tile(WHOLE, (t.whole, 1))
    held[t.voxel[own]] = spread.measures[own]
    np.add.at(held, spread.takers, spread.given)
    np.subtract.at(held, t.voxel[spread.givers], spread.moved)
    np.add.at(held, spread.levered, spread.moved_to)
    fractions = held[:, 0]
    center = held[:, 1:4] / fractions[:, None]
    variance = held[:, 4:7] / fractions[:, None] - center**2
    products = held[:, 7:] / fractions[:, None]
    moments = np.hstack([center, np.sqrt(3.0 * variance), products])
    return fractions, moments, surfaces(around), voids(design, spread, t.zones, cubes), lost


def _material(
    design: Design, t: _Topology, cubes: Cubes | None = None
) -> tuple[Spread, Floats, float]:
    """Material near the surface, sums over the surface in each voxel, lost volume [m³]."""
    own = t.voxel >= 0
    measures, around = measures_of(design, t.places, t.size, t.phase, t.beside, own, cubes)
    filled = measures[:, 0]
    sums = np.zeros((t.whole, around.shape[1]))
    sums[t.voxel[own]] = around[own]
    # Each donor's material goes to its receivers in proportion to how full they are.
    weights = filled[t.receivers]
    totals = np.bincount(t.donors, weights, len(filled))
    shares = weights / np.maximum(totals[t.donors], 1e-300)
    takers = t.voxel[t.receivers]
    away = (2 * (t.places[t.donors] - t.places[t.receivers])).astype(np.float64)
    np.add.at(sums, takers, around[t.donors] * shares[:, None])
    given = np.bincount(t.donors, filled[t.donors] * shares, len(filled))
    lost = float((filled - given)[~own].sum()) * t.size**3
    givers, behind, levers = _levers(t, measures, around)
    inward = (2 * (t.places[givers] - t.places[behind])).astype(np.float64)
    spread = Spread(
        places=t.places,
        size=t.size,
        phase=t.phase,
        voxel=t.voxel,
        whole=t.whole,
        measures=measures,
        donors=t.donors,
        takers=takers,
        given=_shifted(measures[t.donors], away) * shares[:, None],
        givers=givers,
        levered=t.voxel[behind],
        moved=measures[givers] * levers[:, None],
        moved_to=_shifted(measures[givers], inward) * levers[:, None],
    )
    return spread, sums, lost


def _levers(t: _Topology, measures: Floats, around: Floats) -> tuple[Ints, Ints, Floats]:
    """Return cells, voxels behind them, and shares to move there for the right lever in bending.

    The trilinear motion of a voxel has no squares of a coordinate. Where the surface with the
    normal n is oblique, bending about it varies within a voxel by such squares: at the center of
    the material, δ along n from that of the cell, 2 Σ tₐ² nₐ² of κ δ are missing in the strain
    along t, in a plane of two axes sin² 2θ. A share |δₐ|/h of the material that is counted in the
    next voxel inward along the axis a, at the place where it is, makes up for it; that share is
    moved times the part that is missing. A cell keeps :data:`LEAST_FILLED`. Cells between two
    empty regions keep all.
    """
    cells = np.flatnonzero((t.voxel >= 0) & (measures[:, 0] < 1.0) & (t.zones.region != -2))
    filled = measures[cells, 0]
    shift = measures[cells, 1:4] / filled[:, None] / 2.0
    side = (shift > 0.0).astype(np.intp)
    behind = np.take_along_axis(t.beside[cells], side[:, :, None], axis=2)[:, :, 0]
    shares = np.abs(shift) * obliquity(around[cells]) * (behind >= 0)
    most = np.maximum(0.0, 1.0 - LEAST_FILLED / filled)
    shares *= np.minimum(1.0, most / np.maximum(shares.sum(axis=1), 1e-300))[:, None]
    row, axis = np.nonzero(shares)
    return cells[row], behind[row, axis], shares[row, axis]


def _shifted(measures: Floats, by: Floats) -> Floats:
    """The measures of material counted from a point that lies `by` the other way."""
    filled = measures[:, :1]
    first = measures[:, 1:4] + by * filled
    second = measures[:, 4:7] + 2.0 * by * measures[:, 1:4] + by**2 * filled
    one, other = [1, 2, 0], [2, 0, 1]
    product = measures[:, 7:] + by[:, one] * by[:, other] * filled
    product += by[:, one] * measures[:, 1:4][:, other] + by[:, other] * measures[:, 1:4][:, one]
    return np.hstack([filled, first, second, product])


def _offsets(reach: int) -> Ints:
    steps = np.arange(-reach, reach + 1)
    return np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3)


_AROUND = _offsets(1)
