"""Reading of measured data: one way in for the files of all instruments."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Final

from voxsoft.errors import FileError, MeasurementError
from voxsoft.formats.registry import MEASURED, function
from voxsoft.instruments.column import Column
from voxsoft.instruments.measured import Measured
from voxsoft.instruments.options import Options
from voxsoft.instruments.table_text import LARGEST_TEXT, decoded
from voxsoft.instruments.texts import Found, read_text
from voxsoft.instruments.tracked import DEEPLABCUT, KINOVEA, read_deeplabcut, read_kinovea
from voxsoft.units import si_value

#: Suffix of testXpert's own files, which are not read.
_ZWICK: Final = ".zs2"
_AXIS: Final = re.compile(r"([+-]?)([xyz])")


def measured(
    path: str | os.PathLike[str],
    *,
    units: Mapping[str, str] | None = None,
    unit: str = "",
    pixel: float | str | None = None,
    axes: Mapping[str, str] | None = None,
    rate: float | str | None = None,
    time: str | None = None,
    likelihood: float = 0.6,
) -> Measured:
    r"""Read the columns of a file of an instrument, with their units and times.

    Text with a header (logs, testing machines, ImageJ), DeepLabCut and Kinovea are known by their
    first lines; ``.tdms`` and ``.c3d`` need the extra ``measured``; ``.mat`` is read up to version
    7. ``print(found.account)`` lists columns, units, rates, gaps and axes.

    Parameters
    ----------
    path
        Path of the file.
    units
        Units by the name of a column, where the file has none or wrong ones.
    unit
        Unit of coordinates (columns that end in x, y, z), where the file says none.
    pixel
        Size of a pixel in the plane of the body, in m or with a unit, of coordinates in pixels.
    axes
        Axes of the design by those of the file: ``{"x": "x", "z": "-y"}`` for a picture of a body
        that hangs, whose y points down. Default: those of the file.
    rate
        Rows per second, where the file has no times, or wrong ones.
    time
        Name of the column of the time, where it has an unusual one.
    likelihood
        Least likelihood of a point that DeepLabCut found; below it is a gap. Default 0.6.

    Raises
    ------
    FileError
        A missing, damaged or too large file, or a format that is not read.
    MeasurementError
        No columns of numbers, unknown units or axes, or times that do not rise.
    MissingPackageError
        The library of the format is not installed.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "log.csv"
    >>> _ = file.write_text("time_s,pressure_kPa\n0,0\n0.5,10\n1,20\n")
    >>> print(measured(file).account)
    log.csv
    pressure: pressure in kPa, 3 rows at 2 Hz from 0 s to 1 s
    """
    file = Path(path)
    hertz = None if rate is None else si_value(rate, "rate", "rate", positive=True)
    options = Options(dict(units or {}), unit, hertz, time, likelihood)
    found = _found(file, options)
    columns, notes = found.columns, list(found.notes)
    if pixel is not None:
        size = si_value(pixel, "length", "pixel", positive=True)
        columns = [_scaled(column, size) for column in columns]
        notes.append(f"A pixel is {size * 1e3:.6g} mm")
    if axes is not None:
        columns = _turned(file.name, columns, axes)
        named = ", ".join(f"{mine} is {its}" for mine, its in axes.items())
        notes.append(f"Axes are turned to those of the design: {named}")
    return Measured(file.name, tuple(columns), tuple(notes))


def is_text(path: str | os.PathLike[str]) -> bool:
    """Return True for a file that is a table of text by its suffix: all but known formats.

    Examples
    --------
    >>> is_text("curve.csv"), is_text("curve"), is_text("test.tdms")
    (True, True, False)
    """
    suffix = Path(path).suffix.lower()
    return MEASURED.get(suffix, MEASURED[".csv"]) is MEASURED[".csv"] and suffix != _ZWICK


def table_text(path: str | os.PathLike[str]) -> str:
    """Read the text of a table, in the codings that machines write.

    Raises
    ------
    FileError
        A missing, unreadable or too large file.
    MeasurementError
        Bytes that are no text.
    """
    file = Path(path)
    _refuse_missing(file)
    try:
        if file.stat().st_size > LARGEST_TEXT:
            what = f"has {file.stat().st_size / 1e6:.0f} MB; expected at most "
            raise FileError(str(file), f"{what}{LARGEST_TEXT / 1e6:.0f} MB", "leave columns out")
        content = file.read_bytes()
    except OSError as error:
        reason = error.strerror or str(error)
        raise FileError(str(file), f"cannot be read: {reason}") from None
    return decoded(content, str(file))


def read_table(path: Path, options: Options) -> Found:
    """Read a file of text: a log, or points that a camera tracked."""
    text = table_text(path)
    start = text.removeprefix("\ufeff").lstrip()
    if start.startswith(KINOVEA):
        return read_kinovea(text, path.name, options)
    if re.match(rf'"?{DEEPLABCUT}"?,', start):
        return read_deeplabcut(text, path.name, options)
    return read_text(text, path.name, options)


def _found(file: Path, options: Options) -> Found:
    _refuse_missing(file)
    suffix = file.suffix.lower()
    form = MEASURED.get(suffix)
    if form is None:
        hint = f"export it as CSV; read are {', '.join(MEASURED)}"
        if suffix == _ZWICK:
            hint = "export the curves from testXpert as text (.tra, .csv)"
        raise FileError(str(file), f"{suffix or 'a file without a suffix'} is not read", hint)
    assert form.reader is not None
    found: Found = function(form.reader)(file, options)
    return found


def _refuse_missing(file: Path) -> None:
    if not file.is_file():
        is_folder = file.is_dir()
        raise FileError(str(file), "is a folder" if is_folder else "no such file")


def _scaled(column: Column, size: float) -> Column:
    if column.kind != "pixels":
        return column
    return replace(column, unit="m", numbers=column.numbers * size)


def _turned(name: str, columns: list[Column], axes: Mapping[str, str]) -> list[Column]:
    """Return the columns of points along the axes of the design; others as they are."""
    parts = {}
    for mine, its in axes.items():
        match = _AXIS.fullmatch(its)
        if mine not in ("x", "y", "z") or match is None:
            hint = 'write {"x": "x", "z": "-y"}, say'
            raise MeasurementError(name, f'axes: "{mine}" is "{its}"', hint)
        parts[match[2]] = (mine, -1.0 if match[1] == "-" else 1.0)
    if len(parts) != len(axes):
        raise MeasurementError(name, "axes: one axis of the file is named twice")
    found = []
    for column in columns:
        stem, _, axis = column.name.rpartition(" ")
        if not stem or axis not in ("x", "y", "z"):
            found.append(column)
        elif axis in parts:
            mine, sign = parts[axis]
            found.append(replace(column, name=f"{stem} {mine}", numbers=sign * column.numbers))
    return found
