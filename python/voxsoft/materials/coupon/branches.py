"""Fit of the branches by which rubber relaxes, to tests over time beside quasi-static ones.

Long because the search, the tests of identification, and the result in words stand together.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
from scipy.special import fdtri, stdtrit

from voxsoft.errors import MaterialError, MeasurementError
from voxsoft.materials.card import Card
from voxsoft.materials.coupon.branch_model import BranchModel, Unknowns
from voxsoft.materials.coupon.curve import Curve, ToeCorrection
from voxsoft.materials.coupon.families import FAMILIES, Family, NoFit
from voxsoft.materials.coupon.fit import DEFAULT_MAX_STRAIN, fit_coupons
from voxsoft.materials.coupon.interval import Interval, noise_of
from voxsoft.materials.coupon.timed import TimedTest
from voxsoft.materials.hyperelastic import NEARLY_INCOMPRESSIBLE, Floats, Hyperelastic, PronyTerm
from voxsoft.materials.lattice import SILICONE_DENSITY
from voxsoft.materials.relaxing import StretchHistory
from voxsoft.materials.stability import stable_range
from voxsoft.materials.tested import StretchRange
from voxsoft.records import closest
from voxsoft.units import format_quantity, si_value

_MOST: Final = 4
_CONFIDENCE: Final = 0.95
#: Confidence with which one branch more must fit better: four are tried, each with its own chance.
_BETTER: Final = 0.99
#: Factor over the smallest error up to which families count as equally good, as in `CouponFit`.
_AS_GOOD: Final = 1.1
#: Ratio of strain rates below which they are one.
_ONE_RATE: Final = 2.0
#: Largest half-width of an identified share, as a part of it, and of an identified time, in ln τ.
_SHARE_KNOWN: Final = 0.5
_TIME_KNOWN: Final = float(np.log(2.0))
#: Longest identified time over the longest test. Without a quasi-static curve the long-term
#: stiffness is an extrapolation: at τ of the test, 37 % of the branch.
_LONGEST: Final = 1.0
_LONGEST_WITH_CURVE: Final = 3.0
#: Part of the observed relaxation that a branch beyond the test may have before the fit is refused.
_UNSEEN: Final = 0.05
#: Part of a test's largest stress beyond which its error is a warning.
_LARGE_ERROR: Final = 0.1
_FIRST_INVARIANT: Final = ("neo-hookean", "gent", "yeoh-2", "yeoh-3")


class Branch(NamedTuple):
    """Branch with the intervals of its constants.

    Attributes
    ----------
    g
        Share of the instantaneous stiffness that relaxes in it.
    tau
        Its time in s.
    """

    g: Interval
    tau: Interval


@dataclass(frozen=True)
class BranchFit:
    """Fit of a material with branches.

    Attributes
    ----------
    model
        Name of the family of the long-term stress: ``"yeoh-2"``.
    material
        Material: the constants are long-term, and `prony` has the branches.
    constants
        Long-term constants with their intervals, by name; moduli in Pa.
    young
        Long-term Young's modulus at small strain in Pa, with its interval.
    branches
        Branches, the quickest first.
    rmse
        Root mean square error of the stress over all points, in Pa.
    errors
        Root mean square error of each test and curve in Pa, by name.
    tests, curves
        Tests over time, and quasi-static curves, toe corrected.
    window
        Shortest and longest time in s that the tests show.
    warnings
        Warnings, in sentences.
    """

    model: str
    material: Hyperelastic
    constants: Mapping[str, Interval]
    young: Interval
    branches: tuple[Branch, ...]
    rmse: float
    errors: Mapping[str, float]
    tests: tuple[TimedTest, ...]
    curves: tuple[Curve, ...]
    window: tuple[float, float]
    warnings: tuple[str, ...]

    @property
    def every(self) -> list[TimedTest | Curve]:
        """Tests over time, then curves."""
        return _every(self.tests, self.curves)

    @property
    def instantaneous_young(self) -> float:
        """Young's modulus in Pa that a sudden load meets."""
        return self.young.value / (1.0 - sum(branch.g.value for branch in self.branches))

    @property
    def relative_error(self) -> float:
        """Error as a part of the largest stress."""
        return self.rmse / max(float(np.abs(each.stress).max()) for each in self.every)

    def card(self, name: str, *, title: str = "", source: str = "") -> Card:
        """Make a material card; its source has a default that names the tests.

        Raises
        ------
        MaterialError
            The long-term model is unstable within the strains that were tested.
        """
        low, high = self._span()
        if not _is_stable(self.material, low, high):
            raise MaterialError(
                self.model, f"is unstable between the stretches {low:.3g} and {high:.3g}, which "
                "were tested", "take another model (--model), such as neo-hookean"
            )  # fmt: skip
        names = ", ".join(each.name for each in self.every)
        pressed = round(low, 4) if low < 0.97 else None
        tested = StretchRange(largest=max(round(high, 4), 1.0), smallest=pressed)
        return Card(
            name=name,
            title=title,
            material=self.material.model_copy(update={"tested_stretch": tested}),
            source=source or f"Fitted to tests over time: {names}.",
            caution=". ".join((self.sentence, *self.warnings)) + ".",
            calibration=self._notes(),
        )

    @property
    def sentence(self) -> str:
        """Statement of which stiffness the constants are."""
        return (
            f"The constants are long-term (E {_modulus(self.young.value)}); a sudden load meets "
            f"{self.instantaneous_young / self.young.value:.3g} times as much "
            f"(E {_modulus(self.instantaneous_young)})"
        )

    def summary(self) -> dict[str, Any]:
        """Everything as plain data in SI units."""
        return {
            "model": self.model,
            "material": self.material.model_dump(by_alias=True),
            "constants": {name: _plain(each) for name, each in self.constants.items()},
            "young": _plain(self.young),
            "instantaneous_young": self.instantaneous_young,
            "branches": [{"g": _plain(b.g), "tau": _plain(b.tau)} for b in self.branches],
            "rmse": self.rmse,
            "relative_error": self.relative_error,
            "errors": dict(self.errors),
            "window": list(self.window),
            "tests": [
                {
                    "name": test.name,
                    "kind": test.kind,
                    "points": len(test.time),
                    "duration": test.duration,
                    "rate": test.rate,
                    "strain": float(test.strain[np.argmax(np.abs(test.strain))]),
                }
                for test in self.tests
            ],
            "curves": [curve.name for curve in self.curves],
            "warnings": [self.sentence, *self.warnings],
        }

    def _span(self) -> tuple[float, float]:
        every = np.concatenate([each.stretch for each in self.every])
        return min(float(every.min()), 1.0), float(every.max())

    def _notes(self) -> dict[str, Any]:
        notes: dict[str, Any] = {
            "method": "least squares of engineering stress, incompressible, over time",
            "model": self.model,
            "stiffness": "long-term",
            "data": [each.name for each in self.every],
            "rmse": _modulus(self.rmse),
            "times": [_time(each) for each in self.window],
        }
        for number, branch in enumerate(self.branches, 1):
            notes[f"g{number}_interval"] = f"{branch.g.low:.4g} to {branch.g.high:.4g} (95 %)"
            ends = (_time(branch.tau.low), _time(branch.tau.high))
            notes[f"tau{number}_interval"] = f"{ends[0]} to {ends[1]} (95 %)"
        return notes


def fit_branches(
    tests: Sequence[TimedTest],
    curves: Sequence[Curve] = (),
    *,
    branches: int | None = None,
    model: str | None = None,
    toe: ToeCorrection = "strain",
    max_strain: float = DEFAULT_MAX_STRAIN,
    poisson: float = NEARLY_INCOMPRESSIBLE,
    density: float | str = SILICONE_DENSITY,
) -> BranchFit:
    """Fit a hyperelastic long-term stress and the branches beside it to tests over time.

    Parameters
    ----------
    tests
        Relaxation tests (the strain is held) and rate tests (it grows at a constant rate) of one
        material, at least one. Their stress must be zero at zero strain.
    curves
        Quasi-static curves, of tests so slow that all branches relax: the long-term stress.
    branches
        Number of branches; default: as many as make the fit better and are identified, up to four.
    model
        Name of the family of the long-term stress, such as ``"yeoh-2"``. Default: with curves
        their recommended one; else the one with the fewest constants among those of one invariant
        that fit about best.
    toe, max_strain
        Toe correction and largest strain of the curves, see :func:`fit_coupons`.
    poisson, density
        Poisson's ratio and density of the material; the fit itself is incompressible. Default
        0.499, 1070 kg/m³.

    Raises
    ------
    MeasurementError
        Tests that do not separate stiffness from relaxation: one rate alone, no relaxation,
        no plateau; a branch that is not identified, with the reason.
    MaterialError
        No model could be fitted, or an unknown name of a model.

    Notes
    -----
    Least squares of the engineering stress of all points, by the law of
    :func:`voxsoft.materials.relaxing_stress`. A branch joins where an F test of 99 % says that it
    fits better. It is identified if its time is within the tests, its share is known to ±50 % and
    its time to a factor of 2, by 95 % intervals of the linearized model, see :func:`fit_coupons`.

    Examples
    --------
    >>> from voxsoft.materials import NeoHookean, relaxing_stress
    >>> rubber = NeoHookean(young="60 kPa", prony=[{"g": 0.3, "tau": "20 s"}])
    >>> time = np.geomspace(0.5, 200.0, 60)
    >>> stress = relaxing_stress(rubber, time, np.full(60, 1.5))
    >>> fit = fit_branches([TimedTest(time, np.full(60, 0.5), stress)])
    >>> [(round(b.g.value, 3), round(b.tau.value, 2)) for b in fit.branches]
    [(0.3, 20.0)]
    """
    density = si_value(density, "density", "density", positive=True)
    _check(tests, curves, branches)
    models, used, notes = _models(tests, curves, model, toe, max_strain)
    chosen = _best_family(models)
    found, more = _branches(chosen, branches, plateau=not curves)
    return _result(chosen, found, tests, used, [*notes, *more], poisson, density)


def _check(tests: Sequence[TimedTest], curves: Sequence[Curve], branches: int | None) -> None:
    if not tests:
        raise MeasurementError("tests", "none came", "give a relaxation test or a rate test")
    if branches is not None and not 1 <= branches <= _MOST:
        raise MeasurementError("branches", f"{branches} came; expected 1 to {_MOST}")
    rates = [test.rate for test in tests if test.rate is not None]
    if len(rates) == len(tests) and not curves and max(rates) < _ONE_RATE * min(rates):
        names = ", ".join(test.name for test in tests)
        raise MeasurementError(
            names,
            f"one rate only ({np.mean(rates):.3g} /s): a stress that bends by relaxation and one "
            "that bends with the strain look alike",
            "add a test at a rate ten times slower, a relaxation test, or a quasi-static curve",
        )


def _models(
    tests: Sequence[TimedTest],
    curves: Sequence[Curve],
    model: str | None,
    toe: ToeCorrection,
    max_strain: float,
) -> tuple[list[BranchModel], tuple[Curve, ...], list[str]]:
    """Choose the families to fit, with the curves in their corrected form."""
    known = {family.name: family for family in FAMILIES}
    if model is not None and model not in known:
        raise MaterialError("model", f'"{model}" is not known', closest(model, known))
    notes: list[str] = []
    used: tuple[Curve, ...] = ()
    if curves:
        static = fit_coupons(
            curves, toe=toe, max_strain=max_strain, models=None if model is None else [model]
        )
        names, used, notes = [static.of(model).name], static.curves, list(static.warnings)
    elif model is not None:
        names = [model]
    elif _strains(tests) == 1:
        names = ["neo-hookean"]
        notes = ["One strain alone: how the stress grows with the strain is that of neo-hookean"]
    else:
        names = list(_FIRST_INVARIANT)
    families: list[Family] = [known[name] for name in names]
    if model is not None and not curves and _strains(tests) == 1 and known[model].size > 1:
        raise MeasurementError(
            tests[0].name,
            f"has one strain alone, and {model} has {known[model].size} constants",
            "add tests at other strains, or take neo-hookean",
        )
    return [BranchModel(family, tests, used) for family in families], used, notes


def _strains(tests: Sequence[TimedTest]) -> int:
    """Count the levels of strain, to 5 % of the largest."""
    every = np.concatenate([test.strain for test in tests])
    levels = np.round(20.0 * every / np.abs(every).max())
    return len(np.unique(levels[levels != 0.0]))


def _best_family(models: Sequence[BranchModel]) -> BranchModel:
    """Choose the smallest family that fits about best, with two branches in each."""
    if len(models) == 1:
        return models[0]
    errors: dict[BranchModel, float] = {}
    for each in models:
        try:
            start = each.elastic_start()
        except NoFit:
            continue
        found = start
        for _ in range(2):
            found = _with_one_more(each, found)
        errors[each] = _misfit(each, found) ** 0.5
    if not errors:
        raise MaterialError("fit", "no model could be fitted", "check columns, signs and units")
    limit = _AS_GOOD * min(errors.values())
    return next(each for each in models if errors.get(each, np.inf) <= limit)


def _with_one_more(model: BranchModel, before: Unknowns) -> Unknowns:
    """Add the branch that fits best, from several first times."""
    found = []
    for tau in _first_times(model, before):
        start = Unknowns(
            before.moduli,
            before.shapes,
            np.append(before.gammas, 0.1),
            np.append(before.taus, tau),
        )
        found.append(model.solve(start))
    return min(found, key=lambda each: _misfit(model, each))


def _first_times(model: BranchModel, before: Unknowns) -> Floats:
    """Choose the two best times of a grid: those at which a branch takes most off the residual."""
    residual = np.concatenate(model.residuals(before))
    grid = np.geomspace(2.0 * model.resolved, 0.7 * model.longest, 9)
    gains = []
    for tau in grid:
        added = Unknowns(
            before.moduli, before.shapes, np.append(before.gammas, 0.0), np.append(before.taus, tau)
        )
        slopes = model.slopes(added)
        # Without the slopes by times: that of the new one is zero at γ = 0.
        columns = slopes[:, : model.family.size + len(added.taus)]
        size = np.linalg.norm(columns, axis=0)
        size[size == 0.0] = 1.0
        rest = residual - columns / size @ np.linalg.lstsq(columns / size, residual)[0]
        gains.append(float(residual @ residual - rest @ rest))
    best: Floats = grid[np.argsort(gains)[-2:]]
    return best


def _misfit(model: BranchModel, at: Unknowns) -> float:
    return float(np.sum(np.concatenate(model.residuals(at)) ** 2))


def _branches(
    model: BranchModel, asked: int | None, *, plateau: bool
) -> tuple[Unknowns, list[str]]:
    """Find the branches: as many as were asked for, or as are identified and fit better."""
    before = found = model.elastic_start()
    tried: list[Unknowns] = []
    for _ in range(asked or _MOST):
        before, found = found, _with_one_more(model, found)
        if asked is None and not _is_better(model, found, before):
            break
        tried.append(found)
    if not tried:
        raise _no_better(1)
    if asked is not None:
        tried = tried[-1:]
    causes = [_not_identified(model, each, plateau=plateau) for each in tried]
    known = [at for at, cause in enumerate(causes) if not cause]
    if not known:
        if asked is not None and not _is_better(model, found, before):
            raise _no_better(asked)
        raise _refused(causes[-1])
    kept, best = tried[known[-1]], tried[-1]
    if asked is not None:
        return kept, _left_out(model, kept, plateau=plateau)
    if kept is best:
        return kept, []
    if plateau and _unseen(model, best) > _UNSEEN:
        raise _no_plateau(model, best, len(kept.taus))
    which = ", ".join(f"{_time(best.taus[k])} ({why})" for k, why in causes[-1].items())
    return kept, [f"{len(best.taus)} branches fit better, but are not identified: {which}"]


def _left_out(model: BranchModel, kept: Unknowns, *, plateau: bool) -> list[str]:
    """Warn of a branch that was not asked for and would fit better."""
    if len(kept.taus) == _MOST:
        return []
    more = _with_one_more(model, kept)
    if not _is_better(model, more, kept):
        return []
    if plateau and (share := _unseen(model, more)) > _UNSEEN:
        return [
            f"The stress has no plateau: {share:.0%} of its fall are of a branch of about "
            f"{_time(more.taus[-1])}, and the constants hold to the end of the test, "
            f"{_time(model.longest)}, not for the long term"
        ]
    return [f"{len(more.taus)} branches fit better than the {len(kept.taus)} that were asked for"]


def _is_better(model: BranchModel, found: Unknowns, before: Unknowns) -> bool:
    """Test by Fisher's F that one branch more, two constants, fits better than chance."""
    residuals = model.residuals(found)
    size = model.family.size + 2 * len(found.taus)
    _, share = noise_of(residuals, size, 1e-6 * model.size)
    points = sum(len(each) for each in residuals)
    freedom = max(points * share - size, 1.0)
    # Rounding of the numbers in a file leaves a misfit even of a perfect fit.
    left = max(_misfit(model, found), points * (1e-6 * model.size) ** 2)
    gone = _misfit(model, before) - left
    # Residuals of a fit with too few branches are long waves: their few independent points hide it.
    if gone > (_AS_GOOD**2 - 1.0) * left and points > 10 * size:
        return True
    ratio = gone / 2.0 / (left / freedom)
    return bool(ratio > float(fdtri(2.0, freedom, _BETTER)))


def _covariance(model: BranchModel, at: Unknowns) -> tuple[Floats, float]:
    """Return the covariance of moduli, shapes, γ and ln τ, and Student's t of the intervals."""
    residuals = model.residuals(at)
    slopes = model.slopes(at)
    unknowns = slopes.shape[1]
    scale, share = noise_of(residuals, unknowns, 1e-6 * model.size)
    size = np.linalg.norm(slopes, axis=0)
    size[size == 0.0] = 1.0
    inverse = np.linalg.pinv((slopes / size).T @ (slopes / size), hermitian=True)
    freedom = max(len(slopes) * share - unknowns, 1.0)
    reach = float(stdtrit(freedom, 0.5 + _CONFIDENCE / 2.0))
    return inverse / np.outer(size, size) * scale**2 / share, reach


def _branch_intervals(model: BranchModel, at: Unknowns) -> list[tuple[float, float]]:
    """Return the half-widths of each share and of the logarithm of each time."""
    covariance, reach = _covariance(model, at)
    first, count = model.family.size, len(at.taus)
    by_gamma = np.eye(count) / (1.0 + at.gammas.sum())
    by_gamma -= np.outer(at.gammas, np.ones(count)) / (1.0 + at.gammas.sum()) ** 2
    block = covariance[first : first + count, first : first + count]
    shares = np.sqrt(np.maximum(np.diag(by_gamma @ block @ by_gamma.T), 0.0))
    times = np.sqrt(np.maximum(np.diag(covariance)[first + count :], 0.0))
    return [(reach * float(g), reach * float(t)) for g, t in zip(shares, times, strict=True)]


def _not_identified(model: BranchModel, at: Unknowns, *, plateau: bool) -> dict[int, str]:
    """Say of each branch that the tests do not identify why."""
    causes: dict[int, str] = {}
    longest = model.longest * (_LONGEST if plateau else _LONGEST_WITH_CURVE)
    for k, (share, time) in enumerate(_branch_intervals(model, at)):
        if at.taus[k] > longest:
            causes[k] = f"longer than the longest test, {_time(model.longest)}"
        elif at.taus[k] < model.shortest:
            causes[k] = f"shorter than the time between rows, {_time(model.shortest)}"
        elif share > _SHARE_KNOWN * at.shares[k] or time > _TIME_KNOWN:
            known = f"its share {at.shares[k]:.2g} to ± {share:.2g}, its time to a factor of "
            causes[k] = f"{known}{np.exp(min(time, 20.0)):.3g}"
    return causes


def _refused(causes: Mapping[int, str]) -> MeasurementError:
    where = " and ".join(f"branch {k + 1}" for k in causes)
    what = "not identified: " + "; ".join(causes.values())
    hint = "test more densely, with less noise, or at rates farther apart; or fewer --branches"
    if any("longer than" in cause for cause in causes.values()):
        what += ": the stress has no plateau, and the long-term stiffness is not known"
        hint = "hold the strain several times as long, or add a slower test or quasi-static curve"
    elif any("shorter than" in cause for cause in causes.values()):
        hint = "record more rows at the start"
    return MeasurementError(where, what, hint)


def _no_better(count: int) -> MeasurementError:
    """Refuse a branch that is not there: where noise puts it says nothing."""
    if count == 1:
        return MeasurementError(
            "tests",
            "show no relaxation: an elastic material fits as well",
            "leave them out, or test over a longer time or at rates farther apart",
        )
    fewer = f"{count - 1} branches" if count > 2 else "one"
    return MeasurementError(
        f"branch {count}",
        f"not identified: {count} branches fit no better than {fewer}",
        "take fewer --branches, or test over a longer time or at rates farther apart",
    )


def _unseen(model: BranchModel, at: Unknowns) -> float:
    """Return the part of the relaxation in the tests that branches beyond them have."""
    within = at.gammas * -np.expm1(-model.longest / at.taus)
    return float(within[at.taus > model.longest].sum() / within.sum())


def _no_plateau(model: BranchModel, at: Unknowns, kept: int) -> MeasurementError:
    slow = len(at.taus)
    return MeasurementError(
        f"branch {slow}",
        f"not identified: about {_time(at.taus[-1])}, longer than the longest test, "
        f"{_time(model.longest)}; the stress has no plateau: {_unseen(model, at):.0%} of its fall "
        "go on after the test",
        "hold the strain several times as long, or add a quasi-static curve; "
        f"--branches {kept} takes the end of the test for the long term",
    )


def _result(
    model: BranchModel,
    at: Unknowns,
    tests: Sequence[TimedTest],
    curves: Sequence[Curve],
    notes: Sequence[str],
    poisson: float,
    density: float,
) -> BranchFit:
    family = model.family
    covariance, reach = _covariance(model, at)
    constants = np.concatenate([at.moduli, at.shapes])
    half = reach * np.sqrt(np.maximum(np.diag(covariance), 0.0))
    toward = np.zeros(len(covariance))
    toward[: family.linear] = family.shears * 2.0 * (1.0 + poisson)
    young = float(toward[: family.linear] @ at.moduli)
    spread = reach * float(np.sqrt(max(float(toward @ covariance @ toward), 0.0)))
    elastic = family.material(constants, poisson, density)
    assert isinstance(elastic, Hyperelastic)
    branches = [
        Branch(
            Interval(float(g), float(g) - share, float(g) + share),
            Interval(float(tau), float(tau) * np.exp(-time), float(tau) * np.exp(time)),
        )
        for g, tau, (share, time) in zip(
            at.shares, at.taus, _branch_intervals(model, at), strict=True
        )
    ]
    prony = tuple(
        PronyTerm(g=float(f"{b.g.value:.6g}"), tau=float(f"{b.tau.value:.6g}")) for b in branches
    )
    # All rows, where the fit has means of neighbors.
    residuals = _of_rows(family, at, tests, curves)
    names = [each.name for each in _every(tests, curves)]
    errors = {
        name: float(np.sqrt(np.mean(each**2))) for name, each in zip(names, residuals, strict=True)
    }
    pairs = zip(constants, half[: family.size], strict=True)
    intervals = [Interval(float(c), float(c - h), float(c + h)) for c, h in pairs]
    return BranchFit(
        family.name,
        elastic.model_copy(update={"prony": prony}),
        dict(zip(family.names, intervals, strict=True)),
        Interval(young, young - spread, young + spread),
        tuple(branches),
        float(np.sqrt(np.mean(np.concatenate(residuals) ** 2))),
        errors,
        tuple(tests),
        tuple(curves),
        (model.resolved, model.longest),
        (*notes, *_about_the_tests(model, at, tests, curves, errors)),
    )


def _of_rows(
    family: Family, at: Unknowns, tests: Sequence[TimedTest], curves: Sequence[Curve]
) -> list[Floats]:
    """Return model minus measured stress in Pa in all rows of each test, then of each curve."""
    constants = np.concatenate([at.moduli, at.shapes])
    found = []
    for test in tests:
        way = StretchHistory(test.time, test.stretch)
        elastic = family.stress(constants, "uniaxial", way.stretch)
        found.append(way.response(elastic, list(at.gammas), list(at.taus)) - test.stress)
    return found + [
        family.stress(constants, curve.mode, curve.stretch) - curve.stress for curve in curves
    ]


def _about_the_tests(
    model: BranchModel,
    at: Unknowns,
    tests: Sequence[TimedTest],
    curves: Sequence[Curve],
    errors: Mapping[str, float],
) -> list[str]:
    found = []
    for each in _every(tests, curves):
        part = errors[each.name] / float(np.abs(each.stress).max())
        if part > _LARGE_ERROR:
            found.append(
                f"{each.name}: off by {part:.0%} of its largest stress: another specimen, slack, "
                "or softening, which these branches have not"
            )
    left = float(np.exp(-model.longest / at.taus[-1]))
    if left > _UNSEEN:
        found.append(
            f"{left:.0%} of the branch of {_time(at.taus[-1])} had not relaxed when the longest "
            f"test ended, after {_time(model.longest)}"
            + ("" if curves else ": the long-term stiffness is extrapolated")
        )
    low, high = (_time(each) for each in (model.resolved, model.longest))
    found.append(f"The branches hold for times from {low} to {high}")
    return found


def _every(tests: Sequence[TimedTest], curves: Sequence[Curve]) -> list[TimedTest | Curve]:
    return [*tests, *curves]


def _is_stable(material: Hyperelastic, low: float, high: float) -> bool:
    found = stable_range(material, "uniaxial", min(low, 0.999), max(high, 1.001))
    return found.holds(low * (1.0 + 1e-9), high * (1.0 - 1e-9))


def _plain(interval: Interval) -> dict[str, float]:
    return {"value": interval.value, "low": interval.low, "high": interval.high}


def _time(seconds: float) -> str:
    return format_quantity(float(f"{seconds:.3g}"), "time")


def _modulus(value: float) -> str:
    return format_quantity(float(f"{value:.4g}"), "modulus")
