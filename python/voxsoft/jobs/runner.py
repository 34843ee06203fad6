"""Runner of every kind of job: from a spec to a folder."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

from voxsoft.files.designs import FilePath
from voxsoft.jobs.copies import with_copies
from voxsoft.jobs.events import Listener, nobody
from voxsoft.jobs.outcome import JobOutcome
from voxsoft.jobs.spec import CalibrateSpec, CompareSpec, RunSpec, Spec, StudySpec

if TYPE_CHECKING:
    from voxsoft.calibration import Calibration
    from voxsoft.comparison import Comparison
    from voxsoft.simulation import Result
    from voxsoft.study import StudyResult
    from voxsoft.study.gate import Gate


@overload
def run_job(spec: RunSpec, folder: FilePath, notify: Listener = ...) -> JobOutcome[Result]: ...


@overload
def run_job(
    spec: StudySpec,
    folder: FilePath,
    notify: Listener = ...,
    *,
    gate: Gate | None = ...,
    scheduler: str | None = ...,
    storage: str | None = ...,
) -> JobOutcome[StudyResult]: ...


@overload
def run_job(
    spec: CalibrateSpec, folder: FilePath, notify: Listener = ...
) -> JobOutcome[Calibration]: ...


@overload
def run_job(
    spec: CompareSpec, folder: FilePath, notify: Listener = ...
) -> JobOutcome[Comparison]: ...


@overload
def run_job(
    spec: Spec,
    folder: FilePath,
    notify: Listener = ...,
    *,
    gate: Gate | None = ...,
    scheduler: str | None = ...,
    storage: str | None = ...,
) -> JobOutcome[Any]: ...


def run_job(
    spec: Spec,
    folder: FilePath,
    notify: Listener = nobody,
    *,
    gate: Gate | None = None,
    scheduler: str | None = None,
    storage: str | None = None,
) -> JobOutcome[Any]:
    """Run a job and leave its folder.

    The folder then holds the results, ``job.toml`` and all that the job needs, so that
    :func:`voxsoft.jobs.again` repeats it, also elsewhere.

    Parameters
    ----------
    spec
        Spec of the job.
    folder
        Folder to write; made if it does not exist. A study that it holds already goes on.
    notify
        Called with each :data:`voxsoft.jobs.events.JobEvent`. The job waits for it, and ends with
        its exceptions; ``KeyboardInterrupt`` stops the job as Ctrl-C does.
    gate
        Holds back the trials of a study while it is closed.
    scheduler, storage
        Address of the Dask scheduler that runs the trials of a study, and Optuna storage of the
        trials, see :class:`voxsoft.study.Study`; neither changes a result, and neither is kept.

    Returns
    -------
    JobOutcome
        Result, and the files that were written.

    Raises
    ------
    VoxSoftError
        The errors of :func:`voxsoft.simulate`, :meth:`voxsoft.study.Study.optimize`,
        :func:`voxsoft.calibrate`, :func:`voxsoft.compare`.
    KeyboardInterrupt
        After Ctrl-C; finished results are kept.

    Examples
    --------
    >>> import tempfile
    >>> from voxsoft.design import families
    >>> from voxsoft.jobs import RunSpec
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     outcome = run_job(RunSpec(design=families.beam()), folder)
    >>> outcome.found.status
    'ok'
    """
    place = Path(folder)
    # The job itself reads the copies, so that the folder holds its exact input.
    match spec:
        case RunSpec():
            from voxsoft.jobs.simulating import run_simulation

            return run_simulation(with_copies(spec, place), place, notify)
        case StudySpec():
            from voxsoft.jobs.studying import run_study

            return run_study(
                with_copies(spec, place),
                place,
                notify,
                gate=gate,
                scheduler=scheduler,
                storage=storage,
            )
        case CalibrateSpec():
            from voxsoft.jobs.calibrating import run_calibration

            return run_calibration(with_copies(spec, place), place, notify)
        case CompareSpec():
            from voxsoft.jobs.comparing import run_comparison

            return run_comparison(with_copies(spec, place), place, notify)
