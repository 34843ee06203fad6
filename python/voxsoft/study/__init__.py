"""Studies: a design family, a space, objectives; grids and searches that survive interruption.

Names are loaded when first used: a worker process needs the evaluation of a design, and neither
Optuna nor the rest of this package.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

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

_HOME_OF: Final = {
    "Choices": "space",
    "Gate": "gate",
    "Outcome": "outcome",
    "ProgressCallback": "event",
    "Range": "space",
    "Study": "study",
    "StudyResult": "result",
    "Trial": "trial",
    "TrialEvent": "event",
    "evaluate_design": "outcome",
}


def __getattr__(name: str) -> Any:  # noqa: ANN401 - any public object
    if name not in _HOME_OF:
        raise AttributeError(f"module 'voxsoft.study' has no attribute '{name}'")
    value = getattr(import_module(f"voxsoft.study.{_HOME_OF[name]}"), name)
    globals()[name] = value
    return value
