"""Loads that are commanded while a body moves: their names, values, and parts in the core."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import accumulate, pairwise
from types import MappingProxyType
from typing import Any

import numpy as np

from voxsoft.design import AnyLoad, Design
from voxsoft.design.chamber import chosen_cavities
from voxsoft.errors import DesignError
from voxsoft.records import closest
from voxsoft.simulation.loads import LoadReading, readings
from voxsoft.simulation.setup.setup import Setup

#: A load's value in SI units: one number, or three components.
Value = float | tuple[float, float, float]
#: Name of a load: one of :attr:`LoadCommands.names`, its place in the design, or its index.
LoadName = str | int


class LoadCommands:
    """The loads of a design as commands: from names and values to factors of the core's loads.

    Parameters
    ----------
    design
        A design whose loads have no histories: the commands take their place.

    Attributes
    ----------
    names
        Name of each load: the chamber of a pressure, else its kind, ``"pressure"``; where several
        share one name, their places, ``"loads[0]"``. Places and indices are accepted for every
        load.

    Raises
    ------
    DesignError
        A load or an activation with a history.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> commands = LoadCommands(families.cylinder())
    >>> commands.names
    ('pressure',)
    >>> commands.read({"pressure": "2 kPa"})
    {0: 2000.0}
    """

    def __init__(self, design: Design) -> None:
        self._readings = readings(design)
        self._tendons = [tendon.name for tendon in design.tendons]
        self._loads: tuple[AnyLoad, ...] = tuple(design.loads)
        self.names = _names(self._readings)

    @property
    def at_first(self) -> dict[int, Value]:
        """Values before any command: gravity as the design says, zero for all other loads."""
        return {
            index: reading.size if reading.quantity == "acceleration" else _zero(reading)
            for index, reading in enumerate(self._readings)
        }

    def read(self, given: Mapping[LoadName, Any]) -> dict[int, Value]:
        """Read commands: SI values by the index of the load.

        Parameters
        ----------
        given
            Values by name or index: a number in SI units, text with a unit, or a pint quantity;
            three of them for a force, and for a traction that has three in the design.

        Raises
        ------
        DesignError
            An unknown load, or one named twice; a value of another unit or shape, or not finite.
        """
        if not isinstance(given, Mapping):
            what = f"{given!r} is no mapping"
            hint = f'write {{"{self.names[0]}": 1.0}}' if self.names else ""
            raise DesignError("loads", what, hint)
        found: dict[int, Value] = {}
        for name, value in given.items():
            index = self._index(name)
            if index in found:
                raise DesignError(f"loads[{name!r}]", "is commanded twice", "give one name of it")
            found[index] = self._value(index, name, value)
        return found

    def named(self, values: Mapping[int, Value]) -> Mapping[str, Value]:
        """Name values by their loads."""
        return MappingProxyType({self.names[index]: value for index, value in values.items()})

    def under(self, design: Design, values: Mapping[int, Value]) -> Design:
        """Return the design with loads of these values."""
        loads = [load.replace(value=values[index]) for index, load in enumerate(self._loads)]
        return design.replace(loads=loads)

    def of_size_one(self, design: Design) -> Design:
        """Return the design with each load of unit size, and one for each axis of a vector."""
        pairs = zip(self._loads, self._readings, strict=True)
        loads = [one for load, reading in pairs for one in _ones(load, reading)]
        return design.replace(loads=loads)

    def core_loads(self, of_size_one: Setup) -> list[list[range]]:
        """Return the index range of the core's loads for each load and component of size one."""
        ends = [0, *accumulate(len(load.actions) for load in of_size_one.loads)]
        ranges = iter([range(first, end) for first, end in pairwise(ends)])
        return [[next(ranges) for _ in reading.components] for reading in self._readings]

    def pressures(self, setup: Setup) -> list[tuple[int, list[int]]]:
        """Return the index of each pressure in cavities, and the cavities."""
        return [
            (index, [*chosen_cavities(reading.cavity, setup.mesh, f"loads[{index}].cavity")])
            for index, reading in enumerate(self._readings)
            if reading.cavity is not None
        ]

    def _index(self, name: LoadName) -> int:
        if isinstance(name, int) and not isinstance(name, bool):
            if 0 <= name < len(self._loads):
                return name
            what = f"{name} is no load; there are {len(self._loads)}, from 0"
            raise DesignError("loads", what)
        places = [f"loads[{index}]" for index in range(len(self._loads))]
        for known in ([*self.names], places):
            if isinstance(name, str) and name in known:
                return known.index(name)
        if name in self._tendons:
            what = f'"{name}" is a tendon, and a simulator commands loads'
            hint = "it pulls as the design says; a history of it is followed by vs.simulate"
            raise DesignError("loads", what, hint)
        if not self._loads:
            raise DesignError("loads", f'"{name}" is no load: the design has none', "call step()")
        raise DesignError("loads", f'"{name}" is no load', closest(str(name), self.names))

    def _value(self, index: int, name: LoadName, value: object) -> Value:
        try:
            if isinstance(value, np.generic):
                value = value.item()
            elif isinstance(value, np.ndarray):
                value = value.tolist()
            read = self._loads[index].replace(value=value)
        except DesignError as error:
            where = f"loads[{name!r}]"
            raise DesignError(where, error.what, error.hint) from None
        found: Value = read.value
        due_three = len(self._readings[index].components) > 1
        if isinstance(found, tuple) != due_three:
            due = "three components" if due_three else "a number"
            raise DesignError(f"loads[{name!r}]", f"{value!r} is not {due}", "as in the design")
        return found


def _names(loads: Sequence[LoadReading]) -> tuple[str, ...]:
    wanted = [
        load.cavity if isinstance(load.cavity, str) and load.cavity != "all" else load.kind
        for load in loads
    ]
    return tuple(
        name if wanted.count(name) == 1 else f"loads[{index}]" for index, name in enumerate(wanted)
    )


def _zero(load: LoadReading) -> Value:
    return (0.0, 0.0, 0.0) if len(load.components) > 1 else 0.0


def _ones(load: AnyLoad, reading: LoadReading) -> list[AnyLoad]:
    if len(reading.components) == 1:
        return [load.replace(value=1.0)]
    return [load.replace(value=(float(at == 0), float(at == 1), float(at == 2))) for at in range(3)]
