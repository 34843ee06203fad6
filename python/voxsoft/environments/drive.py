"""Drives of an environment: commands of a simulator with the bounds that an agent has."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal

from voxsoft.errors import DesignError, UnitError
from voxsoft.records import Record, closest
from voxsoft.simulation import Command, Simulator
from voxsoft.units import UnitOf

#: A number in SI units, or text with a unit.
Amount = float | str
_AXES: Final = ("x", "y", "z")


class Drive(Record):
    """A command that an agent gives, between two bounds and no quicker than its rate.

    Parameters
    ----------
    command
        Name of the command, see :attr:`voxsoft.Simulator.commands`.
    low, high
        Bounds, in SI units or with a unit. Default: the state in which nothing is driven, and the
        value of the design, whichever is less and more.
    rate
        Largest change in a second, as of a pump or a motor: a number in SI units, or text with the
        unit of the bounds, ``"20 mm"``. Default: none, a drive may jump.
    axis
        Component of a command with three.

    Examples
    --------
    >>> Drive(command="pressure", low=0, high="20 kPa", rate="50 kPa").rate
    '50 kPa'
    """

    command: str
    low: Amount | None = None
    high: Amount | None = None
    rate: Amount | None = None
    axis: Literal["x", "y", "z"] | None = None


@dataclass(frozen=True)
class Channel:
    """One number of an action: a drive with its bounds in SI units.

    Attributes
    ----------
    name
        Name of the command, with the axis behind a dot where it has three components.
    command
        Name of the command.
    axis
        Index of the component; None for a command of one number.
    unit
        SI unit.
    low, high
        Bounds in that unit.
    rate
        Largest change in a second; infinite without one.
    """

    name: str
    command: str
    axis: int | None
    unit: str
    low: float
    high: float
    rate: float

    def value(self, share: float) -> float:
        """Return the value at -1 (low) to 1 (high)."""
        return self.low + 0.5 * (min(max(share, -1.0), 1.0) + 1.0) * (self.high - self.low)

    def share(self, value: float) -> float:
        """Return where a value is, from -1 (low) to 1 (high)."""
        return 2.0 * (value - self.low) / (self.high - self.low) - 1.0

    def toward(self, now: float, share: float, time: float) -> float:
        """Return the value after a time in s on the way from `now` to a wanted share."""
        most = self.rate * time
        return now + min(max(self.value(share) - now, -most), most)


Drives = Iterable[Drive | str] | Mapping[str, tuple[Amount, Amount]]


def channels_of(simulator: Simulator, drives: Drives | None) -> tuple[Channel, ...]:
    """Return the channels of drives; default: all commands but gravity and rates.

    Raises
    ------
    DesignError
        An unknown command, bounds of another unit or without a distance, or none at all.
    """
    commands = simulator.commands
    listed: list[Drive | str]
    if drives is None:
        own = ((name, each) for name, each in commands.items() if not each.moves)
        listed = [name for name, each in own if each.kind != "acceleration"]
    elif isinstance(drives, Mapping):
        listed = [Drive(command=name, low=low, high=high) for name, (low, high) in drives.items()]
    else:
        listed = list(drives)
    found: list[Channel] = []
    for index, each in enumerate(listed):
        drive = Drive(command=each) if isinstance(each, str) else each
        where = f"drives[{index}]"
        if drive.command not in commands:
            what = f'"{drive.command}" is no command'
            raise DesignError(f"{where}.command", what, closest(drive.command, list(commands)))
        found += _channels(commands[drive.command], drive, where)
    if not found:
        raise DesignError("drives", "are none", "give the design a load, a tendon or a motion")
    return tuple(found)


def _channels(command: Command, drive: Drive, where: str) -> Iterable[Channel]:
    axes = _axes(command, drive, where)
    for axis in axes:
        ends = [_component(each, axis) for each in (command.first, command.design)]
        low = min(ends) if drive.low is None else _read(drive.low, command, f"{where}.low")
        high = max(ends) if drive.high is None else _read(drive.high, command, f"{where}.high")
        if not low < high:
            what = f"has the bounds {low:g} and {high:g} {command.unit}"
            raise DesignError(where, what, "give low and high, with low below high")
        rate = math.inf if drive.rate is None else _read(drive.rate, command, f"{where}.rate")
        if rate <= 0.0:
            raise DesignError(f"{where}.rate", f"{rate:g} is no rate", "give more than zero")
        name = drive.command if axis is None else f"{drive.command}.{_AXES[axis]}"
        yield Channel(
            name=name,
            command=drive.command,
            axis=axis,
            unit=command.unit,
            low=max(low, command.low),
            high=min(high, command.high),
            rate=rate,
        )


def _axes(command: Command, drive: Drive, where: str) -> tuple[int | None, ...]:
    if drive.axis is not None:
        if not command.shape:
            what = f'is given, and "{drive.command}" is one number'
            raise DesignError(f"{where}.axis", what, "leave it out")
        return (_AXES.index(drive.axis),)
    return (0, 1, 2) if command.shape else (None,)


def _component(value: Any, axis: int | None) -> float:  # noqa: ANN401 - a number or three
    return float(value if axis is None else value[axis])


def _read(amount: Amount, command: Command, where: str) -> float:
    if not isinstance(amount, str):
        return float(amount)
    try:
        return float(UnitOf(command.kind).read(amount))
    except UnitError as error:
        raise DesignError(where, error.what, error.hint) from None
