"""Result of a coupon fit: the models, their errors, and warnings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np

from voxsoft.errors import MaterialError
from voxsoft.materials.card import Card
from voxsoft.materials.coupon.curve import Curve, Toe, ToeCorrection
from voxsoft.materials.coupon.cycles import Cycles, SofteningFit, fit_softening
from voxsoft.materials.coupon.interval import Interval
from voxsoft.materials.coupon.modulus_test import MeasuredModulus
from voxsoft.materials.coupon.untested import UntestedMode
from voxsoft.materials.homogeneous import nominal_stress
from voxsoft.materials.hyperelastic import Hyperelastic
from voxsoft.materials.stability import StableRange
from voxsoft.materials.tested import StretchRange
from voxsoft.records import closest
from voxsoft.units import format_quantity

# Factor over the smallest prediction error up to which models count as equally good; among them the
# one with the fewest constants is recommended.
_AS_GOOD: Final = 1.1
_FIRST_INVARIANT: Final = ("neo-hookean", "gent", "yeoh")
# Strain of slack that changes moduli by more than a tenth, for a curve whose first 30 % count.
_LARGE_TOE: Final = 0.03
# Toe below the resolution of any strain measurement.
_SMALL_TOE: Final = 1e-3
# Range of the moduli of rubber, in Pa.
_RUBBER: Final = (1e2, 1e8)


@dataclass(frozen=True)
class ModelFit:
    """Fit of one model to all data.

    Attributes
    ----------
    name
        Name of the family: ``"yeoh-3"``.
    material
        Model with the fitted constants.
    constants
        Every constant with its interval, by name; moduli in Pa.
    young
        Initial Young's modulus in Pa, with its interval.
    rmse, max_error
        Root mean square and largest error of the stress over the fitted points, in Pa.
    cv_rmse
        Root mean square error in cross-validation: each fifth of every curve is predicted from the
        other four.
    r2
        Share of the variance of the stress that is explained.
    stability
        Stable ranges in the three modes.
    stable_in_fit
        True if it is stable over all strains that were fitted, in their modes.
    """

    name: str
    material: Hyperelastic
    constants: Mapping[str, Interval]
    young: Interval
    rmse: float
    max_error: float
    cv_rmse: float
    r2: float
    stability: tuple[StableRange, ...]
    stable_in_fit: bool

    @property
    def size(self) -> int:
        """Number of constants."""
        return len(self.constants)

    @property
    def warnings(self) -> list[str]:
        """Warnings on the model, in sentences."""
        found = [] if self.stable_in_fit else [f"{self.name} is unstable inside the fitted range"]
        return found + [f"{self.name}, {r.sentence}" for r in self.stability if r.sentence]


@dataclass(frozen=True)
class CouponFit:
    """Result of the fit of coupons of one material.

    Attributes
    ----------
    measured
        Curves as they were measured.
    curves
        Curves that were fitted: toe corrected, up to the largest strain.
    toes
        Toe of each curve, or None where it could not be determined.
    correction
        Correction of the toe.
    observed
        Moduli from other tests.
    max_strain
        Largest strain of the fit.
    models
        Fits, best prediction first.
    rejected
        Models that could not be fitted, with the reason.
    cycles
        Cyclic tests, toe corrected; their first loadings are among the curves.
    untested
        Stress in each mode that no curve has, by all models that fit alike and the recommended one.
    """

    measured: tuple[Curve, ...]
    curves: tuple[Curve, ...]
    toes: tuple[Toe | None, ...]
    correction: ToeCorrection
    observed: tuple[MeasuredModulus, ...]
    max_strain: float
    models: tuple[ModelFit, ...]
    rejected: Mapping[str, str]
    untested: tuple[UntestedMode, ...] = ()
    cycles: tuple[Cycles, ...] = ()

    @property
    def recommended(self) -> ModelFit:
        """Model with the fewest constants among the sound ones that predict about best.

        Sound are those that are stable over the fitted range and, where all curves are uniaxial,
        are written in ``I₁`` alone (neo-Hookean, Gent, Yeoh): the stress of Ogden and Mooney–Rivlin
        models in the other modes is then a guess, and inflated robots work in those. "About best"
        is within 10 % of the smallest ``cv_rmse``. Where no model is sound, all of them count.
        """
        stable = [fit for fit in self.models if fit.stable_in_fit] or list(self.models)
        if {curve.mode for curve in self.curves} == {"uniaxial"}:
            stable = [f for f in stable if f.material.model in _FIRST_INVARIANT] or stable
        limit = _AS_GOOD * min(fit.cv_rmse for fit in stable)
        return min(
            (fit for fit in stable if fit.cv_rmse <= limit), key=lambda f: (f.size, f.cv_rmse)
        )

    def of(self, name: str | None = None) -> ModelFit:
        """Return the fit of a model by name; default: the recommended one.

        Raises
        ------
        MaterialError
            No such model, or one that could not be fitted.
        """
        if name is None:
            return self.recommended
        by_name = {fit.name: fit for fit in self.models}
        if name in self.rejected:
            raise MaterialError(name, f"could not be fitted: {self.rejected[name]}")
        if name not in by_name:
            raise MaterialError("model", f'"{name}" is not known', closest(name, by_name))
        return by_name[name]

    def softening(self, model: str | None = None) -> SofteningFit | None:
        """Fit the softening of the cyclic tests, if there are any, beside a model.

        Raises
        ------
        MaterialError
            No such model, or one that could not be fitted.
        MeasurementError
            The cycles show no softening.
        """
        if not self.cycles:
            return None
        fit = self.of(model)
        if fit.name not in self._softenings:
            self._softenings[fit.name] = fit_softening(fit.material, self.cycles)
        return self._softenings[fit.name]

    @cached_property
    def _softenings(self) -> dict[str, SofteningFit]:
        """Softening fits that were requested, by the name of the model."""
        return {}

    @property
    def warnings(self) -> list[str]:
        """Warnings on the data and the recommended model, in sentences."""
        return self._warnings(self.recommended)

    def _warnings(self, fit: ModelFit) -> list[str]:
        """Return the warnings beside a model."""
        found: list[str] = []
        for curve, toe in zip(self.measured, self.toes, strict=True):
            found += _about_the_start(curve, toe, self.correction)
        if {curve.mode for curve in self.curves} == {"uniaxial"}:
            found.append(
                "Only uniaxial curves: each model is a guess in the other modes; neo-hookean, gent "
                "and yeoh, of one invariant, stay stable there, and may be far off"
            )
        for mode in self.untested:
            sentence = mode.beside(fit.name, stress_in(fit, mode))
            found += [sentence] if sentence else []
        young = fit.young.value
        if not _RUBBER[0] < young < _RUBBER[1]:
            found.append(
                f"Young's modulus comes out as {_kpa(young)}, which is no rubber: check the units"
            )
        for seen in self.observed:
            misfit = abs(young - seen.young) / seen.uncertainty
            if misfit > 2.0:
                found.append(
                    f"{seen.name} ({_kpa(seen.young)}) and {fit.name} "
                    f"({_kpa(young)}) differ by {misfit:.1f} standard uncertainties"
                )
        return found

    def card(
        self, name: str, model: str | None = None, *, title: str = "", source: str = ""
    ) -> Card:
        """Make a material card of a model.

        Parameters
        ----------
        name
            Name in designs.
        model
            Name of a model; default: the recommended one.
        title, source
            See :class:`~voxsoft.materials.Card`; the source has a default that names the curves.

        Raises
        ------
        MaterialError
            The model is unstable within the strains that were tested: no simulation could use it
            there. Its fit is still among :attr:`models`.
        """
        fit = self.of(model)
        if not fit.stable_in_fit:
            raise self._unstable(fit)
        soft = self.softening(model)
        changes: dict[str, Any] = {"tested_stretch": self._tested()}
        if soft is not None:
            changes["mullins"] = soft.mullins
        breaks = [c.elongation_at_break for c in self.measured if c.elongation_at_break]
        modes = ", ".join(dict.fromkeys(curve.mode for curve in self.curves))
        names = ", ".join(curve.name for curve in self.curves)
        return Card(
            name=name,
            title=title,
            material=fit.material.model_copy(update=changes),
            source=source or f"Fitted to {modes} curves: {names}.",
            caution=". ".join(
                [
                    f"Fitted to strains between {self._span(0):.2f} and {self._span(1):.2f}",
                    *fit.warnings,
                    *self._warnings(fit),
                    *(() if soft is None else soft.warnings),
                ]
            )
            + ".",
            elongation_at_break=min(breaks) if breaks else None,
            calibration=self._notes(fit, soft),
        )

    def summary(self, model: str | None = None) -> dict[str, Any]:
        """Everything as plain data in SI units, with the softening beside a model."""
        soft = self.softening(model)
        return {
            "recommended": self.recommended.name,
            "toe": self.correction,
            "max_strain": self.max_strain,
            "curves": [
                {
                    "name": curve.name,
                    "mode": curve.mode,
                    "points": len(curve.strain),
                    "strain": [float(curve.strain.min()), float(curve.strain.max())],
                    "elongation_at_break": curve.elongation_at_break,
                    "toe_strain": None if toe is None else toe.strain,
                    "toe_uncertainty": None if toe is None else toe.uncertainty,
                    "offset": None if toe is None else toe.offset,
                }
                for curve, toe in zip(self.curves, self.toes, strict=True)
            ],
            "observed": [seen._asdict() for seen in self.observed],
            "models": [_summary_of(fit) for fit in self.models],
            "softening": None
            if soft is None
            else {
                "cycles": [each.name for each in self.cycles],
                "constants": {
                    name: {"value": i.value, "low": i.low, "high": i.high}
                    for name, i in soft.constants.items()
                },
                "rmse": soft.rmse,
                "warnings": list(soft.warnings),
            },
            "rejected": dict(self.rejected),
            "untested": [mode._asdict() for mode in self.untested],
            "warnings": self.of(model).warnings + self._warnings(self.of(model)),
        }

    def _unstable(self, fit: ModelFit) -> MaterialError:
        sound = [other.name for other in self.models if other.stable_in_fit]
        return MaterialError(
            fit.name,
            f"is unstable between the strains {self._span(0):.3g} and {self._span(1):.3g} that "
            f"were tested: {'; '.join(each.sentence for each in fit.stability if each.sentence)}",
            f"take one that is stable there: {', '.join(sound)}"
            if sound
            else "look at the curves: no model is stable there; --max-strain leaves their ends out",
        )

    def _span(self, end: int) -> float:
        choose = (min, max)[end]
        return float(choose(choose(curve.strain) for curve in self.curves))

    def _tested(self) -> StretchRange:
        """Return the range of stretches of the specimens in the fitted parts of the curves."""
        low, high = self._span(0), self._span(1)
        pressed = round(1.0 + low, 4) if low < -_LARGE_TOE else None
        return StretchRange(largest=max(round(1.0 + high, 4), 1.0), smallest=pressed)

    def _notes(self, fit: ModelFit, soft: SofteningFit | None) -> dict[str, Any]:
        notes: dict[str, Any] = {
            "method": "least squares of engineering stress, incompressible",
            "model": fit.name,
            "data": [curve.name for curve in self.curves],
            "modes": [curve.mode for curve in self.curves],
            "points": [len(curve.strain) for curve in self.curves],
            "strain_range": [round(self._span(0), 6), round(self._span(1), 6)],
            "toe_correction": self.correction,
            "toe_strain": [0.0 if toe is None else round(toe.strain, 6) for toe in self.toes],
            "stress_offset": [_kpa(0.0 if toe is None else toe.offset) for toe in self.toes],
            "rmse": _kpa(fit.rmse),
            "cross_validated_rmse": _kpa(fit.cv_rmse),
            "young": _kpa(fit.young.value),
            "young_interval": _between(fit.young, "modulus"),
        }
        if self.observed:
            notes["observed"] = [
                f"{seen.name}: E = {_kpa(seen.young)} ± {_kpa(seen.uncertainty)}"
                for seen in self.observed
            ]
        for name, interval in fit.constants.items():
            notes[f"{name}_interval"] = _between(interval, _kind_of(name))
        if soft is not None:
            notes["cycles"] = [each.name for each in self.cycles]
            notes["softening_rmse"] = _kpa(soft.rmse)
            for name, interval in soft.constants.items():
                notes[f"{name}_interval"] = _between(
                    interval, "modulus" if name == "m" else "number"
                )
        notes["interval_method"] = (
            "linearized least squares, residual scale widened for residuals that follow one "
            "another; it holds for this model and these specimens"
        )
        return notes


def stress_in(fit: ModelFit, mode: UntestedMode) -> float:
    """Return the engineering stress of a model at the stretch of an untested mode in Pa."""
    return float(nominal_stress(fit.material, np.array([mode.stretch]), mode.mode)[0])


def _summary_of(fit: ModelFit) -> dict[str, Any]:
    return {
        "name": fit.name,
        "material": fit.material.model_dump(by_alias=True),
        "constants": {
            name: {"value": i.value, "low": i.low, "high": i.high}
            for name, i in fit.constants.items()
        },
        "young": {"value": fit.young.value, "low": fit.young.low, "high": fit.young.high},
        "rmse": fit.rmse,
        "max_error": fit.max_error,
        "cv_rmse": fit.cv_rmse,
        "r2": fit.r2,
        "stable_in_fit": fit.stable_in_fit,
        "stable": {found.mode: list(found.stable) for found in fit.stability},
        "warnings": fit.warnings,
    }


def _about_the_start(curve: Curve, toe: Toe | None, correction: ToeCorrection) -> list[str]:
    first = float(np.abs(curve.strain).min())
    found = []
    if toe is None:
        found.append(f"{curve.name}: too few points below 30 % strain to find the toe")
    elif correction != "off" and _SMALL_TOE < abs(toe.strain) < 2.0 * toe.uncertainty:
        found.append(
            f"{curve.name}: the toe of {toe.strain:.1%} strain is no larger than its own "
            f"uncertainty of {toe.uncertainty:.1%}: without correction (off) the fit may be better"
        )
    elif abs(toe.strain) > _LARGE_TOE:
        done = {"strain": "taken off the strain", "stress": "taken off the stress"}
        found.append(
            f"{curve.name}: toe of {toe.strain:.1%} strain, or {_kpa(toe.offset)} of load-cell "
            f"offset, {done.get(correction, 'left in')}: small-strain moduli are uncertain"
        )
    if first > 0.04:
        found.append(
            f"{curve.name}: the first point is at {first:.1%} strain: "
            "small-strain moduli are extrapolated"
        )
    return found


def _kind_of(name: str) -> str:
    return "number" if name == "jm" or name.startswith("alpha") else "modulus"


def _between(interval: Interval, kind: str) -> str:
    low, high = (format_quantity(float(f"{v:.4g}"), kind) for v in (interval.low, interval.high))
    return f"between {low} and {high} (95 %)"


def _kpa(value: float) -> str:
    return format_quantity(float(f"{value:.4g}"), "modulus")
