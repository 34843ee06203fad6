"""Calibration of a material by experiments."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final, Literal

import numpy as np

from voxsoft._interrupt import Interrupts
from voxsoft.calibration.experiment import Experiment
from voxsoft.calibration.identifiability import profiles
from voxsoft.calibration.methods import Batch, errors_of, method_named
from voxsoft.calibration.misfit import TOLERANCE, Evaluation, Misfit
from voxsoft.calibration.refinement import refine as refined
from voxsoft.calibration.result import Calibration, Candidate, Fit, Generation
from voxsoft.calibration.space import Bounds, Space
from voxsoft.errors import MeasurementError, SimulationError, StudyError
from voxsoft.materials import Hyperelastic, Material
from voxsoft.simulation.solving.choice import check_settings_of

#: Solver settings of an experiment that count, and why no others do.
_USED: Final = frozenset({"refine"})
_SOLVES: Final = "calibrations, which bring every candidate to rest with settings of their own"


@dataclass(frozen=True)
class CalibrationEvent:
    """Progress of a calibration.

    Attributes
    ----------
    stage
        ``search``, then ``refinement`` and ``profiles`` (once each, as they start).
    done, total
        Number of finished generations of the search, and of all.
    evaluations
        Number of candidates simulated so far.
    mean_error
        Smallest mean error so far, m.
    generation
        Generation that has just finished; None at the start of a further stage.
    fits
        Function that simulates the best candidate so far and compares it with the measurements;
        empty where none came to rest.
    """

    stage: Literal["search", "refinement", "profiles"]
    done: int
    total: int
    evaluations: int
    mean_error: float
    generation: Generation | None = None
    fits: Callable[[], tuple[Fit, ...]] = tuple


ProgressCallback = Callable[[CalibrationEvent], None]


def calibrate(
    experiments: Experiment | Sequence[Experiment],
    method: str = "genetic",
    *,
    parameters: Mapping[str, Bounds] | None = None,
    free_scale: bool = False,
    seed: int = 0,
    workers: int | None = None,
    generations: int = 50,
    population: int = 30,
    refine: bool = True,
    identify: bool = True,
    lanes: bool = True,
    progress: ProgressCallback | None = None,
) -> Calibration:
    """Fit the constants of one material to measurements.

    Three stages follow each other. *Search*: the method explores the whole range; with
    ``genetic`` this is the paper's Algorithm 4 to the letter; ``gradient`` takes initial samples
    and then descends along exact slopes. *Refinement*: a simplex walks to the bottom of the valley
    that the search found. *Profiles*: the error along each constant shows which of them the data
    determine.

    Parameters
    ----------
    experiments
        One or several, each with the same weight; all bodies are of the same material.
    method
        ``genetic``, ``gradient``, ``cma-es``, or an Optuna sampler: ``random``, ``tpe``, ``gp``,
        ``nsga-ii`` ...
    parameters
        Range of each constant that is fitted, as text with a unit or in SI units, positive, by
        a name of :func:`voxsoft.materials.constants_of`: ``edge``, ``c10``, ``mu.1`` ... Default:
        for a lattice ``edge`` from 1 kPa to 1 MPa and ``bulk`` from 2 kPa to 1 MPa
        (:data:`voxsoft.calibration.DEFAULT_BOUNDS` gives the reason); for a hyperelastic model
        ``young`` from 5 kPa to 2 MPa, which scales all its moduli. Other constants stay as the
        design has them.
    free_scale
        True if each experiment has a factor of its own on the simulated shape, for photographs
        whose scale is doubtful. Errors stay in the data's own meters.
    seed
        Seed of the search; the same seed gives the same answer.
    workers
        Number of simulations at a time; default: of cores. The answer does not depend on it.
    generations, population
        Budget of the search; the paper's 50 and 30 by default. CMA-ES may need fewer;
        ``gradient`` stops by itself.
    refine
        True to refine after the search.
    identify
        True to profile the error.
    lanes
        True to solve slender lattice bodies in dead loads by statics with several candidates at a
        time, one in each lane of the processor; without, each is relaxed by itself. Both find the
        same states, within the tolerance. ``gradient`` has its candidates one by one.
    progress
        Called after each generation and at the start of each further stage.

    Returns
    -------
    Calibration
        Moduli, errors for each station, history, identifiability.

    Raises
    ------
    MeasurementError
        Fewer stations than parameters (a free scale is one more for each experiment).
    MaterialError
        An unknown constant or an empty range.
    SimulationError
        No candidate of the search came to rest.
    StudyError
        An unknown method or an impossible budget.

    Notes
    -----
    Refinement is needed because, with ``exp(k S)`` as fitness, the wheel of Algorithm 4 gives a
    candidate that is 0.1 mm better at nine stations only a 0.9 % larger chance: the search stops at
    random in a valley a few percent wide. :attr:`Calibration.search` keeps its result.

    Examples
    --------
    >>> from voxsoft.calibration import Measurement
    >>> from voxsoft.design import families
    >>> seen = Measurement(quantities=["dz"], values=[[-0.030], [-0.070]], arcs=[0.04, 0.08])
    >>> beam = families.beam().with_values("parts.0.material=ecoflex-00-30-lattice")
    >>> experiment = Experiment(beam, seen)
    >>> found = calibrate(
    ...     experiment, "cma-es", parameters={"edge": ("5 kPa", "50 kPa")},
    ...     generations=5, population=6, identify=False,
    ... )
    >>> found.mean_error < 0.003
    True
    """
    chosen = [experiments] if isinstance(experiments, Experiment) else list(experiments)
    space = Space.of(parameters, _material_of(chosen))
    for experiment in chosen:
        check_settings_of(experiment.design, _USED, _SOLVES)
    _check_counts(chosen, space, free_scale, generations, population)
    search = method_named(method)
    statics = method == "gradient" or isinstance(space.base, Hyperelastic)
    misfit = Misfit(
        chosen,
        space,
        free_scale=free_scale,
        workers=_workers(workers),
        statics=statics,
        lanes=lanes and not statics,
    )
    report = progress or (lambda _: None)
    history: list[Generation] = []
    best: Evaluation | None = None
    with misfit.pool(), Interrupts() as interrupts:
        for batch in search(misfit, generations, population, seed):
            interrupts.stop_if_interrupted()
            best = min(batch if best is None else [best, *batch], key=lambda each: each.error)
            history.append(_generation(misfit, batch))
            done = len(history)
            report(
                CalibrationEvent(
                    "search",
                    done,
                    generations,
                    misfit.evaluations,
                    best.error,
                    history[-1],
                    partial(_fits, misfit, best),
                )
            )
        found = _require_rest(best)
        stage = _candidate(misfit, found)
        if refine:
            report(CalibrationEvent("refinement", 0, 1, misfit.evaluations, found.error))
            found = refined(misfit, found)
        report(CalibrationEvent("profiles", 0, 1, misfit.evaluations, found.error))
        profiled = profiles(misfit, found) if identify else ()
    compared = misfit.compare(found.genes)
    assert not isinstance(compared, str)  # it came to rest before, and again the same way
    return Calibration(
        material=space.material_at(found.genes),
        parameters=space.parameters(found.genes),
        bounds=dict(zip(space.names, zip(space.low, space.high, strict=True), strict=True)),
        kinds=space.kinds,
        fits=tuple(Fit(*pair) for pair in zip(chosen, compared, strict=True)),
        fitness=found.fitness,
        search=stage,
        history=tuple(history),
        profiles=profiled,
        evaluations=misfit.evaluations,
        free_scale=free_scale,
        method=method,
        seed=seed,
        settings={
            "generations": generations,
            "population": population,
            "refined": refine,
            "solver": ", ".join(dict.fromkeys(misfit.ways)),
            "tolerance": TOLERANCE,
        },
    )


def _fits(misfit: Misfit, candidate: Evaluation) -> tuple[Fit, ...]:
    compared = misfit.compare(candidate.genes)
    if isinstance(compared, str):
        return ()
    return tuple(Fit(*pair) for pair in zip(misfit.experiments, compared, strict=True))


def _material_of(experiments: Sequence[Experiment]) -> Material:
    if not experiments:
        raise MeasurementError("experiments", "there are none", "give at least one")
    return experiments[0].material


def _check_counts(
    experiments: Sequence[Experiment],
    space: Space,
    free_scale: bool,
    generations: int,
    population: int,
) -> None:
    stations = sum(len(experiment.measurement) for experiment in experiments)
    unknowns = len(space) + (len(experiments) if free_scale else 0)
    if stations < unknowns:
        scales = " and scales" if free_scale else ""
        raise MeasurementError(
            "stations",
            f"there are {stations} for {unknowns} parameters{scales}",
            "measure more stations, or fit fewer parameters: "
            f'parameters={{"{space.names[0]}": ...}}',
        )
    if generations < 1 or population < 4:
        raise StudyError(
            "generations, population",
            f"{generations} generations of {population} are no search",
            "use at least 1 generation of at least 4",
        )


def _workers(workers: int | None) -> int:
    if workers is not None and workers < 1:
        raise StudyError("workers", f"{workers} cannot work", "use at least 1")
    return workers or os.cpu_count() or 1


def _generation(misfit: Misfit, batch: Batch) -> Generation:
    best = min(batch, key=lambda each: each.error)
    return Generation(
        best_fitness=best.fitness,
        mean_fitness=float(np.mean([each.fitness for each in batch])),
        best_error=float(errors_of(batch).min()),
        parameters=misfit.space.parameters(best.genes),
        spread=_spread([misfit.space.parameters(each.genes) for each in batch]),
    )


def _spread(candidates: Sequence[Mapping[str, float]]) -> dict[str, tuple[float, float]]:
    return {
        name: (min(each[name] for each in candidates), max(each[name] for each in candidates))
        for name in candidates[0]
    }


def _candidate(misfit: Misfit, found: Evaluation) -> Candidate:
    return Candidate(
        misfit.space.parameters(found.genes), found.error, found.fitness, misfit.evaluations
    )


def _require_rest(best: Evaluation | None) -> Evaluation:
    if best is None or not np.isfinite(best.error):
        status = best.status if best else "failed"
        raise SimulationError(
            "calibrate",
            f"no candidate came to rest; the first ended {status}",
            "narrow or shift the ranges of the constants, or check clamps and loads with `check`",
        )
    return best
