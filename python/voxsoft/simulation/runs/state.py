"""Result of a given state of a body, in which no solver ended."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.errors import SimulationError
from voxsoft.simulation.compatibility import refuse
from voxsoft.simulation.results.result import Result, Status
from voxsoft.simulation.runs.run import result_of
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.method import Report

#: Tolerance that every state meets: nothing is solved.
_ANY: float = 1e300


def result_at(
    setup: Setup,
    positions: NDArray[np.float64],
    *,
    status: Status = "not-at-rest",
    message: str = "a state, as it stands",
    time: float = 0.0,
) -> Result:
    """Measure a state under the loads of its design in their final size; nothing is solved.

    Parameters
    ----------
    setup
        The body.
    positions
        Vertex positions in m, (n, 3).
    status, message
        Status and message of the result.
    time
        Time of the state [s].

    Returns
    -------
    Result
        Forces, residual, metrics and warnings of these positions.

    Raises
    ------
    SimulationError
        Positions that are not finite.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.simulation import simulate
    >>> setup = Setup.of(families.beam())
    >>> found = simulate(setup)
    >>> halfway = result_at(setup, setup.mesh.vertices + found.displacements / 2)
    >>> round(halfway.metrics["sag"] / found.metrics["sag"], 3), halfway.residual > 1.0
    (0.5, True)
    """
    if not np.isfinite(positions).all():
        raise SimulationError("state", "holds positions that are not finite", "go back before it")
    refuse(setup.design, "unsolved states")
    answer = setup.problem.relax(tolerance=_ANY, max_steps=0, start=positions)
    return measured_result(setup, answer, status=status, message=message, time=time)


def measured_result(
    setup: Setup, answer: _core.Answer, *, status: Status, message: str, time: float
) -> Result:
    """Wrap the core's measures of a state, in which no solver ended, in a :class:`Result`."""
    used = {"method": "none", "way": "as it stands"}
    measured = result_of(setup, used, Report.of(answer), seconds=0.0)
    return replace(measured, status=status, message=message, time=time)
