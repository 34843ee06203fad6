"""Units of CalculiX's input files: those of a problem, and the consistent ones that users know."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Self

from voxsoft.comparison.bricks import BrickModel

#: Young's modulus of the softest part in the units of a problem.
YOUNG: Final = 1e5
#: Residual force that CalculiX takes for zero, in the unit of force of the file.
STOP: Final = 1e-8


@dataclass(frozen=True)
class DeckUnits:
    """Units of length and stress; time is in seconds, and the units of all else follow.

    CalculiX takes a residual of 10⁻⁸ for zero, at any size of the forces (it stops there also where
    that is far above the relative tolerance that it was given). In N and mm that is the whole load
    of a small soft body. In the units of :meth:`of` the edge of a brick is 1 and Young's modulus of
    the softest part 10⁵, so that 10⁻⁸ is the force of a strain of 10⁻¹³ on a face of a brick.

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
        return cls(model.edge, softest_young(model) / YOUNG)

    @property
    def force(self) -> float:
        """Unit of force in N."""
        return self.stress * self.length**2

    @property
    def density(self) -> float:
        """Unit of density in kg/m³."""
        return self.stress / self.length**2

    @property
    def slope(self) -> float:
        """Unit of the stiffness of a contact in Pa/m."""
        return self.stress / self.length


#: Systems of units of an exported file by their unit of length.
SYSTEMS: Final[Mapping[str, DeckUnits]] = MappingProxyType(
    {"m": DeckUnits(1.0, 1.0), "mm": DeckUnits(1e-3, 1e6), "um": DeckUnits(1e-6, 1e6)}
)
#: Units of length, force, stress, mass and time of each system.
IN_WORDS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "m": "m, N, Pa, kg, s; density in kg/m^3",
        "mm": "mm, N, MPa, t, s; density in t/mm^3",
        "um": "um, uN, MPa, kg, s; density in kg/um^3",
    }
)


def softest_young(model: BrickModel) -> float:
    """Return Young's modulus of the softest part of a problem in Pa."""
    used = {model.materials[part] for part in set(model.parts.tolist())}
    return float(min(material.young(model.edge * model.split) for material in used))
