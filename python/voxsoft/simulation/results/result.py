"""Result of a simulation.

Long because all that it gives is a short property of one class, which documents every number.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, NoReturn

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import Shown, rounded, shortened
from voxsoft.design import Design, Objective, Region
from voxsoft.design.chamber import chosen_cavities
from voxsoft.design.contact import FLOOR
from voxsoft.errors import DesignError
from voxsoft.fields import Fields
from voxsoft.geometry import mean_displacement
from voxsoft.mesh import Mesh
from voxsoft.metrics import METRICS, Place, Target, metric_named
from voxsoft.metrics.contact import object_problems
from voxsoft.metrics.reaction import support_problems
from voxsoft.metrics.tendon import tendon_problems
from voxsoft.simulation.checks.fluid_limits import doubtful_fluids
from voxsoft.simulation.checks.overlaps import penetration_of
from voxsoft.simulation.checks.penetration import Penetration
from voxsoft.simulation.checks.relaxed import relaxed_parts, relaxed_tangents
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.simulation.loads import readings
from voxsoft.simulation.results.contact_field import ContactField
from voxsoft.simulation.results.fields import fields_of
from voxsoft.simulation.results.posed import distance_between, posed_surface
from voxsoft.simulation.results.warnings import warnings_at
from voxsoft.simulation.setup.contact import ContactState, Pose
from voxsoft.simulation.setup.fluids import ChamberHistory, ChamberState, Fluids
from voxsoft.simulation.setup.supports import (
    Force,
    clamp_reactions,
    clamped_vertices,
    reaction_in,
    support_moment,
)
from voxsoft.simulation.setup.tendons import TendonState
from voxsoft.simulation.setup.volumes import Volumes, volumes_of
from voxsoft.units import format_percent, format_quantity

if TYPE_CHECKING:
    from voxsoft.studio.outputs.html import LivePage

#: Largest residual of an equilibrium with contact without a warning. Surfaces that slip act from
#: their present position once a state is taken, which leaves less than this where they slip little.
LARGE_RESIDUAL = 1e-3

#: Final status of a trial; ``ok`` is the only one whose numbers may be compared.
Status = Literal["ok", "no-cavity", "disconnected", "diverged", "not-at-rest", "failed"]


@dataclass(frozen=True)
class Recording:
    """Recording over time, or along the load path.

    Attributes
    ----------
    times
        Instants in s, (f,).
    probes
        Displacement of each probe in m, (f, 3) by name.
    frames
        Positions of all vertices in m, (f, n, 3); f is 0 unless frames were asked for.
    contacts
        Contacts at each instant; empty without contact.
    objects
        Positions in m, (f, 3), and rotations from the first pose, (f, 3, 3), of each object by
        name.
    elastic_energy, kinetic_energy, load_potential
        Energies in J, (f,), of all bodies and free objects: without that of contact, and with the
        loads as they are at that instant. Empty without contact.
    momentum
        Momentum in kg m/s, (f, 3). Empty without contact.
    chambers
        Pressure, volume, mass, flow, work and energy of each supply by name, each (f,); for statics
        at each point of the load path.
    """

    times: NDArray[np.float64]
    probes: Mapping[str, NDArray[np.float64]]
    frames: NDArray[np.float64]
    contacts: tuple[tuple[ContactState, ...], ...] = ()
    objects: Mapping[str, tuple[NDArray[np.float64], NDArray[np.float64]]] = field(
        default_factory=dict
    )
    elastic_energy: NDArray[np.float64] = field(default_factory=lambda: np.zeros(0))
    kinetic_energy: NDArray[np.float64] = field(default_factory=lambda: np.zeros(0))
    load_potential: NDArray[np.float64] = field(default_factory=lambda: np.zeros(0))
    momentum: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 3)))
    chambers: Mapping[str, ChamberHistory] = field(default_factory=dict)


@dataclass(frozen=True, repr=False)
class Result(Shown):
    """Final state of a design, with its status and its residual.

    Attributes
    ----------
    design, mesh
        The design that was simulated, and its mesh.
    status
        ``ok``: at rest (or at the end time, where one was set). ``not-at-rest`` and
        ``diverged`` keep the last good positions.
    message
        The status in a sentence.
    positions, velocities
        Vertices in m and m/s, (n, 3).
    residual
        Norm of the forces left over on free vertices over that of the loads or reactions.
    reactions
        Support forces in N, (n, 3), zero on free vertices.
    reaction, reaction_moment, load, load_moment
        Totals in N and N m (about the origin), (3,). Springs to fixed points count as loads.
    elastic_energy
        Elastic energy in J.
    solver
        The method of the solver, and its settings.
    steps, back_offs
        Substeps taken, and how often the step was halved.
    time
        Simulated time in s; 0 for relaxation, which has none.
    seconds
        Wall-clock time of the solution.
    recording
        Recording of runs over time; for statics one entry for each point of the load path, with the
        load factor as time.
    load_factor
        The part of the loads that ``positions`` carry; 1 unless statics met a limit (or, in
        volume control, the factor that the pressure reached).
    limit_factor
        The largest load factor of a path that turned back, if it did: 0.8 means that a
        pressure of 5 kPa has its limit at 4 kPa.
    stable
        True for a stable equilibrium; None where the solver does not decide it.
    snaps
        The load factors at which a body with contact snapped to another equilibrium on the way; of
        a creep the times in s at which any body did.
    contacts
        Contacts with their forces; pairs that are apart are left out.
    objects
        Poses of the rigid objects, by name.
    contact_field
        Pressure, friction and gap at each vertex; None for a design without contact.
    tendons
        Tension and length of each tendon, by name.
    supplies
        Pressure, volume, mass, flow, work and energy of each volume of gas or liquid: those of the
        design's supplies in their order, then those that only a connection reaches.
    peaks
        Largest energy of the change of shape that each softening voxel has had, in J/m³.
    """

    design: Design
    mesh: Mesh
    places: Mapping[str, Place] = field(repr=False)
    status: Status
    message: str
    positions: NDArray[np.float64] = field(repr=False)
    velocities: NDArray[np.float64] = field(repr=False)
    residual: float
    reactions: NDArray[np.float64] = field(repr=False)
    reaction: tuple[float, float, float]
    reaction_moment: tuple[float, float, float]
    load: tuple[float, float, float]
    load_moment: tuple[float, float, float]
    elastic_energy: float
    mass: float
    solver: Mapping[str, Any]
    steps: int
    back_offs: int
    time: float
    seconds: float
    recording: Recording = field(repr=False)
    load_factor: float = 1.0
    limit_factor: float | None = None
    stable: bool | None = None
    snaps: tuple[float, ...] = ()
    contacts: tuple[ContactState, ...] = ()
    objects: Mapping[str, Pose] = field(default_factory=dict)
    contact_field: ContactField | None = field(default=None, repr=False)
    tendons: Mapping[str, TendonState] = field(default_factory=dict)
    supplies: tuple[ChamberState, ...] = ()
    peaks: NDArray[np.float64] | None = field(default=None, repr=False)

    @property
    def history(self) -> NoReturn:
        """Refused, as loads have histories: see :attr:`recording`."""
        raise AttributeError("a Result has no history: what was recorded is its recording")

    @property
    def displacements(self) -> NDArray[np.float64]:
        """Displacement of every vertex in m, (n, 3)."""
        moved: NDArray[np.float64] = self.positions - self.mesh.vertices
        return moved

    @cached_property
    def probes(self) -> Mapping[str, NDArray[np.float64]]:
        """Displacement of each probe in m, (3,) by name."""
        return {
            name: mean_displacement(
                self.mesh.vertices, self.positions, place.vertices, place.weights
            )
            for name, place in self.places.items()
        }

    @cached_property
    def cavity_volumes(self) -> tuple[float, ...]:
        """Volume of each cavity now, in m³, in the order of the mesh's cavities.

        Volumes of named chambers are in :attr:`chamber_volumes`.
        """
        return tuple(cavity.volume_at(self.positions) for cavity in self.mesh.cavities)

    @cached_property
    def cavity_pressures(self) -> tuple[float, ...]:
        """Gauge pressure in each cavity in Pa, in the order of the mesh's cavities."""
        pressures = [self.load_factor * value for value in pressures_of(self.design, self.mesh)]
        for supplied in self.supplies:
            for index in supplied.cavities:
                pressures[index] = supplied.pressure
        return tuple(pressures)

    @cached_property
    def fields(self) -> Fields:
        """Stress and strain in each voxel, and averaged on the vertices."""
        return fields_of(self.design, self.mesh, self.positions, peaks=self.peaks)

    @cached_property
    def clamp_reactions(self) -> Mapping[str, Force]:
        """Reaction force of each clamp on the body in N, by its name or its place, ``"clamps[0]"``.

        Each force counts once: where several clamps hold the same axis of a vertex, for the last.
        """
        clamped = clamped_vertices(self.design, self.mesh)
        return clamp_reactions(self.design, clamped, self.reactions)

    def reaction_in(self, region: Region) -> Force:
        """Compute the reaction force in N of all supports of the vertices in a region.

        Parameters
        ----------
        region
            A region of the unloaded body.

        Raises
        ------
        DesignError
            The region catches nothing.
        """
        return reaction_in(self.design, self.mesh, region, self.reactions)

    def support_moment(
        self, about: Force, *, clamp: str | None = None, region: Region | None = None
    ) -> Force:
        """Compute the moment of the clamps on the body about a point, N m, as it stands.

        Parameters
        ----------
        about
            The point, m.
        clamp, region
            Name or place of the only clamp that counts, or a region of the unloaded body; default:
            all.

        Raises
        ------
        DesignError
            The region catches nothing.
        """
        return support_moment(
            self.design,
            self.mesh,
            self.positions,
            self.reactions,
            about,
            clamp=clamp,
            region=region,
        )

    @property
    def chamber_volumes(self) -> dict[str, float]:
        """Volume of each named chamber now, in m³."""
        pairs = zip(self.mesh.cavities, self.cavity_volumes, strict=True)
        return {cavity.name: volume for cavity, volume in pairs if cavity.name}

    def metric(
        self,
        name: str,
        *,
        probe: str | None = None,
        base: str | None = None,
        axis: Literal["x", "y", "z"] | None = None,
        cavity: int | str | None = None,
        percentile: float | None = None,
        object: str | None = None,
        tendon: str | None = None,
        clamp: str | None = None,
        region: Region | Mapping[str, Any] | None = None,
        about: tuple[float | str, float | str, float | str] | None = None,
    ) -> float:
        """Return one metric in SI units.

        Parameters
        ----------
        name
            A key of :data:`voxsoft.metrics.METRICS`, which lists the choices of each.
        probe
            The probe, for a metric that needs it; may be left out if there is one probe.
        base
            Another probe, where the line of a chord begins; may be left out if there are two.
        axis
            The component of a vector; default: its magnitude.
        cavity
            The chamber, by its name or the index of the cavity; default: all of them.
        percentile
            Percentage of the volume at or below the metric, so that one sharp corner does not
            decide; default: 100, the largest of all.
        object
            The contact: an object by its name, or ``"body"`` for self-contact; default: the only
            object there is.
        tendon
            The tendon, by its name; default: the only one there is.
        clamp
            The clamp, by its name or its place, ``"clamps[0]"``; default: all that hold the body.
        region
            Region in which supports count; default: everywhere.
        about
            Point of a moment, m; default: the origin.

        Raises
        ------
        DesignError
            An unknown metric, probe, cavity or object; one that is missing or not used.
        """
        target = Objective(
            maximize=name,
            probe=probe,
            base=base,
            axis=axis,
            cavity=cavity,
            percentile=percentile,
            object=object,
            tendon=tendon,
            clamp=clamp,
            region=region,
            about=about,
        )
        metric = metric_named(name)
        problems = [
            *metric.refusals(target),
            *object_problems(metric, target, self.design),
            *tendon_problems(metric, target, self.design),
            *support_problems(metric, target, self.design),
        ]
        if problems:
            raise DesignError.listing(problems)
        return self._value(target)

    def _value(self, target: Target) -> float:
        return metric_named(target.metric).value(self, target)

    @cached_property
    def metrics(self) -> Mapping[str, float]:
        """Objectives and constraints of the design by name, and all metrics that need no choice.

        Metrics of supplies are listed if there are any.
        """
        asked: dict[str, Target] = {**self.design.objectives, **self.design.constraints}
        values = {name: self._value(target) for name, target in asked.items()}
        free = {
            name
            for name, metric in METRICS.items()
            if not metric.needs
            and not metric.is_costly
            and (metric.is_of is None or metric.is_of(self))
        }
        return values | {name: self.metric(name) for name in sorted(free - values.keys())}

    @cached_property
    def volumes(self) -> Volumes:
        """Volumes of unloaded parts and chambers: as simulated, and as described by shapes."""
        return volumes_of(self.design, self.mesh)

    @cached_property
    def penetration(self) -> Penetration:
        """Penetration of the body into itself or its floor."""
        return penetration_of(self.design, self.mesh, self.positions)

    def gap_to(self, name: str) -> float:
        """Measure the smallest distance of the body and an object [m].

        Parameters
        ----------
        name
            Name of the object.

        Raises
        ------
        DesignError
            No object has this name.
        """
        bodies = self.design.body_names
        touching = [e.gap for e in self.contacts if e.of[0] in bodies and e.of[1] == name]
        if touching and name not in bodies:
            return min(touching)
        if name == FLOOR and self.design.floor is not None:
            return float(self.positions[:, 2].min()) - self.design.floor.z
        surface = posed_surface(self.design, name, self.objects.get(name))
        return distance_between(self.mesh, self.positions, surface)

    def compliance_at(self, place: Place) -> NDArray[np.float64]:
        """Compute the compliance at a place under forces along x, y and z, (3, 3), m/N.

        Rubber with ``prony`` branches has its long-term stiffness, crept or not.

        Raises
        ------
        SimulationError
            The tangent is singular there, or does not fit in memory.
        """
        from voxsoft.simulation.results.compliance import (
            compliance,  # needs a setup, which makes results
        )

        return compliance(self.design, self.mesh, self.positions, place, self.peaks)

    def natural_frequency(self) -> float:
        """Compute the lowest natural frequency, Hz; errors as those of :func:`voxsoft.modes`."""
        from voxsoft.simulation.results.vibration import modes  # of results

        return float(modes(self, 1).frequencies[0])

    @cached_property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """Warnings about this result, each with subject, finding and remedy."""
        found = warnings_at(self.design, self.mesh, self.positions, self.fields)
        if self.supplies:
            fluids = Fluids(self.design, self.mesh)
            found = (*doubtful_fluids(fluids, self.supplies, self.recording.chambers), *found)
        if self.solver["way"] == "creep":
            found = (*relaxed_tangents(self.design), *found)
        elif self.solver["way"] != "dynamics":
            found = (*relaxed_parts(self.design), *found)
        if self.stable is False:
            what, hint = "is not stable under constant loads", "lower the load"
            found = (Diagnostic("warning", "equilibrium", what, hint), *found)
        if self.status == "ok" and self.load_factor != 1.0 and self.solver["way"] != "volume":
            what = f"is that of {format_percent(self.load_factor)} of the loads"
            hint = "lower the loads to what the body carries"
            found = (Diagnostic("warning", "equilibrium", what, hint), *found)
        if self.snaps:
            where = f"{format_percent(self.snaps[0])} of the loads"
            if self.solver["way"] == "creep":
                instant = float(f"{self.snaps[0]:.6g}")
                where = format_quantity(instant, "time") if instant else "0 s"
            what = f"snapped to another one at {where}"
            hint = 'check by motion over time (method = "dynamics") where it ends'
            found = (Diagnostic("warning", "equilibrium", what, hint), *found)
        if self.contacts and self.stable is not None and self.residual > LARGE_RESIDUAL:
            what = f"leaves {format_percent(self.residual)} of the loads without a counterforce"
            hint = "take smaller voxels, or more friction, and compare"
            found = (Diagnostic("warning", "equilibrium", what, hint), *found)
        return found

    def _lines(self) -> Iterator[str]:
        yield f"{self.design.name}: {self.status}, {self.message}"
        yield from shortened([moved_in_words(*probe) for probe in self.probes.items()])
        asked: dict[str, Target] = {**self.design.objectives, **self.design.constraints}
        for name, target in asked.items():
            kind = METRICS[target.metric].kind
            yield f"{name}: {format_quantity(rounded(self.metrics[name]), kind)}"
        yield from shortened([supply.sentence for supply in self.supplies])
        yield from shortened([contact.sentence for contact in self.contacts])
        yield from shortened([f"warning: {found}" for found in self.warnings])

    def show(self) -> LivePage:
        """Show the design as an interactive page: in a notebook, or as a file with ``save``.

        The page begins at this result; its Play shows the motion there from the unloaded shape.
        """
        # `studio` lies above `simulation` in the layers; this convenience reaches up when called.
        from voxsoft.studio.outputs.html import page_of

        return page_of(self)

    def summary(self) -> dict[str, Any]:
        """Return all that a record needs, as plain data in SI units (the ``--json`` of ``run``)."""
        return {
            "status": self.status,
            "message": self.message,
            "solver": self.solver["method"],
            "settings": dict(self.solver),
            "residual": self.residual,
            "probes": {
                name: {"displacement": moved.tolist()} for name, moved in self.probes.items()
            },
            "metrics": dict(self.metrics),
            "cavities": [
                {
                    "name": cavity.name,
                    "volume": volume,
                    "rest_volume": float(cavity.volume),
                    "pressure": pressure,
                }
                for volume, cavity, pressure in zip(
                    self.cavity_volumes, self.mesh.cavities, self.cavity_pressures, strict=True
                )
            ],
            "contacts": [contact.summary() for contact in self.contacts],
            "supplies": [supply.summary() for supply in self.supplies],
            "objects": {name: pose.summary() for name, pose in self.objects.items()},
            "tendons": {name: found.summary() for name, found in self.tendons.items()},
            "penetration": self.penetration.depth,
            "warnings": [warning.summary() for warning in self.warnings],
            "reaction": list(self.reaction),
            "reactions": {name: list(force) for name, force in self.clamp_reactions.items()},
            "load": list(self.load),
            "volumes": self.volumes.summary(),
            "voxels": len(self.mesh.tets) // 5 if self.mesh.voxel_size else None,
            "phase": self.mesh.phase,
            "load_factor": self.load_factor,
            "limit_factor": self.limit_factor,
            "stable": self.stable,
            "snaps": list(self.snaps),
            "steps": self.steps,
            "time": self.time,
            "seconds": self.seconds,
        }


def moved_in_words(name: str, moved: NDArray[np.float64]) -> str:
    """Write the displacement of a probe in mm.

    Examples
    --------
    >>> moved_in_words("tip", np.array([0.0, 1e-3, -2.5e-3]))
    'tip: moved (0.000, 1.000, -2.500) mm'
    """
    shown = ", ".join(f"{round(1e3 * component, 3) + 0.0:.3f}" for component in moved)
    return f"{name}: moved ({shown}) mm"


def pressures_of(design: Design, mesh: Mesh) -> list[float]:
    """The final pressure in Pa of all loads in each cavity."""
    pressures = [0.0] * len(mesh.cavities)
    for number, load in enumerate(readings(design)):
        if load.cavity is not None:
            for index in chosen_cavities(load.cavity, mesh, f"loads[{number}].cavity"):
                pressures[index] += load.final_factor * load.size
    return pressures
