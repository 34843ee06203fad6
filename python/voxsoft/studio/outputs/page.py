"""The built page: one archive, which is served and filled as it is, without being unpacked."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Final

#: Archive of the page that `make studio` writes (studio/archive.py); part of every wheel.
ARCHIVE: Final = Path(__file__).parents[1] / "page.zip"
#: Folder of the page's files inside; beside them is the core as WebAssembly.
FOLDER: Final = "page/"


def page_file(name: str) -> bytes | None:
    """Read one file of the built page.

    Parameters
    ----------
    name
        Its path in the page, such as ``assets/index.js``.

    Returns
    -------
    bytes or None
        The content; None where there is no such file, or no page.
    """
    try:
        with zipfile.ZipFile(ARCHIVE) as archive:
            return archive.read(FOLDER + name)
    except (KeyError, OSError, zipfile.BadZipFile):
        return None
