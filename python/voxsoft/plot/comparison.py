"""Pictures of comparisons: agreement of runs, convergence with the size of voxels, and times."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from voxsoft.comparison import Comparison, Run
from voxsoft.plot.quantities import scale_for
from voxsoft.plot.style import (
    BLACK,
    BLUE,
    GRAY,
    RED,
    SERIES,
    empty_figure,
    plain_axes,
    plain_legend,
    plain_log_axis,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_MARKERS = "osD^vPX"
# Most quantities of a kind that can be read under each other; the largest are kept.
_MOST = 14
_ORDER = {"length": 0, "angle": 1, "volume": 2, "force": 3}
# Least span of an axis, as a share of its largest number, so that noise does not look like much.
_NARROWEST = 0.02
# Least relative change from size to size of a number that is drawn.
_LEVEL = 1e-4
# Distance of error bars that stand side by side, as a share of the largest voxel.
_ASIDE = 0.03


def plot_agreement(comparison: Comparison) -> Figure:
    """Draw every quantity with the value of each run over each other, with error estimates.

    Parameters
    ----------
    comparison
        Result of :func:`voxsoft.compare`.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each kind of quantity. Bars are the estimated discretization errors of the
        solver (on split voxels) and of the outside code.
    """
    runs = comparison.side_by_side
    kinds: dict[str, list[str]] = {}
    sizes = {
        name: max(abs(run.quantities[name].value) for run in runs)
        for name in comparison.quantities
        if all(name in run.quantities for run in runs)
    }
    for name in sorted(sizes, key=lambda name: -sizes[name]):
        names = kinds.setdefault(runs[0].quantities[name].kind, [])
        if len(names) < _MOST:
            names.append(name)
    # Displacements come first, at any size of the numbers.
    kinds = dict(sorted(kinds.items(), key=lambda item: _ORDER.get(item[0], len(_ORDER))))
    heights = [1.1 + 0.34 * len(names) for names in kinds.values()] or [2.0]
    figure = empty_figure(8.4, 0.5 + sum(heights))
    panels = figure.subplots(len(heights), 1, squeeze=False, height_ratios=heights)[:, 0]
    for axes, (kind, names) in zip(panels, kinds.items(), strict=False):
        order = [name for name in comparison.quantities if name in names]
        _draw_panel(axes, comparison, runs, kind, order)
    if kinds:
        panels[0].legend(
            frameon=False, fontsize=9, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3
        )
    else:
        plain_axes(panels[0], x="", y="", title="no run came to rest")
    return figure


def _draw_panel(
    axes: Axes, comparison: Comparison, runs: tuple[Run, ...], kind: str, names: list[str]
) -> None:
    scale = scale_for([run.quantities[name].value for run in runs for name in names], kind)
    rows = np.arange(len(names), dtype=np.float64)
    for index, run in enumerate(runs):
        values = np.array([run.quantities[name].value for name in names]) * scale.factor
        errors = np.array([_error(comparison, run, name) for name in names]) * scale.factor
        # A little apart, so that equal answers do not hide each other.
        places = rows + 0.16 * (index - (len(runs) - 1) / 2)
        color, marker = SERIES[index % len(SERIES)], _MARKERS[index % len(_MARKERS)]
        axes.errorbar(
            values,
            places,
            xerr=np.where(np.isfinite(errors), errors, 0.0),
            fmt=marker,
            color=color,
            markersize=5,
            markerfacecolor="none",
            capsize=3,
            linewidth=1.2,
            label=run.label,
        )
    low, high = axes.get_xlim()
    narrow = _NARROWEST * max(abs(low), abs(high)) - (high - low)
    if narrow > 0:
        axes.set_xlim(low - narrow / 2, high + narrow / 2)
    axes.set_yticks(rows, names)
    axes.set_ylim(len(names) - 0.5, -0.5)
    name = {"length": "displacement", "volume": "growth of cavities"}.get(kind, kind)
    plain_axes(axes, x=scale.label(name), y="")


def _error(comparison: Comparison, run: Run, name: str) -> float:
    if run is comparison.base:
        error = comparison.base_error(name, "split voxels")
        return float("nan") if error is None else error
    if run is comparison.yardstick:
        estimate = comparison.estimate(name, "outside, split voxels")
        return float("nan") if estimate is None else estimate.error
    return float("nan")


def plot_shapes(comparison: Comparison) -> Figure | None:
    """Draw the displaced probes, seen from the side, for every run on the design's own voxels.

    Returns
    -------
    matplotlib.figure.Figure or None
        None where there are fewer than three probes, which make no shape.
    """
    base = comparison.base.result
    if base is None or len(base.places) < 3:
        return None
    rest = np.array(
        [place.weights @ base.mesh.vertices[place.vertices] for place in base.places.values()]
    )
    moved = {run.label: rest + _moved(run, list(base.places)) for run in comparison.side_by_side}
    if not moved:
        return None
    everything = np.concatenate([rest, *moved.values()])
    # The plane of the largest extents, the vertical last.
    spread = np.ptp(everything, axis=0)
    across, along = sorted(np.argsort(spread)[-2:].tolist())
    scale = scale_for(everything, "length")
    figure = empty_figure(7.0, 4.4)
    axes = figure.add_subplot()
    still = rest * scale.factor
    axes.plot(still[:, across], still[:, along], "-", color=GRAY, linewidth=1, label="at rest")
    for index, (label, points) in enumerate(moved.items()):
        seen = points * scale.factor
        axes.plot(
            seen[:, across],
            seen[:, along],
            marker=_MARKERS[index % len(_MARKERS)],
            markerfacecolor="none",
            markersize=6,
            linewidth=1.2,
            color=SERIES[index % len(SERIES)],
            label=label,
        )
    axes.set_aspect("equal", adjustable="datalim")
    plain_axes(axes, x=scale.label("xyz"[across]), y=scale.label("xyz"[along]))
    plain_legend(axes, loc="best")
    return figure


def _moved(run: Run, names: list[str]) -> Floats:
    return np.array([[run.quantities[f"{name} {axis}"].value for axis in "xyz"] for name in names])


def plot_convergence(comparison: Comparison) -> Figure | None:
    """Draw the largest quantity of each kind over the size of voxels, with its estimated limit.

    Returns
    -------
    matplotlib.figure.Figure or None
        None where no series has two runs.
    """
    names: dict[str, str] = {}
    for each in comparison.estimates:
        value, kind, scale, _ = comparison.known(each.quantity)
        if np.ptp(each.estimate.values) < _LEVEL * scale:
            continue
        if kind not in names or abs(value) > abs(comparison.known(names[kind]).value):
            names[kind] = each.quantity
    if not names:
        return None
    figure = empty_figure(4.2 * len(names), 3.9)
    panels = figure.subplots(1, len(names), squeeze=False)[0]
    for axes, (kind, name) in zip(panels, names.items(), strict=True):
        unit = scale_for([comparison.known(name).value], kind)
        chosen = [each for each in comparison.distinguished if each.quantity == name]
        for index, each in enumerate(chosen):
            estimate, color = each.estimate, SERIES[index % len(SERIES)]
            edges = np.array(estimate.sizes) * 1e3
            values = np.array(estimate.values) * unit.factor
            axes.plot(
                edges, values, marker=_MARKERS[index], color=color, label=each.series, linewidth=1.2
            )
            # Series end at the same size: side by side, their bars can be distinguished.
            place = edges[-1] + _ASIDE * edges[0] * (index - (len(chosen) - 1) / 2)
            bar = estimate.error * unit.factor
            axes.errorbar([place], [values[-1]], yerr=bar, color=color, capsize=4, linewidth=1.2)
        axes.set_xlim(left=0.0)
        plain_axes(axes, x="edge of voxels or bricks (mm)", y=unit.label(name))
    lines = panels[0].get_legend_handles_labels()
    figure.legend(*lines, loc="outside upper left", ncols=3, frameon=False, fontsize=9)
    return figure


def plot_times(comparison: Comparison) -> Figure:
    """Draw the seconds of every run, on a logarithmic axis."""
    runs = comparison.runs
    figure = empty_figure(8.4, 0.9 + 0.3 * len(runs))
    axes = figure.add_subplot()
    rows = np.arange(len(runs))
    seconds = [max(run.seconds, 1e-3) for run in runs]
    axes.barh(rows, seconds, color=[BLUE if run.ok else RED for run in runs], height=0.6)
    for row, run, time in zip(rows.tolist(), runs, seconds, strict=True):
        text = f" {run.seconds:.3g} s" + ("" if run.ok else f" ({run.status})")
        axes.text(time, row, text, va="center", fontsize=9, color=BLACK)
    axes.set_xscale("log")
    axes.set_xlim(min(seconds) / 2, max(seconds) * 12)
    plain_log_axis(axes.xaxis)
    axes.set_yticks(rows, [run.label for run in runs])
    axes.invert_yaxis()
    plain_axes(axes, x="time (s)", y="")
    return figure


def plot_errors(comparison: Comparison, index: int = 0) -> Figure | None:
    """Draw the distance of each run from each station of a measurement.

    Parameters
    ----------
    comparison
        Result of :func:`voxsoft.compare`.
    index
        Index of the measurement.

    Returns
    -------
    matplotlib.figure.Figure or None
        None where no run has an answer at the stations.
    """
    judged = comparison.measured[index]
    errors = {run.label: comparison.errors(run, index) for run in comparison.side_by_side}
    known = {label: values for label, values in errors.items() if values is not None}
    if not known:
        return None
    figure = empty_figure(7.6, 3.4)
    axes = figure.add_subplot()
    rows = np.arange(len(judged.stations))
    for number, (label, values) in enumerate(known.items()):
        mean = f"{label}: mean {values.mean() * 1e3:.2f} mm"
        axes.plot(
            rows,
            values * 1e3,
            marker=_MARKERS[number % len(_MARKERS)],
            markerfacecolor="none",
            color=SERIES[number % len(SERIES)],
            label=mean,
        )
    axes.set_xticks(rows, [name.removeprefix("arc ") for name in judged.stations], fontsize=8)
    axes.set_ylim(bottom=0.0)
    plain_axes(axes, x="station", y="distance from the measurement (mm)", title=judged.name)
    axes.legend(frameon=False, fontsize=9)
    return figure
