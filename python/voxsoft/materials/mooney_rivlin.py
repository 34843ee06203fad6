"""Mooney–Rivlin model: two coefficients."""

from __future__ import annotations

from typing import Literal

import numpy as np

from voxsoft import _core
from voxsoft.materials.hyperelastic import Floats, InvariantModel, SignedModulus


class MooneyRivlin(InvariantModel):
    """Mooney–Rivlin rubber, ``W = C10 (I₁ - 3) + C01 (I₂ - 3)`` with ``μ₀ = 2 (C10 + C01)``.

    Stable at every stretch where neither coefficient is negative. A fit to tension of a silicone
    that stiffens has a negative ``C01`` and buckles in compression: do not use it there
    (:func:`~voxsoft.materials.stability.stable_range`).

    Parameters
    ----------
    c10, c01
        Coefficients; one of them may be negative.
    poisson, density, prony
        See :class:`~voxsoft.materials.hyperelastic.Hyperelastic`.

    Examples
    --------
    >>> MooneyRivlin(c10="10.4 kPa", c01="4 kPa", poisson=0.48).shear
    28800.0
    >>> MooneyRivlin(c10="1 kPa", c01="-2 kPa")
    Traceback (most recent call last):
    ...
    voxsoft.errors.MaterialError: the initial shear modulus is -2 kPa; it must be above zero for \
the material to resist at all. Try: check signs and units, or fit another model
    """

    model: Literal["mooney-rivlin"] = "mooney-rivlin"
    c10: SignedModulus
    c01: SignedModulus

    @property
    def shear(self) -> float:
        """Initial shear modulus ``2 (C10 + C01)`` in Pa."""
        return 2.0 * (self.c10 + self.c01)

    @property
    def constants(self) -> list[float]:
        """``[C10, C01]`` in Pa."""
        return [self.c10, self.c01]

    @property
    def elastic_core(self) -> _core.Material:
        """Material of the Rust core, without branches."""
        return _core.Material.mooney_rivlin(
            c10=self.c10, c01=self.c01, bulk=self.bulk, density=self.density
        )

    def invariant_energy(self, i1: Floats, i2: Floats) -> Floats:
        """Strain energy in J/m³."""
        energy: Floats = self.c10 * (i1 - 3.0) + self.c01 * (i2 - 3.0)
        return energy

    def invariant_slopes(self, i1: Floats) -> tuple[Floats, Floats, Floats]:
        """``(C10, C01, 0)`` in Pa."""
        nothing = np.zeros_like(i1)
        return nothing + self.c10, nothing + self.c01, nothing
