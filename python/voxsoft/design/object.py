"""Rigid objects beside the body, with which it has contact."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import ConfigDict, model_validator

from voxsoft.design.clamp import Motion
from voxsoft.design.operands import Name, ShapeOrName
from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import PositiveDensity, PositiveLength, PositiveMass


class Object(Record):
    """A rigid thing that the body touches: a plate, a post, a tool, something to grip.

    Parameters
    ----------
    name
        Name in results and :class:`Contact`.
    shape
        Name of a shape of the design, or a shape. It is not part of the body.
    motion
        ``"fixed"`` (default), ``"free"``, or a prescribed motion, as of a clamp. A free object
        moves under its weight and contact, over time or to its place in equilibrium.
    density, mass
        Density or mass of a free object. Volume and moments of inertia are those of its shape, of
        one density.
    voxel_size
        Size of the triangles of its surface: edges are rounded by a third of it. Default: the voxel
        size of the design.

    Examples
    --------
    >>> from voxsoft.shapes import Sphere
    >>> ball = Object(name="ball", shape=Sphere(radius="10 mm"))
    >>> ball.motion
    'fixed'
    >>> Object(name="ball", shape="ball", motion="free")
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: mass: an object that moves freely needs a mass. Try: write mass = \
"50 g" or density = "1000 kg/m^3"
    """

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [{"name": "ball", "shape": {"kind": "sphere", "radius": "10 mm"}}]
        }
    )

    name: Name
    shape: ShapeOrName
    motion: Literal["fixed", "free"] | Motion = "fixed"
    density: PositiveDensity | None = None
    mass: PositiveMass | None = None
    voxel_size: PositiveLength | None = None

    @model_validator(mode="after")
    def _has_one_mass(self) -> Self:
        given = [name for name in ("density", "mass") if getattr(self, name) is not None]
        if self.motion != "free" and given:
            what = 'is that of an object that moves freely, and the motion is not "free"'
            raise DesignError(given[0], what, f'write motion = "free", or leave {given[0]} out')
        if self.motion == "free" and not given:
            what = "an object that moves freely needs a mass"
            hint = 'write mass = "50 g" or density = "1000 kg/m^3"'
            raise DesignError("mass", what, hint)
        if len(given) > 1:
            raise DesignError("mass", "is given twice, by the density too", "leave one of them out")
        return self

    @property
    def is_free(self) -> bool:
        """True if it moves freely."""
        return self.motion == "free"

    @property
    def way(self) -> Motion | None:
        """The motion; None if it is fixed or free."""
        return self.motion if isinstance(self.motion, Motion) else None
