"""Jobs: tasks as values, one runner for all of them, and folders that repeat them.

A job is a run, a study (a sweep or an optimization), a calibration or a comparison. Its spec holds
all that decides its results; the command line and the studio make specs and run them here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxsoft._lazy import lazy_names

if TYPE_CHECKING:
    from voxsoft.jobs.folder import Job, load
    from voxsoft.jobs.outcome import JobOutcome
    from voxsoft.jobs.repetition import Repetition, again
    from voxsoft.jobs.runner import run_job
    from voxsoft.jobs.source import DesignSource, MeasuredTable
    from voxsoft.jobs.spec import CalibrateSpec, CompareSpec, RunSpec, Spec, StudySpec

__all__ = [
    "CalibrateSpec",
    "CompareSpec",
    "DesignSource",
    "Job",
    "JobOutcome",
    "MeasuredTable",
    "Repetition",
    "RunSpec",
    "Spec",
    "StudySpec",
    "again",
    "load",
    "run_job",
]

# Imported when first used: a run needs no Optuna, a study no outside code.
_HOMES = {
    "CalibrateSpec": "voxsoft.jobs.spec",
    "CompareSpec": "voxsoft.jobs.spec",
    "DesignSource": "voxsoft.jobs.source",
    "Job": "voxsoft.jobs.folder",
    "JobOutcome": "voxsoft.jobs.outcome",
    "MeasuredTable": "voxsoft.jobs.source",
    "Repetition": "voxsoft.jobs.repetition",
    "RunSpec": "voxsoft.jobs.spec",
    "Spec": "voxsoft.jobs.spec",
    "StudySpec": "voxsoft.jobs.spec",
    "again": "voxsoft.jobs.repetition",
    "load": "voxsoft.jobs.folder",
    "run_job": "voxsoft.jobs.runner",
}
__getattr__, __dir__ = lazy_names(__name__, _HOMES)
