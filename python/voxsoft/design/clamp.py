"""Clamps: regions that are held, or moved in a prescribed way."""

from __future__ import annotations

from collections.abc import Sequence

from pydantic import field_validator, model_validator

from voxsoft.design.history import History
from voxsoft.design.operands import Name
from voxsoft.design.region import Region
from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import Angle, Point, Vector


class Rotation(Record):
    """A turn about an axis through a center, right-handed.

    Parameters
    ----------
    axis
        Direction of the axis; its length does not matter.
    angle
        Angle of the turn, ``"90 deg"``.
    center
        A point on the axis; default: the origin.

    Examples
    --------
    >>> Rotation(axis=(0, 0, 1), angle="180 deg").center
    (0.0, 0.0, 0.0)
    """

    axis: Vector
    angle: Angle
    center: Point = (0.0, 0.0, 0.0)

    @field_validator("axis")
    @classmethod
    def _has_direction(cls, axis: Vector) -> Vector:
        return check_direction(axis)


class Motion(Record):
    """Prescribed motion of a clamp: first turned, then displaced, both scaled by the history.

    Parameters
    ----------
    displacement
        Displacement along x, y, z.
    rotation
        A turn about an axis; default: none.
    history
        The factor over time; default: reached at once and held.

    Examples
    --------
    >>> Motion(displacement=(0, 0, "-5 mm")).displacement
    (0.0, 0.0, -0.005)
    """

    displacement: Point = (0.0, 0.0, 0.0)
    rotation: Rotation | None = None
    history: History | None = None


class Clamp(Record):
    """Hold the vertices in a region, along all axes or some, still or on a prescribed way.

    Parameters
    ----------
    region
        Region that is held.
    axes
        The held axes, such as ``"xyz"`` (default) or ``"z"`` for a symmetry plane.
    motion
        The way the held vertices go; default: they stay.
    name
        Name in results and metrics; default: its place, ``"clamps[0]"``.

    Examples
    --------
    >>> Clamp(region=Region(x=(0, "10 mm"))).axes
    'xyz'
    >>> Clamp(region=Region(x=(0, 0)), axes="xw")
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: axes: "xw" does not name axes. Try: write "x", "yz" or "xyz"
    """

    region: Region
    axes: str = "xyz"
    motion: Motion | None = None
    name: Name | None = None

    @field_validator("axes")
    @classmethod
    def _known_axes(cls, axes: str) -> str:
        if not axes or set(axes) - set("xyz") or len(set(axes)) != len(axes):
            raise DesignError("", f'"{axes}" does not name axes', 'write "x", "yz" or "xyz"')
        return "".join(sorted(axes))

    @model_validator(mode="after")
    def _turns_whole(self) -> Clamp:
        if self.motion and self.motion.rotation and self.axes != "xyz":
            raise DesignError("axes", "a turning clamp holds all axes", 'write "xyz"')
        return self


def clamp_names(clamps: Sequence[Clamp]) -> list[str]:
    """Return the name of each clamp of a design in results, else its place.

    Examples
    --------
    >>> base = Region(x=(0, 0))
    >>> clamp_names([Clamp(region=base, name="base"), Clamp(region=base)])
    ['base', 'clamps[1]']
    """
    return [clamp.name or f"clamps[{index}]" for index, clamp in enumerate(clamps)]


def check_clamps(clamps: Sequence[Clamp]) -> None:
    """Refuse a name that two clamps have: results could not say which of them is meant."""
    names = clamp_names(clamps)
    for index, name in enumerate(names):
        if name in names[:index]:
            what = f'"{name}" is the name of clamps[{names.index(name)}] too'
            raise DesignError(f"clamps[{index}].name", what, "give it another name")


def check_direction(vector: Vector) -> Vector:
    """Refuse the zero vector as a direction."""
    if not any(vector):
        raise DesignError("", "has no direction", "give a vector that is not zero")
    return vector
