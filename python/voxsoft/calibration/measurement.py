"""Measurement: positions or displacements of a real body, and their source."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from voxsoft._shown import Shown, counted
from voxsoft.calibration.line import LineName
from voxsoft.errors import MeasurementError

#: Quantities of a station: positions relative to the clamp face, and displacements.
QUANTITIES: Final = ("x", "y", "z", "dx", "dy", "dz")


@dataclass(frozen=True, eq=False, repr=False)
class Measurement(Shown):
    """Measured positions or displacements at stations of one body at rest.

    Parameters
    ----------
    quantities
        Measured quantities at every station, of ``x y z`` (position relative to the clamp face, in
        the axes of the design) and ``dx dy dz`` (displacement); at most one of the two for each
        axis.
    values
        Numbers in m, (n, q): a row for each station, a column for each quantity.
    arcs
        Distance of each station from the clamp face along the undeformed body in m, (n,); or
    probes
        names of the design's probes, one for each station. Give one of the two.
    name
        Name of the measurement, such as that of the material.
    source
        Source of the numbers, and the license under which they may be used.
    line
        Line of the body on which arc positions were marked, if it is known: ``lower-edge``,
        ``centerline`` or ``upper-edge``.
    changes
        Values of the design in this test, as ``--set`` takes them: ``("loads[0].value=12 kPa",)``.

    Raises
    ------
    MeasurementError
        No stations, NaN, a station twice, lists of unequal length, or unknown quantities.

    Examples
    --------
    >>> tip = Measurement(quantities=["dz"], values=[[-0.02]], arcs=[0.09], name="coupon 1")
    >>> len(tip), tip.station_names
    (1, ('arc 90 mm',))
    >>> Measurement(quantities=["dz"], values=[[float("nan")]], arcs=[0.09])
    Traceback (most recent call last):
    ...
    voxsoft.errors.MeasurementError: arc 90 mm: dz is nan. Try: leave out stations that were not \
seen
    """

    quantities: tuple[str, ...]
    values: NDArray[np.float64]
    arcs: NDArray[np.float64] | None = None
    probes: tuple[str, ...] | None = None
    name: str = "measurement"
    source: str = ""
    line: LineName | None = None
    changes: tuple[str, ...] = ()

    def __init__(
        self,
        *,
        quantities: ArrayLike | tuple[str, ...] | list[str],
        values: ArrayLike,
        arcs: ArrayLike | None = None,
        probes: tuple[str, ...] | list[str] | None = None,
        name: str = "measurement",
        source: str = "",
        line: LineName | None = None,
        changes: tuple[str, ...] | list[str] = (),
    ) -> None:
        numbers = np.array(values, dtype=np.float64)
        numbers.setflags(write=False)
        fields: dict[str, object] = {
            "quantities": tuple(str(quantity) for quantity in np.atleast_1d(quantities)),
            "values": numbers,
            "arcs": None if arcs is None else np.array(arcs, dtype=np.float64),
            "probes": None if probes is None else tuple(probes),
            "name": name,
            "source": source,
            "line": line,
            "changes": tuple(changes),
        }
        for field, value in fields.items():
            object.__setattr__(self, field, value)
        self._check()

    @classmethod
    def read(cls, path: str | os.PathLike[str], *, select: str | None = None) -> Measurement:
        """Read a measurement from a CSV file.

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
            Text that is not UTF-8, or a table that cannot be used, with the line.
        """
        # `files` lies above `calibration` in the layers; like `Design.save`, this convenience
        # reaches up when it is called, so that no import runs in a circle.
        from voxsoft.files.measurements import load_measurement

        return load_measurement(path, select=select)

    def _lines(self) -> Iterator[str]:
        stations = counted(len(self), "station")
        yield f"{self.name}: {', '.join(self.quantities)} at {stations}"

    def __len__(self) -> int:
        """Count the stations."""
        return len(self.values)

    @property
    def station_names(self) -> tuple[str, ...]:
        """Name of each station: its probe, or its arc position."""
        if self.probes is not None:
            return self.probes
        arcs = np.zeros(0) if self.arcs is None else self.arcs
        return tuple(f"arc {arc * 1e3:.6g} mm" for arc in arcs)

    @property
    def axes(self) -> NDArray[np.intp]:
        """Axis of each quantity, 0 to 2, (q,)."""
        return np.array(["xyz".index(quantity[-1]) for quantity in self.quantities])

    @property
    def are_positions(self) -> NDArray[np.bool_]:
        """True for each quantity that is a position rather than a displacement, (q,)."""
        return np.array([len(quantity) == 1 for quantity in self.quantities])

    def _check(self) -> None:
        self._check_quantities()
        if (self.arcs is None) == (self.probes is None):
            raise MeasurementError(self.name, "needs either arc positions or probes, and not both")
        count = len(self.station_names)
        if self.values.shape != (count, len(self.quantities)) or count == 0:
            raise MeasurementError(
                self.name,
                f"has numbers of the shape {self.values.shape}; expected {count} rows, one for "
                f"each station, and {len(self.quantities)} columns, one for each quantity",
            )
        self._check_stations()
        for station, row in zip(self.station_names, self.values, strict=True):
            for quantity, value in zip(self.quantities, row, strict=True):
                if not np.isfinite(value):
                    raise MeasurementError(
                        station, f"{quantity} is {value}", "leave out stations that were not seen"
                    )

    def _check_quantities(self) -> None:
        unknown = [quantity for quantity in self.quantities if quantity not in QUANTITIES]
        if unknown or not self.quantities:
            came = f'"{unknown[0]}" is not a quantity' if unknown else "no quantity is named"
            raise MeasurementError(self.name, came, f"name some of {', '.join(QUANTITIES)}")
        axes = [quantity[-1] for quantity in self.quantities]
        twice = next((axis for axis in axes if axes.count(axis) > 1), None)
        if twice:
            raise MeasurementError(
                self.name, f"{twice} is measured twice", f"keep one of {twice} and d{twice}"
            )

    def _check_stations(self) -> None:
        if self.arcs is not None and not (np.isfinite(self.arcs) & (self.arcs > 0)).all():
            raise MeasurementError(
                self.name,
                "has an arc position that is not a positive length",
                "measure arcs from the clamp face, where the body starts to be free",
            )
        names = self.station_names
        twice = next((station for station in names if names.count(station) > 1), None)
        if twice:
            raise MeasurementError(
                twice,
                "comes twice",
                "average repeated readings, or make an experiment of each run",
            )
