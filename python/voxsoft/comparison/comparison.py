"""Several answers to one design side by side, with estimates of their errors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import Shown, counted
from voxsoft.calibration import Experiment
from voxsoft.comparison.quantities import Quantities, Quantity
from voxsoft.comparison.richardson import Estimate, discretization_error
from voxsoft.design import Design
from voxsoft.simulation import Diagnostic, Result

Floats = NDArray[np.float64]

#: Components below this share of the largest of their kind are zero by symmetry, and left out.
NEGLIGIBLE = 1e-3

_SPLIT = "split voxels"


@dataclass(frozen=True, eq=False)
class Run:
    """One run of a comparison, by a solver or an outside code.

    Attributes
    ----------
    label
        Solver or outside code, and its voxels, in words.
    code
        A solver of our own, ``calculix`` or ``scikit-fem``.
    voxel_size, split
        Size of the voxels in m, and bricks or voxels along the edge of each.
    status, message
        Final status in a word and a sentence; ``ok`` is the only status whose numbers count.
    seconds
        Wall-clock time of the solution.
    cells
        Number of voxels or bricks that were solved.
    detail
        Residual, or version and element.
    quantities
        Numbers by name.
    stations
        Computed values at the stations of each measurement, in m; empty on other voxels.
    result
        Whole result of a run of our own.
    """

    label: str
    code: str
    voxel_size: float
    split: int
    status: str
    message: str
    seconds: float
    cells: int = 0
    detail: str = ""
    quantities: Quantities = field(default_factory=dict, repr=False)
    stations: tuple[Floats, ...] = field(default=(), repr=False)
    result: Result | None = field(default=None, repr=False)

    @property
    def ok(self) -> bool:
        """True if the run succeeded, so that its numbers count."""
        return self.status == "ok"

    @property
    def edge(self) -> float:
        """Edge in m of the voxels or bricks that were solved."""
        return self.voxel_size / self.split


class SeriesEstimate(NamedTuple):
    """Error estimate of one quantity from one series of runs."""

    quantity: str
    series: str
    runs: tuple[str, ...]
    estimate: Estimate


@dataclass(frozen=True, eq=False)
class Judged:
    """Measurement that runs are judged by: its name, stations, and values in m."""

    name: str
    source: str
    stations: tuple[str, ...]
    quantities: tuple[str, ...]
    values: Floats = field(repr=False)
    sag: float

    @classmethod
    def of(cls, experiment: Experiment) -> Self:
        """Take the fields of an experiment that a report shows."""
        measurement = experiment.measurement
        return cls(
            measurement.name,
            measurement.source,
            measurement.station_names,
            measurement.quantities,
            measurement.values,
            experiment.sag,
        )


@dataclass(frozen=True, eq=False, repr=False)
class Comparison(Shown):
    """Result of :func:`voxsoft.compare`.

    Attributes
    ----------
    design
        The compared design.
    runs
        Runs in the order they were made.
    solver
        Solver that the estimates are for.
    outside
        Name of the outside code; empty without one.
    measured
        The measurements.
    note
        Note on missing parts, if any.
    warnings
        Reasons why an estimate may be too small, and parts of the design that were not used.
    """

    design: Design
    runs: tuple[Run, ...]
    solver: str
    outside: str
    measured: tuple[Judged, ...] = ()
    note: str = ""
    warnings: tuple[Diagnostic, ...] = ()

    def _lines(self) -> Iterator[str]:
        yield f"{self.design.name}: {counted(len(self.runs), 'run')}"
        for run in self.runs:
            yield f"{run.label}: {run.status}, {run.message}"
        if self.note:
            yield self.note
        for warning in self.warnings:
            yield f"warning: {warning}"

    @property
    def base(self) -> Run:
        """Run of the solver on the design's own voxels."""
        return next(
            run
            for run in self.runs
            if run.code == self.solver
            and run.split == 1
            and run.voxel_size == self.design.voxel_size
        )

    @property
    def yardstick(self) -> Run | None:
        """Run of the outside code on the finest split, if there is one."""
        found = [run for run in self.runs if run.code == self.outside and run.ok]
        return max(found, key=lambda run: run.split, default=None)

    @property
    def side_by_side(self) -> tuple[Run, ...]:
        """Runs on the design's own voxels, the outside code's on its finest split."""
        best = self.yardstick
        whole = [
            run
            for run in self.runs
            if run.ok
            and run.code != self.outside
            and run.split == 1
            and run.voxel_size == self.design.voxel_size
        ]
        return (*whole, *([best] if best else []))

    @cached_property
    def quantities(self) -> tuple[str, ...]:
        """Names of the quantities that are not negligible in every run."""
        sizes: dict[str, float] = {}
        largest: dict[str, float] = {}
        for run in self.runs:
            for name, quantity in run.quantities.items() if run.ok else ():
                if abs(quantity.value) <= quantity.floor:
                    continue
                sizes[name] = max(sizes.get(name, 0.0), abs(quantity.value))
                kind = quantity.kind
                largest[kind] = max(largest.get(kind, 0.0), abs(quantity.value))
        kinds = {name: q.kind for run in self.runs for name, q in run.quantities.items()}
        return tuple(
            name for name, size in sizes.items() if size > NEGLIGIBLE * largest[kinds[name]]
        )

    def known(self, quantity: str) -> Quantity:
        """Return the first run's number for a quantity."""
        return next(
            run.quantities[quantity] for run in self.runs if run.ok and quantity in run.quantities
        )

    @cached_property
    def series(self) -> Mapping[str, tuple[Run, ...]]:
        """Runs that differ in nothing but the size of their cells, coarsest first."""
        good = [run for run in self.runs if run.ok]
        own = [run for run in good if run.code == self.solver]
        here = [run for run in own if run.voxel_size == self.design.voxel_size]
        outside = [run for run in good if run.code == self.outside]
        whole = [run for run in own if run.split == 1]
        found = {_SPLIT: here, "voxel sizes": whole, "outside, split voxels": outside}
        return {
            name: tuple(sorted(runs, key=lambda run: -run.edge))
            for name, runs in found.items()
            if len(runs) > 1
        }

    @cached_property
    def estimates(self) -> tuple[SeriesEstimate, ...]:
        """Discretization error of each quantity, from each series."""
        return tuple(
            SeriesEstimate(
                name,
                series,
                tuple(run.label for run in runs),
                discretization_error(
                    [run.edge for run in runs], [run.quantities[name].value for run in runs]
                ),
            )
            for series, runs in self.series.items()
            for name in self.quantities
            if all(name in run.quantities for run in runs)
        )

    @property
    def distinguished(self) -> tuple[SeriesEstimate, ...]:
        """Estimates without those of voxel sizes whose voxels are the split ones."""
        split = {e.quantity: e.estimate.values for e in self.estimates if e.series == _SPLIT}
        return tuple(
            each
            for each in self.estimates
            if each.series == _SPLIT or each.estimate.values != split.get(each.quantity)
        )

    def estimate(self, quantity: str, series: str) -> Estimate | None:
        """Return the estimate of one quantity from one series, if there is one."""
        found = (e for e in self.estimates if (e.quantity, e.series) == (quantity, series))
        return next((each.estimate for each in found), None)

    def base_error(self, quantity: str, series: str) -> float | None:
        """Estimated error of the solver on the design's own voxels, SI, if there is one."""
        estimate = self.estimate(quantity, series)
        if estimate is None:
            return None
        edges = [run.edge for run in self.series[series]]
        return estimate.error_at(edges.index(self.base.edge)) if self.base.edge in edges else None

    def difference(self, run: Run, quantity: str) -> float | None:
        """Difference to the outside code's best answer, as a share of its vector's length."""
        best = self.yardstick
        if best is None or not run.ok or quantity not in run.quantities:
            return None
        other = best.quantities[quantity]
        gap = run.quantities[quantity].value - other.value
        return gap / other.scale if other.scale > 0 else None

    def agrees(self, quantity: str) -> bool | None:
        """Return True if solver and outside code agree within their estimated errors.

        The solver's error is that of its split voxels, as the outside code sees the same body.
        """
        best = self.yardstick
        own = self.base_error(quantity, _SPLIT)
        if best is None or own is None or not self.base.ok:
            return None
        outer = self.estimate(quantity, "outside, split voxels")
        gap = abs(self.base.quantities[quantity].value - best.quantities[quantity].value)
        return gap <= own + (outer.error if outer else 0.0)

    def errors(self, run: Run, index: int) -> Floats | None:
        """Distance in m between measurement and run at each station, (n,)."""
        if not run.ok or len(run.stations) <= index:
            return None
        gaps = run.stations[index] - self.measured[index].values
        lengths: Floats = np.linalg.norm(gaps, axis=1)
        return lengths

    def summary(self) -> dict[str, Any]:
        """Everything as plain data in SI units (the ``--json`` of ``compare``)."""
        return {
            "design": self.design.name,
            "hash": self.design.hash,
            "voxel_size": self.design.voxel_size,
            "solver": self.solver,
            "outside": self.outside or None,
            "note": self.note,
            "warnings": [warning.summary() for warning in self.warnings],
            "runs": [self._run(run) for run in self.runs],
            "estimates": [
                {
                    "quantity": each.quantity,
                    "series": each.series,
                    "runs": list(each.runs),
                    "order": each.estimate.order,
                    "limit": each.estimate.limit,
                    "error": each.estimate.error,
                    "basis": each.estimate.basis,
                }
                for each in self.estimates
            ],
            "agreement": {name: self.agrees(name) for name in self.quantities},
        }

    def _run(self, run: Run) -> dict[str, Any]:
        measured = {}
        for index, judged in enumerate(self.measured):
            errors = self.errors(run, index)
            if errors is not None:
                mean, largest = float(errors.mean()), float(errors.max())
                measured[judged.name] = {"mean_error": mean, "max_error": largest}
        return {
            "label": run.label,
            "code": run.code,
            "voxel_size": run.voxel_size,
            "split": run.split,
            "cells": run.cells,
            "status": run.status,
            "message": run.message,
            "detail": run.detail,
            "seconds": run.seconds,
            "quantities": {
                name: run.quantities[name].value
                for name in self.quantities
                if name in run.quantities
            },
            "measured": measured,
        }
