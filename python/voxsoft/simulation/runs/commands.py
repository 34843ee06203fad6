"""Commands of a body in motion: all that drives it, by names, with units and bounds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Any, Final

import numpy as np

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.chamber import chosen_cavities
from voxsoft.design.shape_memory import ShapeMemory
from voxsoft.errors import DesignError, UnitError
from voxsoft.records import closest
from voxsoft.simulation.loads import readings
from voxsoft.simulation.runs.drives import Drive, Input, Value, drives_of, of_size_one
from voxsoft.simulation.setup.growth import growths_of
from voxsoft.simulation.setup.materials import core_materials
from voxsoft.simulation.setup.setup import Setup
from voxsoft.units import UnitOf, format_quantity

#: Name of a command: one of :attr:`Commands.names`, a place in the design, or the index of a load.
CommandName = str | int
#: Input with a course over time: times in s and values.
Course = tuple[str, int, int, list[float], list[float]]

_SI: Final = MappingProxyType(
    {
        "acceleration": "m/s^2",
        "force": "N",
        "pressure": "Pa",
        "magnetic field": "T",
        "density": "kg/m^3",
        "length": "m",
        "angle": "rad",
        "volume": "m^3",
        "volume flow": "m^3/s",
        "mass": "kg",
        "temperature": "K",
        "electric field": "V/m",
        "number": "1",
    }
)


@dataclass(frozen=True)
class Command:
    """A quantity that a simulator takes.

    Attributes
    ----------
    name
        Its name.
    place
        Its place in the design, which is accepted for the name: ``"tendons[0].tension"``.
    kind
        Kind of quantity, a key of :data:`voxsoft.units.KINDS`.
    shape
        ``()`` for one number, ``(3,)`` for three components along x, y, z.
    low, high
        Bounds of each number in SI units that the physics sets; infinite without one.
    first
        Its value after a reset: zero or the state in which nothing is driven; of gravity, that of
        the design; with a history, the beginning of that.
    design
        Its value in the design, at the end of a history.
    evenly
        True if it goes evenly to a new value over a step, as places and amounts do; False if it has
        the new value from the beginning of the step on, as forces and pressures do.
    moves
        Name of the command whose value it moves at its own as a rate, until it is 0 or the other
        one is commanded; empty for all but the flow of a syringe.
    """

    name: str
    place: str
    kind: str
    shape: tuple[int, ...]
    low: float
    high: float
    first: Value
    design: Value
    evenly: bool
    moves: str = field(default="", kw_only=True)
    #: From a value, and the remembered state of its material, to inputs of the core.
    _inputs: Callable[[Value, float], Sequence[Input]] = field(repr=False, compare=False)
    #: The design with a value of it, as it then acts.
    _put: Callable[[Design, Value], Design] = field(repr=False, compare=False)
    #: Times [s] and values that it follows until it is commanded.
    history: tuple[tuple[float, ...], tuple[Value, ...]] | None = field(default=None, repr=False)
    #: Other names of it.
    _aliases: tuple[str, ...] = field(default=(), repr=False, compare=False)
    #: Activation with a state of its own.
    _memory: ShapeMemory | None = field(default=None, repr=False, compare=False)

    @property
    def unit(self) -> str:
        """SI unit of its numbers; ``"1"`` for one without."""
        return _SI[self.kind]

    def read(self, given: Any, where: str) -> Value:  # noqa: ANN401 - from outside
        """Read a value: numbers in SI units, texts with units, or pint quantities.

        Raises
        ------
        DesignError
            A value of another unit or shape, not finite, or out of bounds.
        """
        if isinstance(given, np.generic):
            given = given.item()
        elif isinstance(given, np.ndarray):
            given = given.tolist()
        many = isinstance(given, (list, tuple))
        if self.shape:
            if not many:
                what = f"{given!r} is not three components"
                raise DesignError(where, what, "give x, y and z")
            if len(given) != 3:
                raise DesignError(where, f"has {len(given)} components", "give x, y and z")
            x, y, z = (self._number(each, where) for each in given)
            return x, y, z
        if many:
            raise DesignError(where, f"{given!r} is not a quantity", "give one number")
        return self._number(given, where)

    def _number(self, given: Any, where: str) -> float:  # noqa: ANN401 - from outside
        try:
            number = UnitOf(self.kind).read(given)
        except UnitError as error:
            raise DesignError(where, error.what, error.hint) from None
        if not self.low <= number <= self.high:
            shown, low, high = (
                format_quantity(each, self.kind) for each in (number, self.low, self.high)
            )
            if number < self.low:
                raise DesignError(where, f"{shown} is below {low}", f"give {low} or more")
            raise DesignError(where, f"{shown} is above {high}", f"give {high} or less")
        return number

    def at(self, time: float) -> Value:
        """Value of its history at a time in s, or the first value."""
        if self.history is None:
            return self.first
        times, values = self.history
        rows = np.array(values, dtype=np.float64)
        if rows.ndim == 1:
            return float(np.interp(time, times, rows))
        x, y, z = (float(np.interp(time, times, column)) for column in rows.T)
        return x, y, z

    def memory_at(self, time: float) -> float:
        """State of its material at a time in s, until it is commanded."""
        return 0.0 if self._memory is None else self._memory.at(time).transformed

    def memory_after(self, memory: float, value: Value) -> float:
        """State of its material after another value."""
        if self._memory is None:
            return memory
        assert isinstance(value, float)
        return self._memory.transformed_at(memory, value)

    def course(self) -> list[Course]:
        """Inputs of the core until it is commanded."""
        if self._memory is not None and self.history is not None:
            growth = self._memory.growth
            [(kind, index, number, _)] = self._inputs(self.first, 0.0)
            return [(kind, index, number, list(growth.times), list(growth.bases))]
        if self.history is None:
            return self.held(self.first, self.memory_after(0.0, self.first))
        times, values = self.history
        each = [self._inputs(value, 0.0) for value in values]
        return [
            (kind, index, number, list(times), [row[column][3] for row in each])
            for column, (kind, index, number, _) in enumerate(each[0])
        ]

    def held(self, value: Value, memory: float) -> list[Course]:
        """Inputs of the core for a constant value."""
        return [
            (kind, index, number, [0.0], [size])
            for kind, index, number, size in self._inputs(value, memory)
        ]

    def ramped(self, before: Value, value: Value, span: tuple[float, float]) -> list[Course]:
        """Inputs of the core that go evenly from one value to another over a time span in s."""
        pairs = zip(self._inputs(before, 0.0), self._inputs(value, 0.0), strict=True)
        return [
            (kind, index, number, [*span], [start, end])
            for (kind, index, number, start), (*_, end) in pairs
        ]

    def put(self, design: Design, value: Value) -> Design:
        """Return the design with a value of it."""
        return self._put(design, value)


class Commands:
    """All commands of a design.

    Parameters
    ----------
    design
        The design.

    Attributes
    ----------
    setup
        The design with loads, tendons and dielectrics of unit size, whose problem is driven.
    all
        All commands: loads, supplies, connections, tendons, activations, clamps, objects.

    Notes
    -----
    A command is called by the thing that it drives: the chamber or the kind of a load, the supply,
    the tendon, the part that is activated, the clamp, the object. Where a thing has several
    quantities, or several things share a name, the quantity is added, ``"left.valve"``, or the
    place is the name, ``"loads[0]"``. Places are accepted for all, and so is the quantity behind
    any name.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> commands = Commands(Setup.of(families.cylinder()))
    >>> commands.names
    ('pressure',)
    >>> commands.read({"pressure": "2 kPa"})
    {0: 2000.0}
    """

    def __init__(self, setup: Setup) -> None:
        self._design = design = setup.design
        self.setup = Setup(of_size_one(design), setup.mesh)
        self.all = tuple(_named(list(drives_of(setup, self.setup))))

    @cached_property
    def problem(self) -> _core.Problem:
        """Problem of the core with loads of unit size, and growth that is commanded."""
        one = self.setup
        if not growths_of(one.design):
            return one.problem
        own = core_materials(one.design, one.materials, one.mesh, one.origin, over_time=True)
        return one.problem.with_materials(own)

    @cached_property
    def load_owners(self) -> list[int]:
        """Index of the design's load behind each load of the core."""
        actions = iter(self.setup.loads)
        return [
            index
            for index, reading in enumerate(readings(self._design))
            for _ in reading.components
            for _ in next(actions).actions
        ]

    @property
    def names(self) -> tuple[str, ...]:
        """Name of each command."""
        return tuple(command.name for command in self.all)

    @property
    def of_loads(self) -> tuple[str, ...]:
        """Names of the commands that are loads, which come first."""
        return tuple(each.name for each in self.all if each.place.startswith("loads["))

    @cached_property
    def forces(self) -> list[tuple[int, str, list[int]]]:
        """Commands that are loads of the core, but tendons, weight and the liquid around.

        Each has its index, its name and the numbers of its loads of the core.
        """
        found = []
        for index, each in enumerate(self.all):
            drives = each.place.startswith(("loads[", "activations["))
            if not drives or each.kind in ("acceleration", "density"):
                continue
            inputs = each._inputs(each.first, 0.0)
            if cores := [core for kind, core, *_ in inputs if kind == "load"]:
                found.append((index, each.name, cores))
        return found

    @cached_property
    def clamps(self) -> dict[int, str]:
        """Name of each clamp and object that is moved, by the number of its clamp in the core."""
        found = {}
        for each in self.all:
            if each.place.endswith("].displacement"):
                (_, core, *_), *_ = each._inputs(each.first, 0.0)
                found[core] = each.name.removesuffix(".displacement")
        return found

    @cached_property
    def rates(self) -> Mapping[int, int]:
        """Index of each command that is a rate, with that of the command that it moves."""
        names = self.names
        pairs = ((index, each.moves) for index, each in enumerate(self.all))
        return {index: names.index(moved) for index, moved in pairs if moved}

    def read(self, given: Mapping[CommandName, Any]) -> dict[int, Value]:
        """Read commands: SI values by the index of the command.

        Parameters
        ----------
        given
            Values by name: a number in SI units, text with a unit, or a pint quantity; three of
            them for a vector.

        Raises
        ------
        DesignError
            An unknown command, or one named twice; a value of another unit or shape, not finite, or
            out of bounds; a rate with the value that it moves.
        """
        if not isinstance(given, Mapping):
            hint = f'write {{"{self.names[0]}": ...}}' if self.all else ""
            raise DesignError("commands", f"{given!r} is no mapping", hint)
        found: dict[int, Value] = {}
        for name, value in given.items():
            index = self._index(name)
            where = f"commands[{name!r}]"
            if index in found:
                raise DesignError(where, "is commanded twice", "give one name of it")
            found[index] = self.all[index].read(value, where)
        for rate, moved in self.rates.items():
            if moved in found and found.get(rate):
                where, other = (self.all[each].name for each in (rate, moved))
                what = f"is not 0, and {other!r} says where the plunger goes"
                raise DesignError(f"commands[{where!r}]", what, "give one of them")
        return found

    def moved(
        self, new: Mapping[int, Value], values: Sequence[Value], seconds: float
    ) -> Mapping[int, Value]:
        """Add the values to which rates lead within a step, up to their bounds.

        Parameters
        ----------
        new
            Values that are commanded now, by the index of the command.
        values
            All values before.
        seconds
            Length of the step.
        """
        found = dict(new)
        for rate, moved in self.rates.items():
            before, speed = values[moved], new.get(rate, values[rate])
            assert isinstance(before, float)
            assert isinstance(speed, float)
            if moved in new:
                found[rate] = 0.0
            elif rate in new or speed != 0.0:
                end = before + speed * seconds
                found[moved] = min(max(end, self.all[moved].low), self.all[moved].high)
                if found[moved] != end:
                    found[rate] = 0.0
        return found

    def pressures(self, setup: Setup) -> list[tuple[int, list[int]]]:
        """Return the index of each pressure in cavities, and the cavities."""
        return [
            (index, [*chosen_cavities(reading.cavity, setup.mesh, f"loads[{index}].cavity")])
            for index, reading in enumerate(readings(setup.design))
            if reading.cavity is not None
        ]

    def under(self, design: Design, values: Sequence[Value]) -> Design:
        """Return a design with these values, constant over time."""
        for command, value in zip(self.all, values, strict=True):
            design = command.put(design, value)
        return design

    def _index(self, name: CommandName) -> int:
        if isinstance(name, int) and not isinstance(name, bool):
            count = len(self.of_loads)
            if 0 <= name < count:
                return name
            raise DesignError("commands", f"{name} is no load; there are {count}, from 0")
        if isinstance(name, str):
            if name in self.names:
                return self.names.index(name)
            for index, command in enumerate(self.all):
                if name in command._aliases:
                    return index
        if not self.all:
            what = f'"{name}" is no command: the design has none'
            raise DesignError("commands", what, "call step()")
        raise DesignError("commands", f'"{name}" is no command', closest(str(name), self.names))


def _named(drives: list[Drive]) -> Iterator[Command]:
    """Name commands: by the base where that means one, else with the quantity or the place."""
    for drive in drives:
        entries = {each.entry for each in drives if each.base == drive.base}
        base = drive.base if len(entries) == 1 else drive.entry
        own = [each for each in drives if each.entry == drive.entry and not each.rate_of]
        alone = len(own) == 1 and not drive.rate_of
        name = base if alone else f"{base}.{drive.quantity}"
        place = f"{drive.entry}.{drive.quantity}"
        aliases = [place, f"{base}.{drive.quantity}"]
        if alone:
            aliases += [drive.entry]
        moves = ""
        if drive.rate_of:
            moves = base if len(own) == 1 else f"{base}.{drive.rate_of}"
        yield Command(name=name, place=place, moves=moves, _aliases=tuple(aliases), **drive.rest)
