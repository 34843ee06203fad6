"""TDMS of LabVIEW and DAQmx, read by npTDMS: scaled channels, each at its own rate."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np

from voxsoft.errors import FileError, MeasurementError, MissingPackageError
from voxsoft.instruments.column import Column, Floats
from voxsoft.instruments.heads import is_time
from voxsoft.instruments.options import Options
from voxsoft.instruments.texts import Found

#: Lead-in of a segment, and the length of one whose writer was stopped.
_LEAD: Final = struct.Struct("<4sIIQQ")
_OPEN: Final = 0xFFFF_FFFF_FFFF_FFFF
_UNITS: Final = ("unit_string", "NI_UnitDescription", "unit", "Unit")


def read(path: Path, options: Options) -> Found:
    """Read all channels with numbers, in the units of their scales.

    A waveform has its times from its increment and its start; others from a channel of the time in
    their group, or from a given rate. Times count from the earliest start in the file.

    Raises
    ------
    FileError
        It is damaged.
    MeasurementError
        A unit that is not known.
    MissingPackageError
        npTDMS is not installed.
    """
    try:
        from nptdms import TdmsFile
    except ImportError:
        what = "is not installed, and reads TDMS"
        raise MissingPackageError("npTDMS", what, "pip install 'voxsoft[measured]'") from None
    notes: list[str] = []
    columns: list[Column] = []
    try:
        with TdmsFile.open(path) as file:
            groups = [(g.name, [_channel(c) for c in g.channels()]) for g in file.groups()]
    # npTDMS raises errors of many kinds for damaged files.
    except Exception as error:
        shown = str(error).partition("\n")[0][:200] or type(error).__name__
        what = f"cannot be read as TDMS: {shown}"
        raise FileError(str(path), what, "save or copy it again") from error
    notes += _cut(path)
    starts = [c["start"] for _, channels in groups for c in channels if c["start"] is not None]
    zero = min(starts, default=None)
    if zero is not None:
        notes.append(f"Times count from {zero} UTC")
    several = sum(bool(channels) for _, channels in groups) > 1
    for group, channels in groups:
        over = _times_of_group(path.name, channels, options)
        for channel in channels:
            name, values = channel["name"], channel["values"]
            label = f"{group}/{name}" if several else name
            if channel is over[0] or not len(values):
                continue
            if values.dtype.kind not in "fiub":
                notes.append(f"{label} holds no numbers, and is left out")
                continue
            times = _times(channel, zero, options)
            if times is None and over[1] is not None and len(over[1]) == len(values):
                times = over[1]
            unit = options.unit_of(label, channel["unit"])
            columns.append(Column(label, unit, values.astype(np.float64), times))
            if channel["scaled"]:
                notes.append(f"{label}: scaled as the file says")
    return Found(columns, notes)


def _cut(path: Path) -> Iterator[str]:
    """Yield a sentence where a segment goes on after the end of the file.

    A segment begins with 28 bytes: ``TDSm``, flags, version, and offsets of the next segment and of
    the raw data, each of 64 bits, with all ones where the writer was stopped.
    """
    size, at = path.stat().st_size, 0
    with path.open("rb") as file:
        while at < size:
            file.seek(at)
            lead = file.read(_LEAD.size)
            if len(lead) < _LEAD.size or lead[:4] != b"TDSm":
                break
            length = int(_LEAD.unpack(lead)[3])
            if length == _OPEN:
                yield "The writer was stopped in the last segment: rows up to there are read"
                return
            at += _LEAD.size + length
    if at != size:
        yield "The file is cut short in its last segment: rows up to there are read"


def _channel(channel: Any) -> dict[str, Any]:  # noqa: ANN401 - npTDMS has no types
    properties = channel.properties
    unit = next((str(properties[key]) for key in _UNITS if properties.get(key)), "")
    start = properties.get("wf_start_time")
    increment = float(properties.get("wf_increment", 0.0) or 0.0)
    return {
        "name": channel.name,
        "values": np.asarray(channel[:]),
        "unit": unit,
        "increment": increment,
        "offset": float(properties.get("wf_start_offset", 0.0) or 0.0),
        "start": np.datetime64(start) if start is not None and increment > 0.0 else None,
        "scaled": "NI_Number_Of_Scales" in properties,
    }


def _times(channel: dict[str, Any], zero: np.datetime64 | None, options: Options) -> Floats | None:
    count = len(channel["values"])
    if options.rate is not None:
        return np.arange(count) / options.rate
    if channel["increment"] <= 0.0:
        return None
    late = 0.0
    if zero is not None and channel["start"] is not None:
        late = float((channel["start"] - zero) / np.timedelta64(1, "us")) * 1e-6
    times: Floats = late + channel["offset"] + channel["increment"] * np.arange(count)
    return times


def _times_of_group(
    name: str, channels: list[dict[str, Any]], options: Options
) -> tuple[dict[str, Any] | None, Floats | None]:
    """Return the channel of the time of a group, and its times in s."""
    asked = None if options.time is None else options.time.casefold()
    for channel in channels:
        named = is_time(channel["name"]) and channel["increment"] <= 0.0
        if not (named if asked is None else channel["name"].casefold() == asked):
            continue
        values = channel["values"]
        if values.dtype.kind == "M":
            return channel, (values - values[0]) / np.timedelta64(1, "us") * 1e-6
        if values.dtype.kind not in "fiu":
            continue
        found = Column(channel["name"], options.unit_of(channel["name"], channel["unit"]), values)
        if found.kind != "time":
            where = f'{name}, channel "{channel["name"]}"'
            hint = f'give units={{"{channel["name"]}": "s"}}, or rate='
            raise MeasurementError(where, "is a time without a unit of time", hint)
        return channel, found.values
    return None, None
