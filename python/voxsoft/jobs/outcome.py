"""Outcome of a job."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

from voxsoft.errors import ErrorDetail, details_as_data

if TYPE_CHECKING:
    from voxsoft.comparison import Confirmation, ErrorBars
    from voxsoft.simulation import LoadPath
    from voxsoft.simulation.results.vibration import Modes


class Summarized(Protocol):
    """Result with a summary as plain data."""

    def summary(self) -> dict[str, Any]:
        """Return all numbers in SI units."""
        ...


Found = TypeVar("Found", bound=Summarized)


@dataclass(frozen=True)
class JobOutcome(Generic[Found]):
    """Result of a job, and the files it wrote.

    Attributes
    ----------
    folder
        Folder of the job.
    found
        Result of the job.
    sentence
        Result in a sentence.
    written
        Files of the results.
    earlier
        Number of trials that a study held before.
    confirmed
        Best designs of a study, solved again, if that was asked.
    error_bars
        Error bars of a run, or why there are none.
    path
        Path that a run followed, whose last equilibrium is the result.
    path_bars
        Error bars along it, as far as it was followed.
    modes
        Slowest natural vibrations of a run, where they were asked for and exist.
    modes_missing
        Reason why they do not exist; empty otherwise.
    unwritten
        Files that could not be written after the numbers were, each with the reason.
    """

    folder: Path
    found: Found
    sentence: str
    written: tuple[Path, ...] = ()
    earlier: int = 0
    confirmed: Confirmation | None = None
    error_bars: ErrorBars | None = None
    path: LoadPath | None = None
    path_bars: tuple[ErrorBars, ...] = ()
    modes: Modes | None = None
    modes_missing: str = ""
    unwritten: tuple[ErrorDetail, ...] = ()

    @property
    def summary(self) -> dict[str, Any]:
        """Plain data in SI units: the ``--json`` of its verb."""
        more: dict[str, Any] = (
            {} if self.confirmed is None else {"confirmed": self.confirmed.summary()}
        )
        if self.error_bars is not None:
            more["error_bars"] = self.error_bars.summary()
        if self.path is not None:
            more |= path_summary(self.path, self.path_bars)
        more |= modes_summary(self.modes, self.modes_missing)
        if self.unwritten:
            more["problems"] = details_as_data(self.unwritten)
        return self.found.summary() | more | {"folder": str(self.folder)}


def modes_summary(modes: Modes | None, missing: str) -> dict[str, Any]:
    """Summarize natural vibrations that were asked for, or why there are none."""
    if modes is not None:
        return modes.summary()
    return {"frequencies": [], "frequencies_missing": missing} if missing else {}


def path_summary(path: LoadPath, bars: Sequence[ErrorBars] = ()) -> dict[str, Any]:
    """Summarize a path beside its last equilibrium, each row with its error bars."""
    rows = path.summary()
    for row, bar in zip(rows["path"], bars, strict=False):
        row["error_bars"] = bar.summary()
    return rows
