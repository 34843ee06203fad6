"""C3D of motion capture, read by ezc3d: markers, and analog channels at a rate of their own."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any, Final

import numpy as np

from voxsoft.errors import FileError, MissingPackageError
from voxsoft.instruments.column import Column, Floats
from voxsoft.instruments.options import Options
from voxsoft.instruments.texts import Found

#: Largest number of frames that the format counts, in 16 bits.
_MOST: Final = 65_535
_BLOCK: Final = 512
#: Second byte of a file, and codes of processors with other numbers than Intel's.
_KEY: Final = 0x50
_DEC: Final = 85
_MIPS: Final = 86


def read(path: Path, options: Options) -> Found:
    """Read the markers, as columns of their coordinates, and the analog channels.

    Frames in which a marker was hidden are gaps: ezc3d reads those with a negative residual as NaN,
    and other programs write 0, 0, 0. Times
    count from the first frame of the capture, whose number the file holds.

    Raises
    ------
    FileError
        It is damaged, or holds more frames than it counts.
    MeasurementError
        A unit that is not known.
    MissingPackageError
        ezc3d is not installed.
    """
    try:
        import ezc3d
    except ImportError:
        what = "is not installed, and reads C3D"
        raise MissingPackageError("ezc3d", what, "pip install 'voxsoft[measured]'") from None
    _refuse_cut(path)
    try:
        file: Any = ezc3d.c3d(str(path))
        points = np.asarray(file["data"]["points"], dtype=np.float64)
        analogs = np.asarray(file["data"]["analogs"], dtype=np.float64)
        known: Any = file["parameters"]
        first = int(file["header"]["points"]["first_frame"])
    # ezc3d raises errors of many kinds for damaged files.
    except Exception as error:
        shown = str(error).partition("\n")[0][:200] or type(error).__name__
        what = f"cannot be read as C3D: {shown}"
        raise FileError(str(path), what, "save or copy it again") from error
    frames = points.shape[2]
    _refuse_more_frames(path, points, analogs, known)
    notes = ["Axes are those of the laboratory, as the file has them"]
    columns: list[Column] = []
    rate = options.rate or _number(known, "POINT", "RATE")
    times = None if rate <= 0.0 else (first + np.arange(frames)) / rate
    if first:
        notes.append(f"The first frame is number {first}: times count from number 0")
    labels = _labels(known, "POINT", points.shape[1], "marker")
    unit = (_texts(known, "POINT", "UNITS") or [""])[0].strip()
    for index, label in enumerate(labels):
        place = points[:3, index, :].copy()
        place[:, ~np.isfinite(place).all(axis=0)] = np.nan
        zeros = (place == 0.0).all(axis=0)
        if zeros.any() and not zeros.all():
            place[:, zeros] = np.nan
            notes.append(
                f"{label}: {np.count_nonzero(zeros):,} frames are at exactly 0, 0, 0, as programs "
                "write hidden markers: they are gaps"
            )
        for axis, numbers in zip("xyz", place, strict=True):
            name = f"{label} {axis}"
            columns.append(Column(name, options.unit_of(name, unit), numbers, times))
    columns += _analogs(analogs, known, first, rate, options)
    return Found(columns, notes)


def _refuse_cut(path: Path) -> None:
    """Refuse a file that ends early: ezc3d returns the frames before the end without a word.

    The layout is that of https://www.c3d.org/HTML/default.htm: 512 bytes of counts as words of 16
    bits, parameters from a block that byte 0 names, and frames from a block of word 9.
    """
    size = path.stat().st_size
    hint = "save or copy it again"
    with path.open("rb") as file:
        head = file.read(_BLOCK)
        if len(head) < _BLOCK or head[1] != _KEY or not head[0]:
            raise FileError(str(path), "cannot be read as C3D: it begins otherwise", hint)
        file.seek((head[0] - 1) * _BLOCK)
        parameters = file.read(4)
    if len(parameters) < 4:
        raise FileError(str(path), "cannot be read as C3D: it ends before its parameters", hint)
    blocks, processor = parameters[2], parameters[3]
    order = ">" if processor == _MIPS else "<"
    points, analogs, first, last = struct.unpack(f"{order}4H", head[2:10])
    (start,) = struct.unpack(f"{order}H", head[16:18])
    # The sign of the scale says if numbers are floats; floats of DEC and MIPS have it elsewhere.
    sign = head[{_MIPS: 12, _DEC: 13}.get(processor, 15)]
    frames = max(last - first + 1, 0)
    needed = (start - 1) * _BLOCK + frames * (4 * points + analogs) * (4 if sign & 0x80 else 2)
    needed = max(needed, (head[0] - 1 + blocks) * _BLOCK)
    if size < needed:
        what = f"is cut short: it has {size:,} bytes, and its {frames:,} frames end at {needed:,}"
        raise FileError(str(path), what, hint)


def _analogs(
    analogs: Floats,
    known: Any,  # noqa: ANN401
    first: int,
    frame_rate: float,
    options: Options,
) -> list[Column]:
    count = analogs.shape[1]
    if not count or not analogs.shape[2]:
        return []
    rate = _number(known, "ANALOG", "RATE")
    start = first / frame_rate if frame_rate > 0.0 else 0.0
    times = None if rate <= 0.0 else start + np.arange(analogs.shape[2]) / rate
    units = _texts(known, "ANALOG", "UNITS")
    labels = _labels(known, "ANALOG", count, "analog")
    return [
        Column(
            label,
            options.unit_of(label, units[index].strip() if index < len(units) else ""),
            analogs[0, index],
            times,
        )
        for index, label in enumerate(labels)
    ]


def _refuse_more_frames(path: Path, points: Floats, analogs: Floats, known: Any) -> None:  # noqa: ANN401
    """Refuse a file that goes on after the frames that it counts: readers stop there silently."""
    frames = points.shape[2]
    if frames < _MOST - 1:
        return
    scale = _number(known, "POINT", "SCALE")
    size = 4 if scale < 0.0 else 2
    per_frame = size * (4 * points.shape[1] + analogs.shape[1] * (analogs.shape[2] // frames))
    start = int(_number(known, "POINT", "DATA_START") or 2) - 1
    held = (path.stat().st_size - start * _BLOCK) // per_frame
    if held - frames > _BLOCK // per_frame:
        what = f"counts {frames:,} frames, the most that C3D can, and holds about {held:,}"
        hint = "export shorter takes, of less than 65,535 frames, or at a lower rate"
        raise FileError(str(path), what, hint)


def _texts(known: Any, group: str, name: str) -> list[str]:  # noqa: ANN401
    found = known[group][name]["value"] if group in known and name in known[group] else []
    return [str(each) for each in found]


def _number(known: Any, group: str, name: str) -> float:  # noqa: ANN401
    found = known[group][name]["value"] if group in known and name in known[group] else []
    return float(found[0]) if len(found) else 0.0


def _labels(known: Any, group: str, count: int, called: str) -> list[str]:  # noqa: ANN401
    written = [label.strip() for label in _texts(known, group, "LABELS")]
    padded = [*written, *[""] * count][:count]
    return [label or f"{called} {index + 1}" for index, label in enumerate(padded)]
