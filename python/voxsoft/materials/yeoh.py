"""Yeoh model: a polynomial of the first invariant."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from voxsoft import _core
from voxsoft.materials.hyperelastic import Floats, InvariantModel, SignedModulus


class Yeoh(InvariantModel):
    """Yeoh's rubber, ``W = C10 (I₁ - 3) + C20 (I₁ - 3)² + C30 (I₁ - 3)³`` with ``μ₀ = 2 C10``.

    The model to choose when tension is all that was measured: it has no second invariant, whose
    coefficient tension hardly tells. A negative last coefficient makes the stress fall beyond some
    stretch (:func:`~voxsoft.materials.stability.stable_range` says where).

    Parameters
    ----------
    c
        One to three coefficients ``C10, C20, C30``; the first is positive.
    poisson, density, prony
        See :class:`~voxsoft.materials.hyperelastic.Hyperelastic`.

    References
    ----------
    O. H. Yeoh, "Some forms of the strain energy function for rubber", Rubber Chemistry and
    Technology 66 (1993), 754-771.

    Examples
    --------
    >>> Yeoh(c=["13.2229 kPa", "-142.341 Pa", "20.1153 Pa"], poisson=0.48).shear
    26445.8
    >>> Yeoh(c=[])
    Traceback (most recent call last):
    ...
    voxsoft.errors.MaterialError: c: has 0 entries; expected at least 1
    """

    model: Literal["yeoh"] = "yeoh"
    c: tuple[SignedModulus, ...] = Field(min_length=1, max_length=3)

    @property
    def shear(self) -> float:
        """Initial shear modulus ``2 C10`` in Pa."""
        return 2.0 * self.c[0]

    @property
    def constants(self) -> list[float]:
        """``[C10, C20, C30]`` in Pa, with zeros for those not given."""
        return [*self.c, *[0.0] * (3 - len(self.c))]

    @property
    def elastic_core(self) -> _core.Material:
        """Material of the Rust core, without branches."""
        return _core.Material.yeoh(c=self.constants, bulk=self.bulk, density=self.density)

    def invariant_energy(self, i1: Floats, i2: Floats) -> Floats:
        """Strain energy in J/m³."""
        del i2
        x = i1 - 3.0
        c10, c20, c30 = self.constants
        energy: Floats = x * (c10 + x * (c20 + x * c30))
        return energy

    def invariant_slopes(self, i1: Floats) -> tuple[Floats, Floats, Floats]:
        """``∂W/∂I₁``, 0 and ``∂²W/∂I₁²`` in Pa."""
        x = i1 - 3.0
        c10, c20, c30 = self.constants
        return c10 + x * (2.0 * c20 + x * 3.0 * c30), 0.0 * x, 2.0 * c20 + 6.0 * c30 * x
