"""Setup of the sector of a symmetric body, and its result for the whole body."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Final, Self

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.metrics import Place
from voxsoft.simulation.results.result import Recording, Result
from voxsoft.simulation.setup.contact import Pose, Touching
from voxsoft.simulation.setup.materials import core_materials
from voxsoft.simulation.setup.setup import Setup, core_problem
from voxsoft.simulation.setup.symmetry.sector import Sector

Floats = NDArray[np.float64]

_SHARES: Final = {2: "a half", 4: "a quarter", 8: "an eighth"}


@dataclass(frozen=True, repr=False)
class SectorSetup(Setup):
    """Setup of the solved sector of a symmetric body: its mesh is that of the sector.

    Attributes
    ----------
    whole
        Setup of the whole body.
    sector
        The sector that is solved.
    """

    whole: Setup = field(kw_only=True)
    sector: Sector = field(kw_only=True)

    def __post_init__(self) -> None:
        """Skip the preparation: layers and chambers are those of the whole body."""

    @classmethod
    def part_of(cls, whole: Setup) -> Self | None:
        """Return the sector setup of a body; None for one without planes of symmetry."""
        sector = whole.sector
        if sector is None:
            return None
        return cls(whole.design, sector.mesh, whole=whole, sector=sector)

    @property
    def origin(self) -> Floats:
        """Origin of the solver, (3,), m: on all planes."""
        return self.sector.origin

    @cached_property
    def problem(self) -> _core.Problem:
        """The problem of the sector, held at its planes."""
        parts = self.whole.sector_parts
        materials = core_materials(self.design, self.materials, self.mesh, self.origin)
        return core_problem(self.mesh, materials, parts, self.sector.directions)

    @property
    def touching(self) -> Touching | None:
        """Contact of the whole: the problem of the sector has all of it."""
        return self.whole.sector_touching

    @cached_property
    def clamped(self) -> list[NDArray[np.uint32]]:
        """The vertices of each clamp that are in the sector."""
        return [self.sector.restricted(each[:, None])[:, 0] for each in self.whole.clamped]

    @cached_property
    def places(self) -> dict[str, Place]:
        """Places of each probe in each part of the body, as places of the sector."""
        return {
            f"{name}/{number}": place
            for name in self.whole.places
            for number, (_, place) in enumerate(self._parts_of(name))
        }

    def _parts_of(self, name: str) -> list[tuple[Floats, Place]]:
        """Return the factors on vectors of each part of a probe, and its place."""
        place, source = self.whole.places[name], self.sector.source
        found = []
        for sign, here in self.sector.patterns():
            mine = here[place.vertices]
            if mine.any():
                at = source[place.vertices[mine]].astype(np.uint32)
                found.append((sign, Place(at, place.weights[mine])))
        return found

    def unfolded(self, result: Result) -> Result:
        """Convert the result of the sector to that of the whole body."""
        sector, count = self.sector, self.sector.count
        reactions = self._reactions(result.reactions)
        positions = sector.places(result.positions)
        load, load_moment = self._totals(result.load, result.load_moment)
        reaction, reaction_moment = self._totals(result.reaction, result.reaction_moment)
        recording = result.recording
        probes = {
            name: sum(
                (
                    sign * recording.probes[f"{name}/{number}"]
                    for number, (sign, _) in enumerate(self._parts_of(name))
                ),
                start=np.zeros((len(recording.times), 3)),
            )
            for name in self.whole.places
        }
        frames = recording.frames
        return replace(
            result,
            mesh=self.whole.mesh,
            places=self.whole.places,
            message=f"{result.message}; solved for {_SHARES[count]} of the body",
            positions=positions,
            velocities=sector.unfolded(result.velocities),
            reactions=reactions,
            reaction=reaction,
            reaction_moment=reaction_moment,
            load=load,
            load_moment=load_moment,
            elastic_energy=count * result.elastic_energy,
            mass=count * result.mass,
            solver={**result.solver, "symmetry": [plane.plane for plane in sector.planes]},
            recording=Recording(
                times=recording.times,
                probes=probes,
                frames=sector.places(frames) if len(frames) else frames,
                contacts=recording.contacts,
                objects={
                    name: (positions + self.origin, turns)
                    for name, (positions, turns) in recording.objects.items()
                },
                elastic_energy=count * recording.elastic_energy,
                kinetic_energy=count * recording.kinetic_energy,
                load_potential=count * recording.load_potential,
                momentum=sum(
                    (sign * recording.momentum for sign, _ in sector.patterns()),
                    start=np.zeros_like(recording.momentum),
                ),
            ),
            objects=self._poses(result.objects),
            # Modes that break the symmetry are not seen in the sector.
            stable=None if result.stable else result.stable,
        )

    def _reactions(self, reactions: Floats) -> Floats:
        """Return reaction forces on the whole: on a plane those of all sides add up, along it."""
        sector = self.sector
        found = sector.unfolded(reactions)
        for axis, on in zip(sector.axes, sector.on_planes.T, strict=True):
            found[on] *= 2.0
            found[on, axis] = 0.0
        return found

    def _totals(
        self, of: tuple[float, float, float], about: tuple[float, float, float]
    ) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Sum a part's forces and their moments about the origin over all parts."""
        force, own = np.array(of), np.array(about)
        total, moment = np.zeros(3), np.zeros(3)
        for sign, _ in self.sector.patterns():
            image = sign * force
            total += image
            # A moment is a pseudovector: mirroring changes its sign besides.
            moment += np.prod(sign) * sign * own + np.cross(self.sector.origin, image)
        return _triple(total), _triple(moment)

    def _poses(self, poses: Mapping[str, Pose]) -> dict[str, Pose]:
        """Shift poses of objects, all of which the core has, from the sector's frame."""
        return {
            name: replace(pose, position=_triple(np.array(pose.position) + self.origin))
            for name, pose in poses.items()
        }


def _triple(vector: Floats) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z
