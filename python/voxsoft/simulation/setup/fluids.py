"""Supplies of a design as volumes of gas and liquid in the core's problem.

The result, the studio and metrics take the pressure of each chamber from here. Long because the
network and the places of its parts, by which they are commanded, are found together.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core, _core_data
from voxsoft.cavity import MeshCavity
from voxsoft.design import Connection, Design
from voxsoft.design.chamber import chosen_cavities, name_of_cavity
from voxsoft.design.fluid import ATMOSPHERE, ROOM, Gas, Liquid
from voxsoft.design.history import History
from voxsoft.design.line import Tube, Valve
from voxsoft.design.supply import (
    AnySupply,
    FlowSupply,
    MassSupply,
    PressureSupply,
    VolumeSupply,
    check_valve,
)
from voxsoft.errors import DesignError, NoCavityError
from voxsoft.mesh import Mesh
from voxsoft.simulation.loads import LoadReading, readings
from voxsoft.simulation.setup.chambers import center_of
from voxsoft.simulation.setup.contact import times_and_factors
from voxsoft.units import format_quantity

#: Numbers that the core reports for a chamber, in their order.
_READINGS: Final = ("pressure", "volume", "mass", "flow", "work", "energy")


def has_supplies(design: Design) -> bool:
    """Return True if chambers of a design hold volumes of gas or liquid of their own."""
    return bool(design.supplies or design.connections)


@dataclass(frozen=True)
class ChamberState:
    """State of a volume of gas or liquid.

    Attributes
    ----------
    name
        Name of the supply, or of its chambers.
    cavities
        The indices of its cavities in the mesh.
    pressure
        Gauge pressure [Pa].
    volume
        Volume of its cavities [m³], without lines.
    mass
        Mass of the fluid, with that in lines and syringes [kg].
    flow
        Mass flow into it [kg/s].
    work
        Work on the walls since the unloaded body [J].
    energy
        Energy taken from the supply for it [J]: of gas, that of an isothermal expansion to the
        atmosphere.
    """

    name: str
    cavities: tuple[int, ...]
    pressure: float
    volume: float
    mass: float
    flow: float
    work: float
    energy: float

    @property
    def efficiency(self) -> float | None:
        """Work on the walls over the energy taken for it; None where none was taken."""
        return self.work / self.energy if self.energy > 0.0 else None

    @property
    def words(self) -> str:
        """Pressure, volume and mass in words."""
        shown = [
            format_quantity(float(f"{number:.4g}"), kind)
            for number, kind in (
                (self.pressure, "pressure"),
                (self.volume, "volume"),
                (self.mass, "mass"),
            )
        ]
        return f"{shown[0]}, {shown[1]}, {shown[2]} of fluid"

    @property
    def sentence(self) -> str:
        """Name with pressure, volume and mass in words."""
        return f"{self.name}: {self.words}"

    def summary(self) -> dict[str, Any]:
        """Plain data in SI units."""
        numbers = {key: getattr(self, key) for key in _READINGS}
        return {"name": self.name, **numbers, "efficiency": self.efficiency}


@dataclass(frozen=True)
class ChamberHistory:
    """History of a volume of gas or liquid over time or load factor; each an array, (f,).

    The names and units are those of :class:`ChamberState`.
    """

    pressure: NDArray[np.float64] = field(repr=False)
    volume: NDArray[np.float64] = field(repr=False)
    mass: NDArray[np.float64] = field(repr=False)
    flow: NDArray[np.float64] = field(repr=False)
    work: NDArray[np.float64] = field(repr=False)
    energy: NDArray[np.float64] = field(repr=False)


@dataclass(frozen=True)
class Volume:
    """One volume of a network.

    Attributes
    ----------
    supply
        The supply that drives it; None for one that only a connection reaches.
    where
        Its place in the design.
    cavities
        The indices of its cavities.
    """

    supply: AnySupply | None
    where: str
    cavities: tuple[int, ...]

    @property
    def medium(self) -> Gas | Liquid:
        """Fluid that fills it."""
        return Gas() if self.supply is None else self.supply.medium


@dataclass(frozen=True)
class SupplyParts:
    """Indices of the parts of a supply in the network of the core; None for those it has not.

    Attributes
    ----------
    source
        Its source, among all sources.
    pump
        Its pump, among all pumps.
    valve, leak
        The branches through its valve or tube, and through its leak.
    """

    source: int | None = None
    pump: int | None = None
    valve: int | None = None
    leak: int | None = None


@dataclass(frozen=True)
class Fluids:
    """The supplies and connections of a design on its mesh.

    Raises
    ------
    NoCavityError
        A supply of a chamber that is not closed, or does not exist.
    DesignError
        Two supplies of one chamber, or a supply and a pressure load; fluids that do not mix.
    """

    design: Design
    mesh: Mesh

    @cached_property
    def volumes(self) -> tuple[Volume, ...]:
        """All volumes: those of supplies in their order, then those of connections alone."""
        found: list[Volume] = []
        for index, supply in enumerate(self.design.supplies):
            where = f"supplies[{index}]"
            cavities = self._cavities(supply.choices, where)
            found.append(Volume(supply, where, cavities))
            self._check_single(found)
        for index, connection in enumerate(self.design.connections):
            where = f"connections[{index}]"
            for choice in connection.chambers:
                (cavity, *more) = self._cavities((choice,), where)
                if more:
                    what = f'"{choice}" is several cavities'
                    raise DesignError(f"{where}.chambers", what, "name one of them")
                if not any(cavity in volume.cavities for volume in found):
                    found.append(Volume(None, where, (cavity,)))
        self._check_loads(found)
        return tuple(found)

    def _cavities(self, choices: Sequence[str | int], where: str) -> tuple[int, ...]:
        if not self.mesh.cavities:
            what = "there is no closed chamber to fill"
            hint = "close the chamber: walls and caps at least one voxel thick, or smaller voxels"
            raise NoCavityError(
                where, what, f"{hint}; the check of the design shows where it leaks"
            )
        key = f"{where}.chamber"
        found = [i for choice in choices for i in chosen_cavities(choice, self.mesh, key)]
        if len(set(found)) < len(found):
            what = "names a chamber twice"
            raise DesignError(where, what, "name each chamber of the manifold once")
        return tuple(found)

    def _check_single(self, found: Sequence[Volume]) -> None:
        *earlier, last = found
        for other in earlier:
            if both := set(other.cavities) & set(last.cavities):
                name = name_of_cavity(self.mesh, min(both))
                what = f"drives {name}, and so does {other.where}: two supplies contradict"
                raise DesignError(last.where, what, "keep one of them")

    def _check_loads(self, found: Sequence[Volume]) -> None:
        for number, load in enumerate(readings(self.design)):
            if load.cavity is None:
                continue
            where = f"loads[{number}]"
            loaded = set(chosen_cavities(load.cavity, self.mesh, f"{where}.cavity"))
            for volume in found:
                if both := loaded & set(volume.cavities):
                    name = name_of_cavity(self.mesh, min(both))
                    what = (
                        f"is a pressure in {name}, and {volume.where} supplies it: they contradict"
                    )
                    raise DesignError(where, what, "keep the load or the supply")

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Name of each volume."""
        return tuple(self._name(volume) for volume in self.volumes)

    def _name(self, volume: Volume) -> str:
        if volume.supply is not None and volume.supply.name is not None:
            return volume.supply.name
        cavities = self.mesh.cavities
        return " + ".join(cavities[i].name or f"cavity {i}" for i in volume.cavities)

    def volume_of(self, cavity: int) -> int | None:
        """The number of the volume that a cavity belongs to, if any."""
        for number, volume in enumerate(self.volumes):
            if cavity in volume.cavities:
                return number
        return None

    def give_to(self, parts: _core.ProblemParts) -> None:
        """Hand the network and its walls to the problem of the core."""
        walls = [
            [wall for index in volume.cavities for wall in _walls(self.mesh.cavities[index])]
            for volume in self.volumes
        ]
        parts.fluid(self.network, walls)
        for reading in readings(self.design):
            if reading.quantity == "acceleration":
                self._weigh(parts, reading)

    def _weigh(self, parts: _core.ProblemParts, gravity: LoadReading) -> None:
        """Give the weight of liquids to the core: pressures count at the centers of chambers."""
        down = np.asarray(gravity.direction) / np.linalg.norm(gravity.direction)
        history = times_and_factors(gravity.history)
        for volume in self.volumes:
            if not isinstance(volume.medium, Liquid):
                continue
            slope = volume.medium.density * gravity.size * down
            cavities = [self.mesh.cavities[index] for index in volume.cavities]
            sizes = [float(cavity.volume) for cavity in cavities]
            centers = [center_of(cavity, self.mesh) for cavity in cavities]
            origin = np.average(centers, axis=0, weights=sizes).tolist()
            for cavity in cavities:
                for triangles, voids, weight in _walls(cavity):
                    parts.hydrostatic(triangles, (weight * slope).tolist(), origin, history, voids)

    @property
    def network(self) -> _core_data.Network:
        """Network as the core reads it."""
        return self._built[0]

    @property
    def supply_parts(self) -> tuple[SupplyParts, ...]:
        """Parts of each supply in the network."""
        return self._built[1]

    @property
    def connection_branches(self) -> range:
        """The branch of each connection in the network."""
        last = len(self.network["branches"])
        return range(last - len(self.design.connections), last)

    @property
    def weights(self) -> int:
        """Number of loads of the core by which each gravity weighs liquids."""
        liquids = [each for each in self.volumes if isinstance(each.medium, Liquid)]
        cavities = [self.mesh.cavities[index] for each in liquids for index in each.cavities]
        return sum(len(cavity.splits) for cavity in cavities)

    @cached_property
    def _built(self) -> tuple[_core_data.Network, tuple[SupplyParts, ...]]:
        """Build the network, and note where the parts of each supply are in it."""
        noted: list[SupplyParts] = []
        sources: list[_core_data.Source] = []
        branches: list[_core_data.Branch] = []
        pumps: list[_core_data.Pump] = []
        chambers: list[_core_data.Chamber] = []
        for number, volume in enumerate(self.volumes):
            chamber = self._chamber(volume)
            supply = volume.supply
            source: int | None = None
            pump: int | None = None
            valve: int | None = None
            leak: int | None = None
            if isinstance(supply, PressureSupply):
                source = chamber["held"] = len(sources)
                sources.append(_source(supply.value, supply.history))
            if isinstance(supply, FlowSupply) and supply.source is not None:
                ends: list[_core_data.End] = [{"source": len(sources)}, {"chamber": number}]
                source, valve = len(sources), len(branches)
                sources.append(_source(supply.source, supply.history))
                line = _line(supply.valve, supply.tube, supply.medium, supply.temperature)
                branches.append(_branch(ends, line, supply.valve))
            if isinstance(supply, FlowSupply) and supply.pump is not None:
                density = _density(supply.medium, supply.temperature)
                curve = _core_data.Curve(pressures=supply.pump.pressure, flows=supply.pump.flow)
                history = _course(supply.history)
                pump = len(pumps)
                pumps.append(
                    {"chamber": number, "curve": curve, "density": density, "history": history}
                )
            if supply is not None and supply.leak is not None:
                ends = [{"chamber": number}, {"source": len(sources)}]
                leak = len(branches)
                sources.append(_source(0.0, None))
                line = _line(supply.leak, None, supply.medium, supply.temperature)
                branches.append(_branch(ends, line, supply.leak))
            chambers.append(chamber)
            if supply is not None:
                noted.append(SupplyParts(source, pump, valve, leak))
        for index, connection in enumerate(self.design.connections):
            where = f"connections[{index}]"
            branches.append(self._joined(connection, where, chambers))
        network = _core_data.Network(
            atmosphere=ATMOSPHERE,
            chambers=chambers,
            branches=branches,
            sources=sources,
            pumps=pumps,
        )
        return network, tuple(noted)

    def _joined(
        self, connection: Connection, where: str, chambers: list[_core_data.Chamber]
    ) -> _core_data.Branch:
        """The branch of a connection; half the volume of its tube counts at either end."""
        numbers = []
        for choice in connection.chambers:
            (cavity,) = self._cavities((choice,), where)
            number = self.volume_of(cavity)
            assert number is not None  # each cavity of a connection is in a volume
            numbers.append(number)
        first, second = (self.volumes[number] for number in numbers)
        if numbers[0] == numbers[1]:
            what = "joins chambers that are on one manifold"
            raise DesignError(f"{where}.chambers", what, "name chambers of two supplies")
        if first.medium != second.medium:
            what = f"joins {first.where} and {second.where}, which are of different fluids"
            raise DesignError(where, what, "give both the same fluid")
        check_valve(connection.valve, first.medium, f"{where}.valve")
        if connection.tube is not None:
            for number, volume in zip(numbers, (first, second), strict=True):
                half = 0.5 * connection.tube.volume
                density = _density(volume.medium, _filled_at(volume.supply))
                chamber = chambers[number]
                chamber["outside"] = [value + half for value in chamber["outside"]]
                mass = density * half
                is_given = isinstance(volume.supply, MassSupply) and volume.supply.value is not None
                first_mass, last_mass = chamber["mass"]
                last_mass = last_mass if is_given else last_mass + mass
                chamber["mass"] = [first_mass + mass, last_mass]
        supply = first.supply
        temperature = ROOM if supply is None else supply.temperature
        line = _line(connection.valve, connection.tube, first.medium, temperature)
        return _branch([{"chamber": number} for number in numbers], line, connection.valve)

    def _chamber(self, volume: Volume) -> _core_data.Chamber:
        """Return fluid mass, temperature and outside volume: unloaded, and in the end."""
        supply = volume.supply
        inside = sum(float(self.mesh.cavities[index].volume) for index in volume.cavities)
        lines = 0.0 if supply is None else supply.line_volume
        if isinstance(supply, FlowSupply) and supply.tube is not None:
            lines += supply.tube.volume
        outside = (lines, lines)
        if isinstance(supply, VolumeSupply):
            stroke = supply.value
            outside = (lines + max(stroke, 0.0), lines + max(-stroke, 0.0))
        filled_at = _filled_at(supply)
        mass = _density(volume.medium, filled_at) * (inside + outside[0])
        last = mass
        if isinstance(supply, MassSupply) and supply.value is not None:
            last = supply.value
        temperature = ROOM if supply is None else supply.temperature
        moves = isinstance(supply, (VolumeSupply, MassSupply))
        history = supply.history if supply is not None and moves else None
        return {
            "medium": _medium(volume.medium),
            "mass": [mass, last],
            "temperature": [filled_at, temperature],
            "outside": list(outside),
            "history": _course(history),
            "held": None,
        }

    def states(self, numbers: NDArray[np.float64]) -> tuple[ChamberState, ...]:
        """Wrap the core's numbers of each volume, (c, 6)."""
        rows = zip(self.names, self.volumes, numbers.tolist(), strict=True)
        return tuple(ChamberState(name, volume.cavities, *row) for name, volume, row in rows)

    def histories(self, numbers: NDArray[np.float64]) -> dict[str, ChamberHistory]:
        """Wrap the core's records of each volume, (f, c, 6)."""
        if not len(numbers):
            return {}
        return {name: ChamberHistory(*numbers[:, index].T) for index, name in enumerate(self.names)}


def _walls(cavity: MeshCavity) -> Iterator[tuple[Any, Any, float]]:
    """Yield the splits of a surface into triangles with their weights; voids count once."""
    splits = cavity.splits
    for triangles, weight in splits:
        parts = (len(splits) * weight) * cavity.void_parts
        yield triangles.astype(np.uint32), (cavity.void_tets.astype(np.uint32), parts), weight


def _filled_at(supply: AnySupply | None) -> float:
    """The temperature at which the unloaded body is filled, K."""
    if supply is None:
        return ROOM
    return supply.fill_temperature if isinstance(supply, MassSupply) else supply.temperature


def _density(medium: Gas | Liquid, temperature: float) -> float:
    """Compute the density under the atmosphere, kg/m³."""
    if isinstance(medium, Liquid):
        return medium.density
    return ATMOSPHERE / (medium.gas_constant * temperature)


def _medium(medium: Gas | Liquid) -> _core_data.Medium:
    if isinstance(medium, Liquid):
        return {"liquid": {"density": medium.density, "bulk": medium.bulk_modulus}}
    return {"gas": {"constant": medium.gas_constant}}


def _line(
    valve: Valve | None, tube: Tube | None, medium: Gas | Liquid, temperature: float
) -> _core_data.Line:
    through: _core_data.Valve | None = None
    if valve is not None and isinstance(medium, Gas):
        assert valve.conductance is not None  # check_valve
        through = {
            "gas": {"conductance": valve.conductance, "critical_ratio": valve.critical_ratio}
        }
    elif valve is not None:
        assert valve.area is not None  # check_valve
        through = {"liquid": {"area": valve.area}}
    along: _core_data.Tube | None = None
    if tube is not None:
        viscosity = medium.viscosity
        along = {"length": tube.length, "diameter": tube.diameter, "viscosity": viscosity}
    return {
        "valve": through,
        "tube": along,
        "medium": _medium(medium),
        "temperature": temperature,
    }


def _branch(
    ends: list[_core_data.End], line: _core_data.Line, valve: Valve | None
) -> _core_data.Branch:
    history = None if valve is None else valve.history
    opening = None if history is None else _course(history)
    return {"ends": ends, "line": line, "opening": opening}


def _source(pressure: float, history: History | None) -> _core_data.Source:
    return {"pressure": pressure, "history": _course(history)}


def _course(history: History | None) -> _core_data.Course:
    return [[0.0], [1.0]] if history is None else [list(history.times), list(history.factors)]
