"""Ogden model: powers of the principal stretches."""

from __future__ import annotations

from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field, model_validator

from voxsoft import _core
from voxsoft.errors import MaterialError
from voxsoft.materials.hyperelastic import Floats, Hyperelastic, SignedModulus
from voxsoft.records import plain_values
from voxsoft.units import UnitOf, to_si


class Ogden(Hyperelastic):
    """Ogden's rubber, ``W = Σ 2 μᵢ/αᵢ² (λ₁^αᵢ + λ₂^αᵢ + λ₃^αᵢ - 3)`` with ``μ₀ = Σ μᵢ``.

    This is the convention of Abaqus. Where a source writes ``W = Σ mᵢ/αᵢ (...)``, as Ogden did and
    many papers do, ``μᵢ = mᵢ αᵢ/2``: :meth:`from_classic` converts. Stable at every stretch where
    all ``μᵢ`` are positive.

    Parameters
    ----------
    mu
        One to three moduli.
    alpha
        Exponents, as many as `mu`, none of them zero.
    poisson, density, prony
        See :class:`~voxsoft.materials.hyperelastic.Hyperelastic`.

    References
    ----------
    R. W. Ogden, "Large deformation isotropic elasticity", Proceedings of the Royal Society A 326
    (1972), 565-584. Abaqus theory manual, "Hyperelastic material behavior".

    Examples
    --------
    >>> soft = Ogden(mu=["20 kPa", "5 kPa"], alpha=[1.7, -3.4])
    >>> soft.shear, soft.constants
    (25000.0, [20000.0, 1.7, 5000.0, -3.4])
    >>> Ogden(mu=["20 kPa"], alpha=[1.7, 2])
    Traceback (most recent call last):
    ...
    voxsoft.errors.MaterialError: alpha: has 2 entries, mu has 1; expected one exponent for each \
modulus
    """

    model: Literal["ogden"] = "ogden"
    mu: tuple[SignedModulus, ...] = Field(min_length=1, max_length=3)
    alpha: tuple[Annotated[float, UnitOf("number")], ...] = Field(min_length=1, max_length=3)

    @model_validator(mode="after")
    def _paired(self) -> Self:
        if len(self.mu) != len(self.alpha):
            raise MaterialError(
                "alpha",
                f"has {len(self.alpha)} entries, mu has {len(self.mu)}; "
                "expected one exponent for each modulus",
            )
        if 0.0 in self.alpha:
            raise MaterialError(
                f"alpha[{self.alpha.index(0.0)}]",
                "is zero, where the energy has no meaning",
                "leave the term out",
            )
        return self

    @classmethod
    def from_classic(
        cls,
        moduli: ArrayLike,
        exponents: ArrayLike,
        poisson: float | None = None,
        density: float | None = None,
    ) -> Ogden:
        """Convert constants of ``W = Σ mᵢ/αᵢ (λ₁^αᵢ + λ₂^αᵢ + λ₃^αᵢ - 3)``.

        Parameters
        ----------
        moduli
            ``mᵢ`` in Pa or with their unit, (n,); those that are zero are left out.
        exponents
            ``αᵢ``, (n,).
        poisson, density
            Poisson's ratio and density in kg/m³; default: those of the model.

        Examples
        --------
        >>> Ogden.from_classic([10e3, 0.0], [2.0, 5.0]).mu
        (10000.0,)
        """
        many = plain_values(moduli)
        many = many if isinstance(many, (list, tuple)) else [many]
        given = [to_si(modulus, "modulus", "moduli") for modulus in many]
        pairs = zip(given, np.ravel(exponents).tolist(), strict=True)
        terms = [(0.5 * modulus * alpha, alpha) for modulus, alpha in pairs if modulus != 0.0]
        rest = {"poisson": poisson, "density": density}
        return cls(
            mu=[mu for mu, _ in terms],
            alpha=[alpha for _, alpha in terms],
            **{name: value for name, value in rest.items() if value is not None},
        )

    @property
    def shear(self) -> float:
        """Initial shear modulus ``Σ μᵢ`` in Pa."""
        return float(sum(self.mu))

    @property
    def constants(self) -> list[float]:
        """``[μ₁, α₁, μ₂, α₂, ...]``, the moduli in Pa."""
        return [number for term in zip(self.mu, self.alpha, strict=True) for number in term]

    @property
    def elastic_core(self) -> _core.Material:
        """Material of the Rust core, without branches."""
        terms = list(zip(self.mu, self.alpha, strict=True))
        return _core.Material.ogden(terms=terms, bulk=self.bulk, density=self.density)

    def energy(self, stretches: ArrayLike) -> Floats:
        """Strain energy in J/m³ at principal stretches whose product is 1, (3, ...) → (...)."""
        logs = np.log(np.asarray(stretches, dtype=np.float64))
        energy: Floats = np.zeros(logs.shape[1:])
        for mu, alpha in zip(self.mu, self.alpha, strict=True):
            energy = energy + 2.0 * mu / alpha**2 * np.expm1(alpha * logs).sum(axis=0)
        return energy

    def log_gradient(self, stretches: ArrayLike) -> Floats:
        """``∂W/∂ln λᵢ = Σ 2 μ/α λᵢ^α`` in Pa, (3, ...) → (3, ...)."""
        given = np.asarray(stretches, dtype=np.float64)
        gradient: Floats = np.zeros_like(given)
        for mu, alpha in zip(self.mu, self.alpha, strict=True):
            gradient = gradient + 2.0 * mu / alpha * given**alpha
        return gradient

    def log_hessian(self, stretches: ArrayLike) -> Floats:
        """``Σ 2 μ λᵢ^α δᵢⱼ`` in Pa, (3, ...) → (3, 3, ...)."""
        given = np.asarray(stretches, dtype=np.float64)
        hessian: Floats = np.zeros((3, *given.shape))
        for mu, alpha in zip(self.mu, self.alpha, strict=True):
            for axis in range(3):
                hessian[axis, axis] += 2.0 * mu * given[axis] ** alpha
        return hessian
