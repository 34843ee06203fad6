"""Tested stretch of the materials of a design."""

from __future__ import annotations

from voxsoft.design.model import Design
from voxsoft.materials import Hyperelastic, Lattice, StretchRange


def tested_ranges(design: Design) -> list[StretchRange | None]:
    """Return the range in which the material of each part was tested; None where it is unknown.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> beam = families.beam().with_values("parts.0.material=rtv615-tensile")
    >>> tested_ranges(beam)
    [StretchRange(largest=2.92)]
    """
    materials = [design.material_of(part) for part in design.parts]
    return [
        material.tested_stretch if isinstance(material, Hyperelastic | Lattice) else None
        for material in materials
    ]
