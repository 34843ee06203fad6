"""Gent model: rubber whose chains have a limit."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np

from voxsoft import _core
from voxsoft.materials.hyperelastic import Floats, InvariantModel
from voxsoft.units import Modulus, UnitOf


class Gent(InvariantModel):
    """Gent's rubber, ``W = -μ Jm/2 ln(1 - (I₁ - 3)/Jm)``.

    Stable up to its limit ``I₁ - 3 = Jm``, where the stress grows without bound; beyond it there
    is no energy. As ``Jm`` grows it becomes neo-Hookean.

    Parameters
    ----------
    shear
        Initial shear modulus ``μ``.
    jm
        Limit of ``I₁ - 3``, a positive number. In uniaxial tension the stretch ``λ`` cannot pass
        ``λ² + 2/λ - 3 = Jm``: about 10 for silicones that stretch to three times their length.
    poisson, density, prony
        See :class:`~voxsoft.materials.hyperelastic.Hyperelastic`.

    References
    ----------
    A. N. Gent, "A new constitutive relation for rubber", Rubber Chemistry and Technology 69
    (1996), 59-61.

    Examples
    --------
    >>> round(Gent(shear="20 kPa", jm=30.0, poisson=0.49).bulk)
    993333
    >>> Gent(shear="20 kPa", jm=-1)
    Traceback (most recent call last):
    ...
    voxsoft.errors.MaterialError: jm: -1 is not positive. Try: give a plain number above zero
    """

    model: Literal["gent"] = "gent"
    shear: Modulus
    jm: Annotated[float, UnitOf("number", positive=True)]

    @property
    def constants(self) -> list[float]:
        """``[μ, Jm]``, the first in Pa."""
        return [self.shear, self.jm]

    @property
    def elastic_core(self) -> _core.Material:
        """Material of the Rust core, without branches."""
        return _core.Material.gent(
            shear=self.shear, limit=self.jm, bulk=self.bulk, density=self.density
        )

    def invariant_energy(self, i1: Floats, i2: Floats) -> Floats:
        """Strain energy in J/m³; NaN beyond the limit."""
        del i2
        energy: Floats = -0.5 * self.shear * self.jm * np.log(self._room(i1))
        return energy

    def invariant_slopes(self, i1: Floats) -> tuple[Floats, Floats, Floats]:
        """``∂W/∂I₁``, 0 and ``∂²W/∂I₁²`` in Pa; NaN beyond the limit."""
        room = self._room(i1)
        return 0.5 * self.shear / room, 0.0 * room, 0.5 * self.shear / (self.jm * room**2)

    def _room(self, i1: Floats) -> Floats:
        """Return the remaining part of the range to the limit: 1 at rest, 0 at it, then NaN."""
        room = 1.0 - (i1 - 3.0) / self.jm
        left: Floats = np.where(room > 0.0, room, np.nan)
        return left
