"""Supplies of chambers: pressure, syringe, sealed gas, flow; and lines between chambers."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, JsonValue, model_validator

from voxsoft import units
from voxsoft.design.chamber import CavityChoice
from voxsoft.design.fluid import ATMOSPHERE, ROOM, FluidChoice, Gas, Liquid, Temperature, fluid_of
from voxsoft.design.history import History
from voxsoft.design.line import Pump, Tube, Valve
from voxsoft.design.operands import Name
from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import PositiveMass, UnitOf, Volume, format_quantity

NonNegativeVolume = Annotated[float, UnitOf("volume", non_negative=True)]


def check_pressure(pressure: float, where: str) -> None:
    """Refuse a gauge pressure that no gas can have.

    Raises
    ------
    DesignError
        It is a perfect vacuum, or below one.
    """
    if pressure <= -ATMOSPHERE:
        what = (
            f"is {format_quantity(pressure, 'pressure')}: pressures are over the atmosphere of "
            f"{format_quantity(ATMOSPHERE, 'pressure')}, and no absolute pressure is below zero"
        )
        raise DesignError(where, what, 'write the gauge pressure of a vacuum, such as "-80 kPa"')


class Supply(Record):
    """Entries that all supplies have.

    Parameters
    ----------
    chamber
        The chamber that is driven: its name, the index of a cavity, or ``"all"`` for all
        cavities behind one manifold.
    chambers
        Several chambers that one manifold joins, in place of `chamber`.
    fluid
        ``"air"`` (default), ``"water"``, or a table of a gas or a liquid.
    temperature
        Temperature of gas; default 20 °C. Walls and lines keep it.
    line_volume
        Volume of hoses and fittings, beside that of a `tube`; default 0.
    leak
        A valve to the atmosphere; default: none.
    history
        Factor over time on the supplied quantity; default: constant.
    name
        Name in results; default: the chamber.
    """

    chamber: CavityChoice | None = None
    chambers: tuple[CavityChoice, ...] = ()
    fluid: FluidChoice = "air"
    temperature: Temperature = ROOM
    line_volume: NonNegativeVolume = 0.0
    leak: Valve | None = None
    history: History | None = None
    name: Name | None = None

    @model_validator(mode="after")
    def _check_supply(self) -> Any:  # noqa: ANN401 - of the subclass
        if (self.chamber is None) == (not self.chambers):
            both = "has both" if self.chambers else "has neither"
            what = f'{both} "chamber" and "chambers"'
            raise DesignError("", what, "name the one that it drives, or those on its manifold")
        check_valve(self.leak, self.medium, "leak")
        return self

    @property
    def choices(self) -> tuple[str | int, ...]:
        """The chambers on its manifold."""
        return self.chambers if self.chamber is None else (self.chamber,)

    @property
    def medium(self) -> Gas | Liquid:
        """The fluid that fills them."""
        return fluid_of(self.fluid)


def check_valve(valve: Valve | None, medium: Gas | Liquid, where: str) -> None:
    """Refuse a valve that is not one for a fluid.

    Raises
    ------
    DesignError
        It has an area and the fluid is a gas, or a conductance and it is a liquid.
    """
    if valve is None:
        return
    if medium.kind == "gas" and valve.conductance is None:
        what = "has an area, which is that of a valve for liquids, and the fluid is a gas"
        raise DesignError(where, what, 'give its sonic conductance, such as "0.1 L/s/bar"')
    if medium.kind == "liquid" and valve.area is None:
        what = "has a sonic conductance, which is that of a valve for gas; the fluid is a liquid"
        raise DesignError(where, what, 'give the area of its orifice, such as "0.5 mm^2"')


def _example(**entries: JsonValue) -> ConfigDict:
    return ConfigDict(json_schema_extra={"examples": [{"chamber": "all", **entries}]})


class PressureSupply(Supply):
    """A pressure that a regulator holds, whatever flows.

    A :class:`~voxsoft.design.Pressure` load does the same to the body; this one also tells mass,
    flow and energy, and serves connections.

    Parameters
    ----------
    value
        The gauge pressure; negative is a vacuum.

    Examples
    --------
    >>> PressureSupply(chamber="left", value="20 kPa").value
    20000.0
    """

    model_config = _example(kind="pressure", value="10 kPa")

    kind: Literal["pressure"] = "pressure"
    value: units.Pressure

    @model_validator(mode="after")
    def _check_value(self) -> PressureSupply:
        check_pressure(self.value, "value")
        return self


class VolumeSupply(Supply):
    """A syringe: its plunger pushes a volume into the chamber, or draws it out.

    Parameters
    ----------
    value
        The volume that the plunger goes through; negative draws out. The syringe is full of the
        fluid, under the atmosphere, when it begins, or empty if it draws out.

    Examples
    --------
    >>> VolumeSupply(chamber="left", value="5 mL", fluid="water").value
    5e-06
    """

    model_config = _example(kind="volume", value="5 mL")

    kind: Literal["volume"] = "volume"
    value: Volume


class MassSupply(Supply):
    """A mass of fluid, sealed in.

    Parameters
    ----------
    value
        The mass in chamber and lines; default: their content unloaded, under the atmosphere.
    temperature
        Temperature of the sealed gas in the end; it begins at `fill_temperature`.
    fill_temperature
        Temperature at which the unloaded body is filled under the atmosphere; default 20 °C.

    Examples
    --------
    >>> MassSupply(chamber="left", temperature="60 degC").temperature
    333.15
    """

    model_config = _example(kind="mass", temperature="60 degC")

    kind: Literal["mass"] = "mass"
    value: PositiveMass | None = None
    fill_temperature: Temperature = ROOM


class FlowSupply(Supply):
    """A source behind a valve, a tube, or one after the other; or a pump.

    At rest nothing flows, and the chamber has the pressure of the source, less the drop by a leak.

    Parameters
    ----------
    source
        The gauge pressure of the source; negative is a vacuum. Give this or `pump`.
    pump
        A pump that feeds the chamber itself, in place of `source`.
    valve, tube
        Elements that the flow goes through, in this order; at least one of them with a `source`.

    Examples
    --------
    >>> feed = FlowSupply(chamber="left", source="50 kPa", valve={"conductance": "0.1 L/s/bar"})
    >>> feed.source
    50000.0
    """

    model_config = _example(kind="flow", source="50 kPa", valve={"conductance": "0.1 L/s/bar"})

    kind: Literal["flow"] = "flow"
    source: units.Pressure | None = None
    pump: Pump | None = None
    valve: Valve | None = None
    tube: Tube | None = None

    @model_validator(mode="after")
    def _check_flow(self) -> FlowSupply:
        if (self.source is None) == (self.pump is None):
            both = "has neither" if self.source is None else "has both"
            what = f'{both} "source" and "pump"'
            raise DesignError("", what, "give the pressure of a source, or what a pump delivers")
        if self.pump is not None and (self.valve or self.tube):
            where = "valve" if self.valve else "tube"
            what = "is that of a source, and a pump feeds the chamber itself"
            raise DesignError(where, what, "put what the line takes into the curve of the pump")
        if self.source is not None:
            check_pressure(self.source, "source")
            if self.valve is None and self.tube is None:
                what = "has neither a valve nor a tube: how fast it flows is not known"
                hint = 'give one, such as tube = { length = "1 m", diameter = "2 mm" }'
                raise DesignError("", what, f'{hint}, or write kind = "pressure"')
        check_valve(self.valve, self.medium, "valve")
        return self


AnySupply = Annotated[
    PressureSupply | VolumeSupply | MassSupply | FlowSupply, Field(discriminator="kind")
]


class Connection(Record):
    """A line between two chambers, through which they exchange their fluid.

    Parameters
    ----------
    chambers
        The two. One without a supply is closed, and full of air under the atmosphere at first.
    valve, tube
        Elements that the flow goes through, from the first chamber to the second; at least one.

    Examples
    --------
    >>> Connection(
    ...     chambers=("left", "right"), tube={"length": "0.5 m", "diameter": "1 mm"}
    ... ).chambers
    ('left', 'right')
    """

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [
                {"chambers": [0, 1], "tube": {"length": "0.5 m", "diameter": "1 mm"}},
            ]
        }
    )

    chambers: tuple[CavityChoice, CavityChoice]
    valve: Valve | None = None
    tube: Tube | None = None

    @model_validator(mode="after")
    def _check_line(self) -> Connection:
        if self.valve is None and self.tube is None:
            what = "has neither a valve nor a tube"
            raise DesignError("", what, "give one, or name both chambers in one supply")
        if "all" in self.chambers or self.chambers[0] == self.chambers[1]:
            what = "does not join two chambers"
            raise DesignError("chambers", what, "name two of them")
        return self
