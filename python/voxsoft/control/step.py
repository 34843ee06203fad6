"""Step response: how a quantity follows a sudden change of a command."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from voxsoft.control.signals import Output, Response, command_value, moved, quantity_named
from voxsoft.errors import SimulationError
from voxsoft.simulation.runs.simulator import Simulator
from voxsoft.units import si_value

Floats = NDArray[np.float64]

#: Band around the last value within which a response counts as settled.
_BAND = 0.02
#: Parts of the change at which a first-order response with a delay is read, and the delay and time
#: constant by the two times (Sundaresan and Krishnaswamy 1978, doi 10.1002/cjce.5450560215).
_READ = (0.353, 0.853)
_DELAY, _CONSTANT = (1.3, -0.29), 0.67


@dataclass(frozen=True, eq=False)
class StepResponse(Response):
    """Response of a quantity to a step of a command, see :class:`Response`.

    Attributes
    ----------
    before, after
        Values of the command, SI units.
    times
        Times since the step in s, from 0 on, (n,).
    values
        Values of the quantity at these times, SI units, (n,).
    """

    before: float
    after: float
    times: Floats
    values: Floats

    @property
    def change(self) -> float:
        """Change of the quantity, to the end of the response."""
        return float(self.values[-1] - self.values[0])

    @property
    def gain(self) -> float:
        """Change of the quantity over that of the command."""
        return self.change / (self.after - self.before)

    @property
    def overshoot(self) -> float:
        """Largest excess over the last value, as a part of the change; 0 without one."""
        return max(float(np.max(self._parts)) - 1.0, 0.0)

    @property
    def rise_time(self) -> float:
        """Time from 10 to 90 % of the change, s."""
        return self._time_at(0.9) - self._time_at(0.1)

    @property
    def settling_time(self) -> float:
        """Time after which the quantity stays within 2 % of the change around its last value, s."""
        outside = np.flatnonzero(np.abs(self._parts - 1.0) > _BAND)
        return float(self.times[outside[-1] + 1]) if outside.size else 0.0

    @property
    def first_order(self) -> tuple[float, float, float]:
        """Gain, time constant and delay (s) of the first-order response with a delay nearest to it.

        Read from the times at 35.3 and 85.3 % of the change (Sundaresan and Krishnaswamy 1978,
        doi 10.1002/cjce.5450560215).
        """
        early, late = (self._time_at(part) for part in _READ)
        delay = _DELAY[0] * early + _DELAY[1] * late
        return self.gain, _CONSTANT * (late - early), max(delay, 0.0)

    @property
    def _parts(self) -> Floats:
        return np.asarray((self.values - self.values[0]) / self.change)

    def _time_at(self, part: float) -> float:
        """Return the time at which the quantity first passes a part of its change."""
        parts = self._parts
        place = int(np.argmax(parts >= part))
        if place == 0:
            return float(self.times[0])
        low, high = parts[place - 1], parts[place]
        share = (part - low) / (high - low)
        return float(self.times[place - 1] + share * (self.times[place] - self.times[place - 1]))


def step_response(
    simulator: Simulator,
    command: str,
    *,
    to: float | str,
    output: Output,
    duration: float | str,
) -> StepResponse:
    """Change a command at once and watch a quantity.

    Parameters
    ----------
    simulator
        The simulator, which starts from its present state and keeps it.
    command
        Name of a command of one number.
    to
        Its new value, SI or with a unit.
    output
        Quantity by name, ``"chambers.air.pressure"`` or ``"probes.tip[2]"``, or a function of an
        observation.
    duration
        Time to watch in s, or with a unit.

    Returns
    -------
    StepResponse
        The quantity at each step of the simulator.

    Raises
    ------
    DesignError
        An unknown command or quantity, or a value out of bounds.
    SimulationError
        A body that diverges, or a quantity that does not change.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> simulator = vs.Simulator(families.cylinder(radius="20 mm", height="30 mm"))
    >>> found = step_response(
    ...     simulator, "pressure", to="1 kPa", output="probes.top[2]", duration="0.4 s"
    ... )
    >>> found.gain > 0, found.settling_time < 0.4
    (True, True)
    """
    value = command_value(simulator, command, to, "to")
    quantity = quantity_named(output, simulator)
    last = si_value(duration, "time", "duration", positive=True)
    own = simulator.copy()
    before = own.state.commands[command]
    assert isinstance(before, float)
    values = [quantity.read(own.state)]
    for _ in range(max(round(last / own.time_step), 1)):
        values.append(quantity.read(moved(own, {command: value})))
    if values[-1] == values[0]:
        what = f"{quantity.name} does not change when {command} goes from {before:g} to {value:g}"
        raise SimulationError("response", what, "give another value, or another quantity")
    return StepResponse(
        command=command,
        output=quantity.name,
        kind=quantity.kind,
        before=before,
        after=value,
        times=np.arange(len(values), dtype=np.float64) * own.time_step,
        values=np.array(values),
    )
