"""Signals of a loop: a scalar command, and a scalar quantity of observations."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from voxsoft.errors import DesignError, SimulationError
from voxsoft.records import closest
from voxsoft.simulation.runs.commands import CommandName
from voxsoft.simulation.runs.observation import Observation
from voxsoft.simulation.runs.sensors import kind_of, quantity_of
from voxsoft.simulation.runs.simulator import Simulator

#: A quantity by name, or computed from an observation.
Output = str | Callable[[Observation], float]
_COMPONENT = re.compile(r"(?P<of>.*)\[(?P<index>\d)\]")


@dataclass(frozen=True)
class Quantity:
    """A scalar quantity of observations.

    Parameters
    ----------
    name
        Its name, for labels.
    kind
        Kind of its unit, a key of :data:`voxsoft.units.KINDS`; ``"number"`` if it is computed.
    read
        Value in SI units in an observation.
    """

    name: str
    kind: str
    read: Callable[[Observation], float]


@dataclass(frozen=True, eq=False)
class Response:
    """A quantity that answers a command, over time or frequency.

    Attributes
    ----------
    command, output
        Names of both.
    kind
        Kind of unit of the quantity, a key of :data:`voxsoft.units.KINDS`.
    """

    command: str
    output: str
    kind: str


def quantity_named(output: Output, simulator: Simulator, where: str = "output") -> Quantity:
    """Return a quantity of the observations of a simulator.

    Parameters
    ----------
    output
        A sensor of the simulator by its name; or a quantity as :class:`~voxsoft.Sensor` names it:
        ``"chambers.air.pressure"``, with the axis for a vector: ``"probes.tip[2]"``; or a function
        of an observation.
    simulator
        The simulator.
    where
        Place for messages.

    Raises
    ------
    DesignError
        A quantity that observations do not have, or a vector without an axis.
    """
    if not isinstance(output, str):
        return Quantity(getattr(output, "__name__", "output"), "number", output)
    seen = simulator.state
    found = _COMPONENT.fullmatch(output)
    of, index = (output, None) if found is None else (found["of"], int(found["index"]))
    measured = of in seen.sensors
    if not measured:
        kind = kind_of(of, seen, where)
    else:
        kind = next(
            (kind_of(each.of, seen, where) for each in simulator.sensors if each.label == of),
            "number",
        )

    def values(now: Observation) -> np.ndarray[Any, Any]:
        return now.sensors[of] if measured else quantity_of(of, now)

    shape = values(seen).shape
    if (index is None) != (shape == ()) or (index is not None and index >= shape[0]):
        what = f'"{output}" is a number' if shape == () else f'"{of}" has {shape[0]} components'
        raise DesignError(where, what, f'"{of}"' if shape == () else f'name one: "{of}[0]"')
    if index is None:
        return Quantity(output, kind, lambda now: float(values(now)))
    return Quantity(output, kind, lambda now: float(values(now)[index]))


def command_value(simulator: Simulator, command: str, value: float | str, where: str) -> float:
    """Return a value of a scalar command in SI units.

    Raises
    ------
    DesignError
        An unknown command, one of a vector, or a value out of its bounds.
    """
    commands = simulator.commands
    if command not in commands:
        raise DesignError("command", f'"{command}" is no command', closest(command, list(commands)))
    found = commands[command]
    if found.shape:
        raise DesignError("command", f'"{command}" is a vector', "name a command of one number")
    number = found.read(value, where)
    assert isinstance(number, float)
    return number


def moved(simulator: Simulator, commands: Mapping[CommandName, Any]) -> Observation:
    """Return the observation after a step of a simulator.

    Raises
    ------
    SimulationError
        A body that diverges: nothing can be measured of it.
    """
    seen = simulator.step(commands)
    if seen.status in ("diverged", "inverted"):
        given = ", ".join(f"{name} = {value}" for name, value in commands.items())
        what = f"{seen.message}, under {given} at {seen.time:g} s"
        raise SimulationError("simulator", what, "command less, or more slowly")
    return seen
