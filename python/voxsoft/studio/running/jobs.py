"""The jobs of the studio: one process each, which goes on when every tab is closed."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import msgspec

from voxsoft.errors import StudyError
from voxsoft.jobs import Spec
from voxsoft.jobs.copies import with_copies
from voxsoft.jobs.folder import write_job
from voxsoft.records import closest
from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.event_bus import Tabs
from voxsoft.studio.protocol.tab import Tab
from voxsoft.studio.running.job_journal import FINISHED, JobJournal
from voxsoft.studio.running.subject import subject_of

#: Standard error of a process.
LOG: Final = "job.log"
#: Seconds that a process may take to stop before it is killed.
PATIENCE: Final = 10.0
#: Lines of the log that are told where a process died.
_LAST_LINES: Final = 3

_decoder: Final[msgspec.json.Decoder[events.AnyEvent]] = msgspec.json.Decoder(events.AnyEvent)


@dataclass(eq=False)
class Job:
    """A process at work, or the events it left.

    Attributes
    ----------
    folder
        Folder of the process; the job has its name.
    state
        The last it said of itself.
    subject
        The design that it is of, where that can be read.
    kept
        Further events for a tab that comes later.
    """

    folder: Path
    state: events.Job
    process: subprocess.Popen[str]
    subject: events.Subject | None = None
    kept: list[events.Event] = field(default_factory=list)
    trials: dict[int, events.Trial] = field(default_factory=dict)

    @property
    def running(self) -> bool:
        """True if its process still works."""
        return self.state.state not in FINISHED

    def order(self, word: str) -> None:
        """Send a word to the process, if it is still there."""
        with suppress(OSError, ValueError):
            assert self.process.stdin is not None
            self.process.stdin.write(word + "\n")
            self.process.stdin.flush()


class Jobs:
    """Starts jobs, listens to them, and tells the tabs.

    Parameters
    ----------
    tabs
        Whom to tell.
    changed
        Called when a job has ended, as its folder then holds something new.
    """

    def __init__(self, tabs: Tabs, changed: Callable[[], None]) -> None:
        self._tabs, self._changed = tabs, changed
        self._jobs: dict[str, Job] = {}
        self._lock = threading.Lock()

    def start(self, spec: Spec, folder: Path, document: str = "") -> Job:
        """Start a job in its folder, or go on with it.

        Parameters
        ----------
        spec
            The job.
        folder
            Its folder.
        document
            Id of the document that it is started from; empty where there is none.

        Raises
        ------
        StudyError
            It runs already.
        FileError
            The folder cannot be written.
        """
        if spec.kind == "compare":
            what = "is a comparison, which the studio cannot run"
            raise StudyError(folder.name, what, f"run `voxsoft again {folder}`")
        with self._lock:
            before = self._jobs.get(folder.name)
            if before is not None and before.running:
                raise StudyError(folder.name, "is running already")
            write_job(with_copies(spec, folder), folder)
            log = (folder / LOG).open("w", encoding="utf-8")
            with log:
                process = subprocess.Popen(
                    [sys.executable, "-m", "voxsoft.studio.running.worker", str(folder)],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=log,
                    text=True,
                    encoding="utf-8",
                    # Ctrl-C in the terminal is for the studio, which then tells its jobs.
                    start_new_session=True,
                )
            state = events.Job(
                id=folder.name,
                kind=spec.kind,
                name=folder.name,
                state="running",
                done=0,
                total=0,
                elapsed=0.0,
                left=None,
                best="",
                folder=str(folder),
                message="",
                stage="starting",
            )
            job = Job(folder, state, process, subject_of(spec, folder.name, document))
            self._jobs[folder.name] = job
        if job.subject is not None:
            self._tabs.publish(job.subject)
        self._tabs.publish(state)
        threading.Thread(target=self._listen, args=(job,), daemon=True).start()
        return job

    def pause(self, name: str) -> None:
        """Hold a job."""
        self._job(name).order("pause")

    def resume(self, name: str) -> bool:
        """Go on with a job that was paused; returns False if its process has ended."""
        job = self._job(name)
        job.order("resume")
        return job.running

    def stop(self, name: str) -> None:
        """Stop a job; finished work is kept."""
        job = self._job(name)
        if job.running:
            self._report(job, msgspec.structs.replace(job.state, state="stopping"))
            job.order("stop")

    def known(self, name: str) -> Job | None:
        """The job of a name, if it was started by this studio."""
        return self._jobs.get(name)

    def running_in(self, folder: Path) -> bool:
        """Check if a job works in a folder."""
        return any(job.running and job.folder == folder for job in self._jobs.values())

    def send_snapshot(self, tab: Tab) -> None:
        """Tell a new tab of all jobs."""
        for job in list(self._jobs.values()):
            if job.subject is not None:
                self._tabs.send_to(tab, job.subject)
            self._tabs.send_to(tab, job.state)
            for event in [*job.kept, *job.trials.values()]:
                self._tabs.send_to(tab, event)

    def end(self) -> None:
        """End all jobs, and wait until they have stored their finished work."""
        running = [job for job in self._jobs.values() if job.process.poll() is None]
        for job in running:
            job.order("stop")
        for job in running:
            try:
                job.process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                job.process.kill()

    def _job(self, name: str) -> Job:
        if name not in self._jobs:
            raise StudyError("job", f'"{name}" is not known', closest(name, self._jobs))
        return self._jobs[name]

    def _listen(self, job: Job) -> None:
        """Pass on the events of a process, until it ends."""
        assert job.process.stdout is not None
        for line in job.process.stdout:
            try:
                event = _decoder.decode(line)
            except msgspec.DecodeError:  # cut off by the end of the process
                continue
            self._report(job, event)
        code = job.process.wait()
        if job.running:
            failed = msgspec.structs.replace(
                job.state, state="failed", left=None, message=self._died(job, code)
            )
            JobJournal(job.folder).keep(failed)
            self._report(job, failed)
        self._changed()

    def _report(self, job: Job, event: events.Event) -> None:
        if isinstance(event, events.Job):
            stopping = job.state.state == "stopping" and event.state not in FINISHED
            job.state = msgspec.structs.replace(event, state="stopping") if stopping else event
            event = job.state
        elif isinstance(event, events.Trial):
            job.trials[event.index] = event
        elif isinstance(event, events.Trials):
            job.trials.clear()
            job.kept = [event]
        elif isinstance(event, (events.Overlay, events.Calibrated, events.Path)):
            job.kept = [each for each in job.kept if type(each) is not type(event)] + [event]
        else:
            job.kept.append(event)
        self._tabs.publish(event)

    def _died(self, job: Job, code: int) -> str:
        """Say in words how a process ended that did not say so itself."""
        how = f"was killed by signal {-code}" if code < 0 else f"ended with code {code}"
        with suppress(OSError):
            lines = (job.folder / LOG).read_text(encoding="utf-8", errors="replace").splitlines()
            last = " ".join(line.strip() for line in lines[-_LAST_LINES:] if line.strip())
            if last:
                how += f": {last[-400:]}"
        return f"The process {how}. Finished work is kept in {job.folder}; resume to go on."
