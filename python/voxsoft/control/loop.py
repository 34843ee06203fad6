"""Closed loop around a simulator."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from voxsoft.control.signals import Output, Response, command_value, moved, quantity_named
from voxsoft.simulation.runs.commands import CommandName
from voxsoft.simulation.runs.simulator import Simulator
from voxsoft.units import si_value

Floats = NDArray[np.float64]


class Controller(Protocol):
    """A controller of one quantity by one command.

    Attributes
    ----------
    preview
        Steps ahead for which it wants targets.
    """

    @property
    def preview(self) -> int:
        """Steps ahead for which it wants targets."""
        ...

    def start(self, step: float, measured: float = 0.0, command: float = 0.0) -> None:
        """Begin a loop with steps of some seconds, from a value and a command."""
        ...

    def command(self, ahead: Floats, measured: float) -> float:
        """Return the command for the next step by the targets ahead and the value now."""
        ...


@dataclass(frozen=True, eq=False)
class Track(Response):
    """A closed loop over time, see :class:`Response`.

    Attributes
    ----------
    command_kind
        Kind of unit of the command.
    times
        Ends of the steps in s, (n,).
    targets, values, commands
        Target and quantity at these times, and the command of each step, SI units, (n,).
    """

    command_kind: str
    times: Floats
    targets: Floats
    values: Floats
    commands: Floats

    @property
    def errors(self) -> Floats:
        """Target less value, (n,)."""
        return np.asarray(self.targets - self.values)

    def error(self, after: float = 0.0) -> float:
        """Root of the mean square of the errors later than a time in s."""
        late = self.errors[self.times > after]
        return float(np.sqrt(np.mean(late**2)))


def track(
    simulator: Simulator,
    controller: Controller,
    target: Callable[[float], float],
    command: str,
    output: Output,
    *,
    duration: float | str,
    meanwhile: Callable[[float], Mapping[str, Any]] | None = None,
) -> Track:
    """Let a controller make a quantity follow a target.

    Parameters
    ----------
    simulator
        The simulator, which moves on from its present state.
    controller
        :class:`PIDController`, :class:`PredictiveController`, or any object like them.
    target
        Target by the time since the start of the loop in s.
    command
        Name of the command that the controller gives; values out of its bounds are cut.
    output
        Quantity that is measured and follows: a sensor by its name, a quantity as for
        :func:`step_response`, or a function of an observation.
    duration
        Time in s, or with a unit.
    meanwhile
        Other commands by the time since the start: disturbances, other drives. Default: none.

    Returns
    -------
    Track
        Targets, values and commands.

    Raises
    ------
    DesignError
        An unknown command or quantity.
    SimulationError
        A body that diverges.
    """
    quantity = quantity_named(output, simulator)
    drive, step = simulator.commands.get(command), simulator.time_step
    now = simulator.state.commands.get(command, 0.0)
    command_value(simulator, command, now if isinstance(now, float) else 0.0, "command")
    assert drive is not None
    assert isinstance(now, float)
    value = quantity.read(simulator.state)
    controller.start(step, value, now)
    count = max(round(si_value(duration, "time", "duration", positive=True) / step), 1)
    rows = np.empty((count, 3))
    for index in range(count):
        ahead = np.array([target(step * (index + 1 + k)) for k in range(controller.preview)])
        given = float(np.clip(controller.command(ahead, value), drive.low, drive.high))
        others = dict[CommandName, Any](
            () if meanwhile is None else meanwhile(step * index).items()
        )
        value = quantity.read(moved(simulator, others | {command: given}))
        rows[index] = ahead[0], value, given
    return Track(
        command=command,
        output=quantity.name,
        kind=quantity.kind,
        command_kind=drive.kind,
        times=np.arange(1, count + 1, dtype=np.float64) * step,
        targets=rows[:, 0],
        values=rows[:, 1],
        commands=rows[:, 2],
    )
