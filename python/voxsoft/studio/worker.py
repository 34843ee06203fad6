"""The process of one job: ``python -m voxsoft.studio.worker FOLDER``.

It writes events as lines of JSON, and reads ``pause``, ``resume`` and ``stop``, one a line. When
nobody listens any more it stops as if told to; what is finished is kept.
"""

from __future__ import annotations

import _thread
import os
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import TextIO

from voxsoft.errors import VoxSoftError
from voxsoft.studio import events
from voxsoft.studio.job_journal import JobJournal
from voxsoft.studio.protocol import encode
from voxsoft.studio.task import Task

Tell = Callable[[events.Event], None]


class Controls:
    """What the studio wants of the job meanwhile."""

    def __init__(self, lines: TextIO) -> None:
        self._lines = lines
        self._goes_on = threading.Event()
        self._goes_on.set()
        self.stopped = False

    def listen(self) -> None:
        """Read wishes until the studio is gone."""
        for line in self._lines:
            match line.strip():
                case "pause":
                    self._goes_on.clear()
                case "resume":
                    self._goes_on.set()
                case "stop":
                    break
        self.stopped = True
        self._goes_on.set()
        _thread.interrupt_main()

    @property
    def paused(self) -> bool:
        """Whether the job is to wait."""
        return not self._goes_on.is_set()

    def wait(self) -> None:
        """Wait while the job is paused.

        Raises
        ------
        KeyboardInterrupt
            The job is to stop.
        """
        while not self._goes_on.wait(0.2):
            pass
        if self.stopped:
            raise KeyboardInterrupt


class Progress:
    """Tells how far a job is, and waits where it is paused."""

    def __init__(self, task: Task, folder: Path, tell: Tell, controls: Controls) -> None:
        self.task, self.folder, self.tell = task, folder, tell
        self._controls = controls
        self._started = time.monotonic()
        self._paused = 0.0
        self._first: int | None = None
        self._done, self._total, self._best, self._stage = 0, 0, "", ""
        self.parameters: list[str] = []
        self.objectives: list[str] = []
        self.directions: list[str] = []

    @property
    def elapsed(self) -> float:
        """Seconds of work, pauses left out."""
        return time.monotonic() - self._started - self._paused

    def at(self, done: int, total: int, *, best: str = "", stage: str = "") -> None:
        """Say how far the job is, then wait if it is paused.

        Raises
        ------
        KeyboardInterrupt
            The job is to stop.
        """
        self._first = done if self._first is None else self._first
        self._done, self._total, self._best, self._stage = done, total, best, stage
        self.say("running")
        if self._controls.paused:
            self.say("paused")
            began = time.monotonic()
            self._controls.wait()
            self._paused += time.monotonic() - began
            self.say("running")
        if self._controls.stopped:
            raise KeyboardInterrupt

    def say(self, state: events.JobState, message: str = "") -> None:
        """Tell the state of the job."""
        new = self._done - (self._first or 0)
        left = None
        if state == "running" and new > 0 and self._total >= self._done:
            left = self.elapsed / new * (self._total - self._done)
        self.tell(
            events.Job(
                id=self.task.id,
                kind=self.task.kind,
                name=self.task.name,
                state=state,
                done=self._done,
                total=self._total,
                elapsed=self.elapsed,
                left=left,
                best=self._best,
                folder=str(self.folder),
                message=message,
                stage=self._stage,
                parameters=self.parameters,
                objectives=self.objectives,
                directions=self.directions,
            )
        )


def runner_of(kind: events.JobKind) -> Callable[[Task, Progress], str]:
    """What does jobs of a kind; each loads no more than it needs."""
    if kind == "run":
        from voxsoft.studio.running import run_once

        return run_once
    if kind == "study":
        from voxsoft.studio.studying import run_study

        return run_study
    from voxsoft.studio.calibrating import run_calibration

    return run_calibration


def main(folder: Path) -> int:
    """Do the task of a folder; returns the exit code."""
    # Whatever libraries print must not come between the events.
    line_out = os.fdopen(os.dup(1), "w", encoding="utf-8", buffering=1)
    os.dup2(2, 1)
    lock = threading.Lock()

    task = Task.read(folder)
    # Only a study goes on where it was; other work begins anew.
    journal = JobJournal(folder, anew=task.kind != "study")

    def tell(event: events.Event) -> None:
        with lock:
            written = not journal.trouble
            journal.keep(event)
            if written and journal.trouble:
                what = f"how the job goes cannot be kept: {journal.trouble}"
                line_out.write(encode(events.Log(level="warning", text=what)) + "\n")
            line_out.write(encode(event) + "\n")
            line_out.flush()

    controls = Controls(sys.stdin)
    progress = Progress(task, folder, tell, controls)
    threading.Thread(target=controls.listen, daemon=True).start()
    try:
        message = runner_of(task.kind)(task, progress)
        progress.say("done", message)
    except KeyboardInterrupt as interrupt:
        progress.say("stopped", str(interrupt) or "stopped; what is finished is kept")
    except VoxSoftError as error:
        progress.say("failed", str(error))
        return 1
    except BrokenPipeError:  # the studio went away
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
