"""Clamps: regions that are held, or moved in a prescribed way."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal

from pydantic import field_validator, model_validator

from voxsoft.design.history import History
from voxsoft.design.operands import Name
from voxsoft.design.region import Region
from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import Angle, Point, Vector

#: Slope against a coordinate axis that is rounding, as of an axis that is turned with a body.
_ALONG: Final = 1e-9


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

    @property
    def along(self) -> Literal["x", "y", "z"] | None:
        """The coordinate axis that it is about; None for any other axis."""
        sizes = [abs(each) for each in self.axis]
        longest = max(sizes)
        if sum(sizes) - longest > _ALONG * longest:
            return None
        return ("x", "y", "z")[sizes.index(longest)]


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
        The held axes, such as ``"xyz"`` (default) or ``"z"`` for a symmetry plane. A clamp that
        turns about one of them may leave that one free, so that the section can warp: ``"yz"``
        about x.
    motion
        The way the held vertices go; default: they stay.
    name
        Name in results and metrics; default: its place, ``"clamps[0]"``.

    Examples
    --------
    >>> Clamp(region=Region(x=(0, "10 mm"))).axes
    'xyz'
    >>> turn = Motion(rotation=Rotation(axis=(1, 0, 0), angle="30 deg"))
    >>> Clamp(region=Region(x=(0, 0)), axes="yz", motion=turn).axes
    'yz'
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
        turn = self.motion.rotation if self.motion else None
        if turn is None or self.axes == "xyz":
            return self
        along = turn.along
        if along is None:
            raise DesignError("axes", "a turning clamp holds all axes", 'write "xyz"')
        across = "xyz".replace(along, "")
        if self.axes != across:
            what = f"a clamp that turns about {along} holds {across} or all axes"
            raise DesignError("axes", what, f'write "{across}" or "xyz"')
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
