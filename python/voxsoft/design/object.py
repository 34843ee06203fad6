"""Rigid objects beside the body: what it touches."""

from __future__ import annotations

from typing import Literal

from pydantic import ConfigDict, field_validator

from voxsoft.design.clamp import Motion
from voxsoft.design.operands import Name, ShapeOrName
from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import PositiveLength


class Object(Record):
    """A rigid thing that the body touches: a plate, a post, a tool.

    Parameters
    ----------
    name
        What results and :class:`Contact` call it.
    shape
        Name of a shape of the design, or a shape. It is not part of the body.
    motion
        ``"fixed"`` (default), or the way that it goes, as a clamp does.
    voxel_size
        How finely its surface is traced: edges are rounded by a third of it. Default: the voxel
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
    voxsoft.errors.DesignError: motion: "free" cannot be simulated yet. Try: write "fixed", or \
give it a displacement or a rotation
    """

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [{"name": "ball", "shape": {"kind": "sphere", "radius": "10 mm"}}]
        }
    )

    name: Name
    shape: ShapeOrName
    motion: Literal["fixed"] | Motion = "fixed"
    voxel_size: PositiveLength | None = None

    @field_validator("motion", mode="before")
    @classmethod
    def _not_free(cls, motion: object) -> object:
        if motion == "free":
            what = '"free" cannot be simulated yet'
            raise DesignError("", what, 'write "fixed", or give it a displacement or a rotation')
        return motion

    @property
    def way(self) -> Motion | None:
        """The motion; None if it is fixed."""
        return self.motion if isinstance(self.motion, Motion) else None
