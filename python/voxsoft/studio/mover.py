"""A body in motion: the core's stepper with the loads and grabs of the page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.errors import SimulationError
from voxsoft.studio import events
from voxsoft.studio.body import StudioBody
from voxsoft.studio.message import Triple

#: How far a motion is looked ahead: seconds of it, and vertices times steps of either kind, some
#: 0.05 s of work.
LONGEST_LOOK: Final = 1.0
MOST_WORK: Final = {"explicit": 1_000_000, "implicit": 4_000}
#: Residual at which a body counts as at rest: small beside what a picture shows.
TOLERANCE: Final = 1e-4

#: Steps are whole numbers of frames' times up to rounding.
_ROUNDING: Final = 1e-6

Status = Literal["moving", "at-rest", "diverged"]


@dataclass
class _Grab:
    shown: int
    stiffness: float


@dataclass
class Mover:
    """Steps a body through time.

    Parameters
    ----------
    body
        The body; it must be one that can be solved.
    """

    body: StudioBody
    tolerance: float = TOLERANCE
    steps: int = 0
    time: float = 0.0
    residual: float | None = None
    elastic: float | None = None
    kinetic: float | None = None
    state: Status = "moving"
    breakdown: Triple | None = None
    loads: list[float] = field(default_factory=list)
    _held: dict[int, _Grab] = field(default_factory=dict)
    _due: float = 0.0
    _solved: bool = False

    def __post_init__(self) -> None:
        body, solver = self.body, self.body.setup.design.solver
        self._live = _core.Live(
            body.setup.problem,
            body.mesh.triangles.astype(np.uint32),
            body.surface.tags,
            body.mesh.voxel_size or 0.0,
            substeps=solver.substeps,
            damping=solver.damping if isinstance(solver.damping, float) else None,
            retardation=solver.retardation or 0.0,
            tolerance=self.tolerance,
        )
        self.loads = list(body.load_values)
        self._final = list(self.loads)

    def advance(self, seconds: float, budget: float) -> int:
        """Simulate for some seconds, or for as long as the budget of the clock allows.

        Parts of a step are carried over to the next call.

        Returns
        -------
        int
            Steps that were taken: none where less than one is due.
        """
        if self.implicit:
            self._live.prefer_step(seconds)
        self._due += seconds / self._live.substep
        wanted = int(self._due + _ROUNDING)
        if wanted == 0:
            return 0
        self._due -= wanted
        report = self._live.advance_for(budget, wanted)
        self._take(report)
        return int(report["taken"])

    @property
    def unloaded(self) -> bool:
        """Whether the body has its unloaded shape still."""
        return self.steps == 0 and not self._solved

    @property
    def implicit(self) -> bool:
        """Whether steps are as long as the time between two frames, each solved for its end."""
        return self._live.method == "implicit"

    def time_to_rest(self) -> float | None:
        """Look ahead, unseen, how long the body takes to come to rest from its unloaded shape [s].

        Returns
        -------
        float or None
            None where it has moved already, is pulled, or does not rest soon.
        """
        if not self.unloaded or self._held:
            return None
        work = MOST_WORK[self._live.method] // max(1, len(self.body.mesh.vertices))
        report = self._live.advance(min(work, round(LONGEST_LOOK / self._live.substep)))
        self._live.reset()
        return float(report["time"]) if report["status"] == "at-rest" else None

    def set_load(self, index: int, *, value: float | None, factor: float | None) -> None:
        """Change a load of the design at once, its history or not.

        Raises
        ------
        SimulationError
            There is no such load, or neither or both of value and factor are given.
        """
        if index >= len(self._final):
            raise SimulationError("load", f"there are {len(self._final)} loads, from 0")
        if (value is None) == (factor is None):
            raise SimulationError("load", "needs one of value and factor")
        final = self._final[index]
        if factor is None:
            assert value is not None
            if final == 0.0 and value != 0.0:
                raise SimulationError(
                    "load", "is zero in the design, which leaves its direction open", "set it there"
                )
            factor = value / final if final else 0.0
        for inner in inner_loads(self.body, index):
            self._live.set_load(inner, factor)
        self.loads[index] = factor * final
        self.state = "moving"

    def factors_of(self, loads: Sequence[float]) -> list[float]:
        """How many times as large as in the design some loads are."""
        pairs = zip(loads, self._final, strict=True)
        return [load / final if final else 1.0 for load, final in pairs]

    def grab(self, number: int, vertex: int, target: Triple, stiffness: float, shown: int) -> None:
        """Pull a vertex of the mesh toward a point by a spring; `shown` is its number on the page.

        Raises
        ------
        SimulationError
            A target that is not a point in space.
        """
        if not np.isfinite(target).all():
            raise SimulationError("grab", "the target is not a point")
        self._live.grab(number, vertex, list(target), stiffness)
        self._held[number] = _Grab(shown, stiffness)
        self.state = "moving"

    def release(self, number: int) -> None:
        """Take a spring away, if it is there."""
        if self._live.release(number):
            self._held.pop(number, None)
            self.state = "moving"

    def grabs(self) -> list[events.GrabState]:
        """The springs that pull, and how hard."""
        return [
            events.GrabState(
                id=number,
                vertex=self._held[number].shown,
                target=_triple(target),
                stiffness=self._held[number].stiffness,
                force=_triple(force),
                stretch=stretch,
            )
            for number, _, target, force, stretch in self._live.grabs()
            if number in self._held
        ]

    def reset(self) -> None:
        """Go back to the unloaded shape at time zero; loads are those of the design again."""
        self._live.reset()
        for number in list(self._held):
            self.release(number)
        for index in range(len(self._final)):
            for inner in inner_loads(self.body, index):
                self._live.set_load(inner, None)
        self.loads = list(self._final)
        self.time, self.steps, self.state = 0.0, 0, "moving"
        self._due, self._solved = 0.0, False
        self.residual = self.elastic = self.kinetic = None
        self.breakdown = None

    def go_to_rest(self, positions: NDArray[np.float64], residual: float, elastic: float) -> None:
        """Take the state at rest that a solver found, at the present time."""
        self._live.seek(positions, self.time)
        self.state, self._solved = "at-rest", True
        self.residual, self.elastic, self.kinetic = residual, elastic, 0.0

    def positions(self) -> NDArray[np.float64]:
        """Where the vertices of the mesh are [m]."""
        return self._live.positions()

    def packed(
        self,
        frame: int,
        field: int,
        seq: int,
        flags: int,
        display: _core.Display | None = None,
    ) -> bytes:
        """The present state as the page reads it."""
        return self._live.pack_frame(
            self.body.topology, frame & 0xFFFF_FFFF, field, seq & 0xFFFF_FFFF, flags, display
        )

    def _take(self, report: dict[str, Any]) -> None:
        self.state, self.time, self.steps = report["status"], report["time"], report["substeps"]
        self.residual, self.elastic = _finite(report["residual"]), _finite(report["elastic"])
        self.kinetic = _finite(report["kinetic"])
        found = report["breakdown"]
        self.breakdown = None if found is None else _triple(found[1])


def inner_loads(body: StudioBody, index: int) -> range:
    """The core's loads that one load of the design became: one for each cavity."""
    counts = [len(load.actions) for load in body.setup.loads]
    first = sum(counts[:index])
    return range(first, first + counts[index])


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _triple(values: Any) -> Triple:  # noqa: ANN401 - any three numbers
    x, y, z = (float(value) for value in values)
    return (x, y, z)
