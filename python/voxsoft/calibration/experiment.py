"""Experiment: a design and the measurement of its real body."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import Shown
from voxsoft.calibration.line import LineName, StationLine
from voxsoft.calibration.measurement import Measurement
from voxsoft.design import Design, Probe
from voxsoft.errors import MeasurementError
from voxsoft.geometry import mean_displacement
from voxsoft.materials import Material
from voxsoft.records import closest
from voxsoft.simulation import Place, Setup
from voxsoft.simulation.compatibility import refuse
from voxsoft.simulation.loads import readings
from voxsoft.simulation.setup.large_voxels import evenly_small
from voxsoft.simulation.setup.places import place_of, voxel_size
from voxsoft.units import format_quantity

# Limit of stretch and travel of a real body, in its own lengths at rest.
_FARTHEST = 2.0
# Least distance of the farthest station, as a share of the free length: a nearer one was not
# measured along the body, or in other units.
_NEAREST = 0.02


@dataclass(frozen=True, eq=False, repr=False)
class Experiment(Shown):
    """Design together with a measurement of the body it describes.

    Parameters
    ----------
    design
        Body as it was clamped and loaded in the laboratory. All its parts are of one material, the
        one to be calibrated; its present constants do not matter. Values that the measurement
        names (:attr:`Measurement.changes`) stand in place of its own.
    measurement
        Measured positions or displacements of its stations.
    line
        Line of the body on which arc positions lie: ``lower-edge``, ``centerline`` or
        ``upper-edge``, at the middle of the width. Default: that of the measurement, or
        ``lower-edge``, as on the paper's photographs. Stations that name a probe do not use it.

    Raises
    ------
    MeasurementError
        A station that the design does not have, or numbers that do not fit its size.
    DesignError
        A design that cannot be simulated, or of several materials.

    Notes
    -----
    The clamp face is the end of the clamped vertices toward the free part of the body; arcs and
    positions are counted from there, along and relative to the chosen line.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> tip = Measurement(quantities=["x", "dz"], values=[[0.046, -0.08]], arcs=[0.09])
    >>> Experiment(families.beam(), tip).points.round(4).tolist()
    [[0.1, 0.005, 0.0]]
    """

    design: Design
    measurement: Measurement
    line: LineName = None  # type: ignore[assignment] # filled in below
    line_is_assumed: bool = field(init=False, default=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "design", changed(self.design, self.measurement.changes))
        assumed = self.line is None and self.measurement.line is None
        object.__setattr__(self, "line_is_assumed", assumed)
        if self.line is None:
            object.__setattr__(self, "line", self.measurement.line or "lower-edge")
        _ = self.material, self.places
        self._check_size()

    def _lines(self) -> Iterator[str]:
        yield f"{self.name}: {len(self.measurement)} stations of the design {self.design.name}"

    @property
    def caution(self) -> str:
        """Warning that nothing says on which line arc positions lie; empty where something does."""
        if self.measurement.arcs is None or not self.line_is_assumed:
            return ""
        return (
            f"{self.name}: arc positions are taken for marks on the lower edge; another line "
            'gives another modulus: say it by "# line: centerline" in the table, --line or line='
        )

    @property
    def name(self) -> str:
        """Name of the measurement."""
        return self.measurement.name

    @cached_property
    def setup(self) -> Setup:
        """Design prepared for the solver."""
        refuse(self.design, "calibration")
        return Setup.of(evenly_small(self.design, self.design.solver.refine))

    @cached_property
    def material(self) -> Material:
        """Material of all parts."""
        first, *others = (self.design.material_of(part) for part in self.design.parts)
        if any(other != first for other in others):
            raise MeasurementError(
                "parts",
                "are of several materials; a calibration fits one",
                "calibrate each material on a coupon of its own",
            )
        return first

    @cached_property
    def voxel_size(self) -> float:
        """Voxel size in m."""
        return voxel_size(self.setup.mesh)

    @cached_property
    def station_line(self) -> StationLine:
        """Line that arcs and positions are counted along."""
        clamped = np.concatenate([np.zeros(0, np.uint32), *self.setup.clamped])
        return StationLine.along(
            self.setup.mesh.vertices,
            clamped,
            line=self.line,
            gravity=self.gravity,
            voxel_size=self.voxel_size,
        )

    @cached_property
    def gravity(self) -> tuple[float, float, float]:
        """Direction of gravity; zero without it."""
        ways = (load.direction for load in readings(self.design) if load.quantity == "acceleration")
        return next(ways, (0.0, 0.0, 0.0))

    @cached_property
    def places(self) -> tuple[Place, ...]:
        """Weighted vertices that each station averages over."""
        if self.measurement.probes is not None:
            return tuple(self._probe(name) for name in self.measurement.probes)
        assert self.measurement.arcs is not None  # a measurement has one or the other
        self._check_arcs(self.measurement.arcs)
        mesh, shapes = self.setup.mesh, self.design.shapes
        points = self.station_line.points(self.measurement.arcs)
        return tuple(
            place_of(Probe(point=tuple(point)), mesh, shapes, f"station {name}")
            for point, name in zip(points, self.measurement.station_names, strict=True)
        )

    @cached_property
    def points(self) -> NDArray[np.float64]:
        """Stations on the undeformed body, (n, 3), m."""
        rest = self.setup.mesh.vertices
        return np.array([place.weights @ rest[place.vertices] for place in self.places])

    @cached_property
    def offsets(self) -> NDArray[np.float64]:
        """Value of each measured number on the undeformed body, (n, q), m.

        Position relative to the clamp face, and zero for displacements.
        """
        measurement = self.measurement
        if not measurement.are_positions.any():
            return np.zeros_like(measurement.values)
        relative = self.points - self.station_line.foot
        undeformed: NDArray[np.float64] = np.where(
            measurement.are_positions, relative[:, measurement.axes], 0.0
        )
        return undeformed

    @cached_property
    def sag(self) -> float:
        """Measured sag of the body in m: the largest measured displacement.

        Measured along gravity if possible, else in all measured axes together.
        """
        moved = self.measurement.values - self.offsets
        down = np.flatnonzero(
            self.measurement.axes == int(np.argmax(np.abs([*self.gravity[:2], self.gravity[2]])))
        )
        seen = moved[:, down] if any(self.gravity) and down.size else moved
        return float(np.linalg.norm(seen, axis=1).max())

    def seen_at(self, positions: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the numbers that would be measured on a simulated body.

        Parameters
        ----------
        positions
            Vertices at rest under load, (v, 3), m.

        Returns
        -------
        ndarray of shape (n, q)
            Numbers in m, in the order of the measurement.
        """
        rest = self.setup.mesh.vertices
        moved = np.array(
            [
                mean_displacement(rest, positions, place.vertices, place.weights)
                for place in self.places
            ]
        )
        seen: NDArray[np.float64] = self.offsets + moved[:, self.measurement.axes]
        return seen

    def _probe(self, name: str) -> Place:
        if name not in self.setup.places:
            hint = closest(name, self.setup.places) or "add it to the probes of the design"
            raise MeasurementError(f"probe {name}", "is not a probe of the design", hint)
        return self.setup.places[name]

    def _check_arcs(self, arcs: NDArray[np.float64]) -> None:
        line, last = self.station_line, float(arcs.max())
        free = format_quantity(float(f"{line.length:.6g}"), "length")
        came = format_quantity(float(f"{last:.6g}"), "length")
        if last > line.length + 0.5 * self.voxel_size:
            raise MeasurementError(
                f"station arc {came}",
                f"lies beyond the body, which is free for {free} from its clamp",
                _unit_hint(last, line.length),
            )
        if last < _NEAREST * line.length:
            raise MeasurementError(
                f"station arc {came}",
                f"is the farthest, on a body that is free for {free}",
                _unit_hint(last, line.length),
            )

    def _check_size(self) -> None:
        extent = self.setup.mesh.vertices.max(axis=0) - self.setup.mesh.vertices.min(axis=0)
        size = float(np.linalg.norm(extent))
        values = np.abs(self.measurement.values)
        station, quantity = np.unravel_index(int(values.argmax()), values.shape)
        largest = float(values[station, quantity])
        where = (
            f"{self.measurement.station_names[station]}, {self.measurement.quantities[quantity]}"
        )
        came = format_quantity(float(f"{largest:.6g}"), "length")
        body = format_quantity(float(f"{size:.4g}"), "length")
        if largest > _FARTHEST * size:
            raise MeasurementError(
                where, f"{came} is too far for a body of {body}", _unit_hint(largest, size)
            )
        if self.measurement.are_positions.any() and self.measurement.arcs is not None:
            reach = float(np.abs(self.measurement.values).max())
            if reach < _NEAREST * float(self.measurement.arcs.max()):
                raise MeasurementError(
                    where,
                    f"{came} is the farthest position, at arcs up to "
                    f"{format_quantity(float(self.measurement.arcs.max()), 'length')}",
                    _unit_hint(reach, float(self.measurement.arcs.max())),
                )


def changed(design: Design, changes: Sequence[str]) -> Design:
    """Return a design with other values, as ``--set`` takes them.

    Raises
    ------
    DesignError
        A key that leads nowhere, or a value that is none.
    """
    return design.with_values(*changes) if changes else design


def _unit_hint(came: float, due: float) -> str:
    """Suggest the unit that would make `came` about as large as `due`."""
    ratio = came / due
    for factor, hint in (
        (1e3, "are the numbers in mm? then name the column _mm"),
        (1e2, "are the numbers in cm? then name the column _cm"),
        (1e1, "are the numbers in mm under _cm? check the unit of the column"),
        (1e-1, "are the numbers in cm under _mm? check the unit of the column"),
        (1e-2, "are the numbers in m under _cm? check the unit of the column"),
        (1e-3, "are the numbers in m under _mm? check the unit of the column"),
    ):
        if factor / 3 < ratio < factor * 3:
            return hint
    return "check the unit of the column, and the size of the design"
