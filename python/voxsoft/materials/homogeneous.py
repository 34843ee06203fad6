"""Closed forms of the three tests with homogeneous strain of a rubber specimen.

A sheet of incompressible material is pulled so that its principal stretches are powers of one
stretch ``λ`` and its faces are free of stress:

=============  ==================  ===
mode           λ₁, λ₂, λ₃          n
=============  ==================  ===
uniaxial       λ, λ^-1/2, λ^-1/2   1
equibiaxial    λ, λ, λ^-2          2
planar         λ, 1, λ^-1          1
=============  ==================  ===

The stress in the ``n`` pulled directions does the work ``n P dλ`` on a unit of volume (a planar
specimen is held, not pulled, across), so that the nominal stress is ``P = U'(λ)/n`` with
``U(λ) = W(λ₁, λ₂, λ₃)``. With ``λᵢ = λ^pᵢ`` and ``wᵢ = ∂W/∂ln λᵢ`` this is

    P(λ) = Σ pᵢ wᵢ / (n λ),    P'(λ) = (Σ pᵢ pⱼ wᵢⱼ - Σ pᵢ wᵢ) / (n λ²).

At small strain ``P = E ε`` in uniaxial, ``2 E ε`` in equibiaxial and ``4/3 E ε`` in planar tension.
"""

from __future__ import annotations

from typing import Final, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from voxsoft.errors import MaterialError
from voxsoft.materials.hyperelastic import Floats, Hyperelastic
from voxsoft.records import closest

#: Mode of a test with homogeneous strain.
Mode = Literal["uniaxial", "equibiaxial", "planar"]

#: Names of the modes.
MODES: Final[tuple[Mode, ...]] = get_args(Mode)

#: Exponents ``p`` of the stretch along the three axes.
EXPONENTS: Final[dict[str, tuple[float, float, float]]] = {
    "uniaxial": (1.0, -0.5, -0.5),
    "equibiaxial": (1.0, 1.0, -2.0),
    "planar": (1.0, 0.0, -1.0),
}

_PULLED: Final = {"uniaxial": 1, "equibiaxial": 2, "planar": 1}


def principal_stretches(mode: Mode, stretch: ArrayLike) -> Floats:
    """Return the principal stretches of a test at stretches ``λ``, (...) → (3, ...).

    Raises
    ------
    MaterialError
        An unknown mode, or a stretch that is not above zero.

    Examples
    --------
    >>> principal_stretches("equibiaxial", 2.0).tolist()
    [2.0, 2.0, 0.25]
    """
    if mode not in EXPONENTS:
        raise MaterialError("mode", f'"{mode}" is not a test', closest(str(mode), MODES))
    pulled = np.asarray(stretch, dtype=np.float64)
    if not np.all(pulled > 0.0):
        raise MaterialError(
            "stretch", "a stretch that is not above zero", "a stretch is 1 plus the strain"
        )
    return np.stack([pulled**power for power in EXPONENTS[mode]])


def nominal_stress(material: Hyperelastic, stretch: ArrayLike, mode: Mode = "uniaxial") -> Floats:
    """Compute the engineering stress (force over original area) of incompressible material, in Pa.

    Parameters
    ----------
    material
        Material; its Poisson's ratio is ignored, as volume is kept.
    stretch
        Current over original length, above zero, (...).
    mode
        ``"uniaxial"``, ``"equibiaxial"`` or ``"planar"`` (pure shear).

    Returns
    -------
    numpy.ndarray
        Stress, (...); NaN beyond the limit of a Gent material.

    Raises
    ------
    MaterialError
        An unknown mode, or a stretch that is not above zero.

    Examples
    --------
    >>> from voxsoft.materials import NeoHookean
    >>> soft = NeoHookean(young="60 kPa", poisson=0.499)
    >>> round(float(nominal_stress(soft, 2.0)))  # μ (λ - 1/λ²)
    35023
    """
    powers, gradient, _ = _along(material, stretch, mode)
    stress: Floats = np.tensordot(powers, gradient, axes=1) / (_PULLED[mode] * np.asarray(stretch))
    return stress


def nominal_tangent(material: Hyperelastic, stretch: ArrayLike, mode: Mode = "uniaxial") -> Floats:
    """Differentiate :func:`nominal_stress` with respect to the stretch, in Pa, (...) → (...).

    Examples
    --------
    >>> from voxsoft.materials import NeoHookean
    >>> soft = NeoHookean(young="60 kPa", poisson=0.499)
    >>> round(float(nominal_tangent(soft, 1.0)) / soft.shear, 12)
    3.0
    """
    powers, gradient, hessian = _along(material, stretch, mode)
    twice = np.einsum("i,j,ij...->...", powers, powers, hessian)
    pulled = np.asarray(stretch, dtype=np.float64)
    tangent: Floats = (twice - np.tensordot(powers, gradient, axes=1)) / (_PULLED[mode] * pulled**2)
    return tangent


def _along(material: Hyperelastic, stretch: ArrayLike, mode: Mode) -> tuple[Floats, Floats, Floats]:
    stretches = principal_stretches(mode, stretch)
    powers = np.array(EXPONENTS[mode])
    return powers, material.log_gradient(stretches), material.log_hessian(stretches)
