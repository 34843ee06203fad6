"""The journal of a job: its events, one a line, so that they can be shown again later.

The trials of a study are not in it: the study keeps them in a journal of its own.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import Final

import msgspec

from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.codec import encode

#: The file of the journal in the folder of a job.
JOURNAL: Final = "events.jsonl"
#: States in which nothing is at work any more.
FINISHED: Final = frozenset({"stopped", "done", "failed", "interrupted"})
#: Seconds between two lines that only say how far a job is.
_SPACING: Final = 1.0

_Kept = events.Job | events.Generation | events.Overlay | events.Calibrated | events.Path
_KEPT: Final = (events.Job, events.Generation, events.Overlay, events.Calibrated, events.Path)
_decoder: Final[msgspec.json.Decoder[_Kept]] = msgspec.json.Decoder(_Kept)


class JobJournal:
    """Writes down the events of a job.

    A journal that cannot be written must not cost the job, whose results count more: the
    first failure is remembered in `trouble`, and later events are tried again.

    Parameters
    ----------
    folder
        The folder of the job.
    anew
        True to forget the events of an earlier process, as for work that begins from its start.
    """

    def __init__(self, folder: Path, *, anew: bool = False) -> None:
        self._file = folder / JOURNAL
        self._last: events.Job | None = None
        self._when = 0.0
        self.trouble = ""
        if anew:
            self._write("w", "")

    def keep(self, event: events.Event) -> None:
        """Write an event down, if it is one that a later tab has to know."""
        if not isinstance(event, _KEPT):
            return
        if isinstance(event, events.Job):
            now = time.monotonic()
            before, self._last = self._last, event
            repeats = before is not None and before.state == event.state
            if repeats and event.state not in FINISHED and now - self._when < _SPACING:
                return
            self._when = now
        self._write("a", encode(event) + "\n")

    def _write(self, mode: str, text: str) -> None:
        try:
            with self._file.open(mode, encoding="utf-8") as file:
                file.write(text)
        except OSError as error:
            self.trouble = self.trouble or f"{self._file}: {error.strerror or error}"


def read_journal(folder: Path) -> list[_Kept]:
    """Read the events of a folder's job; lines that were cut off are left out.

    The folder may have been renamed since: its events carry the name that it has now.
    """
    try:
        lines = (folder / JOURNAL).read_bytes().splitlines()
    except OSError:
        return []
    found: list[_Kept] = []
    for line in lines:
        try:
            event = _decoder.decode(line)
        except msgspec.DecodeError:
            continue
        if isinstance(event, events.Job):
            event.id = event.name = folder.name
            event.folder = str(folder)
        else:
            event.job = folder.name
        found.append(event)
    return found
