"""A body that moves step by step under commands that come as it goes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Annotated, Any, Final, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag

from voxsoft import _core
from voxsoft._memory import memory_limit
from voxsoft.design import Design, require_design
from voxsoft.errors import SimulationError
from voxsoft.records import Record
from voxsoft.simulation.compatibility import refuse
from voxsoft.simulation.loads import undefined_in_words
from voxsoft.simulation.runs.commands import Command, CommandName, Commands, Course
from voxsoft.simulation.runs.critical_damping import critical_damping
from voxsoft.simulation.runs.drives import Value
from voxsoft.simulation.runs.observation import (
    Driven,
    Moment,
    MotionStatus,
    Observation,
    Subject,
)
from voxsoft.simulation.runs.sensors import Sensor, Sensors, SensorState
from voxsoft.simulation.runs.stored_observation import observation_from
from voxsoft.simulation.runs.work import work_after
from voxsoft.simulation.setup.large_voxels import evenly_small
from voxsoft.simulation.setup.setup import Setup
from voxsoft.units import NonNegativeRate, NonNegativeTime, PositiveTime

#: Residual at which a body counts as at rest, relative to the load.
TOLERANCE: Final = 1e-4
#: Seconds of a step: fifty commands a second, as valves take them.
TIME_STEP: Final = 0.02


def _named_or_rate(value: object) -> str:
    return "named" if value == "critical" else "rate"


class _Settings(Record):
    """Settings of a simulator besides its design, read as designs are."""

    time_step: PositiveTime = TIME_STEP
    damping: Annotated[
        Annotated[Literal["critical"], Tag("named")] | Annotated[NonNegativeRate, Tag("rate")],
        Discriminator(_named_or_rate),
    ] = "critical"
    retardation: NonNegativeTime = 0.0
    tolerance: float = Field(TOLERANCE, gt=0, lt=1)
    accuracy: float | None = Field(None, gt=0)
    seed: int = Field(0, ge=0)


class Simulator:
    """A design in motion: command all that drives it, step, observe, go back.

    Parameters
    ----------
    design
        A design. A drive with a history follows it until it is commanded.
    time_step
        Seconds of each :meth:`step`; default 0.02. Inside, it is halved where a step is not found,
        and where its error asks for that.
    damping
        Decay rate of velocities in 1/s, or ``"critical"`` (default): twice the lowest natural
        frequency of the unloaded body, which keeps that mode from swinging; where a body or an
        object moves freely, twice that of the present motion. 0 leaves the material's own.
    retardation
        Retardation time of the material, s; default 0.
    tolerance
        Residual force at rest, relative to the load; default 1e-4.
    accuracy
        Allowed error of a step in edges of a voxel, as the root of the mean square over the body:
        a step with more is cut into up to eight. Default: none is cut for it.
    sensors
        Sensors that are sampled after each step: see :class:`Sensor`, or names of quantities
        without error.
    seed
        Seed of the noise of sensors, until a :meth:`reset` gives another; default 0.

    Raises
    ------
    DesignError
        A design that cannot be built, a setting that cannot be read, or a sensor of nothing.

    Notes
    -----
    Steps are those of :func:`~voxsoft.simulate` over time, each converged by Newton's method with
    contact, tendons and fluids settled. Identical commands give identical bits, for any number of
    threads, after a :meth:`reset`, and after :meth:`restore` of any observation. The design's
    `solver` is for :func:`~voxsoft.simulate` and not used here.

    At first gravity acts as in the design, and nothing else drives the body: pressures, forces,
    fields, tensions and lengths drawn in are zero, syringes and valves as before the first stroke,
    sealed gas and activated parts at their reference. ``simulator.step(simulator.targets)`` drives
    everything as the design says.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> simulator = vs.Simulator(families.cylinder(radius="20 mm", height="30 mm"))
    >>> [(command.name, command.unit) for command in simulator.commands.values()]
    [('pressure', 'Pa')]
    >>> seen = simulator.step({"pressure": "1 kPa"})
    >>> round(seen.time, 3), seen.status, bool(seen.probes["top"][2] > 0)
    (0.02, 'moving', True)
    >>> later = simulator.step({"pressure": 0.0})
    >>> simulator.restore(seen).time
    0.02
    >>> bool((simulator.step({"pressure": 0.0}).positions == later.positions).all())
    True
    """

    def __init__(
        self,
        design: Design,
        *,
        time_step: float | str = TIME_STEP,
        damping: float | str = "critical",
        retardation: float | str = 0.0,
        tolerance: float = TOLERANCE,
        accuracy: float | None = None,
        sensors: Sequence[Sensor | str] = (),
        seed: int = 0,
    ) -> None:
        design = require_design(design, "design").assembled
        refuse(design, "simulator")
        design = evenly_small(design, design.solver.refine)
        given: dict[str, Any] = {
            "time_step": time_step,
            "damping": damping,
            "retardation": retardation,
            "tolerance": tolerance,
            "accuracy": accuracy,
            "seed": seed,
        }
        self._settings = _Settings(**given)
        setup = Setup.of(design, allow_loose=True)
        commands = Commands(setup)
        self._subject = Subject(
            setup,
            commands,
            commands.problem,
            commands.pressures(setup),
            self._settings.time_step,
        )
        damping = self._settings.damping
        self._damping = critical_damping(setup) if damping == "critical" else damping
        self._seed = self._settings.seed
        self._sensors: Sensors | None = None
        first = self.reset()
        if sensors:
            self._sensors = Sensors(sensors, first, self.time_step)
            self.reset()

    def __repr__(self) -> str:
        return f"<Simulator of {self.design.name}: {self._seen.status} at {self._seen.time:g} s>"

    @property
    def design(self) -> Design:
        """The design in motion."""
        return self._subject.setup.design

    @property
    def commands(self) -> Mapping[str, Command]:
        """All that can be commanded, by name: unit, shape, bounds, values."""
        return MappingProxyType({each.name: each for each in self._subject.commands.all})

    @property
    def targets(self) -> Mapping[str, Value]:
        """Values of all commands in the design, at the end of histories: a command for a step."""
        return MappingProxyType({name: each.design for name, each in self.commands.items()})

    @property
    def loads(self) -> tuple[str, ...]:
        """Names of the commands that are loads, in the order of the design."""
        return self._subject.commands.of_loads

    @property
    def time_step(self) -> float:
        """Seconds of each step."""
        return self._settings.time_step

    @property
    def sensors(self) -> tuple[Sensor, ...]:
        """All sensors."""
        return () if self._sensors is None else self._sensors.all

    @property
    def state(self) -> Observation:
        """The last observation, which is all that is remembered."""
        return self._seen

    observation = state

    def reset(self, seed: int | None = None) -> Observation:
        """Go back to the unloaded shape at rest and time zero.

        Parameters
        ----------
        seed
            Seed of the noise of sensors; default: the one before.

        Returns
        -------
        Observation
            The unloaded body, with the same bits as that of a new simulator.
        """
        if seed is not None:
            self._seed = _Settings(seed=seed).seed
        all_commands = self._subject.commands.all
        driven = Driven(
            values=tuple(each.first for each in all_commands),
            memories=tuple(each.memory_after(0.0, each.first) for each in all_commands),
            following=frozenset(
                index for index, each in enumerate(all_commands) if each.history is not None
            ),
            moving=frozenset(),
            late=0.0,
            work=MappingProxyType({}),
            power=0.0,
            sensors=SensorState({}, (), ()),
            seed=self._seed,
        )
        self._live = self._made()
        self._live.command(self._subject.inputs(driven, 0.0))
        self._live.reset()
        self._steps = 0
        seen = self._observe(self._live.advance_to(0.0), driven, None)
        if self._sensors is not None:
            started = replace(driven, sensors=self._sensors.start(self._seed, seen))
            seen = self._sampled(replace(seen, _driven=started))
        self._seen = seen
        return seen

    def step(self, commands: Mapping[CommandName, Any] | None = None) -> Observation:
        """Command, and let the body move for one step of time.

        Parameters
        ----------
        commands
            New values by name, see :attr:`commands`: numbers in SI units, texts with units, or pint
            quantities; three components for a vector. Forces, pressures, fields, temperatures,
            flows and valves have them from the beginning of this step on; lengths, angles, volumes
            and masses go to them evenly over the step. All others keep their last values, follow
            their histories until they are commanded, or go on as their flow says. Default: no new
            value.

        Returns
        -------
        Observation
            The body at the end of the step.

        Raises
        ------
        DesignError
            An unknown command, or a value of another unit or shape, not finite or out of bounds;
            the body has not moved.
        SimulationError
            The body has diverged before: only :meth:`reset` or :meth:`restore` leads on.
        """
        if self._seen.status == "diverged":
            raise SimulationError(
                "simulator",
                f"cannot go on from {self._seen.time:g} s: {self._seen.message}",
                "call reset(), then command less or more slowly, or use smaller voxels",
            )
        seen, driven = self._seen, self._seen._driven
        given = self._subject.commands.read({} if commands is None else commands)
        new = self._subject.commands.moved(given, driven.values, self.time_step)
        start = seen._moment.time
        end = (self._steps + 1) * self.time_step - driven.late
        courses, driven = self._changed(driven, new, (start, end))
        if courses:
            self._live.command(courses)
        report = self._live.advance_to(end)
        self._steps += 1
        late = driven.late + (end - report.time) * (report.status != _core.LiveStatus.MOVING)
        values = tuple(
            command.at(report.time) if index in driven.following else value
            for index, (command, value) in enumerate(
                zip(self._subject.commands.all, driven.values, strict=True)
            )
        )
        driven = replace(driven, late=late, values=values)
        found = self._observe(report, driven, seen)
        self._seen = self._sampled(self._counted(found, seen))
        return self._seen

    def restore(self, state: Observation | bytes) -> Observation:
        """Go back to an observation: its state, time, commands and all that it remembers.

        Friction, gas and liquid, softening, viscous stress, the lengths of steps and the noise of
        sensors go on as they were: to the same bits as a motion that was not interrupted, each
        time, in any simulator of the design with the same settings.

        Parameters
        ----------
        state
            An observation of this simulator or of another one of the same design, or the bytes of
            one, see :meth:`Observation.to_bytes`.

        Returns
        -------
        Observation
            ``state``, the last observation from now on.

        Raises
        ------
        SimulationError
            An observation of another design, or with other sensors; bytes that are damaged, or of
            another time step or version of VoxSoft.
        """
        if isinstance(state, bytes):
            state = observation_from(state, self._subject)
        if state._subject.setup.design != self.design:
            raise SimulationError(
                "simulator",
                f"cannot go back to an observation of {state._subject.setup.design.name}",
                "restore observations of the same design only",
            )
        own = self.sensors
        if len(own) != len(state._driven.sensors.drifts):
            raise SimulationError(
                "simulator",
                f"has {len(own)} sensors, and the observation is from one with others",
                "give both the same sensors",
            )
        moment, driven = state._moment, state._driven
        self._live = self._made()
        self._live.command(self._subject.inputs(driven, moment.time))
        self._live.resume(moment.positions, moment.velocities, moment.time, moment.memory)
        self._steps, self._seed, self._seen = state.steps, driven.seed, state
        return state

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the design, the settings and the state; the body is built again."""
        settings = self._settings.model_dump()
        return _rebuilt, (self.design, settings, self.sensors, self._seen.to_bytes())

    def copy(self) -> Simulator:
        """Return another simulator in the same state, which goes on by itself.

        Examples
        --------
        >>> from voxsoft.design import families
        >>> simulator = Simulator(families.cylinder(radius="20 mm", height="30 mm"))
        >>> other = simulator.copy()
        >>> _ = other.step({"pressure": "1 kPa"})
        >>> simulator.state.time, other.state.time
        (0.0, 0.02)
        """
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        other.restore(self._seen)
        return other

    def _made(self) -> _core.Live:
        """Make a run at rest."""
        mesh, settings = self._subject.setup.mesh, self._settings
        return _core.Live(
            self._subject.problem,
            mesh.triangles.astype(np.uint32),
            np.zeros(len(mesh.triangles), np.uint8),
            mesh.voxel_size or 0.0,
            time_step=settings.time_step,
            damping=self._damping,
            retardation=settings.retardation,
            tolerance=settings.tolerance,
            converged=True,
            accuracy=np.inf if settings.accuracy is None else settings.accuracy,
            memory=memory_limit(),
        )

    def _changed(
        self, driven: Driven, new: Mapping[int, Value], span: tuple[float, float]
    ) -> tuple[list[Course], Driven]:
        """Return the inputs of the core that change, and the drives after the step.

        Others are left alone, as they would wake a body at rest.
        """
        values, memories = list(driven.values), list(driven.memories)
        following, moving, courses = set(driven.following), set[int](), list[Course]()
        for index, command in enumerate(self._subject.commands.all):
            value = new.get(index, values[index])
            follows = index in following and index not in new
            if follows or (value == values[index] and index not in driven.moving | following):
                continue
            if index in following:
                following.discard(index)
                memories[index] = command.memory_at(span[0])
            memories[index] = command.memory_after(memories[index], value)
            if command.evenly and value != values[index]:
                courses += command.ramped(values[index], value, span)
                moving.add(index)
            else:
                courses += command.held(value, memories[index])
            values[index] = value
        changed = replace(
            driven,
            values=tuple(values),
            memories=tuple(memories),
            following=frozenset(following),
            moving=frozenset(moving),
        )
        return courses, changed

    def _observe(
        self, report: _core.Advance, driven: Driven, before: Observation | None
    ) -> Observation:
        """Observe the body after an advance."""
        moment = Moment(
            positions=self._live.positions(),
            velocities=self._live.velocities(),
            time=report.time,
            memory=self._live.memory(),
            residual=report.residual,
        )
        own = len(self._subject.setup.mesh.vertices)
        status, message = self._judged(report, moment.positions[:own])
        return Observation.of(
            self._subject,
            moment,
            driven,
            steps=self._steps,
            status=status,
            message=message,
            elastic_energy=report.elastic,
            kinetic_energy=report.kinetic,
            before=None if before is None else before.velocities,
        )

    def _counted(self, seen: Observation, before: Observation) -> Observation:
        """Add the energy that the drives gave in the last step."""
        given = work_after(before, seen)
        power = (sum(given.values()) - sum(before._driven.work.values())) / self.time_step
        driven = replace(seen._driven, work=MappingProxyType(given), power=power)
        return seen.driven_by(driven)

    def _sampled(self, seen: Observation) -> Observation:
        """Sample the sensors."""
        if self._sensors is None:
            return seen
        samples, after = self._sensors.sample(seen._driven.sensors, seen)
        return seen.driven_by(replace(seen._driven, sensors=after), samples)

    def _judged(
        self, report: _core.Advance, positions: np.ndarray[Any, Any]
    ) -> tuple[MotionStatus, str]:
        """Decide the status and its message: sound bodies move or rest, others are reported."""
        if report.status == _core.LiveStatus.DIVERGED and report.breakdown:
            if report.undefined is not None:
                owners = self._subject.commands.load_owners
                return "diverged", undefined_in_words(report.undefined, owners)
            _, place, when = report.breakdown
            point = ", ".join(f"{value * 1e3:.1f}" for value in place)
            what = f"diverged at ({point}) mm, after {when:.6g} s: the loads are too much for it"
            return "diverged", what
        fields = self._subject.fields
        if inverted := fields.inverted(positions):
            return "inverted", f"{inverted:,} of {len(fields.blocks):,} voxels are inside out"
        if report.status == _core.LiveStatus.AT_REST:
            return "at-rest", f"at rest, residual {report.residual:.2g} of the load"
        return "moving", "moving"


def _rebuilt(
    design: Design, settings: Mapping[str, Any], sensors: Sequence[Sensor], state: bytes
) -> Simulator:
    """Make a simulator in a state."""
    found = Simulator(design, sensors=sensors, **settings)
    found.restore(state)
    return found
