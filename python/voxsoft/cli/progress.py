"""Progress: a bar with the time left on a terminal, a plain line now and then elsewhere."""

from __future__ import annotations

import time
from contextlib import ExitStack
from types import TracebackType
from typing import TYPE_CHECKING, Final, Self

from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from voxsoft.cli.output import console, plain, say

if TYPE_CHECKING:
    from voxsoft.jobs.events import JobEvent

#: Seconds between two plain lines where there is no terminal.
PLAIN_PERIOD: Final = 5.0

#: Units counted on a bar that goes away when all is done.
PASSING: Final = frozenset({"percent", "percent of a further run", "confirmations"})


class ProgressBar:
    """A bar over a known number of steps.

    Parameters
    ----------
    title
        The work in progress.
    total
        Number of steps.
    transient
        True if the bar goes away when all is done.

    Examples
    --------
    >>> with ProgressBar("trials", total=2) as bar:
    ...     bar.advance_to(1)
    ...     bar.advance_to(2, "best 3 mm")
    """

    def __init__(self, title: str, total: int, *, transient: bool = False) -> None:
        self._title, self._total, self._done = title, total, 0
        self._first: int | None = None
        self._started = self._spoken = time.monotonic()
        self._bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
            TextColumn("{task.fields[note]}"),
            console=console(),
            transient=transient,
        )
        self._task = self._bar.add_task(title, total=total, note="")
        self._fancy = console().is_terminal

    def __enter__(self) -> Self:
        if self._fancy:
            self._bar.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._fancy:
            self._bar.stop()

    def set_total(self, total: int) -> None:
        """Say how many steps there are, where that is known only after the first."""
        self._total = total
        self._bar.update(self._task, total=total)

    def advance_to(self, done: int, note: str = "") -> None:
        """Show that `done` steps are done, with a short note such as the best value so far."""
        if self._first is None:
            # Steps that an earlier run did must not count for the speed of this one.
            self._first = done - 1
            self._bar.reset(self._task, completed=self._first, note="")
        began = self._done == 0
        self._done = done
        if self._fancy:
            self._bar.update(self._task, completed=done, note=plain(note))
        elif time.monotonic() - self._spoken > PLAIN_PERIOD or (note and began and done):
            self._speak(note)

    def _speak(self, note: str) -> None:
        self._spoken = time.monotonic()
        elapsed = self._spoken - self._started
        left = elapsed / max(self._done - (self._first or 0), 1) * (self._total - self._done)
        tail = f", {plain(note)}" if note else ""
        say(f"{self._title}: {self._done}/{self._total}, {elapsed:.0f} s, {left:.0f} s left{tail}")


class JobBar:
    """Bars that follow a job: one for each thing that it counts."""

    def __init__(self) -> None:
        self._open = ExitStack()
        self._bar: ProgressBar | None = None
        self._counted: tuple[str, int] = ("", 0)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._open.__exit__(kind, error, trace)

    def follow(self, event: JobEvent) -> None:
        """Show how far the job is; events that do not say so change nothing."""
        from voxsoft.jobs.events import Progress

        if not isinstance(event, Progress):
            return
        counted = (event.of, event.total)
        if self._bar is None or counted != self._counted:
            self._open.close()
            bar = ProgressBar(event.of, event.total, transient=event.of in PASSING)
            self._bar, self._counted = self._open.enter_context(bar), counted
        self._bar.advance_to(event.done, ", ".join(filter(None, (event.stage, event.best))))
