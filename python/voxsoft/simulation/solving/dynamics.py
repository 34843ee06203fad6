"""Motion over time: extended position-based dynamics (Algorithm 3 of the paper)."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any, ClassVar, Final

from pydantic import Field

from voxsoft import _core
from voxsoft._core import Status
from voxsoft._memory import memory_limit
from voxsoft.design import Design
from voxsoft.design.solver import Count, Damping, Tolerance
from voxsoft.errors import SimulationError
from voxsoft.simulation.features import has_feature
from voxsoft.simulation.setup.growth import grows_over_time
from voxsoft.simulation.setup.materials import core_materials
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.equilibrium import too_large_a_tangent
from voxsoft.simulation.solving.method import Answer, Method, Report, Watch
from voxsoft.units import NonNegativeTime, PositiveTime, format_quantity

#: Residual at rest of runs over time.
DEFAULT_DYNAMIC_TOLERANCE: Final = 1e-4
DEFAULT_MAX_TIME: Final = 60.0
DEFAULT_TIME_STEP: Final = 0.01
DEFAULT_RECORD_INTERVAL: Final = 0.02


#: Features of designs whose motions are found step by step, each to its tolerance.
_CONVERGED: Final = ("contact", "supplies", "softening", "drag", "force field")


def converges_each_step(design: Design) -> bool:
    """Return True if every step of a motion has to converge.

    States depend on the way to them, or forces on velocities.
    """
    return any(has_feature(design, name) for name in _CONVERGED)


class Dynamics(Method):
    """Motion over time, until the body is at rest or to an end time."""

    family: ClassVar[str] = "dynamics"
    extra: ClassVar[frozenset[str]] = frozenset({"record_interval", "frames"})

    time_step: PositiveTime | None = None
    substeps: Count | None = None
    iterations: Count = 1
    damping: Damping | None = None
    retardation: NonNegativeTime = 0.0

    @property
    @abstractmethod
    def rate(self) -> float | None:
        """The decay rate of velocities in 1/s; None for critical damping."""

    @abstractmethod
    def ends(self) -> dict[str, float]:
        """Return the criteria that end a run, by the key of their setting."""

    def solve(self, setup: Setup, watch: Watch) -> Answer:
        """Move the body from its unloaded state."""
        interval = watch.record_interval or max(DEFAULT_RECORD_INTERVAL, self.time_step or 0.0)
        if setup.tendons or converges_each_step(setup.design):
            return self._by_implicit_steps(setup, watch, interval)
        problem, rate, ends = self._problem(setup), self.rate, self.ends()
        asked: dict[str, Any] = {
            "time_step": self._step(interval),
            "substeps": self.substeps,
            "iterations": self.iterations,
            "damping": rate,
            "retardation": self.retardation,
        }
        answer = problem.simulate(
            **asked,
            end_time=ends.get("end_time"),
            max_time=ends.get("max_time", DEFAULT_MAX_TIME),
            tolerance=ends.get("tolerance", DEFAULT_DYNAMIC_TOLERANCE),
            record_interval=interval,
            sensors=[(place.vertices, place.weights) for place in setup.places.values()],
            frames=watch.frames,
            progress=watch.progress,
        )
        used = {"method": "xpbd", "way": "dynamics", **asked, **ends, "substep": answer.substep}
        return used | {"damping": "critical" if rate is None else rate}, Report.of(answer)

    def _by_implicit_steps(self, setup: Setup, watch: Watch, interval: float) -> Answer:
        """Move the body by implicit steps, which converge contacts, tendons and pressures."""
        problem, rate, ends = self._problem(setup), self.rate, self.ends()
        step = self._step(interval)
        answer = _core.transient(
            problem,
            step=step,
            damping=rate,
            end_time=ends.get("end_time"),
            max_time=ends.get("max_time", DEFAULT_MAX_TIME),
            tolerance=ends.get("tolerance", DEFAULT_DYNAMIC_TOLERANCE),
            retardation=self.retardation,
            record_interval=interval,
            memory=memory_limit(),
            sensors=[(place.vertices, place.weights) for place in setup.places.values()],
            frames=watch.frames,
            progress=watch.progress,
        )
        if answer.status == Status.OUT_OF_MEMORY:
            raise SimulationError(
                "solver.method",
                too_large_a_tangent(len(setup.mesh.vertices), 0),
                "use larger voxels",
            )
        used = {"method": "implicit", "way": "dynamics", "time_step": step, **ends}
        if self.retardation:
            used["retardation"] = self.retardation
        return used | {"damping": "critical" if rate is None else rate}, Report.of(answer)

    @staticmethod
    def _problem(setup: Setup) -> _core.Problem:
        """Return the problem to be stepped: a copy where materials change, which stay changed."""
        if not grows_over_time(setup.design):
            return setup.problem
        own = core_materials(
            setup.design, setup.materials, setup.mesh, setup.origin, over_time=True
        )
        return setup.problem.with_materials(own)

    def _step(self, interval: float) -> float:
        """Return the length of a step in s: probes are recorded after whole steps."""
        if self.time_step is None:
            return min(DEFAULT_TIME_STEP, interval)
        if interval < self.time_step:
            raise SimulationError(
                "record_interval",
                f"is shorter than the time_step of {format_quantity(self.time_step, 'time')}",
                "record after whole steps, or shorten the step",
            )
        return self.time_step


class DynamicsToRest(Dynamics):
    """Motion over time until the body is at rest, damped critically unless a rate is given."""

    title: ClassVar[str] = "dynamics run to rest"

    max_time: PositiveTime = DEFAULT_MAX_TIME
    tolerance: Tolerance = DEFAULT_DYNAMIC_TOLERANCE

    @property
    def rate(self) -> float | None:
        """The decay rate in 1/s; critical damping is right on the way to rest."""
        return self.damping if isinstance(self.damping, float) else None

    def ends(self) -> dict[str, float]:
        """The time after which a body is given up, and the residual at rest."""
        return {"max_time": self.max_time, "tolerance": self.tolerance}


class DynamicsToEnd(Dynamics):
    """Motion over time to an end time, at rest or not, undamped unless a rate is given."""

    title: ClassVar[str] = "dynamics to an end time"
    to_rest: ClassVar[bool] = False

    end_time: PositiveTime = Field()

    @property
    def rate(self) -> float | None:
        """The decay rate in 1/s; critical damping would be wrong over time."""
        if isinstance(self.damping, float):
            return self.damping
        return None if self.damping == "critical" else 0.0

    def ends(self) -> dict[str, float]:
        """The end time."""
        return {"end_time": self.end_time}
