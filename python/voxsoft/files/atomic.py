"""Atomic writing of files."""

from __future__ import annotations

import os
import uuid
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from voxsoft.errors import OutputError


def replace_whole(target: Path, write: Callable[[Path], object]) -> None:
    """Write a temporary file beside the target and rename it, so that no reader sees half a file.

    Parameters
    ----------
    target
        Path of the file to make or replace.
    write
        Function that writes a file at the path that it is given, which has the target's suffix.

    Raises
    ------
    OutputError
        The file cannot be written; the target is unchanged.
    """
    beside = target.with_name(f".{target.stem}-{uuid.uuid4().hex[:8]}{target.suffix}")
    try:
        write(beside)
        beside.replace(target)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        hint = "check that the folder exists and the disk has room"
        raise OutputError(str(target), f"cannot be written: {reason}", hint) from error
    finally:
        with suppress(OSError, ValueError):
            beside.unlink()


def write_atomically(path: str | os.PathLike[str], content: str | bytes) -> None:
    """Write a file atomically; text as UTF-8 with plain line ends.

    Raises
    ------
    OutputError
        The file cannot be written.
    """
    data = content.encode("utf-8") if isinstance(content, str) else content
    replace_whole(Path(path), lambda beside: beside.write_bytes(data))
