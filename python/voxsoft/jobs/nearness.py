"""How near to its end a search for rest is."""

from __future__ import annotations

import math

from voxsoft.design import Solver
from voxsoft.simulation.rest import DEFAULT_TOLERANCE


def digits_lost(residual: float, largest: float, tolerance: float = DEFAULT_TOLERANCE) -> float:
    """The part of the digits that a residual must lose until rest, and has lost.

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
    """The part of a run that is done: of its end time, or of the digits of its residual."""

    def __init__(self, solver: Solver) -> None:
        self._end = solver.end_time
        self._tolerance = solver.tolerance or DEFAULT_TOLERANCE
        self._largest = 0.0

    def at(self, time: float, residual: float) -> float:
        """Return the part that is done, from 0 to 1."""
        if self._end:
            return min(1.0, time / self._end)
        if math.isfinite(residual):
            self._largest = max(self._largest, residual)
        return digits_lost(residual, self._largest, self._tolerance)
