"""Figures to files."""

from __future__ import annotations

import io
import struct
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.files.atomic import write_atomically

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from voxsoft.simulation import Result

#: The picture of a folder in a list of folders.
THUMBNAIL: Final = "thumbnail.png"


def save_figure(figure: Figure, path: Path) -> Path:
    """Write a figure as PNG, whole or not at all; return the path.

    Raises
    ------
    FileError
        The file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from matplotlib.figure import Figure
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_figure(Figure(), Path(folder, "empty.png")).stat().st_size > 0
    True
    """
    drawn = io.BytesIO()
    figure.savefig(drawn, format="png")
    write_atomically(path, drawn.getvalue())
    return path


def save_thumbnail(result: Result, folder: Path) -> Path:
    """Draw the deformed body, small, for a list of folders; return the path of the picture.

    Raises
    ------
    FileError
        The file cannot be written.
    """
    from voxsoft.plot.body import body_image

    write_atomically(folder / THUMBNAIL, _png(body_image(result)))
    return folder / THUMBNAIL


def _png(pixels: NDArray[np.uint8]) -> bytes:
    """Pack pixels, (h, w, 3), as PNG: matplotlib would do it, and is slow to load."""
    height, width, _ = pixels.shape
    # Each row begins with the number of its filter: none.
    rows = np.hstack([np.zeros((height, 1), np.uint8), pixels.reshape(height, 3 * width)])
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = ((b"IHDR", head), (b"IDAT", zlib.compress(rows.tobytes())), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )
