"""Relaxation, and the choice between it and statics for designs that both can solve.

A step of relaxation is cheap, and their number grows with the slenderness of the body: 100 for a
squat cylinder, 30,000 for a thin plate. Statics costs about as much as some thousand steps of
relaxation on any body (`benchmarks/time_to_rest.py`). So relaxation begins, and the residual after
`TRIAL_STEPS` predicts how long it would take.
"""

from __future__ import annotations

from typing import Any, ClassVar, Final, Literal

from voxsoft import _core
from voxsoft.design.solver import Tolerance
from voxsoft.errors import SimulationError
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.equilibrium import LoadControl, find_equilibrium
from voxsoft.simulation.solving.method import Answer, Method, Progress, Report, Watch

#: With 1e-4 the rises of 2 of the paper's 45 closed cylinders, small beside the bulge of their
#: walls, were off by 0.17 and 0.22 %; with 1e-5 none is by more than 0.012 %, for a fifth more
#: steps.
DEFAULT_TOLERANCE: Final = 1e-5
DEFAULT_MAX_STEPS: Final = 400_000

#: Steps of relaxation after which a body that is not at rest shows how slow it is.
TRIAL_STEPS: Final = 200
#: Statics takes over where more than this part of the load is still out of balance then. On bars
#: and plates it is 0.51 where relaxation takes 1,700 steps, 0.60 with 3,300, 0.62 with 3,800 to
#: 4,600 and 0.70 with 6,900; statics was found to cost as much as 2,000 to 7,000 steps on plates,
#: robots and beams.
SLOW_RESIDUAL: Final = 0.6


class Relaxation(Method):
    """Dynamic relaxation to rest; it has no physical time, and adapts its damping step by step."""

    title: ClassVar[str] = "relaxation"
    family: ClassVar[str] = "relaxation"

    tolerance: Tolerance = DEFAULT_TOLERANCE
    damping: Literal["auto"] = "auto"

    def solve(self, setup: Setup, watch: Watch) -> Answer:
        """Bring a setup to rest."""
        return self.go_on(setup, watch.progress, None)

    def go_on(self, setup: Setup, progress: Progress, trial: _core.Answer | None) -> Answer:
        """Bring a setup to rest from where a trial ended."""
        taken = trial.steps if trial else 0
        later = setup.problem.relax(
            tolerance=self.tolerance,
            max_steps=DEFAULT_MAX_STEPS - taken,
            start=trial.positions if trial else None,
            progress=_counted_from(taken, progress),
        )
        return _used(self.tolerance), Report.of(later, taken)


class QuickestRest(Method):
    """Relaxation, or statics under load control where that would take long.

    The choice depends on the body and the load alone, never on the clock: the same design gives the
    same bits. Prescribed motions, which relaxation brings up slowly, are left to it. Where statics
    finds no stable equilibrium relaxation resumes from its last state.
    """

    title: ClassVar[str] = "the quickest way to rest"
    family: ClassVar[str] = "relaxation or statics"

    #: Residual at rest; None for the default of each method.
    tolerance: Tolerance | None = None

    def solve(self, setup: Setup, watch: Watch) -> Answer:
        """Bring a setup to rest."""
        progress = watch.progress
        given = {} if self.tolerance is None else {"tolerance": self.tolerance}
        relaxation = Relaxation(**given)
        if any(clamp.motion is not None for clamp in setup.design.clamps):
            return relaxation.solve(setup, watch)
        trial = setup.problem.relax(
            tolerance=relaxation.tolerance,
            max_steps=DEFAULT_MAX_STEPS,
            trial=(TRIAL_STEPS, SLOW_RESIDUAL),
            progress=progress,
        )
        if trial.status != _core.Status.SLOW:
            return _used(relaxation.tolerance), Report.of(trial)
        counted = _counted_from(trial.steps, progress)
        try:
            used, report = find_equilibrium(setup, LoadControl(**given), counted)
        except SimulationError:  # its tangent does not fit in memory
            return relaxation.go_on(setup, progress, trial)
        path = report.answer.path
        if report.status == _core.Status.AT_REST and path is not None and path.stable:
            return {**used, "trial_steps": trial.steps}, report
        return relaxation.go_on(setup, progress, trial)


def _used(tolerance: float) -> dict[str, Any]:
    """Return the settings of relaxation as used; it adapts its damping step by step."""
    used = {"method": "xpbd", "way": "relaxation", "tolerance": tolerance}
    return {**used, "damping": "auto", "max_steps": DEFAULT_MAX_STEPS}


def _counted_from(taken: int, progress: Progress) -> Progress:
    if progress is None or taken == 0:
        return progress
    return lambda steps, time, residual: progress(taken + steps, time, residual)
