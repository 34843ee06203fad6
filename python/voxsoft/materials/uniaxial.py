r"""Stress of a material that is stretched along one axis with its sides free.

The specimen strains evenly, with the stretches ``λ`` along the axis and ``t`` across it. Its sides
are free where the stress across is zero, which decides ``t``; the nominal stress follows.

Hyperelastic models (:mod:`voxsoft.materials.hyperelastic`) have the Kirchhoff stresses
``τᵢ = wᵢ - (w₁ + w₂ + w₃)/3 + K J (J - 1)``, with ``wᵢ = ∂W/∂ln λᵢ`` at the isochoric stretches.

The lattice has, for each cube of edge ``h``, three edges of length ``h`` and three diagonals of
faces of length ``√2 h``, all of them filled around, and the bulk stiffness of its tetrahedra. An
edge of length ``l`` that is stretched by ``s`` holds the energy ``edge l³ (s - 1)²/2``, so that a
unit of volume holds

    W = e/2 Σ (λᵢ - 1)² + √2 e Σ_{i<j} (sᵢⱼ - 1)² + K/2 (J - 1)²,    sᵢⱼ² = (λᵢ² + λⱼ²)/2.

This is the lattice of a large block along the axes of its voxels, without its surface.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from voxsoft.errors import MaterialError
from voxsoft.materials.hyperelastic import Floats, Hyperelastic
from voxsoft.materials.lattice import Lattice

#: Bisections of the range of the transverse stretch, down to rounding.
_HALVINGS: Final = 60


def uniaxial_stress(material: Hyperelastic | Lattice, stretch: ArrayLike) -> Floats:
    """Compute the nominal stress (force over original area) at uniaxial stretches, in Pa.

    Unlike :func:`voxsoft.materials.nominal_stress` it uses the compressibility of the material, and
    takes lattices too.

    Parameters
    ----------
    material
        Material; viscosity and softening are left out: it is the first loading, at rest.
    stretch
        Current over original length, above zero, (...).

    Returns
    -------
    numpy.ndarray
        Stress, (...). Past the limit of a Gent material the volume grows, and the stress with it.

    Raises
    ------
    MaterialError
        A stretch that is not above zero.

    Examples
    --------
    >>> from voxsoft.materials import NeoHookean
    >>> soft = NeoHookean(young="60 kPa", poisson=0.499)
    >>> round(float(uniaxial_stress(soft, 2.0)) / 1e3, 1)
    35.0
    >>> lattice = Lattice(edge="20 kPa", bulk="100 kPa")
    >>> slope = float(uniaxial_stress(lattice, 1.0001)) / 1e-4
    >>> abs(slope / lattice.young() - 1.0) < 1e-3
    True
    """
    along = np.asarray(stretch, dtype=np.float64)
    if not np.all(along > 0.0):
        what, hint = "a stretch that is not above zero", "a stretch is 1 plus the strain"
        raise MaterialError("stretch", what, hint)
    # Bounds of the transverse stretch: constant volume, and no lateral contraction at all.
    ends = np.stack([-0.5 * np.log(along), np.zeros_like(along)])
    low, high = ends.min(axis=0), ends.max(axis=0)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        too_wide = _principal(material, along, np.exp(middle))[1] > 0.0
        low, high = np.where(too_wide, low, middle), np.where(too_wide, middle, high)
    across = np.exp(0.5 * (low + high))
    stress: Floats = _principal(material, along, across)[0] / along
    return stress


def _principal(
    material: Hyperelastic | Lattice, along: Floats, across: Floats
) -> tuple[Floats, Floats]:
    """Return the Kirchhoff stresses in Pa along the axis and across it, (...) each."""
    if isinstance(material, Lattice):
        return _of_lattice(material, along, across)
    volume = along * across**2
    isochoric = np.stack([along, across, across]) / np.cbrt(volume)
    with np.errstate(invalid="ignore", divide="ignore"):  # beyond the limit of a Gent material
        gradient = material.log_gradient(isochoric)
    pressure = material.bulk * volume * (volume - 1.0) - gradient.mean(axis=0)
    return gradient[0] + pressure, gradient[1] + pressure


def _of_lattice(material: Lattice, along: Floats, across: Floats) -> tuple[Floats, Floats]:
    volume = along * across**2
    pressure = material.bulk * volume * (volume - 1.0)
    mixed = np.sqrt(0.5 * (along**2 + across**2))
    # ∂W/∂ln λᵢ: an edge gives e λ (λ - 1), a diagonal √2 e λᵢ² (1 - 1/s) to each of its two.
    diagonal = np.sqrt(2.0) * (1.0 - 1.0 / mixed)
    lengthwise = along * (along - 1.0) + 2.0 * along**2 * diagonal
    flat = np.sqrt(2.0) * (1.0 - 1.0 / across)
    sideways = across * (across - 1.0) + across**2 * (diagonal + flat)
    return material.edge * lengthwise + pressure, material.edge * sideways + pressure
