"""Fits of all models to the curves of a material, and their ranking."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit

from voxsoft.errors import MaterialError, MeasurementError
from voxsoft.materials.coupon.curve import TOE_CORRECTIONS, Curve, ToeCorrection
from voxsoft.materials.coupon.cycles import Cycles
from voxsoft.materials.coupon.families import FAMILIES, Anchor, Block, Data, Family, NoFit
from voxsoft.materials.coupon.interval import Interval, noise_of
from voxsoft.materials.coupon.modulus_test import MeasuredModulus
from voxsoft.materials.coupon.result import CouponFit, ModelFit, stress_in
from voxsoft.materials.coupon.untested import UntestedMode, untested_modes
from voxsoft.materials.hyperelastic import NEARLY_INCOMPRESSIBLE, Floats, Hyperelastic
from voxsoft.materials.lattice import SILICONE_DENSITY
from voxsoft.materials.stability import stable_range, stable_ranges
from voxsoft.records import closest
from voxsoft.units import si_value

Flags = NDArray[np.bool_]

#: Default of the largest strain of the fit: soft robots seldom stretch more.
DEFAULT_MAX_STRAIN: Final = 3.0

_FOLDS: Final = 5
_CONFIDENCE: Final = 0.95


def fit_coupons(
    curves: Sequence[Curve],
    observed: Sequence[MeasuredModulus] = (),
    *,
    cycles: Sequence[Cycles] = (),
    toe: ToeCorrection = "strain",
    max_strain: float = DEFAULT_MAX_STRAIN,
    poisson: float = NEARLY_INCOMPRESSIBLE,
    density: float | str = SILICONE_DENSITY,
    models: Collection[str] | None = None,
) -> CouponFit:
    """Fit every hyperelastic model to the curves of one material.

    Parameters
    ----------
    curves
        Stress-strain curves, at least one, or one of `cycles`; tests of several kinds may be mixed,
        and several specimens of one kind.
    observed
        Young's moduli from other tests.
    cycles
        Tests with load and unload. Their first loadings join the curves, and
        :meth:`CouponFit.softening` fits their softening.
    toe
        Correction of stress that is not zero at zero strain, see :meth:`Curve.corrected`.
    max_strain
        Points beyond it do not count, after the toe correction. Default 3 (300 %).
    poisson, density
        Poisson's ratio and density of the materials; the fit itself is incompressible. Default
        0.499, 1070 kg/m³.
    models
        Names of the models to fit, such as ``"yeoh-3"``. Default: all.

    Returns
    -------
    CouponFit
        Models ranked by their error in cross-validation.

    Raises
    ------
    MeasurementError
        No curve, or one with fewer than five points in the range.
    MaterialError
        No model could be fitted, or an unknown name of a model.

    Notes
    -----
    Least squares on the engineering stress. With measured moduli, which have uncertainties, points
    need one too: it is the scale of the residuals of the best model, and as these follow one
    another (their lag-1 correlation is ``ρ``), ``n`` points count as ``n (1 - ρ)/(1 + ρ)``. The
    same count widens the confidence intervals, which come from the linearized model. An interval
    holds for its model: it does not cover that the model is wrong, the toe, or other specimens.

    Examples
    --------
    >>> strain = np.linspace(0.0, 1.0, 30)
    >>> stretch = 1.0 + strain
    >>> curve = Curve(strain, 20e3 * (stretch - stretch**-2) * (1.0 + 0.05 * strain**2))
    >>> fit = fit_coupons([curve])
    >>> fit.recommended.stable_in_fit, round(fit.recommended.young.value / 1e3) in range(57, 63)
    (True, True)
    """
    density = si_value(density, "density", "density", positive=True)
    curves = [*curves, *(each.first_loading() for each in cycles)]
    if not curves:
        raise MeasurementError("curves", "none came", "give at least one stress-strain curve")
    if toe not in TOE_CORRECTIONS:
        raise MeasurementError("toe", f'"{toe}" is not known', closest(str(toe), TOE_CORRECTIONS))
    families = _families(models)
    used = tuple(curve.corrected(toe).up_to(max_strain) for curve in curves)
    solved, rejected = _solve_all(families, _data(used, 1.0, 1.0))
    if not solved:
        reasons = "; ".join(f"{name}: {why}" for name, why in rejected.items())
        raise MaterialError(
            "fit",
            f"no model could be fitted ({reasons})",
            "the stress must rise with the strain: check columns, signs and units",
        )
    whole = _data(used, 1.0, 1.0)
    if observed:
        scale, share = min(
            (_noise(family, constants, used) for family, constants in solved.items()),
            key=lambda noise: noise[0],
        )
        per_shear = 2.0 * (1.0 + poisson)
        anchors = tuple(
            Anchor(seen.young / per_shear, per_shear / seen.uncertainty) for seen in observed
        )
        whole = _data(used, scale, share, anchors)
        solved, rejected = _solve_all(families, whole)
    ranked = [
        _model_fit(family, constants, used, whole, poisson, density)
        for family, constants in solved.items()
    ]
    ranked.sort(key=lambda fit: (fit.cv_rmse, fit.size))
    found = CouponFit(
        tuple(curves),
        used,
        tuple(curve.toe() for curve in curves),
        toe,
        tuple(observed),
        max_strain,
        tuple(ranked),
        rejected,
        _untested(used, families, solved, whole, ranked),
        tuple(each.corrected(each.first_loading().toe(), toe, max_strain) for each in cycles),
    )
    # A card outside of the range that its own warning states would be one of two errors.
    card = found.recommended
    held = tuple(mode.holding(card.name, stress_in(card, mode)) for mode in found.untested)
    return replace(found, untested=held)


def _untested(
    curves: Sequence[Curve],
    families: Sequence[Family],
    solved: Mapping[Family, Floats],
    whole: Data,
    ranked: Sequence[ModelFit],
) -> tuple[UntestedMode, ...]:
    """Compare the models that are stable over the curves in the modes that no curve has."""
    unstable = {fit.name for fit in ranked if not fit.stable_in_fit}
    kept = [family for family in families if family.name not in unstable]
    best = min(
        (_noise(family, constants, curves) for family, constants in solved.items()),
        key=lambda noise: noise[0],
    )
    return untested_modes(curves, kept, whole, best[1])


def _data(
    curves: Sequence[Curve],
    scale: float,
    share: float,
    anchors: tuple[Anchor, ...] = (),
    kept: Sequence[Flags] | None = None,
) -> Data:
    """Weight every point by the root of the independent share over the scale of its residual."""
    blocks = []
    for index, curve in enumerate(curves):
        chosen = np.full(len(curve.strain), True) if kept is None else kept[index]
        weight = np.full(np.count_nonzero(chosen), np.sqrt(share) / scale)
        blocks.append(Block(curve.mode, curve.stretch[chosen], curve.stress[chosen], weight))
    return Data(tuple(blocks), anchors)


def _families(names: Collection[str] | None) -> list[Family]:
    known = {family.name: family for family in FAMILIES}
    for name in names or ():
        if name not in known:
            raise MaterialError("models", f'"{name}" is not known', closest(str(name), known))
    return [family for name, family in known.items() if names is None or name in names]


def _solve_all(
    families: Sequence[Family], data: Data
) -> tuple[dict[Family, Floats], dict[str, str]]:
    points = len(data.target)
    solved: dict[Family, Floats] = {}
    rejected: dict[str, str] = {}
    for family in families:
        if points <= family.size + 1:
            rejected[family.name] = f"{points} points are too few for {family.size} constants"
            continue
        try:
            solved[family] = family.solve(data)
        except NoFit as error:
            rejected[family.name] = error.what
    return solved, rejected


def _residuals(family: Family, constants: Floats, curves: Sequence[Curve]) -> list[Floats]:
    return [family.stress(constants, curve.mode, curve.stretch) - curve.stress for curve in curves]


def _noise(family: Family, constants: Floats, curves: Sequence[Curve]) -> tuple[float, float]:
    """Return the scale of the residuals in Pa, and the share of independent points."""
    residuals = _residuals(family, constants, curves)
    # Rounding of the numbers in the file: no measured stress is known to more than six digits.
    floor = 1e-6 * max(float(np.abs(curve.stress).max()) for curve in curves)
    return noise_of(residuals, family.size, floor)


def _model_fit(
    family: Family,
    constants: Floats,
    curves: Sequence[Curve],
    whole: Data,
    poisson: float,
    density: float,
) -> ModelFit:
    residual = np.concatenate(_residuals(family, constants, curves))
    stress = np.concatenate([curve.stress for curve in curves])
    material = family.material(constants, poisson, density)
    assert isinstance(material, Hyperelastic)
    intervals, young = _intervals(family, constants, curves, whole, poisson)
    return ModelFit(
        family.name,
        material,
        dict(zip(family.names, intervals, strict=True)),
        young,
        float(np.sqrt(np.mean(residual**2))),
        float(np.abs(residual).max()),
        _cross_validated(family, constants, curves, whole),
        float(1.0 - np.sum(residual**2) / np.sum((stress - stress.mean()) ** 2)),
        stable_ranges(material),
        all(_stable_over(material, curve) for curve in curves),
    )


def _stable_over(material: Hyperelastic, curve: Curve) -> bool:
    low, high = min(1.0, float(curve.stretch.min())), max(1.0, float(curve.stretch.max()))
    if low == high:
        return True
    found = stable_range(material, curve.mode, min(low, 0.999), max(high, 1.001))
    # The scan's grid ends at the asked stretches exactly, up to rounding.
    return found.holds(low * (1.0 + 1e-9), high * (1.0 - 1e-9))


def _intervals(
    family: Family, constants: Floats, curves: Sequence[Curve], whole: Data, poisson: float
) -> tuple[list[Interval], Interval]:
    """Compute confidence intervals of the constants and of Young's modulus, linearized."""
    scale, share = _noise(family, constants, curves)
    weighted = Data(_data(curves, scale, share).blocks, whole.anchors)
    jacobian = np.stack(
        [_slope(family, constants, weighted, index) for index in range(family.size)], axis=1
    )
    size = np.linalg.norm(jacobian, axis=0)
    size[size == 0.0] = 1.0
    covariance = np.linalg.pinv((jacobian / size).T @ (jacobian / size)) / np.outer(size, size)
    points = sum(len(curve.strain) for curve in curves)
    freedom = max(points * share + len(whole.anchors) - family.size, 1.0)
    # Student's t from the special functions: scipy.stats takes half a second to load.
    reach = float(stdtrit(freedom, 0.5 + _CONFIDENCE / 2.0))
    half = reach * np.sqrt(np.maximum(np.diag(covariance), 0.0))
    toward = np.concatenate([family.shears, np.zeros(family.shapes)]) * 2.0 * (1.0 + poisson)
    young, variance = float(toward @ constants), float(toward @ covariance @ toward)
    spread = reach * float(np.sqrt(max(variance, 0.0)))
    return (
        [
            Interval(float(c), float(c - h), float(c + h))
            for c, h in zip(constants, half, strict=True)
        ],
        Interval(young, young - spread, young + spread),
    )


def _slope(family: Family, constants: Floats, data: Data, index: int) -> Floats:
    """Differentiate the weighted predictions by one constant, (n,)."""
    if index < family.linear:
        return family.matrix(data, constants[family.linear :])[:, index]
    # Exponents and limits are of order 1 to 100: this step leaves an error of some 1e-9.
    step = 1e-5 * max(abs(float(constants[index])), 1.0)
    ends = []
    for sign in (1.0, -1.0):
        moved = constants.copy()
        moved[index] += sign * step
        ends.append(family.matrix(data, moved[family.linear :]) @ moved[: family.linear])
    slope: Floats = np.nan_to_num((ends[0] - ends[1]) / (2.0 * step))
    return slope


def _outside(fold: int, points: int) -> Flags:
    """Select the points that are not in a fifth of a curve; its two ends are in none, (points,)."""
    outside: Flags = np.arange(points) * _FOLDS // points != fold
    outside[[0, -1]] = True
    return outside


def _cross_validated(
    family: Family, constants: Floats, curves: Sequence[Curve], whole: Data
) -> float:
    """Compute the RMS error of cross-validation: each fifth of a curve is predicted from the rest.

    The fifths are runs of neighboring points: leaving out single ones would test nothing, because
    their neighbors determine them. The first and the last point always stay, so that gaps are
    bridged and nothing is extrapolated.
    """
    weights = float(whole.blocks[0].weight[0])
    errors = []
    for fold in range(_FOLDS):
        kept = [_outside(fold, len(curve.strain)) for curve in curves]
        rest = _data(curves, 1.0 / weights, 1.0, whole.anchors, kept)
        if len(rest.target) <= family.size:
            return np.inf
        try:
            found = family.solve(rest, near=constants)
        except NoFit:
            found = constants if family.shapes else np.full(family.size, np.nan)
        for curve, keep in zip(curves, kept, strict=True):
            predicted = family.stress(found, curve.mode, curve.stretch[~keep])
            errors.append(predicted - curve.stress[~keep])
    every = np.concatenate(errors)
    # A Gent material that locks before the end of the curve predicts no stress there at all.
    return float(np.sqrt(np.mean(every**2))) if np.isfinite(every).all() else np.inf
