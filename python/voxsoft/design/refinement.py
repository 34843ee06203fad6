"""Local refinement: where the voxels of a design are half as large."""

from __future__ import annotations

from pydantic import ConfigDict, model_validator

from voxsoft.design.operands import Name
from voxsoft.design.region import Region
from voxsoft.errors import DesignError
from voxsoft.records import Record


class Refinement(Record):
    """A place where voxels have half the edge of those of the design.

    All around it voxels stay as large as they are. Those that the surface cuts are halved
    wherever they are, and so are those that layers, springs and edges of clamps meet.

    Parameters
    ----------
    region
        Voxels that it meets, or comes as near as a quarter of their edge.
    part
        The name of a part: voxels of it alone. Default: of all parts.

    Notes
    -----
    Where large and small voxels meet, the vertices of the small ones move as the large ones do
    there. Voxels stay small where contact, tendons, gas or liquid act, and where the material
    differs from voxel to voxel.

    Examples
    --------
    >>> Refinement(region=Region(x=(0, "10 mm"))).region.x
    (0.0, 0.01)
    >>> Refinement()
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: says nowhere. Try: give a region, or a part, or both
    """

    model_config = ConfigDict(json_schema_extra={"examples": [{"region": {"x": [0, "10 mm"]}}]})

    region: Region | None = None
    part: Name | None = None

    @model_validator(mode="after")
    def _says_where(self) -> Refinement:
        if self.region is None and self.part is None:
            raise DesignError("", "says nowhere", "give a region, or a part, or both")
        return self


#: Ratio of the large voxels to the refined ones.
TIMES_AS_SMALL = 2
