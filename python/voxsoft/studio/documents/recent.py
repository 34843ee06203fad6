"""Designs that were opened or saved, and those that were left unsaved, listed beside the draft."""

from __future__ import annotations

from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Final
from urllib.parse import urlencode

import msgspec

from voxsoft.errors import FileError, VoxSoftError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.run_folder import make_folder
from voxsoft.studio.documents.drafts import Draft
from voxsoft.studio.protocol import events

#: Name of the file.
RECENT: Final = "recent.json"
#: Folder of the texts that have no file of their own.
UNSAVED: Final = "unsaved"
#: Number of designs that are remembered.
MOST: Final = 12


class _Noted(msgspec.Struct, frozen=True):
    """A design file, or the id of an unsaved text; and when it was used last (ISO 8601)."""

    path: str
    when: str
    unsaved: str = ""
    name: str = ""


class RecentFiles:
    """Remembers the designs that were used last.

    Parameters
    ----------
    folder
        The studio's own folder; made when there is something to keep.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "arm.toml")
    ...     _ = file.write_text("")
    ...     recent = RecentFiles(Path(folder))
    ...     recent.note(file)
    ...     recent.note_unsaved(Draft("a = 1", "leg.toml", "", "0a"))
    ...     again = RecentFiles(Path(folder))
    ...     [each.name for each in again.files()], again.unsaved("0a").text
    (['leg.toml', 'arm.toml'], 'a = 1')
    """

    def __init__(self, folder: Path) -> None:
        self._file, self._texts = folder / RECENT, folder / UNSAVED
        self._noted = self._read()

    def note(self, path: Path) -> None:
        """Put a file first. A list that cannot be written is remembered until the studio ends."""
        self._put(_Noted(str(path), _now()))

    def note_unsaved(self, draft: Draft) -> None:
        """Put a text without a file first, and keep it."""
        # A folder that cannot be written to keeps nobody from opening a file.
        with suppress(OSError, VoxSoftError):
            make_folder(self._texts)
            write_atomically(self._text_of(draft.id), msgspec.json.encode(draft))
            self._put(_Noted("", _now(), draft.id, draft.name))

    def forget(self, id: str) -> None:
        """Let a text go that has a file of its own now."""
        if any(each.unsaved == id for each in self._noted):
            self._keep([each for each in self._noted if each.unsaved != id])

    def unsaved(self, id: str) -> Draft:
        """A text that is listed, by its id.

        Raises
        ------
        FileError
            It is not listed, or cannot be read.
        """
        if any(each.unsaved == id for each in self._noted if each.unsaved):
            with suppress(OSError, msgspec.DecodeError, UnicodeError):
                return msgspec.json.decode(self._text_of(id).read_bytes(), type=Draft)
        raise FileError(id[:40] or "design", "is not kept any more", "choose another design")

    def is_first(self, path: Path) -> bool:
        """Check if a file is the one that was noted last."""
        return bool(self._noted) and self._noted[0].path == str(path)

    def files(self) -> list[events.RecentFile]:
        """The designs that are still there, the one that was used last first."""
        return [
            _unsaved_file(each) if each.unsaved else _file(each)
            for each in self._noted
            if _is_there(self._text_of(each.unsaved) if each.unsaved else Path(each.path))
        ]

    def _put(self, noted: _Noted) -> None:
        def key(one: _Noted) -> tuple[str, str]:
            return one.path, one.unsaved

        others = [each for each in self._noted if key(each) != key(noted)]
        self._keep([noted, *others][:MOST])

    def _keep(self, noted: list[_Noted]) -> None:
        """Write another list, and let the texts go that it has no more."""
        gone = {each.unsaved for each in self._noted} - {each.unsaved for each in noted}
        self._noted = noted
        with suppress(OSError, VoxSoftError):
            make_folder(self._file.parent)
            write_atomically(self._file, msgspec.json.encode(noted))
        for id in gone - {""}:
            with suppress(OSError):
                self._text_of(id).unlink(missing_ok=True)

    def _text_of(self, id: str) -> Path:
        return self._texts / f"{id}.json"

    def _read(self) -> list[_Noted]:
        with suppress(OSError, msgspec.DecodeError, UnicodeError):
            return msgspec.json.decode(self._file.read_bytes(), type=list[_Noted])[:MOST]
        return []


def _file(noted: _Noted) -> events.RecentFile:
    return events.RecentFile(
        path=noted.path,
        name=Path(noted.path).name,
        folder=str(Path(noted.path).parent),
        when=noted.when,
        picture=f"/picture?{urlencode({'of': f'file/{noted.path}'})}",
    )


def _unsaved_file(noted: _Noted) -> events.RecentFile:
    # The time makes the address another one once the text is.
    query = urlencode({"of": f"unsaved/{noted.unsaved}", "at": noted.when})
    return events.RecentFile(
        path="",
        name=noted.name,
        folder="",
        when=noted.when,
        picture=f"/picture?{query}",
        unsaved=noted.unsaved,
    )


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")


def _is_there(path: Path) -> bool:
    with suppress(OSError, ValueError):
        return path.is_file()
    return False
