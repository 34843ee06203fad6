"""Observation of a body in motion at one moment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.errors import DesignError
from voxsoft.records import closest
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.simulation.loads import readings
from voxsoft.simulation.results.result import Result, Status
from voxsoft.simulation.runs.commands import Commands, Course
from voxsoft.simulation.runs.drives import Value
from voxsoft.simulation.runs.local_motion import LocalMotion, Patch
from voxsoft.simulation.runs.sensors import SensorState
from voxsoft.simulation.runs.state import measured_result
from voxsoft.simulation.runs.stored_observation import observation_bytes
from voxsoft.simulation.setup.contact import ContactState, Pose
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.setup.tendons import TendonState

Floats = NDArray[np.float64]
#: ``inverted``: voxels are inside out, so that stress and volume mean nothing there.
MotionStatus = Literal["moving", "at-rest", "inverted", "diverged"]


@dataclass(frozen=True)
class ChamberState:
    """A chamber at one moment.

    Attributes
    ----------
    name
        Its name in the design; empty without one.
    volume
        Volume in m³.
    pressure
        Gauge pressure in Pa.
    flow
        Mass flow from its supply, with all chambers behind that, kg/s; 0 without one.
    """

    name: str
    volume: float
    pressure: float
    flow: float = 0.0


@dataclass(frozen=True, eq=False)
class Moment:
    """State of all vertices in the core, those of objects after those of the body.

    Attributes
    ----------
    positions, velocities
        (n, 3), m and m/s; set to be read only.
    time
        Time in s.
    memory
        All data that depend on the load path.
    residual
        Largest force that is not balanced, relative to the load.
    """

    positions: Floats
    velocities: Floats
    time: float
    memory: _core.Memory
    residual: float

    def __post_init__(self) -> None:
        self.positions.flags.writeable = self.velocities.flags.writeable = False

    def drives(
        self, problem: _core.Problem, inputs: Sequence[Course]
    ) -> tuple[Floats, list[_core.Tendon]]:
        """Measure chambers, (c, 6), and tendons alone."""
        return problem.drives(self.positions, self.time, self.memory, inputs)

    def measured(self, problem: _core.Problem, inputs: Sequence[Course]) -> _core.Answer:
        """Measure forces, contacts and chambers under these inputs of a problem."""
        return problem.measure(
            self.positions, self.velocities, self.time, self.memory, self.residual, inputs
        )


@dataclass(frozen=True, eq=False)
class Driven:
    """Drives of a body at one moment, beside the memory of the core.

    Attributes
    ----------
    values
        Value of each command, as it acts.
    memories
        State of the material behind each command.
    following
        Commands that still follow the history of the design.
    moving
        Commands that went evenly to a new value in the last step.
    late
        Seconds by which the core's clock is late: nothing is computed at rest.
    work
        Energy given to the body since the reset by each drive, J.
    power
        Mean power of the last step, W.
    sensors
        State of the sensors.
    seed
        Seed of their noise.
    """

    values: tuple[Value, ...]
    memories: tuple[float, ...]
    following: frozenset[int]
    moving: frozenset[int]
    late: float
    work: Mapping[str, float]
    power: float
    sensors: SensorState
    seed: int


@dataclass(frozen=True, eq=False)
class Subject:
    """Body of a simulator, shared by all its observations.

    Attributes
    ----------
    setup
        The design on its mesh.
    commands
        All that drives it.
    problem
        Problem of the core, with loads of unit size.
    pressed
        Commands that are pressures in cavities, with these cavities.
    step
        Length of a step in s.
    """

    setup: Setup
    commands: Commands
    problem: _core.Problem
    pressed: Sequence[tuple[int, Sequence[int]]]
    step: float

    @cached_property
    def patches(self) -> dict[str, Patch]:
        """Vertices around each probe."""
        mesh = self.setup.mesh
        return {name: Patch.around(place, mesh) for name, place in self.setup.places.items()}

    @cached_property
    def fields(self) -> _core.Fields:
        """Elements of the body, which say whether they are inside out."""
        return _core.Fields(self.problem)

    def inputs(self, driven: Driven, time: float) -> list[Course]:
        """Inputs of the core as they act at a time in s and from there on."""
        found: list[Course] = []
        for index, command in enumerate(self.commands.all):
            if index in driven.following:
                found += command.course()
            else:
                found += command.held(driven.values[index], driven.memories[index])
        return found


@dataclass(frozen=True, repr=False)
class Observation:
    """A body at one moment of a :class:`~voxsoft.Simulator`; it stays as the body moves on.

    It is the whole state of its simulator too: :meth:`~voxsoft.Simulator.restore` goes back to it.

    Attributes
    ----------
    time
        Since the reset, s: the steps taken, times their length.
    steps
        Steps taken since the reset.
    status
        ``moving``; ``at-rest`` under commands that stay; ``inverted``: voxels are inside out; or
        ``diverged``: no sound state was found from here on, and positions are the last sound ones.
    message
        The status in a sentence.
    positions, velocities
        Vertex positions and velocities, (n, 3), m and m/s; read-only copies.
    probes
        Displacement of each probe by name, (3,), m.
    commands
        Value of each command by name, in SI units, as it acts.
    sensors
        Sample of each sensor by name, in SI units.
    residual
        Largest force that is not balanced, relative to the load: below the tolerance at rest.
    elastic_energy, kinetic_energy
        Energies in J.
    """

    time: float
    steps: int
    status: MotionStatus
    message: str
    positions: Floats
    velocities: Floats
    probes: Mapping[str, Floats]
    commands: Mapping[str, Value]
    residual: float
    elastic_energy: float
    kinetic_energy: float
    _moment: Moment = field(compare=False)
    _subject: Subject = field(compare=False)
    _driven: Driven = field(compare=False)
    #: Velocities a step ago; None after a reset.
    _before: Floats | None = field(compare=False)
    sensors: Mapping[str, Floats] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<Observation at {self.time:g} s: {self.status}>"

    @classmethod
    def of(
        cls,
        subject: Subject,
        moment: Moment,
        driven: Driven,
        *,
        steps: int,
        status: MotionStatus,
        message: str,
        elastic_energy: float,
        kinetic_energy: float,
        before: Floats | None,
        sensors: Mapping[str, Floats] = MappingProxyType({}),
    ) -> Self:
        """Observe a body at a moment; `before` are its velocities a step ago, if there is one."""
        mesh, names = subject.setup.mesh, subject.commands.names
        own = len(mesh.vertices)
        positions = moment.positions[:own]
        moved = positions - mesh.vertices
        return cls(
            time=steps * subject.step,
            steps=steps,
            status=status,
            message=message,
            positions=positions,
            velocities=moment.velocities[:own],
            probes={
                name: place.weights @ moved[place.vertices]
                for name, place in subject.setup.places.items()
            },
            commands=MappingProxyType(dict(zip(names, driven.values, strict=True))),
            residual=moment.residual,
            elastic_energy=elastic_energy,
            kinetic_energy=kinetic_energy,
            _moment=moment,
            _subject=subject,
            _driven=driven,
            _before=before,
            sensors=sensors,
        )

    def driven_by(self, driven: Driven, samples: Mapping[str, Floats] | None = None) -> Self:
        """Return it with other drives, and all that was measured of it."""
        found = replace(self, _driven=driven, sensors=self.sensors if samples is None else samples)
        for name in ("_answer", "_drives", "chambers"):
            if name in self.__dict__:
                found.__dict__[name] = self.__dict__[name]
        return found

    def to_bytes(self) -> bytes:
        """Return all that :meth:`~voxsoft.Simulator.restore` needs, for a file or another process.

        Returns
        -------
        bytes
            Content of an ``.npz`` file.

        Raises
        ------
        DesignError
            A shape of the design is made of a Python function.

        Examples
        --------
        >>> import voxsoft as vs
        >>> from voxsoft.design import families
        >>> cup = families.cylinder(radius="20 mm", height="30 mm")
        >>> seen = vs.Simulator(cup).step({"pressure": "1 kPa"})
        >>> other = vs.Simulator(cup)
        >>> restored = other.restore(seen.to_bytes())
        >>> restored.time, bool((restored.positions == seen.positions).all())
        (0.02, True)
        """
        return observation_bytes(self)

    @property
    def loads(self) -> Mapping[str, Value]:
        """Values of the commands that are loads."""
        names = self._subject.commands.of_loads
        return MappingProxyType({name: self.commands[name] for name in names})

    @cached_property
    def _answer(self) -> _core.Answer:
        """Forces and contacts, measured on demand."""
        subject = self._subject
        inputs = subject.inputs(self._driven, self._moment.time)
        return self._moment.measured(subject.problem, inputs)

    @cached_property
    def _drives(self) -> tuple[Floats, list[_core.Tendon]]:
        """Chambers, (c, 6), and tendons, which every step asks for where there are any."""
        subject = self._subject
        inputs = subject.inputs(self._driven, self._moment.time)
        return self._moment.drives(subject.problem, inputs)

    @cached_property
    def chambers(self) -> tuple[ChamberState, ...]:
        """All cavities, the largest first: volume, pressure, flow."""
        setup = self._subject.setup
        cavities = setup.mesh.cavities
        pressures, flows = [0.0] * len(cavities), [0.0] * len(cavities)
        for index, pressed in self._subject.pressed:
            value = self._driven.values[index]
            assert isinstance(value, float)
            for cavity in pressed:
                pressures[cavity] += value
        if (fluids := setup.fluids) is not None:
            for supplied in fluids.states(self._drives[0]):
                for cavity in supplied.cavities:
                    pressures[cavity], flows[cavity] = supplied.pressure, supplied.flow
        rows = zip(cavities, pressures, flows, strict=True)
        return tuple(
            ChamberState(each.name, float(each.volume_at(self.positions)), pressure, flow)
            for each, pressure, flow in rows
        )

    @property
    def tendons(self) -> Mapping[str, TendonState]:
        """Tension, length, slack and points of each tendon by its name, N and m."""
        found = zip(self._subject.setup.tendons, self._drives[1], strict=True)
        return {tendon.name: tendon.state(core) for tendon, core in found}

    @property
    def contacts(self) -> tuple[ContactState, ...]:
        """Contact of each pair of surfaces that may touch: force, place, slip; made on demand."""
        touching = self._subject.setup.touching
        return () if touching is None else touching.contacts(self._answer.contacts)

    @property
    def objects(self) -> Mapping[str, Pose]:
        """Pose of each object by its name; made on demand."""
        touching = self._subject.setup.touching
        return {} if touching is None else touching.poses(self._answer.objects)

    def motion(self, probe: str) -> LocalMotion:
        """Return how the material around a probe moves: rotation, rates and strain, as an IMU.

        Parameters
        ----------
        probe
            Its name.

        Raises
        ------
        DesignError
            An unknown probe.
        """
        patches = self._subject.patches
        if probe not in patches:
            raise DesignError("probe", f'"{probe}" is no probe', closest(probe, list(patches)))
        subject, pull = self._subject, np.zeros(3)
        for index, reading in enumerate(readings(subject.setup.design)):
            value = self._driven.values[index]
            if reading.quantity == "acceleration" and isinstance(value, float):
                down = np.asarray(reading.direction, dtype=np.float64)
                pull += value * down / np.linalg.norm(down)
        return patches[probe].motion(
            self.positions, self.velocities, self._before, subject.step, pull
        )

    @property
    def work(self) -> Mapping[str, float]:
        """Energy that each drive has given since the reset, J.

        Tendons, by name, have the work of the motor; supplies, by name, the energy of the fluid
        that they gave, see :class:`~voxsoft.simulation.setup.fluids.ChamberState`; pressures, by
        the name of their command, the work on the walls; other loads, fields and dielectrics
        likewise that of their forces; clamps and objects that are moved, by name, that of the
        support. Weight and drag, the liquid around, and parts that grow are not counted.
        """
        return self._driven.work

    @property
    def energy(self) -> float:
        """Energy that all drives have given since the reset, J."""
        return float(sum(self._driven.work.values()))

    @property
    def power(self) -> float:
        """Mean power of all drives over the last step, W."""
        return self._driven.power

    @cached_property
    def result(self) -> Result:
        """Result of the state under its commands; made on demand."""
        statuses: dict[MotionStatus, Status] = {"at-rest": "ok", "diverged": "diverged"}
        subject = self._subject
        design = subject.commands.under(subject.setup.design, self._driven.values)
        return measured_result(
            Setup(design, subject.setup.mesh),
            self._answer,
            status=statuses.get(self.status, "not-at-rest"),
            message=self.message,
            time=self.time,
        )

    @property
    def metrics(self) -> Mapping[str, float]:
        """Objectives, constraints and metrics that need no choice; see :attr:`Result.metrics`."""
        return self.result.metrics

    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """Warnings about this state: overlaps, collapsed voxels and more; made on demand."""
        return self.result.warnings

    def metric(self, name: str, **options: Any) -> float:  # noqa: ANN401 - as Result.metric
        """Return one metric in SI units; options are those of :meth:`Result.metric`.

        Raises
        ------
        DesignError
            An unknown metric, probe or cavity.
        """
        return self.result.metric(name, **options)
