"""Names for folders and files, made of names that people gave to designs, studies and cards."""

from __future__ import annotations

import re
import unicodedata
from typing import Final

#: Bytes of a name: file systems take 255, and endings such as ``-comparison.html`` follow.
LONGEST: Final = 120

#: Everything but letters and digits of any script, and ``. _ -``: also invisible characters,
#: such as marks that turn the direction of writing.
_OUTSIDE: Final = re.compile(r"[^\w.-]+")

#: Names that Windows takes for a device, with any ending.
_DEVICE: Final = re.compile(r"(con|prn|aux|nul|conin\$|conout\$|com\d|lpt\d)(\.|$)", re.IGNORECASE)


def folder_name(name: str, otherwise: str = "design") -> str:
    r"""Make the name of one folder or file out of any text.

    A design is data and may come from a stranger: its name must not choose where files are written.

    Parameters
    ----------
    name
        Any text.
    otherwise
        Name returned where nothing is left of it.

    Returns
    -------
    str
        A name that stays in its folder on every system: letters and digits of any script, dots
        inside, ``_`` and ``-``; at most :data:`LONGEST` bytes in UTF-8; no hidden file, no option
        of a program, and no device of Windows.

    Examples
    --------
    >>> folder_name("finger/v2"), folder_name("../../escaped"), folder_name("a\0b")
    ('finger-v2', 'escaped', 'a-b')
    >>> folder_name("Höhe 2.5"), folder_name("con.txt"), folder_name("///")
    ('Höhe-2.5', '_con.txt', 'design')
    """
    # Digits above and below the line are digits to Windows' devices: COM¹ is COM1.
    plain = unicodedata.normalize("NFKC", name.encode("utf-8", "replace").decode("utf-8"))
    plain = _trimmed(_OUTSIDE.sub("-", plain))
    while len(plain.encode("utf-8")) > LONGEST:
        plain = _trimmed(plain[: LONGEST if len(plain) > LONGEST else -1])
    if _DEVICE.match(plain):
        plain = f"_{plain}"
    return plain or otherwise


def _trimmed(name: str) -> str:
    """No dot or hyphen at the ends: Windows drops final dots, and a first one hides a file."""
    return name.strip(".-")
