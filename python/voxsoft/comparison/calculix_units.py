"""Units of CalculiX's input files, in which its absolute stop is far below all forces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Self

from voxsoft.comparison.bricks import BrickModel

#: Young's modulus of the softest part in these units.
YOUNG: Final = 1e5


@dataclass(frozen=True)
class DeckUnits:
    """Units of length and stress; the unit of force follows.

    CalculiX takes a residual of 10⁻⁸ for zero, at any size of the forces (it stops there also where
    that is far above the relative tolerance that it was given). In N and mm that is the whole load
    of a small soft body. In these units the edge of a brick is 1 and Young's modulus of the softest
    part 10⁵, so that 10⁻⁸ is the force of a strain of 10⁻¹³ on a face of a brick.

    Attributes
    ----------
    length
        Unit of length in m.
    stress
        Unit of stress in Pa.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.simulation import Setup
    >>> units = DeckUnits.of(BrickModel.of(Setup.of(families.beam()), split=2))
    >>> units.length * 2 == families.beam().voxel_size
    True
    """

    length: float
    stress: float

    @classmethod
    def of(cls, model: BrickModel) -> Self:
        """Choose units for a problem: the edge of a brick, and Young's modulus over 10⁵."""
        used = {model.materials[part] for part in set(model.parts.tolist())}
        softest = min(material.young(model.edge * model.split) for material in used)
        return cls(model.edge, softest / YOUNG)

    @property
    def force(self) -> float:
        """Unit of force in N."""
        return self.stress * self.length**2

    @property
    def density(self) -> float:
        """Unit of density in kg/m³, with accelerations in m/s²."""
        return self.stress / self.length
