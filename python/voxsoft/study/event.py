"""What a running study tells after each trial."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from voxsoft.simulation import Status
from voxsoft.study.trial import Trial


@dataclass(frozen=True)
class TrialEvent:
    """One finished trial, and how far the study is.

    Attributes
    ----------
    trial
        The trial that has just finished.
    best
        The best value of the first objective so far, in SI units; None while no trial is
        feasible.
    done, total
        Finished trials, earlier runs included, and how many there will be.
    doubts
        What is doubtful about the best trial, each in a sentence.
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
