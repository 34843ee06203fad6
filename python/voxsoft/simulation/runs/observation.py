"""Observation of a body in motion at one moment."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, TypedDict

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.simulation.results.result import Result, Status
from voxsoft.simulation.runs.commands import LoadCommands, Value
from voxsoft.simulation.runs.state import measured_result, result_at
from voxsoft.simulation.setup.contact import ContactState, Pose
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.dynamics import converges_each_step

Floats = NDArray[np.float64]
#: ``inverted``: voxels are inside out, so that stress and volume mean nothing there.
MotionStatus = Literal["moving", "at-rest", "inverted", "diverged"]


class _Known(TypedDict):
    """Facts of a state that its simulator knows."""

    status: Status
    message: str
    time: float


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
    """

    name: str
    volume: float
    pressure: float


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

    def measured(self, problem: _core.Problem) -> _core.Answer:
        """Measure forces, contacts and chambers under the loads of a problem on the body."""
        return problem.measure(
            self.positions, self.velocities, self.time, self.memory, self.residual
        )


@dataclass(frozen=True, repr=False)
class Observation:
    """A body at one moment of a :class:`~voxsoft.Simulator`; it stays as the body moves on.

    Attributes
    ----------
    time
        Since the reset, s: the steps taken, times their length.
    steps
        Steps taken since the reset.
    status
        ``moving``; ``at-rest`` under loads that stay; ``inverted``: voxels are inside out; or
        ``diverged``: no sound state was found from here on, and positions are the last sound ones.
    message
        The status in a sentence.
    positions, velocities
        Vertex positions and velocities, (n, 3), m and m/s; read-only copies.
    probes
        Displacement of each probe by name, (3,), m.
    chambers
        All cavities, the largest first.
    loads
        Values of the loads by name, in SI units, as they act.
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
    chambers: tuple[ChamberState, ...]
    loads: Mapping[str, Value]
    residual: float
    elastic_energy: float
    kinetic_energy: float
    _moment: Moment = field(compare=False)
    _setup: Setup = field(compare=False)
    _commands: LoadCommands = field(compare=False)
    _values: Mapping[int, Value] = field(compare=False)
    #: Seconds by which the state is later than its time.
    _ahead: float = field(compare=False)

    def __repr__(self) -> str:
        return f"<Observation at {self.time:g} s: {self.status}>"

    @cached_property
    def result(self) -> Result:
        """Result of the state under its loads; made on demand."""
        statuses: dict[MotionStatus, Status] = {"at-rest": "ok", "diverged": "diverged"}
        setup = Setup(self._commands.under(self._setup.design, self._values), self._setup.mesh)
        known: _Known = {
            "status": statuses.get(self.status, "not-at-rest"),
            "message": self.message,
            "time": self.time,
        }
        if not converges_each_step(setup.design):
            return result_at(setup, self.positions, **known)
        return measured_result(setup, self._moment.measured(setup.problem), **known)

    @property
    def contacts(self) -> tuple[ContactState, ...]:
        """Contact of each pair of surfaces that may touch; made on demand."""
        return self.result.contacts

    @property
    def objects(self) -> Mapping[str, Pose]:
        """Pose of each object by its name; made on demand."""
        return self.result.objects

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
