"""Loads: gravity, pressures, forces, tractions, magnetic fields, immersion; and the floor."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag, field_validator

from voxsoft import units
from voxsoft.design.chamber import CavityChoice
from voxsoft.design.clamp import check_direction
from voxsoft.design.history import History
from voxsoft.design.region import Region
from voxsoft.records import Record
from voxsoft.units import Acceleration, Length, PositiveDensity, Vector

Forces = tuple[units.Force, units.Force, units.Force]
Stresses = tuple[units.Pressure, units.Pressure, units.Pressure]
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
        Density of the liquid; default: water.
    level
        Height of its surface along z; default 0.
    gravity
        Acceleration that gives the liquid its weight, along −z; default 9.81 m/s². The weight of
        the body is a load :class:`Gravity`.
    history
        The factor over time; default: constant.

    Notes
    -----
    Drag and the liquid that moves along with the body are left out; objects feel no liquid.

    Examples
    --------
    >>> Immersion(level="0.2 m").value
    1000.0
    """

    kind: Literal["immersion"] = "immersion"
    value: PositiveDensity = 1000.0
    level: Length = 0.0
    gravity: Acceleration = 9.81
    history: History | None = None


AnyLoad = Annotated[
    Gravity | Pressure | Force | Traction | MagneticField | Immersion, Field(discriminator="kind")
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
