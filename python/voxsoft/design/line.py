"""Valves, tubes and pumps that a fluid flows through."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated

from pydantic import Field, model_validator

from voxsoft.design.history import History
from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import Pressure, UnitOf

Conductance = Annotated[float, UnitOf("conductance", positive=True)]
PositiveArea = Annotated[float, UnitOf("area", positive=True)]
PositiveLength = Annotated[float, UnitOf("length", positive=True)]
VolumeFlow = Annotated[float, UnitOf("volume flow", non_negative=True)]


class Valve(Record):
    """A restriction: of gas by ISO 6358, of liquid an orifice.

    Parameters
    ----------
    conductance
        Sonic conductance ``C`` for gas, as data sheets give it, ``"0.5 L/s/bar"``.
    critical_ratio
        Ratio ``b`` for gas of the pressures after and before it, 0 to 1, below which the flow
        is choked; default 0.3.
    area
        Area of the orifice for liquid, times its coefficient of discharge, about 0.6.
    history
        Opening over time, 0 (closed) to 1: its conductance or area is in proportion.
        Default: always open. In equilibrium the last factor counts.

    Notes
    -----
    ``ṁ = C ρ₀ p₁ √(T₀/T)`` where it is choked, and ``√(1 − ((p₂/p₁ − b)/(1 − b))²)`` of that else,
    with absolute pressures, ρ₀ = 1.185 kg/m³ and T₀ = 293.15 K. Of liquids ``ṁ = A √(2 ρ Δp)``.

    Examples
    --------
    >>> Valve(conductance="0.1 L/s/bar").conductance
    1e-09
    >>> vent = Valve(
    ...     conductance="0.1 L/s/bar", history={"time": ("2 s", "2.01 s"), "factor": (0, 1)}
    ... )
    >>> vent.history.at(1.0), vent.history.at(3.0)
    (0.0, 1.0)
    """

    conductance: Conductance | None = None
    critical_ratio: Annotated[float, Field(ge=0, lt=1)] = 0.3
    area: PositiveArea | None = None
    history: History | None = None

    @model_validator(mode="after")
    def _has_a_size(self) -> Valve:
        if (self.conductance is None) == (self.area is None):
            given = "neither" if self.area is None else "both"
            what = f'has {given} of "conductance" and "area"'
            raise DesignError("", what, "give conductance for a gas, area for a liquid")
        if self.history is not None:
            for factor in self.history.factors:
                if not 0.0 <= factor <= 1.0:
                    what = f"opens it to {factor:g}"
                    raise DesignError("history", what, "write factors from 0, closed, to 1, open")
        return self


class Tube(Record):
    """A tube with laminar flow, by Hagen and Poiseuille.

    Parameters
    ----------
    length, diameter
        Its length and its inner diameter. Its volume counts as that of the chamber behind it.

    Examples
    --------
    >>> round(Tube(length="1 m", diameter="2 mm").volume * 1e6, 3)
    3.142
    """

    length: PositiveLength
    diameter: PositiveLength

    @property
    def volume(self) -> float:
        """Volume it holds [m³]."""
        return 0.7853981633974483 * self.diameter**2 * self.length


class Pump(Record):
    """A pump from the atmosphere: its flow against a pressure; it lets nothing back.

    Parameters
    ----------
    flow
        Volume flow of the fluid as it is under the atmosphere, at each pressure, falling to 0.
    pressure
        Gauge pressures, rising from 0 to that at which nothing flows.

    Notes
    -----
    Between the points it is linear. Along a history both flow and pressure are in proportion to
    the factor.

    Examples
    --------
    >>> Pump(flow=("2 L/min", 0), pressure=(0, "40 kPa")).pressure
    (0.0, 40000.0)
    """

    flow: tuple[VolumeFlow, ...] = Field(min_length=2)
    pressure: tuple[Pressure, ...] = Field(min_length=2)

    @model_validator(mode="after")
    def _check(self) -> Pump:
        if len(self.flow) != len(self.pressure):
            what = f"has {len(self.flow)} flows and {len(self.pressure)} pressures"
            raise DesignError("", what, "give one flow for each pressure")
        if self.pressure[0] != 0.0 or any(b <= a for a, b in pairwise(self.pressure)):
            raise DesignError("pressure", "does not rise from 0", "begin with the free flow at 0")
        if self.flow[-1] != 0.0 or any(b > a for a, b in pairwise(self.flow)):
            what = "does not fall to 0"
            raise DesignError("flow", what, "end with the pressure at which nothing flows")
        return self
