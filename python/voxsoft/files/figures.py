"""Writing of figures to files."""

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

    from voxsoft.plot.cutout import Cutout
    from voxsoft.simulation import Result

#: File name of a folder's picture in a list of folders.
THUMBNAIL: Final = "thumbnail.png"


def save_figure(figure: Figure, path: Path) -> Path:
    """Write a figure as PNG, atomically; return the path.

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
    """Draw a small picture of the deformed body for a list of folders; return its path.

    Raises
    ------
    FileError
        The file cannot be written.
    """
    from voxsoft.plot.body import body_image

    write_atomically(folder / THUMBNAIL, _png(body_image(result)))
    return folder / THUMBNAIL


def save_cutout(picture: Cutout, path: Path) -> Path:
    """Write a picture without a background as PNG, with its scale; return the path.

    Raises
    ------
    FileError
        The file cannot be written.
    """
    write_atomically(path, _png(picture.pixels, picture.per_meter))
    return path


def scale_of(png: bytes) -> float | None:
    """Read the pixels per meter of a picture that :func:`save_cutout` wrote; None if unknown."""
    at = png.find(b"pHYs")
    if at < 0 or len(png) < at + 13 or png[at + 12] != 1:
        return None
    return float(struct.unpack_from(">I", png, at + 4)[0])


def _png(pixels: NDArray[np.uint8], per_meter: float | None = None) -> bytes:
    """Pack pixels, (h, w, 3) or with opacity (h, w, 4), as PNG.

    Not by matplotlib, which is slow to load.
    """
    height, width, channels = pixels.shape
    # Each row begins with the number of its filter: none.
    rows = np.hstack([np.zeros((height, 1), np.uint8), pixels.reshape(height, channels * width)])
    head = struct.pack(">IIBBBBB", width, height, 8, 2 if channels == 3 else 6, 0, 0, 0)
    chunks = [(b"IHDR", head), (b"IDAT", zlib.compress(rows.tobytes())), (b"IEND", b"")]
    if per_meter is not None:
        pixels_of_meter = max(1, min(round(per_meter), 2**31 - 1))
        chunks.insert(1, (b"pHYs", struct.pack(">IIB", pixels_of_meter, pixels_of_meter, 1)))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )
