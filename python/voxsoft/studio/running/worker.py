"""The process of one job: ``python -m voxsoft.studio.running.worker FOLDER``.

It writes events as lines of JSON, and reads ``pause``, ``resume`` and ``stop``, one a line. When
nobody listens any more it stops as on ``stop``; finished work is kept.
"""

from __future__ import annotations

import _thread
import os
import signal
import sys
import threading
from pathlib import Path
from typing import TextIO

from voxsoft.errors import StudyError, VoxSoftError
from voxsoft.jobs import CompareSpec, load, run_job
from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.codec import encode
from voxsoft.studio.running.job_journal import JobJournal
from voxsoft.studio.running.progress import Progress, Tell
from voxsoft.studio.running.reporting import listener_of


def listen(lines: TextIO, progress: Progress) -> None:
    """Read requests of the studio until it is gone, or wants the job to stop."""
    for line in lines:
        match line.strip():
            case "pause":
                progress.pause()
            case "resume":
                progress.resume()
            case "stop":
                break
    _interrupt_main()


def _interrupt_main() -> None:
    """Send Ctrl-C to the main thread, which also ends its waiting."""
    if hasattr(signal, "pthread_kill"):
        main = threading.main_thread().ident
        assert main is not None
        signal.pthread_kill(main, signal.SIGINT)
    else:
        _thread.interrupt_main()


def main(folder: Path) -> int:
    """Do the job of a folder; returns the exit code."""
    # Whatever libraries print must not come between the events.
    line_out = os.fdopen(os.dup(1), "w", encoding="utf-8", buffering=1)
    os.dup2(2, 1)
    spec = load(folder).spec
    if isinstance(spec, CompareSpec):
        raise StudyError(folder.name, "is a comparison, which the studio cannot run")
    progress = Progress(spec.kind, folder, _teller(line_out, spec.kind, folder))
    try:
        threading.Thread(target=listen, args=(sys.stdin, progress), daemon=True).start()
        gate = progress.gate() if spec.kind == "study" else None
        outcome = run_job(spec, folder, listener_of(spec, progress), gate=gate)
        progress.end("done", outcome.sentence)
    except KeyboardInterrupt as interrupt:
        progress.end("stopped", str(interrupt) or "stopped; finished work is kept")
    except VoxSoftError as error:
        progress.end("failed", str(error))
        return 1
    except BrokenPipeError:  # the studio went away
        return 1
    return 0


def _teller(line_out: TextIO, kind: events.JobKind, folder: Path) -> Tell:
    """Sender of events to the studio, which writes down those that a later tab needs."""
    lock = threading.Lock()
    # Only a study goes on where it was; other work begins anew.
    journal = JobJournal(folder, anew=kind != "study")

    def tell(event: events.Event) -> None:
        with lock:
            written = not journal.trouble
            journal.keep(event)
            if written and journal.trouble:
                what = f"how the job goes cannot be kept: {journal.trouble}"
                line_out.write(encode(events.Log(level="warning", text=what)) + "\n")
            line_out.write(encode(event) + "\n")
            line_out.flush()

    return tell


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
