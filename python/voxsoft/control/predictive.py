"""Model-predictive control by a step response."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from voxsoft.control.step import StepResponse
from voxsoft.errors import DesignError

Floats = NDArray[np.float64]


class PredictiveController:
    """Dynamic matrix control: the commands that keep the next values nearest to their targets.

    Each step predicts the quantity by a measured step response, corrected by the last prediction's
    error, chooses the next commands by bounded least squares, and gives the first of them (Cutler
    and Ramaker 1980, doi 10.1109/JACC.1980.4232009). Constant disturbances leave no error.

    Parameters
    ----------
    response
        Step response, long enough to settle: its steps are those of the loop.
    horizon
        Steps that are predicted; default: those of the settling time.
    moves
        Commands that are chosen; the last one holds. Default 10.
    effort
        Weight of a change of the command against an error, relative to the change of the quantity
        at rest by it; default 0.1.
    low, high
        Bounds of the command; default: 0 and none.

    Raises
    ------
    DesignError
        A horizon longer than the response, or bounds in the wrong order.

    Examples
    --------
    >>> times = 0.1 * np.arange(60)
    >>> lag = StepResponse("u", "y", "number", 0.0, 1.0, times, 2.0 * (1.0 - np.exp(-times)))
    >>> controller = PredictiveController(lag, high=3.0)
    >>> controller.start(step=0.1)
    >>> value = 0.0
    >>> for _ in range(100):
    ...     given = controller.command([1.0] * controller.preview, value)
    ...     value += (2.0 * given + 0.5 - value) * (1.0 - np.exp(-0.1))  # disturbed
    >>> round(float(value), 4), round(given, 4)
    (1.0, 0.25)
    """

    def __init__(
        self,
        response: StepResponse,
        *,
        horizon: int | None = None,
        moves: int = 10,
        effort: float = 0.1,
        low: float = 0.0,
        high: float = math.inf,
    ) -> None:
        steps = (response.values - response.values[0]) / (response.after - response.before)
        longest = len(steps) - 1
        if horizon is None:
            step = float(response.times[1] - response.times[0])
            horizon = min(max(round(response.settling_time / step), moves), longest)
        if not 0 < horizon <= longest:
            raise DesignError(
                "horizon", f"{horizon} of {longest} steps of the response", "watch it longer"
            )
        if not low < high:
            raise DesignError("low", f"{low:g} is not below {high:g}", "give low < high")
        self.preview, self.low, self.high = horizon, low, high
        self._period = float(response.times[1] - response.times[0])
        self._steps = np.asarray(steps[1:], dtype=np.float64)
        moves = min(moves, horizon)
        # Values by changes of the command, and changes by commands.
        by_changes = np.zeros((horizon, moves))
        for move in range(moves):
            by_changes[move:, move] = self._steps[: horizon - move]
        changes = np.eye(moves) - np.eye(moves, k=-1)
        weight = math.sqrt(effort) * abs(response.gain)
        self._matrix = np.vstack([by_changes @ changes, weight * changes])
        self._by_first, self._weight = by_changes[:, 0], weight
        self.start(self._period)

    def __repr__(self) -> str:
        return f"<PredictiveController over {self.preview} steps>"

    def start(self, step: float, measured: float = 0.0, command: float = 0.0) -> None:
        """Begin a loop at rest: see :meth:`PIDController.start`.

        Raises
        ------
        DesignError
            Steps of another length than those of the response.
        """
        if abs(step - self._period) > 1e-9 * step:
            raise DesignError(
                "response", f"has steps of {self._period:g} s, the loop {step:g} s", "measure again"
            )
        self._free = np.full(len(self._steps), measured)
        self._last = command

    def command(self, ahead: Floats | list[float], measured: float) -> float:
        """Return the command for the next step; `ahead` has the targets of `preview` steps."""
        from scipy.optimize import lsq_linear

        self._free += measured - self._free[0]
        coming = np.append(self._free[1:], self._free[-1])
        targets = np.asarray(ahead, dtype=np.float64)[: self.preview]
        side = targets - coming[: self.preview] + self._by_first * self._last
        smooth = np.zeros(self._matrix.shape[1])
        smooth[0] = self._weight * self._last
        size = max(abs(self._by_first[-1]), abs(self._weight), 1e-300)
        found = lsq_linear(
            self._matrix / size,
            np.concatenate([side, smooth]) / size,
            bounds=(self.low, self.high),
            tol=1e-12,
        )
        given = float(np.clip(found.x[0], self.low, self.high))
        self._free = coming + self._steps * (given - self._last)
        self._last = given
        return given
