"""Progress of a job, and its pauses."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path

from voxsoft.jobs import events as jobs
from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.events import JobKind
from voxsoft.study import Study
from voxsoft.study.gate import Gate

Tell = Callable[[events.Event], None]

#: Seconds between two looks at unfinished work.
_LOOK = 0.05


class Progress:
    """Tells how far a job is, and holds it back while it is paused.

    A pause is said at once: the job is `pausing` while something begun is being finished, and
    `paused` from then on. A study has a gate, which holds the trials that have not begun; other
    work is held where it next says how far it is.

    Parameters
    ----------
    kind, folder
        The job, which has the name of its folder.
    tell
        Sends an event to the studio; called by any thread.
    """

    def __init__(self, kind: JobKind, folder: Path, tell: Tell) -> None:
        self.kind, self.folder, self.tell = kind, folder, tell
        self.job = folder.name
        self._goes_on = threading.Event()
        self._goes_on.set()
        self._gate: Gate | None = None
        self._held = False
        self._started = time.monotonic()
        self._idle_since: float | None = None
        self._idle = 0.0
        self._first: int | None = None
        self._since = 0.0
        self._now = jobs.Progress(0, 0, "")
        self._parameters: list[str] = []
        self._objectives: list[str] = []
        self._directions: list[str] = []

    @property
    def elapsed(self) -> float:
        """Seconds of work, pauses left out."""
        now = time.monotonic()
        idle = 0.0 if self._idle_since is None else now - self._idle_since
        return now - self._started - self._idle - idle

    # Requests of the studio, on the thread that listens to it

    def pause(self) -> None:
        """Let nothing more begin."""
        self._goes_on.clear()
        if self._gate is not None:
            self._gate.close()
            threading.Thread(target=self._watch_gate, args=(self._gate,), daemon=True).start()
        self.say()

    def resume(self) -> None:
        """Go on."""
        self._work_again()
        self._goes_on.set()
        if self._gate is not None:
            self._gate.open()
        self.say()

    # Reports of the work, on its own thread

    def gate(self) -> Gate:
        """A gate that is closed while the job is paused, for work that begins piece by piece."""
        self._gate = Gate()
        if not self._goes_on.is_set():
            self.pause()
        return self._gate

    def at(self, now: jobs.Progress) -> None:
        """Say how far the job is; without a gate, wait here while it is paused."""
        if self._first is None or now.of != self._now.of:
            # The unit counted from here on is another, which takes a time of its own.
            self._first, self._since = now.done, self.elapsed
        self._now = now
        self._held = self._gate is None and not self._goes_on.is_set()
        if self._held:
            self._rest()
        self.say()
        if self._held:
            self._goes_on.wait()
            self._held = False
            self.say()

    def begin_study(self, study: Study) -> None:
        """Report from now on the objectives of the job's study."""
        self._parameters, self._objectives = list(study.space), list(study.objectives)
        self._directions = [each.direction for each in study.objectives.values()]

    def end(self, state: events.JobState, message: str) -> None:
        """Say how the job ended."""
        self._tell(state, message)

    def say(self) -> None:
        """Say where the job stands."""
        state = self._state
        left = None
        now = self._now
        new = now.done - (self._first or 0)
        if state == "running" and new > 0 and now.total >= now.done:
            left = (self.elapsed - self._since) / new * (now.total - now.done)
        self._tell(state, left=left, stage=self._finishing if state == "pausing" else now.stage)

    @property
    def _state(self) -> events.JobState:
        if self._goes_on.is_set():
            return "running"
        finishing = not self._held if self._gate is None else self._gate.begun > 0
        return "pausing" if finishing else "paused"

    @property
    def _finishing(self) -> str:
        """Work that a pause waits for."""
        if self._gate is not None:
            begun = self._gate.begun
            return f"{begun} design{' is' if begun == 1 else 's are'} being finished"
        if self.kind == "run":
            return "the present step is being finished"
        part = "present generation" if self._now.stage == "search" else self._now.stage or "start"
        return f"the {part} is being finished"

    def _watch_gate(self, gate: Gate) -> None:
        """Say whenever another trial has ended, until none is left."""
        reported = -1
        while not self._goes_on.is_set():
            begun = gate.begun
            if begun == 0:
                self._rest()
            if begun != reported:
                self.say()
            if begun == 0:
                return
            reported = begun
            time.sleep(_LOOK)

    def _rest(self) -> None:
        self._idle_since = time.monotonic()

    def _work_again(self) -> None:
        if self._idle_since is not None:
            self._idle += time.monotonic() - self._idle_since
            self._idle_since = None

    def _tell(
        self,
        state: events.JobState,
        message: str = "",
        *,
        left: float | None = None,
        stage: str = "",
    ) -> None:
        self.tell(
            events.Job(
                id=self.job,
                kind=self.kind,
                name=self.job,
                state=state,
                done=self._now.done,
                total=self._now.total,
                of=self._now.of,
                elapsed=self.elapsed,
                left=left,
                best=self._now.best,
                folder=str(self.folder),
                message=message,
                stage=stage,
                parameters=self._parameters,
                objectives=self._objectives,
                directions=self._directions,
            )
        )
