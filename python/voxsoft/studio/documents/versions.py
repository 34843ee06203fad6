"""Versions of documents: texts as they were saved, or left for another, kept on disk."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Sequence
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Final
from urllib.parse import urlencode

import msgspec

from voxsoft.errors import FileError, VoxSoftError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.run_folder import make_folder
from voxsoft.studio.protocol import events

#: Name of the folder in the studio's own.
FOLDER: Final = "versions"
#: Number of versions kept of one file, and of files.
MOST: Final = 50
MOST_FILES: Final = 200
#: Texts above this are not kept [characters].
LARGEST: Final = 2_000_000


class Version(msgspec.Struct, frozen=True):
    """A text as it was once.

    Attributes
    ----------
    id
        Names it among those of its document; later ones have larger ids.
    when
        ISO 8601.
    reason
        Why it was kept, such as "saved".
    name, folder
        The document, and where its relative paths begin.
    text
        The text.
    """

    id: str
    when: str
    reason: str
    name: str
    folder: str
    text: str


class Versions:
    """Keeps versions of documents, the newest 50 of each.

    Parameters
    ----------
    folder
        The studio's own folder; made when there is something to keep.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     versions = Versions(Path(folder))
    ...     arm = Path(folder, "arm.toml")
    ...     _ = versions.keep(arm, "a = 1", "saved")
    ...     _ = versions.keep(arm, "a = 2", "saved")
    ...     [(each.text, each.reason) for each in versions.of(arm)]
    [('a = 2', 'saved'), ('a = 1', 'saved')]
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder / FOLDER

    def keep(self, file: Path, text: str, reason: str) -> bool:
        """Keep a text of a file, unless its newest version has the same.

        Parameters
        ----------
        file
            The file; of a document that was never saved, where it would be saved.
        text
            The text.
        reason
            Why it is kept.

        Returns
        -------
        bool
            True if it was kept. A failure to write does not interrupt the work.
        """
        if not text.strip() or len(text) > LARGEST:
            return False
        own = self._of(file)
        kept = self._files(own)
        newest = _read(kept[0]) if kept else None
        if newest is not None and newest.text == text:
            return False
        number = int(kept[0].stem) + 1 if kept else 1
        when = datetime.now(UTC).isoformat(timespec="seconds")
        version = Version(f"{number:08d}", when, reason, file.name, str(file.parent), text)
        try:
            make_folder(own)
            write_atomically(own / f"{version.id}.json", msgspec.json.encode(version))
        except (OSError, VoxSoftError):
            return False
        for old in kept[MOST - 1 :]:
            with suppress(OSError):
                old.unlink()
        if not kept:
            self._make_room()
        return True

    def of(self, file: Path) -> list[Version]:
        """All versions of a file that can be read, the newest first."""
        found = map(_read, self._files(self._of(file)))
        return [version for version in found if version is not None]

    def one(self, file: Path, id: str) -> Version:
        """One version of a file by its id.

        Raises
        ------
        FileError
            There is none of that id, or it cannot be read.
        """
        version = _read(self._of(file) / f"{id}.json") if id.isdecimal() else None
        if version is None:
            what = f'has no version "{id[:40]}"'
            raise FileError(file.name, what, "open the list of versions again")
        return version

    def _of(self, file: Path) -> Path:
        name = hashlib.sha256(str(file).encode("utf-8", "surrogatepass")).hexdigest()[:24]
        return self._folder / name

    @staticmethod
    def _files(own: Path) -> list[Path]:
        """The newest first."""
        with suppress(OSError):
            files = [file for file in own.iterdir() if _is_version(file)]
            return sorted(files, key=lambda file: int(file.stem), reverse=True)
        return []

    def _make_room(self) -> None:
        """Forget the documents whose last version is the oldest, where there are too many."""
        with suppress(OSError):
            folders = sorted(self._folder.iterdir(), key=lambda own: own.stat().st_mtime_ns)
            for own in folders[: max(0, len(folders) - MOST_FILES)]:
                shutil.rmtree(own, ignore_errors=True)


def _is_version(file: Path) -> bool:
    return file.suffix == ".json" and file.stem.isdecimal()


def _read(file: Path) -> Version | None:
    with suppress(OSError, msgspec.DecodeError, UnicodeError):
        return msgspec.json.decode(file.read_bytes(), type=Version)
    return None


def versions_event(file: Path, versions: Sequence[Version]) -> events.Versions:
    """The versions of a file as the page wants them."""
    return events.Versions(
        name=file.name,
        most=MOST,
        versions=[
            events.VersionRow(
                id=each.id,
                when=each.when,
                reason=each.reason,
                picture=f"/picture?{urlencode({'of': f'version/{each.id}', 'in': file.name})}",
            )
            for each in versions
        ],
    )
