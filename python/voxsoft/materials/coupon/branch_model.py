"""Stress of one family with branches in all tests of a fit, and its slopes by the unknowns.

The stress is linear in the moduli ``c`` and in the stiffness ``γ`` of each branch,
``P = (E + Σ γₖ Oₖ) c``, with the elastic columns ``E`` of the family and their response ``Oₖ`` in a
branch of the time ``τₖ``. Slopes by times and exponents are differences.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.optimize import least_squares

from voxsoft.materials.coupon.curve import Curve
from voxsoft.materials.coupon.families import LARGEST_EXPONENT, Block, Data, Family
from voxsoft.materials.coupon.timed import TimedTest, thinned
from voxsoft.materials.homogeneous import Mode
from voxsoft.materials.hyperelastic import Floats
from voxsoft.materials.relaxing import StretchHistory

#: Step of differences: half the digits of a number, for unknowns of order one.
_STEP: Final = 1e-7
#: Largest stiffness of a branch over the long-term one: g = 0.99 of one branch.
_STIFFEST: Final = 100.0
#: Factor by which the search may leave the times between rows and the length of the tests.
_BEYOND: Final = 10.0
#: Columns that are kept from one evaluation to the next.
_REMEMBERED: Final = 40


@dataclass(frozen=True)
class Unknowns:
    """Constants of a family with branches.

    Attributes
    ----------
    moduli, shapes
        Long-term moduli in Pa and exponents or limits, in the order of the family.
    gammas, taus
        Stiffness of each branch over the long-term one, and its time in s, rising.
    """

    moduli: Floats
    shapes: Floats
    gammas: Floats
    taus: Floats

    @property
    def shares(self) -> Floats:
        """Share ``g = γ/(1 + Σ γ)`` of the instantaneous stiffness in each branch."""
        shares: Floats = self.gammas / (1.0 + self.gammas.sum())
        return shares


class BranchModel:
    """All tests of one material, with one family for its long-term stress.

    Parameters
    ----------
    family
        Family of the long-term stress.
    tests, curves
        Tests over time, and quasi-static curves, which have the long-term stress.
    """

    def __init__(self, family: Family, tests: Sequence[TimedTest], curves: Sequence[Curve]) -> None:
        self.family = family
        self._memo: dict[tuple[bytes, float], list[Floats]] = {}
        self.shortest = min(test.shortest for test in tests)
        self.longest = max(test.duration for test in tests)
        self.resolved = min(max(test.shortest, test.ramp) for test in tests)
        pairs = [thinned(test) for test in tests]
        tests = [test for test, _ in pairs]
        self._weights = [weight for _, weight in pairs]
        self._weights += [np.ones(len(curve.stress)) for curve in curves]
        self._histories = [StretchHistory(test.time, test.stretch) for test in tests]
        self._curves = curves
        every: list[TimedTest | Curve] = [*tests, *curves]
        self._stresses = [each.stress for each in every]
        self.size = max(float(np.abs(stress).max()) for stress in self._stresses)
        uniaxial: Mode = "uniaxial"
        modes = [*(uniaxial for _ in tests), *(curve.mode for curve in curves)]
        self.data = Data(
            tuple(
                Block(mode, each.stretch, each.stress, weight / self.size)
                for mode, each, weight in zip(modes, every, self._weights, strict=True)
            )
        )

    def elastic_start(self) -> Unknowns:
        """Return the constants of an elastic material that fits best.

        Raises
        ------
        NoFit
            The family does not suit the data.
        """
        constants = self.family.solve(self.data, redundant=True)
        linear = self.family.linear
        return Unknowns(constants[:linear], constants[linear:], np.empty(0), np.empty(0))

    def residuals(self, at: Unknowns) -> list[Floats]:
        """Return model minus measured stress in Pa of each test, then of each curve.

        A mean of ``n`` rows has ``√n`` times its error: all residuals have the scale of a row's.
        """
        columns = self._columns(at.shapes, at.taus)
        return [
            weight * (_whole(parts, at.gammas) @ at.moduli - stress)
            for parts, stress, weight in zip(columns, self._stresses, self._weights, strict=True)
        ]

    def slopes(self, at: Unknowns) -> Floats:
        """Return the slopes of the residuals by moduli, shapes, γ and ln τ, (n, unknowns)."""
        columns = self._columns(at.shapes, at.taus)
        by_moduli = [_whole(parts, at.gammas) for parts in columns]
        slopes = list(np.concatenate(by_moduli).T)
        base = np.concatenate([part @ at.moduli for part in by_moduli])
        for index in range(len(at.shapes)):
            step = _STEP * max(abs(float(at.shapes[index])), 1.0)
            shapes = at.shapes.copy()
            shapes[index] += step
            moved = [_whole(p, at.gammas) @ at.moduli for p in self._columns(shapes, at.taus)]
            slopes.append((np.concatenate(moved) - base) / step)
        slopes += [
            np.concatenate([parts[1 + k] @ at.moduli for parts in columns])
            for k in range(len(at.taus))
        ]
        later = self._columns(at.shapes, at.taus * np.exp(_STEP))
        for k, gamma in enumerate(at.gammas):
            pairs = zip(later, columns, strict=True)
            change = [(new[1 + k] - old[1 + k]) @ at.moduli for new, old in pairs]
            slopes.append(gamma * np.concatenate(change) / _STEP)
        weights = np.concatenate(self._weights)[:, None]
        weighted: Floats = weights * np.stack(slopes, axis=1)
        return weighted

    def solve(self, start: Unknowns) -> Unknowns:
        """Find the least squares from a start, with γ ≥ 0."""
        low, high = self._bounds(len(start.taus))
        scale = np.ones(len(low))
        scale[: self.family.linear] = self.size

        def residual(x: Floats) -> Floats:
            found = np.concatenate(self.residuals(self._unknowns(x * scale)))
            return np.nan_to_num(found, nan=1e3 * self.size, posinf=1e3 * self.size) / self.size

        def slope(x: Floats) -> Floats:
            return np.nan_to_num(self.slopes(self._unknowns(x * scale))) * scale / self.size

        # Bounds are left by a part of their distance: a search from a bound stays there.
        room = np.where(np.isfinite(high - low), 1e-6 * (high - low), 1e-9)
        first = np.clip(self._packed(start) / scale, low + room, high - room)
        found = least_squares(
            residual,
            first,
            slope,
            bounds=(low, high),
            x_scale="jac",
            xtol=1e-10,
            ftol=1e-10,
            gtol=1e-10,
            max_nfev=60,
        )
        return _in_order(self._unknowns(found.x * scale))

    def _bounds(self, branches: int) -> tuple[Floats, Floats]:
        family = self.family
        low = [0.0] if family.shears[0] > 0.0 else [-np.inf]
        low += [0.0 if family.shapes else -np.inf] * (family.linear - 1)
        high = [np.inf] * family.linear
        if family.model == "gent":
            low += [1.001 * self.data.largest_i1]
            high += [1e4 * self.data.largest_i1]
        else:
            low += [-LARGEST_EXPONENT] * family.shapes
            high += [LARGEST_EXPONENT] * family.shapes
        low += [0.0] * branches + [np.log(self.shortest / _BEYOND)] * branches
        high += [_STIFFEST] * branches + [np.log(self.longest * _BEYOND)] * branches
        return np.array(low), np.array(high)

    def _packed(self, at: Unknowns) -> Floats:
        return np.concatenate([at.moduli, at.shapes, at.gammas, np.log(at.taus)])

    def _unknowns(self, x: Floats) -> Unknowns:
        linear, size = self.family.linear, self.family.size
        branches = (len(x) - size) // 2
        return Unknowns(
            x[:linear], x[linear:size], x[size : size + branches], np.exp(x[size + branches :])
        )

    def _columns(self, shapes: Floats, taus: Floats) -> list[list[Floats]]:
        """Return the columns of each test and curve: elastic, then of each branch, (n, linear)."""
        elastic = self._elastic(shapes)
        parts = [elastic, *(self._overstress(shapes, float(tau)) for tau in taus)]
        found = [
            [history.given(part[at]) for part in parts]
            for at, history in enumerate(self._histories)
        ]
        for curve in self._curves:
            own = self.family.columns(curve.mode, curve.stretch, shapes)
            found.append([own, *(np.zeros_like(own) for _ in taus)])
        return found

    def _elastic(self, shapes: Floats) -> list[Floats]:
        def compute() -> list[Floats]:
            return [
                self.family.columns("uniaxial", history.stretch, shapes)
                for history in self._histories
            ]

        return self._kept((shapes.tobytes(), 0.0), compute)

    def _overstress(self, shapes: Floats, tau: float) -> list[Floats]:
        def compute() -> list[Floats]:
            pairs = zip(self._histories, self._elastic(shapes), strict=True)
            return [history.overstress(elastic, tau) for history, elastic in pairs]

        return self._kept((shapes.tobytes(), tau), compute)

    def _kept(self, key: tuple[bytes, float], compute: Callable[[], list[Floats]]) -> list[Floats]:
        """Return columns that are kept: residuals and slopes are taken at the same unknowns."""
        if key not in self._memo:
            if len(self._memo) > _REMEMBERED:
                self._memo.clear()
            self._memo[key] = compute()
        return self._memo[key]


def _whole(parts: Sequence[Floats], gammas: Floats) -> Floats:
    whole = parts[0].copy()
    for gamma, part in zip(gammas, parts[1:], strict=True):
        whole += gamma * part
    return whole


def _in_order(found: Unknowns) -> Unknowns:
    order = np.argsort(found.taus)
    return Unknowns(found.moduli, found.shapes, found.gammas[order], found.taus[order])
