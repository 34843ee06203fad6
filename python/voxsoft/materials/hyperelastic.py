"""Base of all hyperelastic models: Poisson's ratio, density, viscosity, moduli at rest."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import (
    AfterValidator,
    Field,
    SerializerFunctionWrapHandler,
    model_serializer,
    model_validator,
)

from voxsoft import _core
from voxsoft.errors import MaterialError, VoxSoftError
from voxsoft.materials.lattice import SILICONE_DENSITY
from voxsoft.materials.mullins import Mullins
from voxsoft.materials.tested import StretchRange
from voxsoft.records import Record
from voxsoft.units import PositiveDensity, PositiveTime, UnitOf, format_quantity

Floats = NDArray[np.float64]

#: Modulus that may be negative, as coefficients of polynomials are.
SignedModulus = Annotated[float, UnitOf("modulus")]

#: Default of Poisson's ratio: the bulk modulus is then 500 shear moduli.
NEARLY_INCOMPRESSIBLE = 0.499

_STANDING = ("poisson", "density", "prony", "mullins", "tested_stretch")


def _below_half(poisson: float) -> float:
    if poisson < 0.0:
        raise MaterialError(
            "", f"{poisson:g} is negative; 0 to just below 0.5 is allowed", "rubber has 0.499"
        )
    if poisson >= 0.5:
        raise MaterialError(
            "",
            f"{poisson:g} is not below 0.5, where the bulk modulus would be infinite",
            "use 0.499, or 0.4999 for a stiffer volume; the elements do not lock there",
        )
    return poisson


#: Poisson's ratio: 0 or more, and below 0.5.
PoissonRatio = Annotated[float, UnitOf("number"), AfterValidator(_below_half)]


class PronyTerm(Record):
    """One branch of a generalized Maxwell body: the share of the modulus that relaxes, and when.

    Parameters
    ----------
    g
        Relative shear modulus of the branch, between 0 and 1: the part of the instantaneous
        stiffness that is lost.
    tau
        Relaxation time.

    Examples
    --------
    >>> PronyTerm(g=0.1, tau="1.5 s").tau
    1.5
    """

    error_type: ClassVar[type[VoxSoftError]] = MaterialError

    g: Annotated[float, UnitOf("number", positive=True)]
    tau: PositiveTime


class Hyperelastic(Record):
    """Base of the models whose stress follows from a strain energy.

    The energy is ``W(λ̄₁, λ̄₂, λ̄₃) + K/2 (J - 1)²`` with the principal stretches freed of the
    change of volume ``J``, ``λ̄ = λ J^(-1/3)``, and the bulk modulus
    ``K = 2 μ₀ (1 + ν)/(3 (1 - 2 ν))``. Each model gives its ``W``.

    Parameters
    ----------
    poisson
        Poisson's ratio at small strain, 0 or more and below 0.5. Default 0.499.
    density
        Default 1070 kg/m³, a platinum-cure silicone.
    prony
        Branches that relax. The constants are those at rest, when all branches have relaxed; a
        sudden load meets ``1/(1 - Σ g)`` times as much. Their ``g`` add up to less than 1.
        Default: none, a purely elastic material.
    mullins
        Softening where it was stretched more before, see :class:`Mullins`. The constants are
        those of the first loading. Default: not at all.
    tested_stretch
        Stretch of the specimens from which the constants come, if that is known;
        results that go farther carry a warning. Default: not known.
    """

    error_type: ClassVar[type[VoxSoftError]] = MaterialError

    model: str
    poisson: PoissonRatio = NEARLY_INCOMPRESSIBLE
    density: PositiveDensity = SILICONE_DENSITY
    prony: tuple[PronyTerm, ...] = Field(default=())
    mullins: Mullins | None = None
    tested_stretch: StretchRange | None = None

    if TYPE_CHECKING:

        @property
        def shear(self) -> float:
            """Initial shear modulus in Pa."""

    @property
    @abstractmethod
    def constants(self) -> list[float]:
        """Constants of ``W`` in SI units, in the order of its formula."""

    @property
    @abstractmethod
    def elastic_core(self) -> _core.Material:
        """Material of the Rust core, without branches."""

    @abstractmethod
    def energy(self, stretches: ArrayLike) -> Floats:
        """Strain energy ``W`` in J/m³ at principal stretches whose product is 1, (3, ...) → (...).

        NaN beyond the range of the material.
        """

    @abstractmethod
    def log_gradient(self, stretches: ArrayLike) -> Floats:
        """``∂W/∂ln λᵢ`` in Pa: Kirchhoff stresses up to a pressure, (3, ...) → (3, ...)."""

    @abstractmethod
    def log_hessian(self, stretches: ArrayLike) -> Floats:
        """``∂²W/∂ln λᵢ ∂ln λⱼ`` in Pa, (3, ...) → (3, 3, ...)."""

    def young(self, voxel_size: float | str = 1.0) -> float:
        """Young's modulus in Pa at small strain, ``2 μ₀ (1 + ν)``.

        Parameters
        ----------
        voxel_size
            Ignored; lattices whose modulus depends on it take it too.
        """
        del voxel_size
        return 2.0 * self.shear * (1.0 + self.poisson)

    @property
    def bulk(self) -> float:
        """Bulk modulus ``K`` in Pa."""
        return 2.0 * self.shear * (1.0 + self.poisson) / (3.0 * (1.0 - 2.0 * self.poisson))

    @property
    def core(self) -> _core.Material:
        """Material of the Rust core."""
        core = self.elastic_core.with_prony([(term.g, term.tau) for term in self.prony])
        if self.mullins is None:
            return core
        soft = self.mullins
        return core.with_mullins(soft.r, soft.m, soft.beta, self.first_peak)

    @property
    def first_peak(self) -> float:
        """Largest energy in J/m³ of the preconditioning, the same in all of the material."""
        if self.mullins is None:
            return 0.0
        stretch = 1.0 + self.mullins.preconditioned
        return float(self.energy(np.array([stretch, stretch**-0.5, stretch**-0.5])))

    @model_validator(mode="after")
    def _possible(self) -> Self:
        if not all(map(math.isfinite, (self.shear, self.bulk))):
            raise MaterialError("", "the constants are too large for a number", "check the units")
        if self.shear <= 0.0:
            raise MaterialError(
                "",
                f"the initial shear modulus is {format_quantity(self.shear, 'modulus')}; "
                "it must be above zero for the material to resist at all",
                "check signs and units, or fit another model",
            )
        if not math.isfinite(self.first_peak):
            raise MaterialError(
                "mullins.preconditioned",
                "is a strain that this material cannot reach",
                "take less, or a larger limit jm",
            )
        if (relaxed := sum(branch.g for branch in self.prony)) >= 1.0:
            raise MaterialError(
                "prony",
                f"the relative moduli g add up to {relaxed:g}; less than 1 must remain",
                "g is a share of the instantaneous modulus, not a modulus",
            )
        return self

    @model_serializer(mode="wrap")
    def _constants_first(self, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Write the constants before the common fields, and no empty list of branches."""
        written: dict[str, Any] = write(self)
        standing = {key: written.pop(key) for key in _STANDING if key in written}
        if not standing.get("prony", True):
            del standing["prony"]
        return written | standing


class InvariantModel(Hyperelastic):
    """Base of the models that are written in ``I₁ = Σ λᵢ²`` and, linearly, ``I₂ = Σ λᵢ⁻²``."""

    @abstractmethod
    def invariant_energy(self, i1: Floats, i2: Floats) -> Floats:
        """Strain energy in J/m³ at these invariants, (...) → (...)."""

    @abstractmethod
    def invariant_slopes(self, i1: Floats) -> tuple[Floats, Floats, Floats]:
        """``∂W/∂I₁``, ``∂W/∂I₂`` and ``∂²W/∂I₁²`` in Pa, (...) → three of (...)."""

    def energy(self, stretches: ArrayLike) -> Floats:
        """Strain energy in J/m³ at principal stretches whose product is 1, (3, ...) → (...)."""
        squares = np.square(np.asarray(stretches, dtype=np.float64))
        return self.invariant_energy(squares.sum(axis=0), (1.0 / squares).sum(axis=0))

    def log_gradient(self, stretches: ArrayLike) -> Floats:
        """``∂W/∂ln λᵢ = 2 λᵢ² W₁ - 2 λᵢ⁻² W₂`` in Pa, (3, ...) → (3, ...)."""
        squares = np.square(np.asarray(stretches, dtype=np.float64))
        first, second, _ = self.invariant_slopes(squares.sum(axis=0))
        gradient: Floats = 2.0 * squares * first - 2.0 / squares * second
        return gradient

    def log_hessian(self, stretches: ArrayLike) -> Floats:
        """``4 (λᵢ² W₁ + λᵢ⁻² W₂) δᵢⱼ + 4 λᵢ² λⱼ² W₁₁`` in Pa, (3, ...) → (3, 3, ...)."""
        squares = np.square(np.asarray(stretches, dtype=np.float64))
        first, second, curvature = self.invariant_slopes(squares.sum(axis=0))
        hessian: Floats = 4.0 * squares[:, None] * squares[None, :] * curvature
        for axis in range(3):
            hessian[axis, axis] += 4.0 * (squares[axis] * first + second / squares[axis])
        return hessian
