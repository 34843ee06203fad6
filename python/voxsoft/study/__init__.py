"""Studies: a design family, a space, objectives; grids and searches that survive interruption.

Lazy imports: a worker process needs the evaluation of a design, and neither Optuna nor the rest
of this package.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxsoft._lazy import lazy_names

if TYPE_CHECKING:
    from voxsoft.study.event import ProgressCallback, TrialEvent
    from voxsoft.study.gate import Gate
    from voxsoft.study.outcome import Outcome, evaluate_design
    from voxsoft.study.result import StudyResult
    from voxsoft.study.space import Choices, Range
    from voxsoft.study.study import Study
    from voxsoft.study.trial import Trial

__all__ = [
    "Choices",
    "Gate",
    "Outcome",
    "ProgressCallback",
    "Range",
    "Study",
    "StudyResult",
    "Trial",
    "TrialEvent",
    "evaluate_design",
]

_HOMES = {
    "Choices": "voxsoft.study.space",
    "Gate": "voxsoft.study.gate",
    "Outcome": "voxsoft.study.outcome",
    "ProgressCallback": "voxsoft.study.event",
    "Range": "voxsoft.study.space",
    "Study": "voxsoft.study.study",
    "StudyResult": "voxsoft.study.result",
    "Trial": "voxsoft.study.trial",
    "TrialEvent": "voxsoft.study.event",
    "evaluate_design": "voxsoft.study.outcome",
}
__getattr__, __dir__ = lazy_names(__name__, _HOMES)
