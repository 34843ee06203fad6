"""State of a setup at given positions under its final loads, for derivatives of metrics."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Design, Region
from voxsoft.design.contact import BODY, FLOOR
from voxsoft.fields import Fields
from voxsoft.mesh import Mesh
from voxsoft.metrics import Place
from voxsoft.simulation.checks.overlaps import penetration_of
from voxsoft.simulation.checks.penetration import Penetration
from voxsoft.simulation.loads.actions import SurfacePressure
from voxsoft.simulation.results.compliance import compliance_of
from voxsoft.simulation.results.fields import fields_of
from voxsoft.simulation.results.posed import distance_between, posed_surface
from voxsoft.simulation.results.result import pressures_of
from voxsoft.simulation.results.vibration import modes_of
from voxsoft.simulation.setup.contact import ContactState
from voxsoft.simulation.setup.distance import Surface
from voxsoft.simulation.setup.motion import held_axes, moved_by
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.setup.supports import (
    Force,
    clamp_reactions,
    reaction_in,
    support_moment,
)
from voxsoft.simulation.setup.tendons import TendonState

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class LoadedState:
    """A :class:`~voxsoft.metrics.SlopeState`.

    Attributes
    ----------
    setup
        The prepared design.
    positions
        Its vertices, (n, 3), m. The reaction assumes that they are in equilibrium.
    at
        The problem with its state variables there, such as contact; None where it has none.
    """

    setup: Setup
    positions: Floats
    at: _core.Problem | None = None

    @property
    def problem(self) -> _core.Problem:
        """Mechanical problem with its state variables there."""
        return self.at or self.setup.problem

    @property
    def design(self) -> Design:
        """The loaded design."""
        return self.setup.design

    @property
    def mesh(self) -> Mesh:
        """Its mesh, unloaded."""
        return self.setup.mesh

    @property
    def places(self) -> Mapping[str, Place]:
        """Vertices and weights of each probe."""
        return self.setup.places

    @property
    def mass(self) -> float:
        """Mass in kg."""
        return self.problem.mass

    @cached_property
    def _elastic(self) -> tuple[float, Floats]:
        return self.problem.elastic(self.positions)

    @property
    def elastic_energy(self) -> float:
        """Elastic energy in J."""
        return self._elastic[0]

    @property
    def elastic_forces(self) -> Floats:
        """Forces of the material on its vertices, (n, 3), N."""
        return self._elastic[1]

    @cached_property
    def fields(self) -> Fields:
        """Stress and strain."""
        return fields_of(self.design, self.mesh, self.positions, self.problem)

    @cached_property
    def net_forces(self) -> Floats:
        """Elastic and external force on every vertex, (n, 3), N."""
        return self.problem.net_forces(self.positions)

    @property
    def reaction(self) -> tuple[float, float, float]:
        """Reaction force of all supports, N: in equilibrium minus the sum of all loads.

        Objects are supports too, with their contact forces on the body.
        """
        of_objects = [each.force for each in self.contacts if each.of[1] != BODY]
        x, y, z = np.sum(of_objects, axis=0) - self.net_forces.sum(axis=0)
        return float(x), float(y), float(z)

    @property
    def clamp_reactions(self) -> dict[str, Force]:
        """The force of each clamp on the body by its name, N."""
        return clamp_reactions(self.design, self.setup.clamped, self._support_forces)

    def reaction_in(self, region: Region) -> Force:
        """Compute the reaction force on the body in a region, N."""
        return reaction_in(self.design, self.mesh, region, self._support_forces)

    def support_moment(
        self, about: Force, *, clamp: str | None = None, region: Region | None = None
    ) -> Force:
        """Compute the moment of the clamps on the body about a point, N m."""
        forces = self._support_forces
        return support_moment(
            self.design, self.mesh, self.positions, forces, about, clamp=clamp, region=region
        )

    @property
    def _support_forces(self) -> Floats:
        return np.where(held_axes(self.setup), -self.net_forces, 0.0)

    @property
    def penetration(self) -> Penetration:
        """Penetration of the body into itself or its floor."""
        return penetration_of(self.design, self.mesh, self.positions)

    @cached_property
    def contacts(self) -> tuple[ContactState, ...]:
        """Contacts, with the Lagrange multipliers that the contact of the problem holds."""
        touching = self.setup.touching
        if touching is None:
            return ()
        return touching.contacts(_core.contacts_at(self.problem, self.positions))

    @property
    def cavity_pressures(self) -> tuple[float, ...]:
        """Final pressure in each cavity, Pa, of loads alone: derivatives support no supplies."""
        return tuple(pressures_of(self.design, self.mesh))

    @property
    def supplies(self) -> tuple[()]:
        """Empty: derivatives support no supplies."""
        return ()

    @property
    def tendons(self) -> dict[str, TendonState]:
        """Tendons by name, as if they had been pulled here at once."""
        own = self.setup.tendons
        found = self.problem.tendons(self.positions) if own else []
        return {each.name: each.state(one) for each, one in zip(own, found, strict=True)}

    def gap_to(self, name: str) -> float:
        """Measure the smallest distance between the body and an object, m."""
        for each in self.contacts:
            if each.of == (BODY, name) and name != BODY:
                return each.gap
        if name == FLOOR and self.design.floor is not None:
            return float(self.positions[:, 2].min()) - self.design.floor.z
        first = posed_surface(self.design, name, None)
        (motion,) = (each.way for each in self.design.objects if each.name == name)
        surface = Surface(moved_by(motion, first.vertices), first.triangles)
        return distance_between(self.mesh, self.positions, surface)

    def compliance_at(self, place: Place) -> Floats:
        """Compute the compliance at a place under forces along x, y and z, (3, 3), m/N."""
        return compliance_of(self.setup, self.positions, place)

    def natural_frequency(self) -> float:
        """Compute the lowest natural frequency, Hz."""
        return float(modes_of(self.setup.problem, self.positions, 1).frequencies[0])

    def pushed_triangles(self) -> Iterator[tuple[NDArray[np.int32], float]]:
        """Yield triangles of open surfaces under pressure, (t, 3), and the pressure in Pa.

        Either split of each surface carries half of its pressure.
        """
        for load in self.setup.loads:
            for action in load.actions:
                if isinstance(action, SurfacePressure) and action.cavity is None:
                    half = 0.5 * action.value * load.reading.final_factor
                    yield action.triangles, half
                    yield self.setup.other_split.triangles(action.triangles), half
