"""Mullins effect: rubber that was stretched before is softer."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Final, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import model_validator

from voxsoft.errors import MaterialError, VoxSoftError
from voxsoft.records import Record
from voxsoft.units import UnitOf

Floats = NDArray[np.float64]

_ROOT_PI: Final = math.sqrt(math.pi)


class Mullins(Record):
    """Softening by the largest stretch so far, after Ogden and Roxburgh.

    If the energy ``W`` of the change of shape is below the largest ``P`` that it has had, the
    stress that comes from it is ``η`` times that of the first loading,

    ``η = 1 - erf((P - W)/(m + β P))/r``.

    Parameters
    ----------
    r
        Above 1: at most the part ``1/r`` of the stress is lost.
    m
        Energy below the peak that it takes to lose it, in Pa (J/m³), not negative. The larger,
        the less a material softens that was stretched little.
    beta
        Energy as a part of the peak, not negative; `m` and `beta` are not both zero. Default 0.
    preconditioned
        Strain to which all of the material was pulled before, as a strip is; ``"40 %"`` or 0.4.
        Default 0: virgin material.

    References
    ----------
    R. W. Ogden and D. G. Roxburgh, "A pseudo-elastic model for the Mullins effect in filled
    rubber", doi 10.1098/rspa.1999.0431; `beta` as in Abaqus.

    Examples
    --------
    >>> soft = Mullins(r=1.5, m="2 kPa", beta=0.1)
    >>> [round(float(eta), 3) for eta in soft.remaining([0.0, 8e3, 10e3], 10e3)]
    [0.333, 0.564, 1.0]
    >>> Mullins(r=1.0, m="2 kPa")
    Traceback (most recent call last):
    ...
    voxsoft.errors.MaterialError: r: 1 is not above 1. Try: 1.5 lets softened rubber carry a third \
of the stress at least
    """

    error_type: ClassVar[type[VoxSoftError]] = MaterialError

    r: Annotated[float, UnitOf("number", positive=True)]
    m: Annotated[float, UnitOf("modulus")]
    beta: Annotated[float, UnitOf("number")] = 0.0
    preconditioned: Annotated[float, UnitOf("number")] = 0.0

    @model_validator(mode="after")
    def _possible(self) -> Self:
        if self.r <= 1.0:
            hint = "1.5 lets softened rubber carry a third of the stress at least"
            raise MaterialError("r", f"{self.r:g} is not above 1", hint)
        for name in ("m", "beta", "preconditioned"):
            if (value := getattr(self, name)) < 0.0:
                raise MaterialError(name, f"{value:g} is negative", "take 0 or more")
        if self.m == 0.0 and self.beta == 0.0:
            hint = "beta = 0.1 scales with the largest energy so far"
            raise MaterialError("m", "is zero, and so is beta: nothing says when it softens", hint)
        return self

    def remaining(self, energy: ArrayLike, peak: ArrayLike) -> Floats:
        """Return the part ``η`` of the stress that remains, at energies up to the peak in J/m³."""
        from scipy.special import erf  # slow to load

        energy, peak = np.asarray(energy, dtype=np.float64), np.asarray(peak, dtype=np.float64)
        below = np.maximum(peak - energy, 0.0)
        scale = np.maximum(self.m + self.beta * peak, np.finfo(float).tiny)
        left: Floats = 1.0 - erf(below / scale) / self.r
        return left

    def lost(self, peak: float) -> float:
        """Compute the energy lost in a cycle from zero to a peak and back, both in J/m³.

        ``∫ (1 - η) dW = (s/r) (G(P/s) - G(0))`` with ``s = m + β P`` and
        ``G(x) = x erf x + exp(-x²)/√π``.

        Examples
        --------
        >>> soft = Mullins(r=2.0, m="10 Pa")
        >>> round(soft.lost(1e3) / 1e3, 4)  # near 1/r where m is small
        0.4972
        """
        scale = self.m + self.beta * peak
        if scale == 0.0:
            return 0.0
        x = peak / scale
        return float(scale / self.r * (x * math.erf(x) + (math.exp(-x * x) - 1.0) / _ROOT_PI))
