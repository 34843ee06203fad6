"""The closed form of a specimen that is pulled, let go and pulled again, with softening."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from voxsoft.materials.homogeneous import Mode, nominal_stress, principal_stretches
from voxsoft.materials.hyperelastic import Floats, Hyperelastic


def cycled_stress(material: Hyperelastic, stretch: ArrayLike, mode: Mode = "uniaxial") -> Floats:
    """Engineering stress along a history of stretches of incompressible material, in Pa.

    Parameters
    ----------
    material
        With its `mullins`, if it softens; its Poisson's ratio does not count.
    stretch
        One after the other, (n,), as far apart as one likes but for turning points, which are to be
        among them: the peak is the largest energy of those so far.
    mode
        ``"uniaxial"``, ``"equibiaxial"`` or ``"planar"``.

    Returns
    -------
    numpy.ndarray
        (n,), :func:`nominal_stress` times the part that softening leaves.

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
