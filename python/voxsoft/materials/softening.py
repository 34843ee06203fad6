"""Closed form of a specimen that is loaded, unloaded and loaded again, with softening."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from voxsoft.materials.homogeneous import Mode, nominal_stress, principal_stretches
from voxsoft.materials.hyperelastic import Floats, Hyperelastic


def cycled_stress(material: Hyperelastic, stretch: ArrayLike, mode: Mode = "uniaxial") -> Floats:
    """Compute the engineering stress of incompressible material along a stretch history, in Pa.

    Parameters
    ----------
    material
        Material with its `mullins`, if it softens; its Poisson's ratio is ignored.
    stretch
        Stretches one after the other, (n,), at any spacing but with all turning points among them:
        the peak is the largest energy of those so far.
    mode
        ``"uniaxial"``, ``"equibiaxial"`` or ``"planar"``.

    Returns
    -------
    numpy.ndarray
        Stress, (n,): :func:`nominal_stress` times the part that softening leaves.

    Raises
    ------
    MaterialError
        An unknown mode, or a stretch that is not above zero.

    Examples
    --------
    >>> from voxsoft.materials import NeoHookean
    >>> soft = NeoHookean(young="60 kPa", mullins={"r": 1.5, "m": "1 kPa", "beta": 0.1})
    >>> (cycled_stress(soft, [1.0, 1.5, 2.0, 1.5, 1.0, 1.5, 2.0]) / 1e3).round(1).tolist()
    [0.0, 21.1, 35.0, 7.0, 0.0, 7.0, 35.0]
    """
    first = nominal_stress(material, stretch, mode)
    if material.mullins is None:
        return first
    energy = material.energy(principal_stretches(mode, stretch))
    peak = np.maximum.accumulate(np.maximum(energy, material.first_peak))
    stress: Floats = material.mullins.remaining(energy, peak) * first
    return stress
