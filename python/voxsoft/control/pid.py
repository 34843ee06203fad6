"""PID controller with anti-windup and feed-forward."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from voxsoft.control.step import StepResponse
from voxsoft.errors import DesignError

Floats = NDArray[np.float64]


class PIDController:
    """PID controller in continuous form, sampled once a step.

    The output is ``feedforward(r) + K (e + ∫e dt / Ti − Td dy/dt)`` of the error ``e = r − y``,
    within its bounds. The derivative is that of the measured value, so that steps of the target do
    not kick, filtered over a tenth of ``Td`` at least one step long. At a bound the integral is
    drawn back by the excess (back-calculation; Åström and Hägglund, Advanced PID Control, 2006,
    section 3.5).

    Parameters
    ----------
    gain
        ``K``: command per error, SI units.
    integral_time
        ``Ti`` in s; infinite (default) without an integral.
    derivative_time
        ``Td`` in s; default 0.
    low, high
        Bounds of the command; default: none.
    feedforward
        Command by the target alone, added to that of the error; default: none.

    Raises
    ------
    DesignError
        A time that is not positive, or bounds in the wrong order.

    Examples
    --------
    >>> controller = PIDController(gain=2.0, integral_time=1.0, high=3.0)
    >>> controller.start(step=0.1)
    >>> [controller.command([1.0], 0.0), controller.command([1.0], 0.5)]
    [2.0, 1.2]
    """

    preview = 1

    def __init__(
        self,
        gain: float,
        integral_time: float = math.inf,
        derivative_time: float = 0.0,
        *,
        low: float = -math.inf,
        high: float = math.inf,
        feedforward: Callable[[float], float] | None = None,
    ) -> None:
        if not integral_time > 0.0:
            raise DesignError("integral_time", f"{integral_time:g} s", "give a positive time")
        if not derivative_time >= 0.0:
            raise DesignError("derivative_time", f"{derivative_time:g} s", "give zero or more")
        if not low < high:
            raise DesignError("low", f"{low:g} is not below {high:g}", "give low < high")
        self.gain, self.integral_time, self.derivative_time = gain, integral_time, derivative_time
        self.low, self.high, self.feedforward = low, high, feedforward
        self.start(1.0)

    def __repr__(self) -> str:
        times = f"Ti={self.integral_time:.4g} s, Td={self.derivative_time:.4g} s"
        return f"<PIDController K={self.gain:.4g}, {times}>"

    @classmethod
    def tuned(
        cls,
        response: StepResponse,
        *,
        closed_loop_time: float | None = None,
        low: float = 0.0,
        high: float = math.inf,
        feedforward: Callable[[float], float] | None = None,
    ) -> PIDController:
        """Return a PI controller for a step response, by the SIMC rules.

        ``K = τ/(k (τc + θ))``, ``Ti = min(τ, 4 (τc + θ))`` for the gain ``k``, time constant ``τ``
        and delay ``θ`` of :attr:`StepResponse.first_order` (Skogestad 2003,
        doi 10.1016/S0959-1524(02)00062-8); half a step is added to the delay for the sampling.

        Parameters
        ----------
        response
            The step response.
        closed_loop_time
            Wanted time constant ``τc`` of the closed loop in s; default: the delay, which is the
            quickest that is robust.
        low, high, feedforward
            See :class:`PIDController`; `low` is 0 by default, as most drives only push.
        """
        gain, constant, delay = response.first_order
        step = float(response.times[1] - response.times[0])
        delay += 0.5 * step
        wanted = delay if closed_loop_time is None else closed_loop_time
        constant = max(constant, 0.5 * step)
        return cls(
            constant / (gain * (wanted + delay)),
            min(constant, 4.0 * (wanted + delay)),
            low=low,
            high=high,
            feedforward=feedforward,
        )

    def start(self, step: float, measured: float | None = None, command: float = 0.0) -> None:
        """Begin a loop: forget all errors.

        Parameters
        ----------
        step
            Seconds between two calls of :meth:`command`.
        measured
            Quantity at the start; default: that of the first call.
        command
            Command at the start, from which an integral goes on.
        """
        self._step, self._last, self._slope = step, measured, 0.0
        given = self.feedforward is not None and measured is not None
        already = self.feedforward(measured) if given else 0.0  # type: ignore[misc, arg-type]
        self._sum = command - already if math.isfinite(self.integral_time) else 0.0

    def command(self, ahead: Floats | list[float], measured: float) -> float:
        """Return the command for the next step.

        Parameters
        ----------
        ahead
            Targets at the end of the next steps; the first counts.
        measured
            The quantity now.
        """
        target, step = float(ahead[0]), self._step
        if self._last is None:
            self._last = measured
        smoothing = max(self.derivative_time / 10.0, step)
        slope = (measured - self._last) / step
        self._slope += step / smoothing * (slope - self._slope)
        self._last = measured
        error = target - measured
        ahead_of_errors = 0.0 if self.feedforward is None else self.feedforward(target)
        wanted = ahead_of_errors + self._sum
        wanted += self.gain * (error - self.derivative_time * self._slope)
        given = min(max(wanted, self.low), self.high)
        self._sum += self.gain * error * step / self.integral_time
        if math.isfinite(self.integral_time):
            self._sum += (given - wanted) * min(step / self.integral_time, 1.0)
        return given
