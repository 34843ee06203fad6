"""Events of a job in the form that the page expects."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from voxsoft.calibration import Calibration, CalibrationEvent
from voxsoft.calibration.result import Fit
from voxsoft.files.cards import card_text
from voxsoft.files.specimen import write_specimen
from voxsoft.jobs.events import JobEvent, Listener, StudyStanding
from voxsoft.jobs.events import Progress as Standing
from voxsoft.jobs.spec import CalibrateSpec, Spec
from voxsoft.simulation import LoadPath
from voxsoft.studio.protocol import events
from voxsoft.studio.running.calibrating import calibrated_event, overlay_event
from voxsoft.studio.running.progress import Progress
from voxsoft.studio.running.studying import trial_event, trials_event
from voxsoft.study import TrialEvent


def listener_of(spec: Spec, progress: Progress) -> Listener:
    """Return a listener that passes a job's events to the page, and holds the job in its pauses."""
    smallest = np.inf

    def listen(event: JobEvent) -> None:
        nonlocal smallest
        match event:
            case Standing():
                progress.at(event)
            case LoadPath():
                progress.tell(_path(progress.job, event))
            case StudyStanding():
                progress.begin_study(event.study)
                progress.tell(trials_event(progress.job, event.result))
            case TrialEvent():
                progress.tell(trial_event(progress.job, event.trial))
            case CalibrationEvent():
                if event.generation is not None:
                    progress.tell(_generation(progress.job, event))
                    if event.mean_error < smallest:
                        smallest = event.mean_error
                        _show(event.fits(), progress)
            case Calibration():
                assert isinstance(spec, CalibrateSpec)
                _show(event.fits, progress)
                card = card_text(event.card(spec.card_name))
                progress.tell(calibrated_event(progress.job, event, card))

    return listen


def _path(job: str, path: LoadPath) -> events.Path:
    done = len(path.results) == len(path.over.values) or path.status != "ok"
    return events.Path(
        job=job,
        over=path.over.key,
        kind=path.over.kind,
        values=list(path.values),
        asked=len(path.over.values),
        columns=[
            events.PathColumn(name, kind, [x if np.isfinite(x) else None for x in values])
            for name, (kind, values) in path.columns.items()
        ],
        status=path.status,
        message=path.message if done else "",
    )


def _generation(job: str, event: CalibrationEvent) -> events.Generation:
    found = event.generation
    assert found is not None
    return events.Generation(
        job=job,
        index=event.done,
        best=found.best_fitness,
        mean=found.mean_fitness,
        error=found.best_error if np.isfinite(found.best_error) else None,
        parameters=dict(found.parameters),
        spread=dict(found.spread),
    )


def _show(fits: Sequence[Fit], progress: Progress) -> None:
    """Leave the specimen of the best candidate in the folder, and tell the page of it."""
    if fits:  # all are of one design and one material: they differ in the measurement
        write_specimen(fits[0], progress.folder)
    progress.tell(overlay_event(progress.job, fits))
