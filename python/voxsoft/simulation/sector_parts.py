"""What of a symmetric body's clamps, layers and loads the solved part takes."""

from __future__ import annotations

from typing import Any, Final, NoReturn

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.errors import DesignError
from voxsoft.simulation.sector import Sector
from voxsoft.simulation.touching import CoreHistory

Floats = NDArray[np.float64]
Indices = NDArray[np.uint32]

#: How far loads may be from symmetric, as a part of the largest: sums in different orders.
_ROUNDING: Final = 1e-9

_HINT: Final = "make it symmetric, or leave the plane of symmetry out"


class SectorParts:
    """Takes the parts of a whole body's problem, as the core does, and keeps those of the sector.

    Parameters
    ----------
    sector
        The part of the body.
    spanning
        All triangles of the whole that span openings, (s, 3).

    Attributes
    ----------
    kept
        What the core gets.
    where
        The place in the design of what comes next, for messages.
    """

    def __init__(self, sector: Sector, spanning: NDArray[np.int32]) -> None:
        self.kept = _core.ProblemParts()
        self.where = ""
        self._sector = sector
        self._spanning = spanning
        self._held = np.zeros((len(sector.vertices), 3), dtype=bool)

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
        self._check_symmetric(np.ones((len(vertices), 1)), vertices[:, None], "what it holds")
        displacement = np.asarray(motion.get("displacement") or np.zeros(3))
        self._check_along_planes(displacement, "its displacement")
        if motion.get("angle"):
            turn = np.asarray(motion["axis"])
            for plane in sector.planes:
                across = np.delete(turn, plane.axis)
                if np.abs(across).max() > _ROUNDING:
                    self._refuse(f"turns the plane of symmetry across {plane.plane}")
            motion = motion | {"center": (np.asarray(motion["center"]) - sector.origin).tolist()}
        mine = sector.numbers[vertices]
        mine = mine[mine >= 0]
        self._held[mine] |= axes
        self.kept.clamp(mine.astype(np.uint32), axes, **motion)

    def hold_planes(self) -> None:
        """Hold what is on the planes along their normals, where no clamp does."""
        for axis, on in zip(self._sector.axes, self._sector.on_planes.T, strict=True):
            free = on[self._sector.vertices] & ~self._held[:, axis]
            if free.any():
                found = np.flatnonzero(free).astype(np.uint32)
                self.kept.clamp(found, [axis == each for each in range(3)])

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
        self._check_symmetric(np.ones((len(own), 1)), own, "what it presses on")
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
        """Triangles on faces of voxels, and those that span openings.

        How an opening is cut into triangles need not be symmetric. Over symmetric states all of
        them together have as many times the energy of the sector as there are sectors.
        """
        if len(self._spanning) == 0:
            return triangles, triangles[:0]
        spans = np.isin(self._keys(triangles), self._keys(self._spanning))
        return triangles[~spans], triangles[spans]

    def _keys(self, triangles: NDArray[np.integer]) -> NDArray[np.int64]:
        """A number for each triangle between vertices of openings, whichever way it is turned."""
        rim = np.unique(self._spanning)
        numbers = np.full(len(self._sector.whole.vertices), -1, dtype=np.int64)
        numbers[rim] = np.arange(len(rim))
        a, b, c = np.sort(numbers[triangles], axis=1).T
        return np.where(a < 0, -1, (a * len(rim) + b) * len(rim) + c)

    def forces(self, vertices: Indices, forces: Floats, history: CoreHistory) -> None:
        """Take dead forces on vertices; those on planes are shared by the parts of the body."""
        sector = self._sector
        self._check_symmetric(forces, vertices[:, None], "its force")
        mine = forces * sector.shares[vertices, None]
        inside = sector.numbers[vertices] >= 0
        found = sector.numbers[vertices[inside]].astype(np.uint32)
        self.kept.forces(found, mine[inside], history)

    def floor(self, z: float) -> None:
        """Take a floor."""
        self._check_along_planes(np.array([0.0, 0.0, 1.0]), "it")
        self.kept.floor(z - self._sector.origin[2])

    def attach(self, _term: str, _elements: str) -> None:
        """Refuse what is attached to the body."""
        self._refuse("is not known to planes of symmetry yet", "leave it out, or the planes")

    def tendon(self, _tendon: str, _history: CoreHistory) -> None:
        """Refuse a tendon."""
        self._refuse("is not known to planes of symmetry yet", "leave it out, or the planes")

    def _check_along_planes(self, vector: Floats, what: str) -> None:
        for plane in self._sector.planes:
            if abs(vector[plane.axis]) > _ROUNDING * max(float(np.abs(vector).max()), 1e-300):
                self._refuse(f"is not symmetric: {what} points across {plane.plane}")

    def _check_symmetric(self, values: Floats, elements: NDArray[Any], what: str) -> None:
        """Raise unless values on elements, (e, 1) or vectors (e, 3), are their own images."""
        whole = np.zeros((len(self._sector.whole.vertices), values.shape[1]))
        for corner in elements.T:
            np.add.at(whole, corner, values)
        size = max(float(np.abs(whole).max(initial=0.0)), 1e-300)
        for plane, image in zip(self._sector.planes, self._sector.images, strict=True):
            mirrored = whole[image]
            if values.shape[1] == 3:
                mirrored[:, plane.axis] *= -1.0
            off = np.abs(mirrored - whole).max(axis=1)
            if off.max(initial=0.0) > _ROUNDING * size:
                x, y, z = 1e3 * self._sector.whole.vertices[int(off.argmax())]
                at = f"at ({x:.1f}, {y:.1f}, {z:.1f}) mm"
                self._refuse(f"is not symmetric: {what} has no image across {plane.plane} {at}")

    def _refuse(self, what: str, hint: str = _HINT) -> NoReturn:
        raise DesignError(self.where, what, hint)
