"""Result of a calibration: moduli, errors, history, and identifiability."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft._shown import Shown, counted, rounded
from voxsoft.calibration.experiment import Experiment
from voxsoft.calibration.identifiability import Profile
from voxsoft.calibration.misfit import Deviation
from voxsoft.materials import Card, Hyperelastic, Lattice, Material, with_constants
from voxsoft.units import format_quantity

#: Mean miss that no reading of marks explains, and one that is left to the solver where neighbors
#: deviate alike, in percent of the sag.
_MISREAD: Final = 5.0
_SMALL_MISS: Final = 1.0


@dataclass(frozen=True)
class Generation:
    """One generation of a search (the paper's Fig. 3).

    Attributes
    ----------
    best_fitness, mean_fitness
        Best and mean fitness of this generation; a candidate that failed counts as zero.
    best_error
        Smallest mean error of this generation, m; infinite if all failed.
    parameters
        Parameters of its best candidate, SI.
    spread
        Smallest and largest value of each parameter among its candidates, SI.
    """

    best_fitness: float
    mean_fitness: float
    best_error: float
    parameters: Mapping[str, float]
    spread: Mapping[str, tuple[float, float]] = field(default_factory=dict)


@dataclass(frozen=True)
class Candidate:
    """A candidate at the end of a stage: of the search, or of the refinement after it.

    Attributes
    ----------
    parameters
        Constants by name, SI.
    error
        Mean error in m.
    fitness
        The paper's fitness.
    evaluations
        Number of candidates simulated so far.
    """

    parameters: Mapping[str, float]
    error: float
    fitness: float
    evaluations: int


@dataclass(frozen=True)
class Fit:
    """Fit of one experiment (the paper's Fig. 4).

    Attributes
    ----------
    experiment
        The experiment.
    deviation
        Simulated and measured numbers at its stations, and the scale.
    """

    experiment: Experiment
    deviation: Deviation

    @property
    def errors(self) -> NDArray[np.float64]:
        """Length of the error vector at each station, (n,), m."""
        return self.deviation.errors

    @property
    def percent(self) -> NDArray[np.float64]:
        """Length of the error vector at each station in percent of the measured tip sag, (n,).

        The largest of them is the number that the paper prints for each beam.
        """
        share: NDArray[np.float64] = 100.0 * self.errors / self.experiment.sag
        return share

    @property
    def correlation(self) -> float:
        r"""Correlation of the error vectors of neighboring stations, from -1 to 1.

        :math:`\sum r_i \cdot r_{i+1} / \sum |r_i|^2`: zero in the mean where the misfit is noise;
        near 1 where it is systematic.
        """
        errors = self.deviation.simulated - self.deviation.measured
        arcs = self.experiment.measurement.arcs
        if arcs is not None:
            errors = errors[np.argsort(arcs)]
        squares = float((errors**2).sum())
        return float((errors[:-1] * errors[1:]).sum()) / squares if squares else 0.0

    @property
    def is_systematic(self) -> bool:
        """True if the misfit is more than noise that is independent at each station.

        The correlation of such noise varies by ``1/sqrt(n q)`` for n stations of q numbers; beyond
        twice that it is one time in forty. A misfit below 0.1 % of the sag is left to the solver.
        """
        limit = 2.0 / np.sqrt(self.deviation.measured.size)
        return float(self.percent.mean()) > 0.1 and self.correlation > limit

    @property
    def caution(self) -> str:
        """Warning about a systematic misfit; empty where there is none."""
        if not self.is_systematic:
            return ""
        known = self.experiment.measurement.arcs is not None
        where = self.experiment.line.replace("-", " ")
        line = f", and that the marks were on the {where}" if known else ""
        return (
            f"{self.experiment.name}: neighboring stations deviate alike (correlation "
            f"{self.correlation:.2f}), which noise does not: check sizes, clamp and scale{line}."
        )

    @property
    def miss(self) -> str:
        """Largest miss with its place, where the model misses more than marks are misread.

        Marks of which neighbors deviate alike by more than 1 % of the sag are not misread, nor are
        those that deviate by more than 5 % in the mean.
        """
        mean = float(self.percent.mean())
        if mean <= _MISREAD and not (self.is_systematic and mean > _SMALL_MISS):
            return ""
        worst = int(np.argmax(self.errors))
        station = self.experiment.measurement.station_names[worst]
        off = format_quantity(float(f"{self.errors[worst]:.2g}"), "length")
        return (
            f"{self.experiment.name}: the model misses by up to {off}, {self.percent[worst]:.0f} % "
            f"of the sag, at {station}: try finer voxels, another law of the material, or the "
            "sizes and the clamp of the specimen; intervals of the constants are too narrow."
        )

    def summary(self) -> dict[str, Any]:
        """Plain data in SI units."""
        measurement, deviation = self.experiment.measurement, self.deviation
        return {
            "name": self.experiment.name,
            "source": measurement.source,
            "line": self.experiment.line,
            "correlation": self.correlation,
            "stations": list(measurement.station_names),
            "quantities": list(measurement.quantities),
            "measured": deviation.measured.tolist(),
            "simulated": deviation.simulated.tolist(),
            "errors": self.errors.tolist(),
            "percent": self.percent.tolist(),
            "sag": self.experiment.sag,
            "scale": deviation.scale,
            "mean_error": float(self.errors.mean()),
            "max_error": float(self.errors.max()),
            "mean_percent": float(self.percent.mean()),
            "max_percent": float(self.percent.max()),
        }


@dataclass(frozen=True, repr=False)
class Calibration(Shown):
    """Material fitted to experiments.

    Attributes
    ----------
    material
        Material that fits best.
    parameters
        Constants that were searched, SI.
    bounds
        Search ranges of the constants, SI.
    kinds
        Kind of quantity of each constant.
    fits
        Each experiment with its simulated shape.
    fitness
        ``exp(-10 Σ|r|)`` with error vectors in m, summed over the stations: a mean error of
        5.7 mm at nine stations is 0.60.
    search
        Result of the method, before refinement.
    history
        Generations of the search.
    profiles
        Profile likelihood of each parameter; empty if not requested.
    evaluations
        Number of candidates simulated in search, refinement and profiles.
    free_scale
        True if each experiment had a factor of its own on the simulated shape.
    method, seed, settings
        Method, seed and settings of the search.
    """

    material: Material
    parameters: Mapping[str, float]
    bounds: Mapping[str, tuple[float, float]]
    kinds: Mapping[str, str]
    fits: tuple[Fit, ...]
    fitness: float
    search: Candidate
    history: tuple[Generation, ...] = field(repr=False)
    profiles: tuple[Profile, ...] = field(repr=False)
    evaluations: int
    free_scale: bool
    method: str
    seed: int
    settings: Mapping[str, Any]

    def _lines(self) -> Iterator[str]:
        error = format_quantity(rounded(self.mean_error), "length")
        tried = counted(self.evaluations, "candidate")
        yield f"{self.material.model}: mean error {error} after {tried} ({self.method})"
        for name, value in self.parameters.items():
            yield f"{name} {format_quantity(rounded(value), self.kinds[name])}"

    @property
    def mean_error(self) -> float:
        """Mean length of the error vectors in m: over stations, then over experiments."""
        return float(np.mean([fit.errors.mean() for fit in self.fits]))

    @property
    def max_error(self) -> float:
        """Largest error vector in m."""
        return float(max(fit.errors.max() for fit in self.fits))

    @property
    def scale(self) -> float | list[float]:
        """Factor on the simulated shape; a list for several experiments with a free scale."""
        scales = [fit.deviation.scale for fit in self.fits]
        return scales if len(set(scales)) > 1 else scales[0]

    @property
    def identifiable(self) -> dict[str, bool]:
        """True for each parameter that the data determine, by its name."""
        return {profile.name: profile.identifiable for profile in self.profiles}

    @property
    def young(self) -> float:
        """Young's modulus of a large block of the material, Pa."""
        return self.material.young(self._voxel_size)

    @property
    def poisson(self) -> float:
        """Poisson's ratio of a large block of the material."""
        material = self.material
        if isinstance(material, Hyperelastic):
            return material.poisson
        return material.poisson(self._voxel_size)

    @property
    def _voxel_size(self) -> float:
        return self.fits[0].experiment.voxel_size

    def summary(self) -> dict[str, Any]:
        """Return all results as plain data in SI units (the ``--json`` of ``calibrate``).

        Errors are lengths of vectors in m. Percent are of the measured tip sag.
        """
        return {
            "parameters": dict(self.parameters),
            "mean_error": self.mean_error,
            "max_error": self.max_error,
            "max_percent": max(float(fit.percent.max()) for fit in self.fits),
            "fitness": self.fitness,
            "evaluations": self.evaluations,
            "identifiable": self.identifiable,
            "scale": self.scale,
            "free_scale": self.free_scale,
            "intervals": {profile.name: _interval(profile) for profile in self.profiles},
            "young": self.young,
            "poisson": self.poisson,
            "density": self.material.density,
            "bounds": {name: list(bounds) for name, bounds in self.bounds.items()},
            "search": {
                "parameters": dict(self.search.parameters),
                "mean_error": self.search.error,
                "fitness": self.search.fitness,
                "evaluations": self.search.evaluations,
            },
            "warnings": self.warnings,
            "experiments": [fit.summary() for fit in self.fits],
            "history": [
                {
                    "best_fitness": generation.best_fitness,
                    "mean_fitness": generation.mean_fitness,
                    "best_error": _finite(generation.best_error),
                    "parameters": dict(generation.parameters),
                }
                for generation in self.history
            ],
            "method": self.method,
            "seed": self.seed,
            "settings": dict(self.settings),
            "version": _core.__version__,
        }

    def card(self, name: str, *, title: str = "", source: str = "", caution: str = "") -> Card:
        """Make a material card of the result.

        Parameters
        ----------
        name
            Name of the material in designs.
        title
            Title for people; default: the name of the first experiment.
        source
            Source of the data; default: the sources of the measurements.
        caution
            Limits of the numbers, added to those the calibration found itself.

        Returns
        -------
        Card
            Card with the constants rounded to 4 digits, and a record of the calibration.
        """
        sources = dict.fromkeys(fit.experiment.measurement.source for fit in self.fits)
        return Card(
            name=name,
            title=title or self.fits[0].experiment.name,
            material=self._rounded(),
            source=source or " ".join(filter(None, sources)),
            caution=" ".join(filter(None, [caution, *self._cautions()])),
            calibration=self._record(),
        )

    @property
    def warnings(self) -> list[str]:
        """Warnings in sentences: a miss of the model, an assumed line, a systematic misfit."""
        each = ((fit.miss, fit.experiment.caution, fit.caution) for fit in self.fits)
        return [caution for some in each for caution in some if caution]

    @property
    def miss(self) -> str:
        """Miss of the experiment that fits worst, see :attr:`Fit.miss`; empty without one."""
        missed = [fit for fit in self.fits if fit.miss]
        return max(missed, key=lambda fit: float(fit.percent.mean())).miss if missed else ""

    def _rounded(self) -> Material:
        """Round to 4 digits: all moduli of a lattice, and the other searched constants."""
        rounded = {name: float(f"{value:.4g}") for name, value in self.parameters.items()}
        if isinstance(self.material, Lattice):
            own = {"edge": self.material.edge, "bulk": self.material.bulk}
            rounded = {name: float(f"{value:.4g}") for name, value in own.items()}
        return with_constants(self.material, rounded)

    def _cautions(self) -> Iterator[str]:
        for profile in self.profiles:
            if not profile.identifiable:
                yield f"{profile.name} is not identified by the data: {profile.sentence}."
        yield from (sentence for fit in self.fits for sentence in (fit.miss, fit.caution))

    def _record(self) -> dict[str, Any]:
        sizes = dict.fromkeys(fit.experiment.voxel_size for fit in self.fits)
        record: dict[str, Any] = {
            "data": [fit.experiment.name for fit in self.fits],
            "stations": sum(len(fit.experiment.measurement) for fit in self.fits),
            "line": [fit.experiment.line for fit in self.fits],
            "voxel_size": [_text(size, "length", 6) for size in sizes],
            "scale": [float(f"{fit.deviation.scale:.5g}") for fit in self.fits],
            "free_scale": self.free_scale,
            "mean_error": _text(self.mean_error, "length", 4),
            "max_error": _text(self.max_error, "length", 4),
            "max_percent_of_sag": [float(f"{fit.percent.max():.4g}") for fit in self.fits],
            "fitness": float(f"{self.fitness:.5g}"),
            "young": _text(self.young, "modulus", 4),
            "poisson": float(f"{self.poisson:.4g}"),
            "method": self.method,
            "seed": self.seed,
            "evaluations": self.evaluations,
            "version": _core.__version__,
        }
        record |= {f"{key}": value for key, value in self.settings.items()}
        record |= {
            f"{name}_range": _range(bounds, self.kinds[name])
            for name, bounds in self.bounds.items()
        }
        record |= {f"{profile.name}_interval": profile.sentence for profile in self.profiles}
        return record


def _interval(profile: Profile) -> dict[str, Any]:
    return {
        "low": profile.low,
        "high": profile.high,
        "sentence": profile.sentence,
        "profile": {"values": profile.values.tolist(), "errors": profile.errors.tolist()},
    }


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _text(value: float, kind: str, digits: int) -> str:
    return format_quantity(float(f"{value:.{digits}g}"), kind)


def _range(bounds: tuple[float, float], kind: str) -> list[str]:
    return [format_quantity(bound, kind) for bound in bounds]
