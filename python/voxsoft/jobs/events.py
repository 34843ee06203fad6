"""Events of a job while it works."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from voxsoft.calibration import Calibration, CalibrationEvent
    from voxsoft.simulation import LoadPath
    from voxsoft.study import Study, StudyResult, TrialEvent


@dataclass(frozen=True)
class Progress:
    """Progress of a job.

    Attributes
    ----------
    done, total
        Number of steps that are done, and of all.
    of
        Unit of the steps: ``designs``, ``generations``, ``percent``, ...
    stage
        Current stage.
    best
        Best value so far, in words.
    """

    done: int
    total: int
    of: str
    stage: str = ""
    best: str = ""


@dataclass(frozen=True)
class StudyStanding:
    """Contents of a study, sent as it begins and as it ends."""

    study: Study
    result: StudyResult


JobEvent: TypeAlias = (
    "Progress | StudyStanding | TrialEvent | CalibrationEvent | Calibration | LoadPath"
)

#: Function called on the thread of the job, which waits for it. Its exceptions end the job:
#: ``KeyboardInterrupt`` as Ctrl-C does, and finished results are kept.
Listener: TypeAlias = Callable[[JobEvent], None]


def nobody(event: JobEvent) -> None:
    """Ignore an event."""
