"""Voids: the empty part of cut voxels that belongs to a cavity.

A cavity is made of empty cells. A small cube's room in a cut voxel belongs to the nearest of them
within reach, or to the outside. Across the plane of a layer that closes openings nothing is in
reach, and where the layer lies beside the faces of voxels that stand for it, the cavity ends at the
layer.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design.discretization.cut_cells import WHOLE, Cubes, Floats, Ints, filled_parts
from voxsoft.design.discretization.rooms import room_parts
from voxsoft.design.model import Design
from voxsoft.shapes.base import Triple
from voxsoft.shapes.fractions import SUBCELLS

Marks = NDArray[np.bool_]

#: Voxels, and parts of the tetrahedra of a room in each.
Void = tuple[Ints, Floats]

#: Label of the voxels in a grid of regions; -1 is the outside, and cavities count from 0.
VOXEL = -2


@dataclass(frozen=True, eq=False)
class Film:
    """A plane of faces between cells that a layer covers.

    Attributes
    ----------
    axis, level
        The axis across it, and the index of the cells above it.
    covered, openings
        The faces that it is bonded to or spans, and those that it spans, over the other two axes.
    gap
        Distance of the layer from these faces along the axis, in cells.
    """

    axis: int
    level: int
    covered: Marks = field(repr=False)
    openings: Marks = field(repr=False)
    gap: float

    def hides(self, cells: Ints, seen: Ints) -> Marks:
        """Mark the cells (k, w, 3) that it hides from other cells (k, 3), (k, w)."""
        across = (cells[:, None, self.axis] < self.level) != (seen[..., self.axis] < self.level)
        hidden: Marks = across & (self._covers(cells)[:, None] | self._covers(seen))
        return hidden

    def beyond(self, cells: Ints) -> Floats:
        """Return the share of each small cube of some cells that is beyond the layer, (k, n³)."""
        found = np.zeros((len(cells), SUBCELLS, SUBCELLS, SUBCELLS))
        if self.gap == 0.0:
            return found.reshape(len(cells), -1)
        shares = np.clip(abs(self.gap) * SUBCELLS - np.arange(SUBCELLS), 0.0, 1.0)
        shape = [SUBCELLS if axis == self.axis else 1 for axis in range(3)]
        within = (cells[:, self.axis] == self.layer_of_gap) & self._covers(cells)
        found[within] = (shares if self.gap > 0.0 else shares[::-1]).reshape(shape)
        return found.reshape(len(cells), -1)

    @property
    def layer_of_gap(self) -> int:
        """Index of the cells that the layer passes through."""
        return self.level if self.gap > 0.0 else self.level - 1

    def _covers(self, cells: Ints) -> Marks:
        at = np.delete(cells, self.axis, axis=-1)
        inside: Marks = np.all((at >= 0) & (at < self.covered.shape), axis=-1)
        at = np.where(np.expand_dims(inside, -1), at, 0)
        found: Marks = self.covered[at[..., 0], at[..., 1]] & inside
        return found


@dataclass(frozen=True, eq=False)
class Zones:
    """Regions of empty cells that the empty parts of cells near the surface belong to.

    Attributes
    ----------
    region
        For each cell the cavity (from 0) around it or that its void belongs to, -1 for none, and
        -2 where `zones`, by small cube, (z, n³), tell: those of the cells `torn`, (z,).
    torn, zones
        See there.
    beyond
        The share of each small cube of the torn cells that is beyond a film, (z, n³).
    count
        Number of cavities.
    slabs
        Empty cells of cavities between a film and the faces that stand for it.
    """

    region: Ints = field(repr=False)
    torn: Ints = field(repr=False)
    zones: NDArray[np.int16] = field(repr=False)
    beyond: NDArray[np.float32] = field(repr=False)
    count: int
    slabs: tuple[_Slab, ...] = field(repr=False)

    @classmethod
    def of(
        cls,
        active: Marks,
        cavities: Sequence[NDArray[np.integer]],
        near: Ints,
        voxel: Ints,
        films: Sequence[Film] = (),
    ) -> Zones:
        """Find the regions.

        Parameters
        ----------
        active
            The cells that are voxels.
        cavities
            The cells of each cavity, (c, 3).
        near, voxel
            Cells near the surface, (k, 3), and their numbers as voxels, -1 for the others.
        films
            Planes that layers cover.
        """
        labels = np.where(active, VOXEL, -1).astype(np.int16)
        for index, cells in enumerate(cavities):
            labels[tuple(cells.T)] = index
        padded = np.pad(labels, _core.REACH, constant_values=-1)
        region = labels[tuple(near.T)].astype(np.intp)
        torn, zones = [np.zeros(0, dtype=np.intp)], [np.zeros((0, SUBCELLS**3), dtype=np.int16)]
        beyond = [np.zeros((0, SUBCELLS**3), dtype=np.float32)]
        inner = np.flatnonzero(voxel >= 0)
        for start in range(0, len(inner), 512):
            chunk = inner[start : start + 512]
            window = near[chunk][:, None, :] + _WINDOW
            seen = padded[tuple(np.moveaxis(window + _core.REACH, -1, 0))]
            over = np.zeros((len(chunk), SUBCELLS**3), dtype=np.float32)
            for film in films:
                seen[film.hides(near[chunk], window)] = VOXEL
                over = np.maximum(over, film.beyond(near[chunk]).astype(np.float32))
            first = seen.max(axis=1)
            last = np.where(seen == VOXEL, np.iinfo(np.int16).max, seen).min(axis=1)
            is_torn = (first != VOXEL) & ((first != last) | over.any(axis=1))
            region[chunk] = np.where(first == VOXEL, -1, np.where(is_torn, -2, first))
            torn.append(chunk[is_torn])
            zones.append(_core.nearest_regions(seen[is_torn]))
            beyond.append(over[is_torn])
        slabs = tuple(_slabs(labels, len(cavities), films))
        return cls(
            region,
            np.concatenate(torn),
            np.concatenate(zones),
            np.concatenate(beyond),
            len(cavities),
            slabs,
        )


@dataclass(frozen=True, eq=False)
class _Slab:
    """A layer of cells of a cavity beside a film that lies beside the faces that stand for it.

    Attributes
    ----------
    cavity
        The cavity.
    cells
        Number of its cells at the openings that the film spans.
    depth
        Distance that the cavity reaches beyond these faces, in cells; negative: short of them.
    beside
        Numbers of voxels in the layer.
    rim
        Numbers of voxels around the openings, whose motion the slab takes part in.
    """

    cavity: int
    cells: int
    depth: float
    beside: Ints
    rim: Ints


def _slabs(labels: NDArray[np.int16], count: int, films: Sequence[Film]) -> Iterator[_Slab]:
    numbers = np.cumsum(labels == VOXEL).reshape(labels.shape) - 1
    for film in films:
        if film.gap == 0.0:
            continue
        within = range(labels.shape[film.axis])
        sides = [side for side in (film.level, film.level - 1) if side in within]
        for side in sides:
            cells = labels.take(side, axis=film.axis)
            voxels = numbers.take(side, axis=film.axis)
            depth = -abs(film.gap) if side == film.layer_of_gap else abs(film.gap)
            for cavity in range(count):
                at = film.openings & (cells == cavity)
                if not at.any():
                    continue
                around = _grown(at)
                rim = [
                    numbers.take(each, axis=film.axis)[
                        around & (labels.take(each, axis=film.axis) == VOXEL)
                    ]
                    for each in sides
                ]
                beside = voxels[film.covered & (cells == VOXEL)]
                yield _Slab(cavity, int(at.sum()), depth, beside, np.concatenate(rim))


def _grown(marks: Marks) -> Marks:
    """Return some faces of a plane and their neighbors, also across corners."""
    padded = np.pad(marks, 1)
    across = padded[:-2] | padded[1:-1] | padded[2:]
    grown: Marks = across[:, :-2] | across[:, 1:-1] | across[:, 2:]
    return grown


@dataclass(frozen=True, eq=False)
class Spread:
    """Material of the cells near the surface, and its way to the voxels that hold it.

    Attributes
    ----------
    places, size, phase
        Cells near the surface on their grid, (k, 3), the edge of a cell and the grid's phase [m].
    voxel, whole
        Numbers of these cells as voxels, -1 for the others; the number of all voxels.
    measures
        Integrals over the material of each cell, see
        :func:`~voxsoft.design.discretization.cut_cells.measures_of`.
    donors, takers, given
        Cells that give their material away, the numbers of voxels that get it, and its measures
        there.
    givers, levered, moved, moved_to
        Cells that give a part away for the lever of oblique walls, the numbers of voxels that get
        it, and its measures in the cell and there.
    """

    places: Ints
    size: float
    phase: Triple
    voxel: Ints
    whole: int
    measures: Floats
    donors: Ints
    takers: Ints
    given: Floats
    givers: Ints
    levered: Ints
    moved: Floats
    moved_to: Floats


def voids(
    design: Design, spread: Spread, zones: Zones, cubes: Cubes | None = None
) -> tuple[Void, ...]:
    """Return the void of every cavity.

    Parameters
    ----------
    design
        The design that fills the cells.
    spread
        Its material.
    zones
        Regions of the empty parts of these cells.
    cubes
        Small cubes of these cells, where they are known.
    """
    own = spread.voxel >= 0
    torn = zones.torn
    if len(torn):
        if cubes is None:
            filled, normals, _ = filled_parts(
                design, spread.places[torn], spread.size, spread.phase
            )
        else:
            filled, normals = (each[torn] for each in cubes)
        room_torn = np.maximum(1.0 - filled - zones.beyond, 0.0)
        every = np.maximum((1.0 - filled).sum(axis=1), 1e-300)
    found = []
    for cavity in range(zones.count):
        room = np.zeros((spread.whole, len(WHOLE)))
        over = np.zeros_like(room)
        # Part of the void of each cell that is of the cavity.
        part = (zones.region == cavity).astype(np.float64)
        beside = own & (zones.region == cavity)
        room[spread.voxel[beside]] = WHOLE - spread.measures[beside]
        if len(torn):
            empty = np.where(zones.zones == cavity, room_torn, 0.0)
            room[spread.voxel[torn]] += _core.material_integrals(empty, -normals)
            part[torn] = empty.sum(axis=1) / every
        into = zones.region[spread.donors] == cavity
        np.add.at(over, spread.takers[into], spread.given[into])
        into = part[spread.givers] > 0.0
        share = part[spread.givers[into], None]
        np.add.at(room, spread.voxel[spread.givers[into]], spread.moved[into] * share)
        np.add.at(over, spread.levered[into], spread.moved_to[into] * share)
        slabs = [_parts_of_slab(slab, room, over) for slab in zones.slabs if slab.cavity == cavity]
        numbers = np.flatnonzero((room[:, 0] > 0.0) | (over[:, 0] > 0.0))
        # Material that a voxel holds of its neighbors lies outside it, and has a gradient there.
        parts = _parts(room[numbers]) - _parts(over[numbers])
        found.append(_sum(spread.whole, [(numbers, parts), *slabs]))
    return tuple(found)


def _parts_of_slab(slab: _Slab, room: Floats, over: Floats) -> Void:
    """Return a slab as rooms of the voxels around it, with their mean gradient."""
    cells = float(slab.cells)
    if slab.depth > 0.0:  # as wide as the layer of cells beside the film
        cells += float((room[slab.beside, 0] - over[slab.beside, 0]).sum())
    each = np.full(len(slab.rim), slab.depth * cells / max(len(slab.rim), 1))
    return slab.rim, room_parts(each, np.zeros((len(each), 6)))


def _sum(whole: int, pieces: Sequence[Void]) -> Void:
    if len(pieces) == 1:
        return pieces[0]
    total = np.zeros((whole, pieces[0][1].shape[1]))
    for numbers, parts in pieces:
        np.add.at(total, numbers, parts)
    numbers = np.unique(np.concatenate([numbers for numbers, _ in pieces]))
    return numbers, total[numbers]


def _parts(measures: Floats) -> Floats:
    volume = measures[:, 0]
    filled = np.where(volume > 0.0, volume, 1.0)[:, None]
    return room_parts(volume, measures[:, [1, 2, 3, 7, 8, 9]] / filled)


def _window() -> Ints:
    steps = np.arange(-_core.REACH, _core.REACH + 1)
    return np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3)


_WINDOW = _window()
