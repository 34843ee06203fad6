"""The job of a calibration."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from voxsoft import files
from voxsoft.calibration import Calibration, CalibrationEvent, Experiment, calibrate
from voxsoft.calibration.result import Fit
from voxsoft.calibration.table import read_measurement
from voxsoft.files.cards import card_text
from voxsoft.studio import events
from voxsoft.studio.commands import CalibrateSpec
from voxsoft.studio.progress import Progress
from voxsoft.studio.specimen import stations, write_specimen
from voxsoft.studio.task import Task
from voxsoft.units import format_quantity

#: The card that a calibration leaves in its folder.
CARD: Final = "card"


def run_calibration(task: Task, progress: Progress) -> str:
    """Fit the material of a task's design; returns what came out."""
    spec = task.spec
    assert isinstance(spec, CalibrateSpec)
    design = task.read_design()
    experiments = [
        Experiment(design, read_measurement(table.text, name=table.name, select=table.select))
        for table in task.tables
    ]
    progress.at(0, spec.generations)
    smallest = np.inf

    def tell(event: CalibrationEvent) -> None:
        nonlocal smallest
        if event.generation is not None:
            found = event.generation
            progress.tell(
                events.Generation(
                    job=task.id,
                    index=event.done,
                    best=found.best_fitness,
                    mean=found.mean_fitness,
                    error=found.best_error if np.isfinite(found.best_error) else None,
                    parameters=dict(found.parameters),
                    spread=dict(found.spread),
                )
            )
            if event.mean_error < smallest:
                smallest = event.mean_error
                _show(task.id, event.fits(), progress)
        done = event.done if event.stage == "search" else spec.generations
        best = ""
        if np.isfinite(event.mean_error):
            best = f"mean error {_length(event.mean_error)}"
        progress.at(done, spec.generations, best=best, stage=event.stage)

    answer = calibrate(
        experiments,
        spec.method,
        parameters=spec.bounds,
        free_scale=spec.free_scale,
        seed=spec.seed,
        workers=spec.workers,
        generations=spec.generations,
        population=spec.population,
        refine=spec.refine,
        identify=spec.identify,
        progress=tell,
    )
    name = _card_name(task.name)
    files.write_calibration(answer, progress.folder, name)
    _show(task.id, answer.fits, progress)
    progress.tell(calibrated_event(task.id, answer, card_text(answer.card(name))))
    return f"Mean error {_length(answer.mean_error)}, largest {_length(answer.max_error)}."


def _show(job: str, fits: Sequence[Fit], progress: Progress) -> None:
    """Leave the specimen of the best candidate in the folder, and tell the page of it."""
    if fits:  # all are of one design and one material: they differ in what was measured
        write_specimen(fits[0], progress.folder)
    progress.tell(overlay_event(job, fits))


def overlay_event(job: str, fits: Sequence[Fit]) -> events.Overlay:
    """Measured and simulated stations, as points of the design's space."""
    return events.Overlay(
        job=job,
        experiments=[
            events.OverlayExperiment(
                name=fit.experiment.name,
                measured=measured,
                simulated=simulated,
                error=fit.errors.tolist(),
                percent=fit.percent.tolist(),
            )
            for fit in fits
            for measured, simulated in [stations(fit)]
        ],
    )


def calibrated_event(job: str, answer: Calibration, card: str) -> events.Calibrated:
    """The result of a calibration as the page wants it."""
    profiles = {profile.name: profile for profile in answer.profiles}
    return events.Calibrated(
        job=job,
        parameters=[
            events.FittedParameter(
                name=name,
                value=value,
                kind=answer.kinds[name],
                text=format_quantity(float(f"{value:.4g}"), answer.kinds[name]),
                low=answer.bounds[name][0],
                high=answer.bounds[name][1],
                identifiable=answer.identifiable.get(name),
                sentence=profiles[name].sentence if name in profiles else "not asked",
            )
            for name, value in answer.parameters.items()
        ],
        table=[
            events.StationError(
                experiment=fit.experiment.name,
                station=station,
                measured=fit.comparison.measured[at].tolist(),
                simulated=fit.comparison.simulated[at].tolist(),
                error=float(fit.errors[at]),
                percent=float(fit.percent[at]),
            )
            for fit in answer.fits
            for at, station in enumerate(fit.experiment.measurement.station_names)
        ],
        quantities=list(answer.fits[0].experiment.measurement.quantities),
        identifiable=answer.identifiable,
        fitness=answer.fitness,
        mean_error=answer.mean_error,
        max_error=answer.max_error,
        material=answer.material.model_dump(mode="json", exclude_none=True),
        card=card,
    )


def _length(value: float) -> str:
    return format_quantity(float(f"{value:.3g}"), "length")


def _card_name(name: str) -> str:
    """A name that a design can write: lower case, letters, digits and hyphens."""
    import re

    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-") or CARD
