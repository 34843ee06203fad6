"""Neo-Hookean model: one modulus."""

from __future__ import annotations

from typing import Literal

import numpy as np
from pydantic import Field

from voxsoft import _core
from voxsoft.materials.hyperelastic import Floats, InvariantModel
from voxsoft.units import Modulus


class NeoHookean(InvariantModel):
    """Neo-Hookean rubber, ``W = μ/2 (I₁ - 3)`` with ``μ = E/(2 (1 + ν))``.

    Right for moderate strain, to about 50 %; it does not stiffen at large stretch. Stable at every
    stretch.

    Parameters
    ----------
    young
        Young's modulus at small strain; :meth:`young` reads it back.
    poisson, density, prony
        See :class:`~voxsoft.materials.hyperelastic.Hyperelastic`.

    Examples
    --------
    >>> soft = NeoHookean(young="60 kPa", poisson=0.499)
    >>> round(soft.shear), round(soft.bulk / 1e6, 3)
    (20013, 10.0)
    >>> soft.young()
    60000.0
    >>> NeoHookean(young="60 kPa", poisson=0.5)
    Traceback (most recent call last):
    ...
    voxsoft.errors.MaterialError: poisson: 0.5 is not below 0.5, where the bulk modulus would be \
infinite. Try: use 0.499, or 0.4999 for a stiffer volume; the elements do not lock there
    """

    model: Literal["neo-hookean"] = "neo-hookean"
    young_modulus: Modulus = Field(alias="young")

    def young(self, voxel_size: float | str = 1.0) -> float:
        """Young's modulus in Pa, as it was given; the voxel size is ignored."""
        del voxel_size
        return self.young_modulus

    @property
    def shear(self) -> float:
        """Initial shear modulus ``μ`` in Pa."""
        return self.young_modulus / (2.0 * (1.0 + self.poisson))

    @property
    def constants(self) -> list[float]:
        """``[μ/2]`` in Pa."""
        return [self.shear / 2.0]

    @property
    def elastic_core(self) -> _core.Material:
        """Material of the Rust core, without branches."""
        return _core.Material.neo_hookean(
            c10=self.shear / 2.0, bulk=self.bulk, density=self.density
        )

    def invariant_energy(self, i1: Floats, i2: Floats) -> Floats:
        """Strain energy in J/m³."""
        del i2
        energy: Floats = 0.5 * self.shear * (i1 - 3.0)
        return energy

    def invariant_slopes(self, i1: Floats) -> tuple[Floats, Floats, Floats]:
        """``(μ/2, 0, 0)`` in Pa."""
        nothing = np.zeros_like(i1)
        return nothing + 0.5 * self.shear, nothing, nothing
