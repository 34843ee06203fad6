"""Layers: fabric, film or paper bonded to a body."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, model_validator

from voxsoft.design.operands import Name
from voxsoft.design.region import Region
from voxsoft.errors import DesignError
from voxsoft.materials import SILICONE_DENSITY
from voxsoft.records import Record
from voxsoft.units import PositiveDensity, PositiveLength, UnitOf

#: Poisson's ratio where a layer names none: paper and most films have 0.2 to 0.4.
_POISSON = 0.3


def _of_a_sheet(poisson: float) -> float:
    if not -1.0 < poisson <= 0.5:
        raise DesignError(
            "", f"{poisson:g} is outside -1 to 0.5", "paper and films have 0.2 to 0.4"
        )
    return poisson


class Layer(Record):
    """A thin layer bonded to the body: it resists stretch in its plane and no bending.

    A region that is a plane across an axis, such as ``z = [0, 0]``, takes the faces of voxels in
    that plane, on the surface or inside the body. Any other region takes the faces of the
    surface. A face belongs to the layer if all its corners are in the region.

    Parameters
    ----------
    region
        Place of the layer.
    young
        Young's modulus of the layer.
    thickness
        Its thickness; the layer counts by ``young`` times ``thickness``, and adds no volume.
    poisson
        Poisson's ratio, above -1 and up to 0.5; default 0.3.
    density
        Default 1070 kg/m³.
    seal
        If true, the layer, which must then lie in a plane, also spans the openings that it
        encloses, and so closes the chambers behind them. Default: no.
    name
        Name in results.

    Notes
    -----
    The material is linear (Saint Venant-Kirchhoff in plane stress). Compressed, it wrinkles below
    the size of a voxel (tension field) and keeps a hundredth of its stiffness, or that of a voxel
    of the solid at its corners if that is less. Over an opening it
    is held by the rim and stays flat in between: the bulge there, about
    ``(p s⁴/(E t))^(1/3)`` under a pressure ``p`` over a span ``s``, is left out. Where that counts,
    close the chamber by a layer of voxels.

    Examples
    --------
    >>> Layer(region=Region(z=(0, 0)), young="4.1 GPa", thickness="0.5 mm").poisson
    0.3
    >>> Layer(region=Region(z=(0, 0)), young="1 GPa", thickness="-1 mm")
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: thickness: "-1 mm" is not positive. Try: give a length above zero
    """

    region: Region
    young: Annotated[float, UnitOf("modulus", positive=True)]
    thickness: PositiveLength
    poisson: Annotated[float, UnitOf("number"), AfterValidator(_of_a_sheet)] = _POISSON
    density: PositiveDensity = SILICONE_DENSITY
    seal: bool = False
    name: Name | None = None

    @property
    def axis(self) -> Literal[0, 1, 2] | None:
        """The axis across the layer's plane; None if its region is not a plane across one axis."""
        flat = [bounds is not None and bounds[0] == bounds[1] for bounds in self._ranges()]
        axes: tuple[Literal[0, 1, 2], ...] = (0, 1, 2)
        across = [axis for axis in axes if flat[axis]]
        return across[0] if len(across) == 1 else None

    def _ranges(self) -> tuple[tuple[float, float] | None, ...]:
        return self.region.x, self.region.y, self.region.z

    @model_validator(mode="after")
    def _seals_in_a_plane(self) -> Layer:
        if self.seal and self.axis is None:
            raise DesignError(
                "seal",
                "a layer that closes openings must lie in a plane across one axis",
                "give its region a plane, such as z = [0, 0]",
            )
        return self
