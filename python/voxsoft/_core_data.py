"""Plain data that the core takes, by the names of its fields: networks of fluid, springs, tendons.

Each dictionary is that of the struct or enum of its name in ``crates/solid``; the core reads it
field by field, and refuses a field that is missing or of another type.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NotRequired, TypedDict, final

#: Times [s], and factors at them.
Course = Sequence[Sequence[float]]
#: Value at rest and final value.
Ramp = Sequence[float]


class GasMedium(TypedDict):
    """Ideal gas: its specific gas constant [J/(kg K)]."""

    constant: float


class LiquidMedium(TypedDict):
    """Liquid: density [kg/m³] and bulk modulus [Pa]."""

    density: float
    bulk: float


class Medium(TypedDict, total=False):
    """Fluid; one of the two keys is present."""

    gas: GasMedium
    liquid: LiquidMedium


class GasValve(TypedDict):
    """Valve for gas by ISO 6358-1: sonic conductance [m³/(s Pa)] and critical pressure ratio."""

    conductance: float
    critical_ratio: float


class LiquidValve(TypedDict):
    """Orifice for liquid: area times coefficient of discharge [m²]."""

    area: float


class Valve(TypedDict, total=False):
    """Restriction of flow; one of the two keys is present."""

    gas: GasValve
    liquid: LiquidValve


class Tube(TypedDict):
    """Tube with laminar flow: length and diameter [m], dynamic viscosity [Pa s]."""

    length: float
    diameter: float
    viscosity: float


class Line(TypedDict):
    """Valve and tube in series, with the fluid in them and its temperature [K]."""

    valve: Valve | None
    tube: Tube | None
    medium: Medium
    temperature: float


class End(TypedDict, total=False):
    """End of a line; one of the two keys is present, an index."""

    chamber: int
    source: int


class Branch(TypedDict):
    """Line between two ends, and the opening of its valve over time."""

    ends: Sequence[End]
    line: Line
    opening: Course | None


class Source(TypedDict):
    """Prescribed gauge pressure [Pa] with its history."""

    pressure: float
    history: Course


class Curve(TypedDict):
    """Characteristic curve of a pump: pressures [Pa] and volume flows [m³/s]."""

    pressures: Sequence[float]
    flows: Sequence[float]


class Pump(TypedDict):
    """Pump of a chamber: curve, density of the fluid drawn [kg/m³], and speed over time."""

    chamber: int
    curve: Curve
    density: float
    history: Course


class Chamber(TypedDict):
    """Volume of fluid: mass [kg], temperature [K] and volume of lines [m³], and their history.

    `path` has a course of each of the three in place of the final values; `held` is the source
    that prescribes the pressure.
    """

    medium: Medium
    mass: Ramp
    temperature: Ramp
    outside: Ramp
    history: Course
    path: NotRequired[Sequence[Course]]
    held: int | None


class Network(TypedDict):
    """Chambers with their lines, sources and pumps; pressure of the atmosphere [Pa]."""

    atmosphere: float
    chambers: Sequence[Chamber]
    branches: Sequence[Branch]
    sources: Sequence[Source]
    pumps: Sequence[Pump]


class Spring(TypedDict):
    """Spring between weighted vertices and an anchor: rest length [m] and stiffness [N/m]."""

    vertices: Sequence[int]
    weights: Sequence[float]
    anchor: Sequence[float]
    length: float
    stiffness: float


#: Element of a term that a design attaches; each kind joins the union.
Element = Spring


@final
class BodyPlace(TypedDict):
    """Point that vertices carry; a point fixed in space has an offset [m] and no vertices."""

    vertices: Sequence[int]
    weights: Sequence[float]
    offset: Sequence[float]


@final
class ObjectPlace(TypedDict):
    """Point [m] that a rigid object carries."""

    object: int
    point: Sequence[float]


class Shortening(TypedDict):
    """Length drawn in [m] of an elastic line, and its axial stiffness EA [N]."""

    by: float
    stiffness: float


class Drive(TypedDict, total=False):
    """Actuation of a tendon; one of the two keys is present, a tension in N."""

    tension: float
    shortening: Shortening


class Tendon(TypedDict):
    """Line through places: lengths of its segments [m], drive and friction coefficient."""

    places: Sequence[BodyPlace | ObjectPlace]
    lengths: Sequence[float]
    drive: Drive
    friction: float
