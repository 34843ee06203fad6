"""Studies: a design family, a space, objectives; grids and searches that survive interruption."""

from voxsoft.study.event import ProgressCallback, TrialEvent
from voxsoft.study.outcome import Outcome, evaluate_design
from voxsoft.study.result import StudyResult
from voxsoft.study.space import Choices, Range
from voxsoft.study.study import Study
from voxsoft.study.trial import Trial

__all__ = [
    "Choices",
    "Outcome",
    "ProgressCallback",
    "Range",
    "Study",
    "StudyResult",
    "Trial",
    "TrialEvent",
    "evaluate_design",
]
