"""Cyclic coupon test, loaded, unloaded and loaded again, and the softening that it shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np
from scipy.optimize import least_squares
from scipy.special import stdtrit

from voxsoft.errors import MeasurementError
from voxsoft.materials.coupon.curve import Curve, Toe, ToeCorrection
from voxsoft.materials.coupon.interval import Interval, noise_of
from voxsoft.materials.homogeneous import Mode, principal_stretches
from voxsoft.materials.hyperelastic import Floats, Hyperelastic
from voxsoft.materials.mullins import Mullins
from voxsoft.materials.softening import cycled_stress

_FEWEST: Final = 10
# Fall of the strain, as a part of its range, below which it is jitter of the machine.
_TURNS: Final = 0.02
# Relative difference of energy peaks that is needed to distinguish m from beta.
_APART: Final = 0.2
_CONFIDENCE: Final = 0.95
#: Bounds of `r` less one, `m` over the largest energy, and `beta`: beyond them η is 1, or a step.
_BOUNDS: Final = ((1e-2, 1e-4, 0.0), (50.0, 10.0, 10.0))
_STARTS: Final = ((0.3, 0.05, 0.05), (1.0, 0.3, 0.1), (3.0, 0.05, 0.5))


@dataclass(frozen=True)
class Cycles:
    """Engineering stress over engineering strain of one specimen, in the order of the test.

    Parameters
    ----------
    strain
        Engineering strain, (n,), loaded from rest, unloaded, loaded again.
    stress
        Engineering stress in Pa, (n,).
    mode
        ``"uniaxial"``, ``"equibiaxial"`` or ``"planar"``.
    name
        Name in reports.

    Raises
    ------
    MeasurementError
        Fewer than ten points, numbers that are not finite, lengths that differ, or a strain that
        never falls.

    Examples
    --------
    >>> strain = np.array([0, 0.2, 0.4, 0.6, 0.8, 0.6, 0.4, 0.2, 0.4, 0.6, 0.8, 0.9])
    >>> Cycles(strain, 40e3 * strain).first_loading().strain.tolist()
    [0.0, 0.2, 0.4, 0.6, 0.8, 0.9]
    """

    strain: Floats
    stress: Floats
    mode: Mode = "uniaxial"
    name: str = "cycles"

    def __post_init__(self) -> None:
        strain, stress = (np.asarray(v, dtype=np.float64) for v in (self.strain, self.stress))
        object.__setattr__(self, "strain", strain)
        object.__setattr__(self, "stress", stress)
        if strain.ndim != 1 or strain.shape != stress.shape:
            what = f"strain {strain.shape} and stress {stress.shape} do not pair up"
            raise MeasurementError(self.name, what)
        if len(strain) < _FEWEST:
            what = f"has {len(strain)} points; expected at least {_FEWEST}"
            raise MeasurementError(self.name, what)
        if not (np.isfinite(strain).all() and np.isfinite(stress).all()):
            raise MeasurementError(self.name, "holds numbers that are not finite")
        fall = np.maximum.accumulate(strain) - strain
        if fall.max() <= _TURNS * np.ptp(strain):
            raise MeasurementError(
                self.name, "the strain never falls: no cycle", "give it as a curve of its mode"
            )

    def first_loading(self) -> Curve:
        """Select the points at strains that were not reached before."""
        first = self.strain > np.concatenate([[-np.inf], np.maximum.accumulate(self.strain)[:-1]])
        return Curve(self.strain[first], self.stress[first], self.mode, self.name)

    def corrected(self, toe: Toe | None, correction: ToeCorrection, max_strain: float) -> Cycles:
        """Correct the cycles by the toe of their first loading, up to a strain."""
        strain, stress = self.strain, self.stress
        if toe is not None and correction == "strain":
            strain = strain - toe.strain
        if toe is not None and correction == "stress":
            stress = stress - toe.offset
        over = np.flatnonzero(strain > max_strain)
        end = int(over[0]) if len(over) else len(strain)
        return replace(self, strain=strain[:end], stress=stress[:end])


class SofteningFit(NamedTuple):
    """Softening of cyclic tests, with a model of the first loading.

    Attributes
    ----------
    mullins
        Constants of the Mullins effect.
    constants
        Fitted constants with their intervals, by name; `m` in Pa.
    rmse
        Root mean square error of the stress over all points of the cycles, in Pa.
    warnings
        Warnings, in sentences.
    """

    mullins: Mullins
    constants: Mapping[str, Interval]
    rmse: float
    warnings: tuple[str, ...]


def fit_softening(material: Hyperelastic, cycles: Sequence[Cycles]) -> SofteningFit:
    """Fit Ogden and Roxburgh's constants to cycles by least squares of the engineering stress.

    Parameters
    ----------
    material
        Model of the first loading; its constants are held.
    cycles
        At least one test. Cycles to one peak determine ``m + β P`` alone: `m` is 0 then, with a
        warning.

    Raises
    ------
    MeasurementError
        The stress does not fall on the way back.

    Notes
    -----
    The 95 % intervals come from the linearized problem, see
    :func:`~voxsoft.materials.coupon.fit_coupons`: residuals that follow one another count for
    fewer points. They hold for this model and its constants.

    Examples
    --------
    >>> from voxsoft.materials import NeoHookean
    >>> ways = ((0, 0.5), (0.5, 0), (0, 1), (1, 0))
    >>> turns = np.concatenate([np.linspace(a, b, 40) for a, b in ways])
    >>> rubber = NeoHookean(young="60 kPa")
    >>> soft = rubber.model_copy(update={"mullins": Mullins(r=1.5, m="1 kPa", beta=0.1)})
    >>> found = fit_softening(rubber, [Cycles(turns, cycled_stress(soft, 1 + turns))]).mullins
    >>> round(found.r, 3), round(found.m), round(found.beta, 3)
    (1.5, 1000, 0.1)
    """
    virgin = material.model_copy(update={"mullins": None})
    energies = [virgin.energy(principal_stretches(c.mode, 1.0 + c.strain)) for c in cycles]
    largest = max(float(np.nanmax(energy)) for energy in energies)
    peaks = np.concatenate([_peaks(c, e) for c, e in zip(cycles, energies, strict=True)])
    both = float(np.ptp(peaks)) > _APART * float(peaks.max())

    def softened(x: Floats) -> Mullins:
        r, m, beta = x if both else (x[0], 0.0, x[1])
        return Mullins(r=1.0 + float(r), m=float(m) * largest, beta=float(beta))

    def residuals(x: Floats) -> list[Floats]:
        soft = virgin.model_copy(update={"mullins": softened(x)})
        return [cycled_stress(soft, 1.0 + c.strain, c.mode) - c.stress for c in cycles]

    used = [0, 1, 2] if both else [0, 2]
    low, high = (np.array(bound)[used] for bound in _BOUNDS)
    low[1:] = np.maximum(low[1:], 0.0 if both else 1e-4)
    size = max(float(np.abs(c.stress).max()) for c in cycles)

    def relative(x: Floats) -> Floats:
        return np.concatenate(residuals(x)) / size

    found = min(
        (
            least_squares(
                relative,
                np.array(start)[used],
                bounds=(low, high),
                x_scale=np.array(start)[used],
                xtol=1e-12,
                ftol=1e-14,
                gtol=1e-14,
            )
            for start in _STARTS
        ),
        key=lambda answer: float(answer.cost),
    )
    # Rounded to six digits, as a measurement can have.
    exact = softened(found.x)
    digits = {name: float(f"{getattr(exact, name):.6g}") for name in ("r", "m", "beta")}
    mullins = Mullins(**digits)
    left = residuals(found.x)
    plain = [cycled_stress(virgin, 1.0 + c.strain, c.mode) - c.stress for c in cycles]
    if sum(float(r @ r) for r in left) > 0.99 * sum(float(r @ r) for r in plain):
        raise MeasurementError(
            cycles[0].name,
            "shows no softening: the way back is the way there",
            "leave it out of the cyclic tests",
        )
    scale, share = noise_of(left, len(used), 1e-6 * size)
    constants = _intervals(
        np.asarray(found.jac) * size, found.x, scale, share, mullins, largest, both=both
    )
    rmse = float(np.sqrt(np.mean(np.concatenate(left) ** 2)))
    return SofteningFit(mullins, constants, rmse, tuple(_warnings(constants, both=both)))


def _intervals(
    jacobian: Floats,
    x: Floats,
    scale: float,
    share: float,
    mullins: Mullins,
    largest: float,
    *,
    both: bool,
) -> dict[str, Interval]:
    points = len(jacobian) * share
    covariance = np.linalg.pinv(jacobian.T @ jacobian) * scale**2 / share
    reach = float(stdtrit(max(points - len(x), 1.0), 0.5 + _CONFIDENCE / 2.0))
    half = reach * np.sqrt(np.maximum(np.diag(covariance), 0.0))
    names = ("r", "m", "beta") if both else ("r", "beta")
    found = {}
    for name, spread in zip(names, half, strict=True):
        value = float(getattr(mullins, name))
        own = float(spread) * (largest if name == "m" else 1.0)
        found[name] = Interval(value, value - own, value + own)
    return found


def _warnings(constants: Mapping[str, Interval], *, both: bool) -> list[str]:
    found = []
    if not both:
        found.append(
            "cycles to one peak show m + beta P alone, and m is taken for zero: go on to a larger "
            "peak to see how softening grows with it"
        )
    for name, interval in constants.items():
        if interval.half_width > abs(interval.value - (1.0 if name == "r" else 0.0)):
            found.append(f"{name} of the softening is not known from these cycles")
    return found


def _peaks(cycles: Cycles, energy: Floats) -> Floats:
    """Find the energies at which the strain reversed from a new maximum, (k,)."""
    fall = np.maximum.accumulate(cycles.strain) - cycles.strain
    back = fall > _TURNS * np.ptp(cycles.strain)
    peaks: Floats = np.unique(np.maximum.accumulate(energy)[back])
    return peaks
