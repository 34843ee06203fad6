"""Ports and tokens of earlier studios, so that their tabs come back after a restart.

They are kept in a folder of the user's own, which no other user may read, and for some days only.
"""

from __future__ import annotations

import hashlib
import os
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Final

import msgspec

#: Age after which a token counts no more [s].
LONGEST: Final = 7 * 24 * 3600.0
#: Number of studios on one folder of runs that are remembered.
MOST: Final = 8


class Admission(msgspec.Struct, frozen=True):
    """A port, the token for it, and the time when a studio took it last [s since 1970]."""

    port: int
    token: str
    when: float


def state_folder() -> Path:
    """The folder of the user's own in which programs keep such things."""
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local"), "voxsoft")
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Application Support" / "voxsoft"
    return Path(os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state", "voxsoft")


def admissions(runs: Path) -> list[Admission]:
    """Read the admissions to a folder of runs, the newest first; damaged ones count as none."""
    with suppress(OSError, msgspec.DecodeError, UnicodeError, RuntimeError):
        found = msgspec.json.decode(_file(runs).read_bytes(), type=list[Admission])
        return [each for each in found if 0.0 <= time.time() - each.when < LONGEST]
    return []


def admit(runs: Path, port: int, token: str) -> None:
    """Keep a port and its token. Where nothing can be kept, a restart has another token."""
    others = [each for each in admissions(runs) if each.port != port]
    kept = [Admission(port, token, time.time()), *others][:MOST]
    with suppress(OSError, RuntimeError):
        file = _file(runs)
        file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        file.parent.chmod(0o700)
        # The file is never there with the rights of others, not even for a moment.
        fresh = file.with_suffix(f".{os.getpid()}")
        fresh.unlink(missing_ok=True)
        opened = os.open(fresh, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(opened, "wb") as stream:
            stream.write(msgspec.json.encode(kept))
        fresh.replace(file)


def _file(runs: Path) -> Path:
    name = hashlib.sha256(os.fsencode(runs.absolute())).hexdigest()[:24]
    return state_folder() / "studios" / f"{name}.json"
