"""A body that moves step by step under loads that are commanded as it goes."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil
from typing import Annotated, Any, Final, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag

from voxsoft import _core
from voxsoft._memory import memory_limit
from voxsoft.design import Design, require_design
from voxsoft.errors import SimulationError
from voxsoft.records import Record
from voxsoft.simulation.compatibility import refuse
from voxsoft.simulation.results.fields import fields_of
from voxsoft.simulation.runs.commands import LoadCommands, LoadName, Value
from voxsoft.simulation.runs.observation import ChamberState, Moment, MotionStatus, Observation
from voxsoft.simulation.setup.large_voxels import evenly_small
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.dynamics import converges_each_step
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


class Simulator:
    """A design in motion: command its loads, step, observe.

    Parameters
    ----------
    design
        A design whose loads have no histories. Motions of clamps follow their histories.
    time_step
        Seconds of each :meth:`step`, which takes as many smaller ones inside as the body needs;
        default 0.02.
    damping
        Decay rate of velocities in 1/s, or ``"critical"`` (default): as much as keeps the slowest
        mode from swinging, which comes to rest soon. 0 leaves the material's own.
    retardation
        Retardation time of the material, s; default 0.
    tolerance
        Residual force at rest, relative to the load; default 1e-4.

    Raises
    ------
    DesignError
        A design that cannot be built, a load with a history, or a setting that cannot be read.

    Notes
    -----
    Identical commands give identical bits, for any number of threads and after a :meth:`reset`.
    The design's `solver` is for :func:`~voxsoft.simulate` and not used here. With contact,
    supplies or softening, every step converges by Newton's method, as in
    :func:`~voxsoft.simulate` over time, which takes longer. Supplies act as the design says.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> simulator = vs.Simulator(families.cylinder(radius="20 mm", height="30 mm"))
    >>> simulator.loads
    ('pressure',)
    >>> seen = simulator.step({"pressure": "1 kPa"})
    >>> round(seen.time, 3), seen.status, bool(seen.probes["top"][2] > 0)
    (0.02, 'moving', True)
    """

    def __init__(
        self,
        design: Design,
        *,
        time_step: float | str = TIME_STEP,
        damping: float | str = "critical",
        retardation: float | str = 0.0,
        tolerance: float = TOLERANCE,
    ) -> None:
        design = require_design(design, "design").assembled
        refuse(design, "simulator")
        design = evenly_small(design, design.solver.refine)
        given: dict[str, Any] = {"damping": damping, "retardation": retardation}
        self._settings = _Settings(time_step=time_step, tolerance=tolerance, **given)
        self._commands = LoadCommands(design)
        self._setup = Setup.of(design, allow_loose=True)
        self._pressed = self._commands.pressures(self._setup)
        self._of_size_one = Setup(self._commands.of_size_one(design), self._setup.mesh)
        self._cores = self._commands.core_loads(self._of_size_one)
        self._state = self.reset()

    def __repr__(self) -> str:
        return f"<Simulator of {self.design.name}: {self._state.status} at {self._state.time:g} s>"

    @property
    def design(self) -> Design:
        """The design in motion."""
        return self._setup.design

    @property
    def loads(self) -> tuple[str, ...]:
        """Names of the loads, in the order of the design.

        The chamber of a pressure, else the kind of the load; its place, ``"loads[0]"``, where that
        would mean several. Each load may also be called by its place, or by its index alone.
        """
        return self._commands.names

    @property
    def time_step(self) -> float:
        """Length of each step in s."""
        return self._settings.time_step

    @property
    def state(self) -> Observation:
        """The last observation."""
        return self._state

    def reset(self) -> Observation:
        """Go back to the unloaded shape at rest and time zero.

        Gravity acts from here on as the design says; all other loads are zero until commanded.

        Returns
        -------
        Observation
            The unloaded body, with the same bits as that of a new simulator.
        """
        self._start()
        self._command(self._commands.at_first)
        self._steps, self._time, self._ahead = 0, 0.0, 0.0
        self._state = self._observe(None)
        return self._state

    def step(self, loads: Mapping[LoadName, Any] | None = None) -> Observation:
        """Command loads, and let the body move for one step of time.

        Parameters
        ----------
        loads
            New values by name or index, from the beginning of this step on: numbers in SI units,
            texts with units, or pint quantities; three components for a force. Loads that are not
            named keep their last values. Default: all do.

        Returns
        -------
        Observation
            The body at the end of the step.

        Raises
        ------
        DesignError
            An unknown load, or a value of another unit or not finite; the body has not moved.
        SimulationError
            The body has diverged before: only :meth:`reset` leads on.
        """
        if self._state.status == "diverged":
            raise SimulationError(
                "simulator",
                f"has diverged at {self._state.time:g} s and cannot go on",
                "call reset(), then command less or more slowly, or use smaller voxels",
            )
        new = self._commands.read({} if loads is None else loads)
        self._command({at: to for at, to in new.items() if to != self._values[at]})
        report = self._advance()
        self._steps += 1
        self._state = self._observe(report)
        return self._state

    def restore(self, seen: Observation) -> Observation:
        """Go back to an observation: its state, its time, its loads and its memory.

        Friction, gas and liquid, softening and viscous stress of rubber go on as they were. Motion
        from here on has the same bits each time, in any simulator of the design with the same
        settings. With contact, supplies or softening these are the bits of a motion that was not
        interrupted; without, both agree to the tolerance of a step.

        Parameters
        ----------
        seen
            An observation of this simulator or of another one of the same design.

        Returns
        -------
        Observation
            ``seen``, the last observation from now on.

        Raises
        ------
        SimulationError
            An observation of another design.
        """
        if seen._setup.design != self.design:
            raise SimulationError(
                "simulator",
                f"cannot go back to an observation of {seen._setup.design.name}",
                "restore observations of the same design only",
            )
        self._start()
        self._command(seen._values)
        moment = seen._moment
        self._live.resume(moment.positions, moment.velocities, moment.time, moment.memory)
        self._steps, self._time, self._ahead = seen.steps, moment.time, seen._ahead
        self._state = seen
        return seen

    def _start(self) -> None:
        """Make a run at rest: a new one, because a step that was halved stays so in the old one."""
        mesh, settings = self._setup.mesh, self._settings
        self._live = _core.Live(
            self._of_size_one.problem,
            mesh.triangles.astype(np.uint32),
            np.zeros(len(mesh.triangles), np.uint8),
            mesh.voxel_size or 0.0,
            time_step=settings.time_step,
            damping=settings.damping if isinstance(settings.damping, float) else None,
            retardation=settings.retardation,
            tolerance=settings.tolerance,
            converged=converges_each_step(self.design),
            memory=memory_limit(),
        )
        if self._live.method == "implicit":
            self._live.prefer_step(settings.time_step)
            parts = ceil(settings.time_step / self._live.substep * (1.0 - 1e-9))
            self._live.prefer_step(settings.time_step / parts)
        self._values: dict[int, Value] = {}

    def _command(self, values: Mapping[int, Value]) -> None:
        """Apply changed loads; others are left alone, as they would wake a body at rest."""
        for index, value in values.items():
            sizes = value if isinstance(value, tuple) else (value,)
            for cores, size in zip(self._cores[index], sizes, strict=True):
                for core in cores:
                    self._live.set_load(core, size)
        self._values = {**self._values, **values}

    def _advance(self) -> _core.Advance:
        """Take inner steps until the end of the step, to the nearest of them; fewer at rest."""
        goal = self._time - self._ahead + self._settings.time_step
        report = self._live.advance(0)
        while report.status == _core.LiveStatus.MOVING:
            count = round((goal - report.time) / report.substep)
            if count < 1:
                break
            report = self._live.advance(count)
        self._time = report.time
        self._ahead = self._time - goal if report.status == _core.LiveStatus.MOVING else 0.0
        return report

    def _observe(self, report: _core.Advance | None) -> Observation:
        """Observe the body after an advance; None for its initial state."""
        mesh = self._setup.mesh
        moment = Moment(
            positions=self._live.positions(),
            velocities=self._live.velocities(),
            time=report.time if report else 0.0,
            memory=self._live.memory(),
            residual=report.residual if report else np.inf,
        )
        own = len(mesh.vertices)
        positions, velocities = moment.positions[:own], moment.velocities[:own]
        moved = positions - mesh.vertices
        status, message = self._judged(report, positions)
        return Observation(
            time=self._steps * self._settings.time_step,
            steps=self._steps,
            status=status,
            message=message,
            positions=positions,
            velocities=velocities,
            probes={
                name: place.weights @ moved[place.vertices]
                for name, place in self._setup.places.items()
            },
            chambers=tuple(
                ChamberState(cavity.name, float(cavity.volume_at(positions)), pressure)
                for cavity, pressure in zip(mesh.cavities, self._pressures(moment), strict=True)
            ),
            loads=self._commands.named(self._values),
            residual=moment.residual,
            elastic_energy=report.elastic if report else 0.0,
            kinetic_energy=report.kinetic if report else 0.0,
            _moment=moment,
            _setup=self._setup,
            _commands=self._commands,
            _values=dict(self._values),
            _ahead=self._ahead,
        )

    def _judged(
        self, report: _core.Advance | None, positions: np.ndarray[Any, Any]
    ) -> tuple[MotionStatus, str]:
        """Decide the status and its message: sound bodies move or rest, others are reported."""
        if report and report.status == _core.LiveStatus.DIVERGED and report.breakdown:
            _, place, when = report.breakdown
            point = ", ".join(f"{value * 1e3:.1f}" for value in place)
            what = f"diverged at ({point}) mm, after {when:.6g} s: the loads are too much for it"
            return "diverged", what
        fields = fields_of(self.design, self._setup.mesh, positions, self._of_size_one.problem)
        inverted = int((fields.volume_ratio <= 0.0).sum())
        if inverted:
            return "inverted", f"{inverted:,} of {len(fields.volume_ratio):,} voxels are inside out"
        if report and report.status == _core.LiveStatus.AT_REST:
            return "at-rest", f"at rest, residual {report.residual:.2g} of the load"
        return "moving", "moving"

    def _pressures(self, moment: Moment) -> list[float]:
        """Sum the gauge pressures that act in each cavity."""
        pressures = [0.0] * len(self._setup.mesh.cavities)
        for index, cavities in self._pressed:
            value = self._values[index]
            assert isinstance(value, float)
            for cavity in cavities:
                pressures[cavity] += value
        if (fluids := self._setup.fluids) is not None:
            answer = moment.measured(self._setup.problem)
            for supplied in fluids.states(answer.chambers):
                for cavity in supplied.cavities:
                    pressures[cavity] = supplied.pressure
        return pressures
