"""Archives of folders."""

from __future__ import annotations

import shutil
from pathlib import Path

from voxsoft.errors import FileError


def archive(folder: Path, target: Path) -> Path:
    """Write a folder as a zip archive, and return its path.

    Raises
    ------
    FileError
        It cannot be written.
    """
    try:
        shutil.make_archive(str(target.with_suffix("")), "zip", folder.parent, folder.name)
    except (OSError, ValueError) as error:
        raise FileError(str(folder), f"cannot be archived: {error}") from None
    return target
