"""Marks on a photograph, as ImageJ lists them: measurements at stations of a body."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar, Final

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from voxsoft.calibration import LineName, Measurement
from voxsoft.errors import MeasurementError, UnitError, VoxSoftError
from voxsoft.instruments import measured
from voxsoft.records import Record
from voxsoft.records.table import Table
from voxsoft.units import Length, parse

_AXIS: Final = re.compile(r"([+-]?)(.+)")


class Picture(Record):
    """Marks on a photograph, in the order of their stations.

    Parameters
    ----------
    file
        Table of the marks, from the folder of the test: Results of ImageJ.
    stations
        Probe of each row, or distance from the clamp face along the body; a distance of 0 is the
        clamp face itself, from which positions count.
    axes
        Columns of the table by axes of the design, ``{ x = "X", z = "-Y" }``: rows of a picture
        count down, so that the default turns Y.
    unit
        Unit that the scale in ImageJ has; ``px`` without a scale.
    pixel
        Size of a pixel, where the unit is ``px``.
    rest
        Table of the same marks without the load; displacements are measured then.
    """

    error_type: ClassVar[type[VoxSoftError]] = MeasurementError

    file: str
    stations: tuple[str, ...] = Field(min_length=1)
    axes: Table[str, str] = Field(default_factory=lambda: {"x": "X", "z": "-Y"})
    unit: str
    pixel: Length | None = None
    rest: str | None = None


def measurement_of_marks(
    picture: Picture,
    folder: Path,
    changes: Mapping[str, str],
    line: LineName | None,
    source: str,
) -> Measurement:
    """Return the measurement of a photograph.

    Raises
    ------
    VoxSoftError
        A table that cannot be read, of another number of rows than stations, or without a mark to
        count from.
    """
    axes = [axis for axis in "xyz" if axis in picture.axes]
    seen = _places(picture, folder / picture.file, axes)
    arcs = _arcs(picture)
    kept = np.ones(len(picture.stations), dtype=bool) if arcs is None else arcs > 0.0
    if picture.rest is not None:
        values = seen - _places(picture, folder / picture.rest, axes)
        quantities = [f"d{axis}" for axis in axes]
    elif arcs is None or kept.all():
        what = "has no mark at the clamp face, from which positions count"
        hint = 'list it as station "0 mm", or give rest, the same marks without the load'
        raise MeasurementError(picture.file, what, hint)
    else:
        values = seen - seen[int(np.argmin(arcs))]
        quantities = axes
    return Measurement(
        quantities=quantities,
        values=values[kept],
        arcs=None if arcs is None else arcs[kept],
        probes=None if arcs is not None else picture.stations,
        name=picture.file,
        source=source,
        line=line,
        changes=[f"{key}={value}" for key, value in changes.items()],
    )


def _places(picture: Picture, path: Path, axes: list[str]) -> NDArray[np.float64]:
    """Return the marks along the axes of the design, (n, axes), m."""
    table = measured(path, unit=picture.unit, pixel=picture.pixel)
    columns = []
    for axis in axes:
        sign, name = _AXIS.fullmatch(picture.axes[axis]).groups()  # type: ignore[union-attr]
        column = table[name]
        if column.kind != "length":
            what = f"{name} is in {column.unit or 'no unit'}"
            raise MeasurementError(path.name, what, 'give unit = "mm", or unit = "px" and a pixel')
        columns.append(column.values * (-1.0 if sign == "-" else 1.0))
    found = np.stack(columns, axis=1)
    if len(found) != len(picture.stations):
        what = f"lists {len(found)} marks for {len(picture.stations)} stations"
        raise MeasurementError(path.name, what, "name a station for each row, in their order")
    return found


def _arcs(picture: Picture) -> NDArray[np.float64] | None:
    """Return the distances of the stations in m, (n,); None if they are probes."""
    arcs = []
    for station in picture.stations:
        try:
            arcs.append(parse(station, "length"))
        except UnitError:
            continue
    if arcs and len(arcs) < len(picture.stations):
        raise MeasurementError("stations", "mix probes and distances", "write all of them alike")
    return np.array(arcs) if arcs else None
