"""Measurement files: tables of positions or displacements of a real body."""

from __future__ import annotations

from pathlib import Path

from voxsoft.calibration import Measurement, read_measurement
from voxsoft.files.designs import FilePath
from voxsoft.instruments.read import table_text


def load_measurement(path: FilePath, *, select: str | None = None) -> Measurement:
    r"""Read a measurement from a CSV file.

    Parameters
    ----------
    path
        Path of the file; see :func:`voxsoft.calibration.read_measurement` for its format.
    select
        Name of the material to take from a table of several.

    Raises
    ------
    FileError
        A missing, unreadable or too large file.
    MeasurementError
        No text, or a table that cannot be used, with the line.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "tip.csv"
    >>> _ = file.write_text("probe,dz_mm\ntip,-12.5\n")
    >>> load_measurement(file).values.tolist()
    [[-0.0125]]
    """
    return read_measurement(table_text(path), name=Path(path).name, select=select)
