"""What a job says while it works."""

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
    """How far a job is.

    Attributes
    ----------
    done, total
        Steps that are done, and how many there are.
    of
        What is counted: ``designs``, ``generations``, ``percent``, ...
    stage
        What is being done.
    best
        The best so far, in words.
    """

    done: int
    total: int
    of: str
    stage: str = ""
    best: str = ""


@dataclass(frozen=True)
class StudyStanding:
    """What a study holds, told as it begins and as it ends."""

    study: Study
    result: StudyResult


JobEvent: TypeAlias = (
    "Progress | StudyStanding | TrialEvent | CalibrationEvent | Calibration | LoadPath"
)

#: Called on the thread of the job, which waits for it. What it raises ends the job:
#: ``KeyboardInterrupt`` as Ctrl-C does, and what is finished is kept.
Listener: TypeAlias = Callable[[JobEvent], None]


def nobody(event: JobEvent) -> None:
    """Listen to nothing."""
