"""Loads: gravity, pressures, forces, tractions, liquids, fields; and the floor."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Discriminator,
    Field,
    Tag,
    WithJsonSchema,
    field_validator,
)

from voxsoft import _core, units
from voxsoft.design.chamber import CavityChoice
from voxsoft.design.clamp import check_direction
from voxsoft.design.history import History
from voxsoft.design.region import Region
from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import (
    KINDS,
    Acceleration,
    Dimensionless,
    Length,
    NonNegative,
    NonNegativeDensity,
    NonNegativeSpeed,
    Quantity,
    Speed,
    Vector,
)

Forces = tuple[units.Force, units.Force, units.Force]
Stresses = tuple[units.Pressure, units.Pressure, units.Pressure]
Velocity = tuple[Speed, Speed, Speed]
FluxDensity = tuple[units.MagneticField, units.MagneticField, units.MagneticField]


class Gravity(Record):
    """Weight of the whole body. Without this load there is no gravity.

    Parameters
    ----------
    value
        Acceleration; default 9.81 m/s².
    direction
        Direction of gravity (down); default −z. Its length does not matter.
    history
        The factor over time; default: constant.

    Examples
    --------
    >>> Gravity().value
    9.81
    """

    kind: Literal["gravity"] = "gravity"
    value: Acceleration = 9.81
    direction: Vector = (0.0, 0.0, -1.0)
    history: History | None = None

    @field_validator("direction")
    @classmethod
    def _has_direction(cls, direction: Vector) -> Vector:
        return check_direction(direction)


class Pressure(Record):
    """Gauge pressure in a cavity, a follower load: it stays normal to the deforming wall.

    Parameters
    ----------
    value
        The pressure; negative is a vacuum.
    cavity
        ``"all"`` (default), the name of a chamber of the design, or the index of one cavity; 0 is
        the largest.
    history
        The factor over time; default: constant.

    Examples
    --------
    >>> from voxsoft.units import kPa
    >>> Pressure(value=4 * kPa).cavity
    'all'
    """

    kind: Literal["pressure"] = "pressure"
    value: units.Pressure
    cavity: CavityChoice = "all"
    history: History | None = None


class Force(Record):
    """A dead force, shared evenly by the vertices in a region.

    Parameters
    ----------
    region
        Place where it acts.
    value
        Components x, y, z of the total force.
    history
        The factor over time; default: constant.

    Examples
    --------
    >>> Force(region=Region(x=("100 mm", "100 mm")), value=(0, 0, "-20 mN")).value
    (0.0, 0.0, -0.02)
    """

    kind: Literal["force"] = "force"
    region: Region
    value: Forces
    history: History | None = None


def _scalar_or_vector(value: object) -> str:
    return "vector" if isinstance(value, (list, tuple)) else "scalar"


class Traction(Record):
    """Force per area on the outer surface inside a region.

    Parameters
    ----------
    region
        A boundary triangle is loaded if its three vertices are in the region.
    value
        Three components (a dead load, per undeformed area), or one number: a pressure that
        pushes onto the surface and follows it.
    history
        The factor over time; default: constant.

    Examples
    --------
    >>> Traction(region=Region(z=(0, 0)), value="2 kPa").value
    2000.0
    """

    kind: Literal["traction"] = "traction"
    region: Region
    value: Annotated[
        Annotated[units.Pressure, Tag("scalar")] | Annotated[Stresses, Tag("vector")],
        Discriminator(_scalar_or_vector),
    ]
    history: History | None = None


class MagneticField(Record):
    """A uniform magnetic field, which pulls and turns the parts that have a remanence.

    The magnets are hard: their magnetization is that of the undeformed part, carried along, and
    their own field is left out.

    Parameters
    ----------
    value
        Components x, y, z of the flux density.
    history
        The factor over time; default: constant. A field that turns is two loads, each with the
        history of its direction.

    Examples
    --------
    >>> MagneticField(value=(0, 0, "20 mT")).value
    (0.0, 0.0, 0.02)
    """

    kind: Literal["magnetic_field"] = "magnetic_field"
    value: FluxDensity
    history: History | None = None


class Immersion(Record):
    """A liquid at rest around the whole body: a pressure that grows with depth, and carries it.

    The pressure acts on all that displaces the liquid, material and closed cavities, wherever it
    moves to. There is none at the surface of the liquid; the body stays below it.

    Parameters
    ----------
    value
        Density of the liquid; default: water. 0 is none.
    level
        Height of its surface along z; default 0.
    gravity
        Acceleration that gives the liquid its weight, along −z; default 9.81 m/s². The weight of
        the body is a load :class:`Gravity`.
    history
        The factor over time; default: constant.

    Notes
    -----
    Drag is a load of its own, :class:`Drag`; the liquid that moves along with the body is left
    out, and objects feel no liquid.

    Examples
    --------
    >>> Immersion(level="0.2 m").value
    1000.0
    """

    kind: Literal["immersion"] = "immersion"
    value: NonNegativeDensity = 1000.0
    level: Length = 0.0
    gravity: Acceleration = 9.81
    history: History | None = None


class Drag(Record):
    """Drag of a fluid on the outer surface of the body, against its motion through the fluid.

    An element of the surface with the area A and the outward normal n, which moves by u relative
    to the fluid, feels −ρ A (w u + cₜ/2 |uₜ| uₜ + cₙ/2 max(u·n, 0)² n): a linear part, friction
    along it, and a pressure on the side of the body that meets the fluid.

    Parameters
    ----------
    value
        Density ρ of the fluid; default: water. 0 is none.
    normal
        Coefficient cₙ of the pressure, by Newton's law of the squared sine: a plate across the
        flow and a box have the drag coefficient cₙ, a ball half of it. Default 1.
    tangential
        Coefficient cₜ of the friction along the surface; default 0.
    linear
        Speed w of the linear part, for slow flow: of a ball of the radius R it is 3ν/(2R) with the
        kinematic viscosity ν (of water 1e-6 m²/s). Default 0.
    flow
        Velocity of the fluid along x, y, z; default: at rest.
    history
        The factor over time, not below zero; default: constant.

    Notes
    -----
    It acts in motions by implicit steps, which a run over time with it takes. At rest only the
    flow is felt.

    Examples
    --------
    >>> Drag(normal=1.2, flow=("0.3 m/s", 0, 0)).flow
    (0.3, 0.0, 0.0)
    """

    kind: Literal["drag"] = "drag"
    value: NonNegativeDensity = 1000.0
    normal: NonNegative = 1.0
    tangential: NonNegative = 0.0
    linear: NonNegativeSpeed = 0.0
    flow: Velocity = (0.0, 0.0, 0.0)
    history: History | None = None

    @field_validator("history")
    @classmethod
    def _takes_energy(cls, history: History | None) -> History | None:
        least = 0.0 if history is None else min(history.factors)
        if least < 0.0:
            what = f"has the factor {least:g}, and drag below zero would drive the body"
            raise DesignError("", what, "give factors from 0 on; a flow drives it")
        return history


def _as_text(value: object) -> object:
    """Write numbers, and the values of formulas of the design, as text."""
    if isinstance(value, Quantity):
        if value.dimension != KINDS["acceleration"].dimension:
            raise DesignError("", f"is {value}, not an acceleration", "give one, in m/s^2")
        return repr(value.value)
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return repr(float(value))
    return value


def _readable(text: str) -> str:
    _core.Formula(text)
    return text


#: Text of a function of x, y, z [m], vx, vy, vz [m/s] and t [s], checked; or a number.
FormulaText = Annotated[
    str,
    BeforeValidator(_as_text),
    AfterValidator(_readable),
    WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "number"}]}),
]


class ForceField(Record):
    """An acceleration of all mass of the body, a function of place, velocity and time.

    Parameters
    ----------
    acceleration
        Components along x, y, z in m/s², as functions of ``x``, ``y``, ``z`` in m, ``vx``, ``vy``,
        ``vz`` in m/s and ``t`` in s: numbers, or text in the grammar of
        :class:`voxsoft.shapes.Expression`, whose numbers are in SI units.
    value
        A factor on it; default 1.
    history
        Another factor, over time; default: constant.

    Notes
    -----
    At rest velocities are zero, and statics refuses a field that changes with ``t``. Objects feel
    no field.

    Examples
    --------
    >>> swirl = ForceField(acceleration=("-4*x - 8*vx", "-4*y - 8*vy", "-9.81"))
    >>> swirl.acceleration[2]
    '-9.81'
    >>> ForceField(acceleration=(0, 0, "-9.81*z/hight"))
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: acceleration[2]: at character 9: "hight" is not known; known are \
x y z vx vy vz t pi abs acos asin atan atan2 ceil cos exp floor hypot log max min sin sqrt tan. \
Try: write a function of x, y, z in m, vx, vy, vz in m/s and t in s, such as "-9.81 - 8*vz"
    """

    kind: Literal["force_field"] = "force_field"
    acceleration: tuple[FormulaText, FormulaText, FormulaText]
    value: Dimensionless = 1.0
    history: History | None = None


AnyLoad = Annotated[
    Gravity | Pressure | Force | Traction | MagneticField | Immersion | Drag | ForceField,
    Field(discriminator="kind"),
]


def scaled(load: AnyLoad, factor: float) -> AnyLoad:
    """Return a load that is so many times as large.

    Parameters
    ----------
    load
        Any load.
    factor
        Factor on its value.

    Examples
    --------
    >>> scaled(Pressure(value="4 kPa"), 0.5).value
    2000.0
    """
    value = load.value
    many = tuple(factor * each for each in value) if isinstance(value, tuple) else factor * value
    return load.replace(value=many)


class Floor(Record):
    """A horizontal plane without friction that nothing sinks through.

    Parameters
    ----------
    z
        Its height; default 0.

    Examples
    --------
    >>> Floor(z="-10 mm").z
    -0.01
    """

    z: Length = 0.0
