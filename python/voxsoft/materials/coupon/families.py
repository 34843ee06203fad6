"""Model families that are fitted to coupons: stress as a function of constants, and the solution.

Each family is linear in its moduli. Exponents (Ogden) and the limit (Gent) are searched outside,
with the best moduli found inside for each (variable projection), so that a search has one to three
unknowns however many constants the model has.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from scipy.optimize import least_squares, nnls

from voxsoft.errors import MaterialError
from voxsoft.materials.gent import Gent
from voxsoft.materials.homogeneous import EXPONENTS, Mode, nominal_stress, principal_stretches
from voxsoft.materials.hyperelastic import Floats
from voxsoft.materials.model import Material
from voxsoft.materials.mooney_rivlin import MooneyRivlin
from voxsoft.materials.neo_hookean import NeoHookean
from voxsoft.materials.ogden import Ogden
from voxsoft.materials.yeoh import Yeoh

#: Largest exponent of an Ogden model in the search; larger ones only fit noise.
LARGEST_EXPONENT: Final = 15.0

_SMALLEST_EXPONENT: Final = 0.1
# Largest Gent limit that shows in the data, in multiples of their largest I₁ - 3.
_FARTHEST_LIMIT: Final = 1e3
# Share of the initial shear modulus, and of the stress, below which a term is negligible.
_NEGLIGIBLE: Final = 1e-9
_TWO_I1: Final = MooneyRivlin(c10=1.0, c01=0.0)
_TWO_I2: Final = MooneyRivlin(c10=0.0, c01=1.0)


class Block(NamedTuple):
    """Points of one mode with the weight of each.

    Stretches (n,), nominal stresses in Pa (n,), weights (n,) that make residuals comparable.
    """

    mode: Mode
    stretch: Floats
    stress: Floats
    weight: Floats


class Anchor(NamedTuple):
    """A measured initial shear modulus in Pa, and its weight."""

    shear: float
    weight: float


class Data(NamedTuple):
    """Data of one fit."""

    blocks: tuple[Block, ...]
    anchors: tuple[Anchor, ...] = ()

    @property
    def target(self) -> Floats:
        """Weighted stresses, then weighted moduli, (n,)."""
        parts = [block.weight * block.stress for block in self.blocks]
        parts.append(np.array([anchor.weight * anchor.shear for anchor in self.anchors]))
        return np.concatenate(parts)

    @property
    def largest_i1(self) -> float:
        """Largest ``I₁ - 3`` of all points."""
        return max(
            float(np.sum(principal_stretches(b.mode, b.stretch) ** 2, axis=0).max()) - 3.0
            for b in self.blocks
        )


class NoFit(MaterialError):
    """Error for a family that the data do not suit, with the reason."""


@dataclass(frozen=True)
class Family:
    """Model with a number of terms.

    Attributes
    ----------
    name
        Name in tables: ``"yeoh-3"``.
    model
        Name of its model: ``"yeoh"``.
    linear
        Number of moduli.
    shapes
        Number of exponents or limits.
    lowest
        Smallest exponent of the search.
    """

    name: str
    model: str
    linear: int
    shapes: int = 0
    lowest: float = -LARGEST_EXPONENT

    @property
    def size(self) -> int:
        """Number of constants."""
        return self.linear + self.shapes

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the constants: the moduli, then exponents or limits."""
        if self.model == "ogden":
            terms = range(1, self.linear + 1)
            return (*(f"mu{i}" for i in terms), *(f"alpha{i}" for i in terms))
        return {
            "neo-hookean": ("c10",),
            "mooney-rivlin": ("c10", "c01"),
            "yeoh": ("c10", "c20", "c30")[: self.linear],
            "gent": ("shear", "jm"),
        }[self.model]

    def columns(self, mode: Mode, stretch: Floats, shapes: Floats) -> Floats:
        """Return the nominal stress for each modulus of 1 Pa, (n, linear)."""
        if self.model == "ogden":
            return np.stack([_power_stress(mode, stretch, a) for a in shapes], axis=1)
        first = nominal_stress(_TWO_I1, stretch, mode)
        excess = np.sum(principal_stretches(mode, stretch) ** 2, axis=0) - 3.0
        if self.model == "gent":
            room = 1.0 - excess / shapes[0]
            with np.errstate(divide="ignore", invalid="ignore"):
                return np.where(room > 0.0, 0.5 * first / room, np.nan)[:, None]
        if self.model == "mooney-rivlin":
            return np.stack([first, nominal_stress(_TWO_I2, stretch, mode)], axis=1)
        return np.stack([(k + 1) * excess**k * first for k in range(self.linear)], axis=1)

    @property
    def shears(self) -> Floats:
        """Initial shear modulus for each modulus of 1 Pa, (linear,)."""
        if self.model in ("ogden", "gent"):
            return np.ones(self.linear)
        if self.model == "mooney-rivlin":
            return np.array([2.0, 2.0])
        return np.array([2.0, 0.0, 0.0][: self.linear])

    def matrix(self, data: Data, shapes: Floats) -> Floats:
        """Return the weighted columns of all data, (n, linear)."""
        parts = [b.weight[:, None] * self.columns(b.mode, b.stretch, shapes) for b in data.blocks]
        parts += [anchor.weight * self.shears[None, :] for anchor in data.anchors]
        return np.concatenate(parts)

    def stress(self, constants: Floats, mode: Mode, stretch: Floats) -> Floats:
        """Return the nominal stress in Pa at any constants, also impossible ones, (n,)."""
        stresses: Floats = (
            self.columns(mode, stretch, constants[self.linear :]) @ constants[: self.linear]
        )
        return stresses

    def shear(self, constants: Floats) -> float:
        """Return the initial shear modulus in Pa."""
        return float(self.shears @ constants[: self.linear])

    def material(self, constants: Floats, poisson: float, density: float) -> Material:
        """Make the material with these constants, to the six digits that a measurement can have."""
        rest = {"poisson": poisson, "density": density}
        rounded = [float(f"{constant:.6g}") for constant in constants]
        moduli, shapes = rounded[: self.linear], rounded[self.linear :]
        if self.model == "neo-hookean":
            return NeoHookean(young_modulus=4.0 * moduli[0] * (1.0 + poisson), **rest)
        if self.model == "mooney-rivlin":
            return MooneyRivlin(c10=moduli[0], c01=moduli[1], **rest)
        if self.model == "yeoh":
            return Yeoh(c=moduli, **rest)
        if self.model == "gent":
            return Gent(shear=moduli[0], jm=shapes[0], **rest)
        return Ogden(mu=moduli, alpha=shapes, **rest)

    def solve(self, data: Data, near: Floats | None = None, *, redundant: bool = False) -> Floats:
        """Find the constants by least squares.

        Parameters
        ----------
        data
            Data to fit.
        near
            Constants to start from; default: many starts.
        redundant
            True to allow terms that add nothing. Default false.

        Returns
        -------
        numpy.ndarray
            Constants in SI units, (size,).

        Raises
        ------
        NoFit
            The initial shear modulus is not positive, or the model is no better than one with
            fewer constants.
        """
        shapes = np.empty(0) if self.shapes == 0 else self._best_shapes(data, near)
        moduli = self._moduli(data, shapes)
        constants = np.concatenate([moduli, shapes])
        if self.shear(constants) <= 0.0:
            raise NoFit(
                self.name,
                f"the best initial shear modulus is {self.shear(constants) / 1e3:.3g} kPa, "
                "not above zero",
            )
        if not redundant:
            self._check_terms(constants, data)
        return constants

    def _moduli(self, data: Data, shapes: Floats) -> Floats:
        """Find the moduli by least squares; those of Ogden and Gent are not negative, so stable."""
        matrix, target = self.matrix(data, shapes), data.target
        scale = np.linalg.norm(matrix, axis=0)
        scale[scale == 0.0] = 1.0
        if self.shapes:
            found = nnls(matrix / scale, target)[0]
        else:
            found = np.linalg.lstsq(matrix / scale, target)[0]
        moduli: Floats = found / scale
        return moduli

    def _misfit(self, data: Data, shapes: Floats) -> Floats:
        residual: Floats = self.matrix(data, shapes) @ self._moduli(data, shapes) - data.target
        return residual

    def _best_shapes(self, data: Data, near: Floats | None) -> Floats:
        if self.model == "gent":
            return self._best_limit(data, near)
        if near is not None:
            starts: Sequence[Floats] = [near[self.linear :]]
        else:
            starts = self._starts(data)
        size = np.linalg.norm(data.target)
        low, high = self.lowest, LARGEST_EXPONENT

        def residual(exponents: Floats) -> Floats:
            found: Floats = self._misfit(data, _off_zero(exponents)) / size
            return found

        best = min(
            (
                least_squares(
                    residual,
                    np.clip(start, 0.99 * low, 0.99 * high),
                    bounds=(low, high),
                    xtol=1e-10,
                    ftol=1e-12,
                    gtol=1e-12,
                    max_nfev=80,
                )
                for start in starts
            ),
            key=lambda found: float(found.cost),
        )
        return np.sort(_off_zero(best.x))

    def _starts(self, data: Data) -> list[Floats]:
        """Choose initial exponents: the best of a grid of combinations, and their neighbors."""
        grid = np.array([-10.0, -6.0, -3.5, -1.5, 1.0, 2.0, 3.0, 5.0, 9.0])
        grid = grid[grid > self.lowest]
        ranked = sorted(
            itertools.combinations(grid, self.shapes),
            key=lambda a: float(np.sum(self._misfit(data, np.array(a)) ** 2)),
        )
        return [np.array(start) for start in ranked[:4]]

    def _best_limit(self, data: Data, near: Floats | None) -> Floats:
        """Search the limit ``Jm`` above the largest ``I₁ - 3`` on a log scale."""
        floor, size = data.largest_i1, np.linalg.norm(data.target)

        def limit(x: float) -> Floats:
            return np.array([floor * (1.0 + np.exp(x))])

        def residual(x: Floats) -> Floats:
            found: Floats = self._misfit(data, limit(float(x[0]))) / size
            return found

        low, high = np.log(1e-3), np.log(_FARTHEST_LIMIT)
        if near is None or near[1] <= floor * (1.0 + 1e-3):
            starts = np.linspace(low, high, 25)
            costs = [float(np.sum(self._misfit(data, limit(x)) ** 2)) for x in starts]
            start = float(starts[int(np.argmin(costs))])
        else:
            start = float(np.log(near[1] / floor - 1.0))
        found = least_squares(
            residual,
            [np.clip(start, low + 1e-6, high - 1e-6)],
            bounds=(low, high),
            xtol=1e-10,
            ftol=1e-12,
        )
        return limit(float(found.x[0]))

    def _check_terms(self, constants: Floats, data: Data) -> None:
        if self.model == "gent" and constants[1] > 0.5 * _FARTHEST_LIMIT * data.largest_i1:
            raise NoFit(self.name, "no limit shows in these data: the same as neo-hookean")
        if self.model == "ogden" and self.linear > 1:
            shapes, moduli = constants[self.linear :], constants[: self.linear]
            largest = np.abs(self.matrix(data, shapes) * moduli).max(axis=0)
            near = np.min(np.diff(shapes)) < 1e-3
            if near or largest.min() < _NEGLIGIBLE * largest.max():
                raise NoFit(self.name, f"no better than ogden-{self.linear - 1}")


def _off_zero(exponents: Floats) -> Floats:
    """Keep exponents away from zero, where the energy is undefined."""
    return np.where(
        np.abs(exponents) < _SMALLEST_EXPONENT,
        np.where(exponents < 0.0, -_SMALLEST_EXPONENT, _SMALLEST_EXPONENT),
        exponents,
    )


def _power_stress(mode: Mode, stretch: Floats, alpha: float) -> Floats:
    """Return the nominal stress of one Ogden term of 1 Pa, (n,)."""
    powers = np.array(EXPONENTS[mode])
    pulled = 2.0 if mode == "equibiaxial" else 1.0
    total: Floats = np.sum(powers[:, None] * stretch[None, :] ** (powers[:, None] * alpha), axis=0)
    return 2.0 / alpha * total / (pulled * stretch)


#: Every family, from few constants to many.
FAMILIES: Final[tuple[Family, ...]] = (
    Family("neo-hookean", "neo-hookean", 1),
    Family("gent", "gent", 1, 1),
    Family("mooney-rivlin", "mooney-rivlin", 2),
    Family("yeoh-2", "yeoh", 2),
    Family("ogden-1", "ogden", 1, 1),
    Family("yeoh-3", "yeoh", 3),
    Family("ogden-2", "ogden", 2, 2),
    Family("ogden-3", "ogden", 3, 3),
)
