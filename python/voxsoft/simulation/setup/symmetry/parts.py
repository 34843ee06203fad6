"""Clamps, layers and loads of a symmetric body for its solved sector."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, NoReturn, TypeAlias

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core, _core_data
from voxsoft.design.symmetry import Symmetry
from voxsoft.errors import DesignError
from voxsoft.geometry import rotation_matrix
from voxsoft.simulation.compatibility import REASONS
from voxsoft.simulation.setup.contact import CoreHistory
from voxsoft.simulation.setup.symmetry.sector import Sector

Floats = NDArray[np.float64]
Indices = NDArray[np.uint32]

#: Tolerance of symmetric loads, as a part of the largest: sums in different orders.
_ROUNDING: Final = 1e-9

#: Parts of a motion at which it is compared with its image: a rotation is not linear in its angle.
_PARTS: Final = (1.0, 0.5)
#: The kind of a load and its history.
_Key: TypeAlias = tuple[str, tuple[tuple[float, ...], ...] | None]

_HINT: Final = "make it symmetric, or leave the plane of symmetry out"


def _key(history: CoreHistory) -> tuple[tuple[float, ...], ...] | None:
    return None if history is None else tuple(tuple(each) for each in history)


@dataclass(frozen=True)
class _Lone:
    """Sum of loads of one kind and history that have no image alone, on vertices."""

    where: str
    what: str
    values: Floats


@dataclass(frozen=True)
class _Clamp:
    """A clamp of the whole body."""

    where: str
    motion: dict[str, Any]

    def displaced(self, points: Floats, part: float) -> Floats:
        """Compute the displacement of points by a part of its motion, whatever its history."""
        found = np.zeros_like(points)
        if self.motion.get("angle"):
            arm = points - np.asarray(self.motion["center"])
            matrix = rotation_matrix(self.motion["axis"], part * self.motion["angle"])
            found = arm @ matrix.T - arm
        displacement = self.motion.get("displacement")
        return found if displacement is None else found + part * np.asarray(displacement)


class SectorParts:
    """Receiver of the parts of a whole body's problem that keeps those of the sector.

    Parameters
    ----------
    sector
        The sector of the body.
    spanning
        All triangles of the whole that span openings, (s, 3).

    Attributes
    ----------
    kept
        Parts of the problem for the core.
    where
        Place in the design of the next entry, for messages.
    """

    def __init__(self, sector: Sector, spanning: NDArray[np.int32]) -> None:
        self.kept = _core.ProblemParts()
        self.where = ""
        self._sector = sector
        self._spanning = spanning
        #: The clamp that decides on each axis of each vertex of the whole, -1 where none does.
        self._decides = np.full((len(sector.whole.vertices), 3), -1)
        self._clamps: list[_Clamp] = []
        self._lone: dict[_Key, _Lone] = {}

    def membrane(self, triangles: Indices, **sheet: float) -> None:
        """Take a layer."""
        sector = self._sector
        own, spanning = self._split(triangles)
        self._check_symmetric(np.ones((len(own), 1)), own, "the layer")
        for axis, on in zip(sector.axes, sector.on_planes.T, strict=True):
            if on[triangles].all(axis=1).any():
                self._refuse(f"lies in the plane of symmetry across {'xyz'[axis]}")
        self.kept.membrane(sector.restricted(own), **sheet)
        if len(spanning):
            of, signs, corners = sector.images_of(spanning)
            points = sector.whole.vertices[np.unique(spanning)] - sector.origin
            share = 1.0 / sector.count
            self.kept.mirrored_membrane((of, signs), points, corners, **sheet, share=share)

    def clamp(self, vertices: Indices, axes: list[bool], **motion: Any) -> None:  # noqa: ANN401 - as the core takes them
        """Take a clamp."""
        sector = self._sector
        self._decides[np.ix_(vertices, np.flatnonzero(axes))] = len(self._clamps)
        self._clamps.append(_Clamp(self.where, motion))
        if motion.get("angle"):
            motion = motion | {"center": (np.asarray(motion["center"]) - sector.origin).tolist()}
        mine = sector.numbers[vertices]
        self.kept.clamp(mine[mine >= 0].astype(np.uint32), axes, **motion)

    def hold_planes(self) -> None:
        """Hold vertices on the planes along the normals, where no clamp does."""
        held = self._decides[self._sector.vertices] >= 0
        for axis, on in zip(self._sector.axes, self._sector.on_planes.T, strict=True):
            free = on[self._sector.vertices] & ~held[:, axis]
            if free.any():
                found = np.flatnonzero(free).astype(np.uint32)
                self.kept.clamp(found, [axis == each for each in range(3)])

    def check(self) -> None:
        """Check entries that are symmetric only together: clamps, and loads with images.

        Raises
        ------
        DesignError
            The first entry that has no image.
        """
        self._check_clamps()
        for (_, history), lone in self._lone.items():
            found = self._asymmetry(lone.values)
            if found is not None:
                self.where = lone.where
                also = "" if history is None else " with its history"
                self._refuse(f"is not symmetric: {lone.what} has no image across {found}{also}")

    def _check_clamps(self) -> None:
        """Raise unless clamps hold the images of their vertices, with mirrored motions."""
        whole, decides = self._sector.whole, self._decides
        for plane, image in zip(self._sector.planes, self._sector.images, strict=True):
            self._check_held((decides >= 0) != (decides[image] >= 0), "what it holds", plane, image)
            histories = [clamp.motion.get("history") for clamp in self._clamps]
            keys = [histories.index(each) for each in histories]
            key = np.array([*keys, -1])
            self._check_held(key[decides] != key[decides[image]], "its history", plane, image)
            for part in _PARTS:
                moved = np.zeros_like(whole.vertices)
                for number, clamp in enumerate(self._clamps):
                    rows = (decides == number).any(axis=1)
                    away = clamp.displaced(whole.vertices[rows], part)
                    moved[rows] = np.where(decides[rows] == number, away, moved[rows])
                mirrored = moved[image]
                mirrored[:, plane.axis] *= -1.0
                off = np.abs(mirrored - moved)
                allowed = _ROUNDING * max(float(np.abs(moved).max(initial=0.0)), 1e-300)
                self._check_held(off > allowed, "its motion", plane, image)

    def _check_held(
        self, differs: NDArray[np.bool_], what: str, plane: Symmetry, image: NDArray[np.int64]
    ) -> None:
        if not differs.any():
            return
        vertex, axis = np.argwhere(differs)[0]
        number = self._decides[vertex, axis]
        if number < 0:
            number = self._decides[image[vertex], axis]
            vertex = image[vertex]
        self.where = self._clamps[number].where
        self._refuse(f"is not symmetric: {what} has no image across {self._at(vertex, plane)}")

    def gravity(self, acceleration: list[float], history: CoreHistory) -> None:
        """Take an acceleration of the whole body."""
        self._check_along_planes(np.asarray(acceleration), "its acceleration")
        self.kept.gravity(acceleration, history)

    def pressure(
        self,
        triangles: Indices,
        value: float,
        history: CoreHistory,
        voids: tuple[Indices, Floats] | None,
        closed: bool = False,
    ) -> None:
        """Take a pressure on triangles, of a cavity if they are `closed` in the whole body."""
        sector = self._sector
        own, spanning = self._split(triangles)
        self._add(("pressure", _key(history)), np.full((len(own), 1), value), own, "its pressure")
        within = None
        if voids is not None:
            tets, parts = voids
            inside = sector.inside(tets)
            within = sector.restricted(tets), parts[inside]
        self.kept.pressure(sector.restricted(own), value, history, within, closed=closed)
        if len(spanning):
            of, signs, corners = sector.images_of(spanning)
            self.kept.mirrored_pressure((of, signs), corners, value / sector.count, history)

    def _split(self, triangles: Indices) -> tuple[Indices, Indices]:
        """Separate triangles on faces of voxels from those that span openings.

        The triangulation of an opening need not be symmetric. Over symmetric states all its
        triangles together have as many times the energy of the sector as there are sectors.
        """
        if len(self._spanning) == 0:
            return triangles, triangles[:0]
        spans = np.isin(self._keys(triangles), self._keys(self._spanning))
        return triangles[~spans], triangles[spans]

    def _keys(self, triangles: NDArray[np.integer]) -> NDArray[np.int64]:
        """Number each triangle between vertices of openings, whichever way it is turned."""
        rim = np.unique(self._spanning)
        numbers = np.full(len(self._sector.whole.vertices), -1, dtype=np.int64)
        numbers[rim] = np.arange(len(rim))
        a, b, c = np.sort(numbers[triangles], axis=1).T
        return np.where(a < 0, -1, (a * len(rim) + b) * len(rim) + c)

    def forces(self, vertices: Indices, forces: Floats, history: CoreHistory) -> None:
        """Take dead forces on vertices; those on planes are shared by the parts of the body."""
        sector = self._sector
        self._add(("force", _key(history)), forces, vertices[:, None], "its force")
        mine = forces * sector.shares[vertices, None]
        inside = sector.numbers[vertices] >= 0
        found = sector.numbers[vertices[inside]].astype(np.uint32)
        self.kept.forces(found, mine[inside], history)

    def coarse(self, groups: Indices) -> None:
        """Take large voxels, each a group of eight of the whole that are in the sector."""
        self.kept.coarse(np.searchsorted(self._sector.voxels, groups).astype(np.uint32))

    def floor(self, z: float) -> None:
        """Take a floor."""
        self._check_along_planes(np.array([0.0, 0.0, 1.0]), "it")
        self.kept.floor(z - self._sector.origin[2])

    def attach(self, _term: str, _elements: Sequence[_core_data.Element]) -> None:
        """Refuse an attachment of the body."""
        self._refuse(*REASONS["springs and the like", "symmetry"])

    def tendon(self, _tendon: _core_data.Tendon, _history: CoreHistory) -> None:
        """Refuse a tendon."""
        self._refuse(*REASONS["tendons", "symmetry"])

    def _check_along_planes(self, vector: Floats, what: str) -> None:
        for plane in self._sector.planes:
            if abs(vector[plane.axis]) > _ROUNDING * max(float(np.abs(vector).max()), 1e-300):
                self._refuse(f"is not symmetric: {what} points across {plane.plane}")

    def _add(self, key: _Key, values: Floats, elements: NDArray[Any], what: str) -> None:
        """Take values of a load on elements, whose images may be other loads of its kind."""
        whole = self._on_vertices(values, elements)
        if self._asymmetry(whole) is None:
            return
        before = self._lone.get(key)
        if before is None:
            self._lone[key] = _Lone(self.where, what, whole)
        else:
            self._lone[key] = replace(before, values=before.values + whole)

    def _check_symmetric(self, values: Floats, elements: NDArray[Any], what: str) -> None:
        """Raise unless values on elements, (e, 1), are their own images."""
        found = self._asymmetry(self._on_vertices(values, elements))
        if found is not None:
            self._refuse(f"is not symmetric: {what} has no image across {found}")

    def _on_vertices(self, values: Floats, elements: NDArray[Any]) -> Floats:
        """Sum values on elements, (e, 1) or vectors (e, 3), over the vertices of the whole."""
        whole = np.zeros((len(self._sector.whole.vertices), values.shape[1]))
        for corner in elements.T:
            np.add.at(whole, corner, values)
        return whole

    def _asymmetry(self, whole: Floats) -> str | None:
        """Find the plane and place where values on vertices are not their own images, if any."""
        size = max(float(np.abs(whole).max(initial=0.0)), 1e-300)
        for plane, image in zip(self._sector.planes, self._sector.images, strict=True):
            mirrored = whole[image]
            if whole.shape[1] == 3:
                mirrored[:, plane.axis] *= -1.0
            off = np.abs(mirrored - whole).max(axis=1)
            if off.max(initial=0.0) > _ROUNDING * size:
                return self._at(int(off.argmax()), plane)
        return None

    def _at(self, vertex: int, plane: Symmetry) -> str:
        """Describe a plane and the position of a vertex of the whole."""
        x, y, z = 1e3 * self._sector.whole.vertices[vertex]
        return f"{plane.plane} at ({x:.1f}, {y:.1f}, {z:.1f}) mm"

    def _refuse(self, what: str, hint: str = _HINT) -> NoReturn:
        raise DesignError(self.where, what, hint)
