"""Event of a running study after each trial."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from voxsoft.simulation import Status
from voxsoft.study.trial import Trial


@dataclass(frozen=True)
class TrialEvent:
    """One finished trial, and the progress of the study.

    Attributes
    ----------
    trial
        Trial that has just finished.
    best
        Best value of the first objective so far, in SI units; None while no trial is
        feasible.
    done, total
        Number of finished trials, earlier runs included, and of all trials in the end.
    doubts
        Warnings about the best trial, each in a sentence.
    """

    trial: Trial
    best: float | None
    done: int
    total: int
    doubts: tuple[str, ...] = ()

    @property
    def number(self) -> int:
        """Number of the trial."""
        return self.trial.number

    @property
    def status(self) -> Status:
        """Status of the trial."""
        return self.trial.status

    @property
    def objectives(self) -> Mapping[str, float]:
        """Objectives of the trial by name, in SI units; empty unless its status is ``ok``."""
        return self.trial.objectives


#: Called in the main process after each trial; an exception it raises stops the study.
ProgressCallback = Callable[[TrialEvent], None]
