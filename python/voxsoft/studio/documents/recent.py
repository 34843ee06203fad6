"""Design files that were opened or saved, kept on disk beside the draft."""

from __future__ import annotations

from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Final
from urllib.parse import urlencode

import msgspec

from voxsoft.errors import VoxSoftError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.run_folder import make_folder
from voxsoft.studio.protocol import events

#: Name of the file.
RECENT: Final = "recent.json"
#: Number of files that are remembered.
MOST: Final = 12


class _Noted(msgspec.Struct, frozen=True):
    """A file, and when it was opened or saved last (ISO 8601)."""

    path: str
    when: str


class RecentFiles:
    """Remembers the design files that were used last.

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
    ...     [each.name for each in RecentFiles(Path(folder)).files()]
    ['arm.toml']
    """

    def __init__(self, folder: Path) -> None:
        self._file = folder / RECENT
        self._noted = self._read()

    def note(self, path: Path) -> None:
        """Put a file first. A list that cannot be written is remembered until the studio ends."""
        when = datetime.now(UTC).isoformat(timespec="seconds")
        others = [each for each in self._noted if each.path != str(path)]
        self._noted = [_Noted(str(path), when), *others][:MOST]
        # A folder that cannot be written to keeps nobody from opening a file.
        with suppress(OSError, VoxSoftError):
            make_folder(self._file.parent)
            write_atomically(self._file, msgspec.json.encode(self._noted))

    def is_first(self, path: Path) -> bool:
        """Check if a file is the one that was noted last."""
        return bool(self._noted) and self._noted[0].path == str(path)

    def files(self) -> list[events.RecentFile]:
        """The files that are still there, the one that was used last first."""
        return [
            events.RecentFile(
                path=each.path,
                name=Path(each.path).name,
                folder=str(Path(each.path).parent),
                when=each.when,
                picture=f"/picture?{urlencode({'of': f'file/{each.path}'})}",
            )
            for each in self._noted
            if _is_there(Path(each.path))
        ]

    def _read(self) -> list[_Noted]:
        with suppress(OSError, msgspec.DecodeError, UnicodeError):
            return msgspec.json.decode(self._file.read_bytes(), type=list[_Noted])[:MOST]
        return []


def _is_there(path: Path) -> bool:
    with suppress(OSError, ValueError):
        return path.is_file()
    return False
