"""The text that is being edited, kept on disk for the next start."""

from __future__ import annotations

import threading
from contextlib import suppress
from pathlib import Path
from typing import Final

import msgspec

from voxsoft.errors import FileError, VoxSoftError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.run_folder import make_folder
from voxsoft.studio.documents.document import DesignDocument

#: Name of the file.
DRAFT: Final = "draft.json"
#: Seconds after a change in which the draft is written.
WITHIN: Final = 1.0


class Draft(msgspec.Struct, frozen=True):
    """A text that was not saved, its name, its file ("" for none), and the id of its document."""

    text: str
    name: str
    path: str
    id: str = ""

    @property
    def file(self) -> Path | None:
        """The file that it is a draft of, if it is still there."""
        return Path(self.path) if self.path and Path(self.path).is_file() else None

    def document(self, home: Path) -> DesignDocument:
        """The draft as a document without a file, which would be saved in the folder `home`."""
        document = DesignDocument(self.text, self.name, folder=home, restored=True)
        document.id = self.id or document.id
        return document


class Drafts:
    """Keeps the newest draft in a folder.

    Parameters
    ----------
    folder
        The studio's own folder; made when there is something to keep.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     drafts = Drafts(Path(folder))
    ...     drafts.keep(Draft("a = 1", "a.toml", ""), now=True)
    ...     drafts.read().text
    'a = 1'
    """

    def __init__(self, folder: Path) -> None:
        self._file = folder / DRAFT
        self._newest: Draft | None = None
        self._timer: threading.Timer | None = None
        self._lock = threading.Lock()

    def read(self) -> Draft | None:
        """The draft that was kept last, or None; a damaged one counts as none."""
        with suppress(OSError, msgspec.DecodeError, UnicodeError):
            return msgspec.json.decode(self._file.read_bytes(), type=Draft)
        return None

    def keep(self, draft: Draft | None, *, now: bool = False) -> None:
        """Keep a draft, within a second or at once; None when there is nothing unsaved.

        Raises
        ------
        FileError
            At once was asked for, and it cannot be written.
        """
        with self._lock:
            self._newest = draft
            if self._timer is not None:
                self._timer.cancel()
                self._timer = None
            if not now:
                self._timer = threading.Timer(WITHIN, self._write_quietly)
                self._timer.daemon = True
                self._timer.start()
                return
        self._write()

    def _write_quietly(self) -> None:
        # The next change tries again, and the end of the studio reports the problem.
        with suppress(VoxSoftError):
            self._write()

    def _write(self) -> None:
        with self._lock:
            draft = self._newest
            try:
                if draft is not None:
                    make_folder(self._file.parent)
                    write_atomically(self._file, msgspec.json.encode(draft))
                else:
                    self._file.unlink(missing_ok=True)
            except OSError as error:
                reason = getattr(error, "strerror", None) or str(error)
                raise FileError(str(self._file), f"cannot be written: {reason}") from None
