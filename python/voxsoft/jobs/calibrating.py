"""Job of a calibration: a material from measurements."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from voxsoft import files
from voxsoft.calibration import Calibration, CalibrationEvent, Experiment, calibrate
from voxsoft.jobs.events import Listener, Progress
from voxsoft.jobs.folder import write_job
from voxsoft.jobs.outcome import JobOutcome
from voxsoft.jobs.spec import CalibrateSpec
from voxsoft.units import format_quantity


def run_calibration(spec: CalibrateSpec, folder: Path, notify: Listener) -> JobOutcome[Calibration]:
    """Fit the material of a spec's design and write the card and its report."""
    design = spec.design.read()
    experiments = [Experiment(design, table.read()) for table in spec.data]
    notify(Progress(0, spec.generations, "generations"))

    def report(event: CalibrationEvent) -> None:
        notify(event)
        done = event.done if event.stage == "search" else spec.generations
        found = np.isfinite(event.mean_error)
        best = f"mean error {_length(event.mean_error)}" if found else ""
        notify(Progress(done, spec.generations, "generations", event.stage, best))

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
        progress=report,
    )
    write_job(spec, folder)
    written = files.write_calibration(answer, folder, spec.card_name)
    notify(answer)
    sentence = f"Mean error {_length(answer.mean_error)}, largest {_length(answer.max_error)}."
    return JobOutcome(folder, answer, sentence, tuple(written))


def _length(value: float) -> str:
    return format_quantity(float(f"{value:.3g}"), "length")
