"""Rigid parts: printed caps, inserts, flanges bonded to soft parts."""

from __future__ import annotations

import math
from typing import ClassVar, Final, Literal, NoReturn

from pydantic import Field

from voxsoft.errors import MaterialError, VoxSoftError
from voxsoft.materials.neo_hookean import NeoHookean
from voxsoft.records import Record
from voxsoft.units import PositiveDensity

#: Shear modulus of a rigid part over that of the stiffest soft one of its design. Strains meet at
#: an interface in about the inverse ratio, 10^-4, so that a rigid part moves as one to 10^-3 of the
#: soft motion also where loads concentrate; the residual of statics keeps ten digits.
RIGID_RATIO: Final = 1e4

#: Poisson's ratio of a rigid part, as of plastics; nothing depends on it.
_POISSON: Final = 0.3

#: Density of printed polymers such as PLA, kg/m³ (makers' datasheets give 1240).
_DENSITY: Final = 1240.0


class Rigid(Record):
    """A stiff part that does not deform against the soft parts it is bonded to.

    It has no stiffness of its own: a design solves it as a neo-Hookean solid of 10⁴ times the
    largest initial shear modulus among its soft parts, with Poisson's ratio 0.3.

    Parameters
    ----------
    density
        Default 1240 kg/m³, a printed polymer (PLA).

    Examples
    --------
    >>> Rigid().density
    1240.0
    >>> round(Rigid().beside(shear=20e3).shear)
    200000000
    """

    error_type: ClassVar[type[VoxSoftError]] = MaterialError

    model: Literal["rigid"] = "rigid"
    density: PositiveDensity = Field(_DENSITY)

    def young(self, voxel_size: float | str = 1.0) -> float:
        """Infinity, in Pa."""
        del voxel_size
        return math.inf

    def poisson(self, voxel_size: float = 1.0) -> float:
        """Poisson's ratio of the stiff substitute; nothing depends on it."""
        del voxel_size
        return _POISSON

    def beside(self, shear: float) -> NeoHookean:
        """Return the stiff material that replaces this one beside soft parts.

        Parameters
        ----------
        shear
            Largest shear modulus of the soft parts in Pa.
        """
        young = 2.0 * (1.0 + _POISSON) * RIGID_RATIO * shear
        return NeoHookean(young_modulus=young, poisson=_POISSON, density=self.density)

    @property
    def core(self) -> NoReturn:
        """Unavailable: only a design knows the soft parts that set the stiffness.

        Raises
        ------
        MaterialError
            Always.
        """
        raise MaterialError(
            "material", "a rigid part has no constants of its own", "give the design a soft part"
        )
