"""Progress of a search for equilibrium toward its end."""

from __future__ import annotations

import math

from voxsoft.design import Solver
from voxsoft.simulation.solving.rest import DEFAULT_TOLERANCE


def digits_lost(residual: float, largest: float, tolerance: float = DEFAULT_TOLERANCE) -> float:
    """Return the share of the digits a residual must lose until rest that it has lost.

    A residual falls by about the same factor in the same time.

    Examples
    --------
    >>> round(digits_lost(1e-3, 1e-1), 2), digits_lost(1e-6, 1.0)
    (0.5, 1.0)
    """
    if not largest > residual > 0:
        return 0.0
    if largest <= tolerance:
        return 1.0
    lost = math.log(largest / residual) / math.log(largest / tolerance)
    return min(1.0, max(0.0, lost))


class Nearness:
    """Share of a run that is done: of its end time, its load, or the digits of its residual.

    Parameters
    ----------
    solver
        Settings of the solver.
    of_loads
        True if the solver reports the load that it has reached, as statics does.

    Examples
    --------
    >>> nearness = Nearness(Solver(), of_loads=True)
    >>> nearness.at(0.5, 1e-6), nearness.at(0.5, 0.9), nearness.at(0.25, 0.9)
    (0.5, 0.5, 0.5)
    """

    def __init__(self, solver: Solver, *, of_loads: bool = False) -> None:
        self._end, self._of_loads = solver.end_time, of_loads
        self._tolerance = solver.tolerance or DEFAULT_TOLERANCE
        self._largest = self._share = 0.0

    def at(self, time: float, residual: float) -> float:
        """Return the share that is done, from 0 to 1; it never falls.

        In statics it is the share of the load that was reached, which is reported as the time.
        """
        self._share = max(self._share, self._now(time, residual))
        return self._share

    def _now(self, time: float, residual: float) -> float:
        if self._end:
            return min(1.0, time / self._end)
        if self._of_loads:
            return min(1.0, max(0.0, time))
        if math.isfinite(residual):
            self._largest = max(self._largest, residual)
        return digits_lost(residual, self._largest, self._tolerance)
