"""Pictures of calibrations: the search, the fitted shape, and the profiles of the parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from voxsoft.calibration import Calibration, Fit, Profile
from voxsoft.plot.quantities import Scale, scale_for
from voxsoft.plot.style import (
    BLACK,
    BLUE,
    GRAY,
    PALE,
    RED,
    SERIES,
    SKY,
    empty_figure,
    plain_axes,
    plain_legend,
    plain_log_axis,
)
from voxsoft.units import format_quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_MM = 1e3

# Upper limit of the axis of profiles, in multiples of the best mean error.
_HIGHEST = 2.0


def plot_fitness(calibration: Calibration) -> Figure:
    """Draw fitness and parameters over the generations of the search (paper, Fig. 3).

    Parameters
    ----------
    calibration
        Result of :func:`voxsoft.calibration.calibrate`.

    Returns
    -------
    matplotlib.figure.Figure
        Above: best and mean fitness of each generation. Below, on a logarithmic axis over the
        whole range of the search: the parameters of its best candidate, and as a dashed line
        the value after refinement.
    """
    figure = empty_figure(6.4, 5.6)
    above, below = figure.subplots(2, 1, sharex=True)
    history = calibration.history
    generations = np.arange(1, len(history) + 1)
    above.plot(generations, [g.best_fitness for g in history], color=BLUE, label="best")
    above.plot(generations, [g.mean_fitness for g in history], color=RED, ls="--", label="mean")
    plain_axes(above, x="", y="fitness")
    plain_legend(above, loc="lower right")
    # Constants without a unit share the axis only where there are no others.
    kinds = calibration.kinds
    kind = "modulus" if "modulus" in kinds.values() else "number"
    drawn = [name for name in calibration.parameters if kinds[name] == kind]
    ranges = [bound for name in drawn for bound in calibration.bounds[name]]
    scale = scale_for(min(ranges), kind)
    for name, color in zip(drawn, SERIES, strict=False):
        values = np.array([g.parameters[name] for g in history]) * scale.factor
        below.semilogy(generations, values, color=color, label=name)
        refined = calibration.parameters[name] * scale.factor
        below.axhline(refined, color=color, ls=":", linewidth=1.2)
        below.annotate(
            f"{refined:.3g}",
            (1.0, refined),
            xycoords=("axes fraction", "data"),
            xytext=(4, 0),
            textcoords="offset points",
            va="center",
            fontsize=9,
            color=color,
        )
    below.set_ylim(min(ranges) * scale.factor, max(ranges) * scale.factor)
    plain_log_axis(below.yaxis)
    plain_axes(below, x="generation", y=scale.label(f"{kind} of the best"))
    plain_legend(below, loc="best")
    return figure


def plot_shape(calibration: Calibration) -> Figure:
    """Draw real and simulated shape over each other, with the error of each station (Fig. 4).

    Parameters
    ----------
    calibration
        Result of :func:`voxsoft.calibration.calibrate`.

    Returns
    -------
    matplotlib.figure.Figure
        A row for each experiment: stations as they were measured and simulated, joined by their
        error vectors; beside it the length of each vector in mm, its mean as a line, and the
        largest in percent of the measured sag.
    """
    rows = len(calibration.fits)
    figure = empty_figure(8.4, 3.2 * rows + 0.4)
    grid = figure.subplots(rows, 2, squeeze=False, width_ratios=[1.25, 1.0])
    for (left, right), fit in zip(grid, calibration.fits, strict=True):
        _draw_shape(left, fit)
        _draw_errors(right, fit)
    return figure


def plot_profiles(calibration: Calibration) -> Figure:
    """Draw the smallest possible error for every value of each parameter.

    Parameters
    ----------
    calibration
        Result of :func:`voxsoft.calibration.calibrate`.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each parameter: the profile of the mean error, the best value, and the 95 %
        interval shaded. A flat profile is a parameter that the data do not determine.
    """
    profiles = calibration.profiles
    count = max(len(profiles), 1)
    figure = empty_figure(4.6 * count, 3.7)
    panels = figure.subplots(1, count, squeeze=False, sharey=True)[0]
    for axes, profile in zip(panels, profiles, strict=False):
        _draw_profile(axes, profile, calibration.bounds[profile.name])
    if not profiles:
        plain_axes(panels[0], x="", y="", title="no profiles: identify was off")
        return figure
    # Far from the best value errors grow without bound; only the flatness of the bottom matters.
    panels[0].set_ylim(0.0, _HIGHEST * calibration.mean_error * _MM + 1e-9)
    panels[0].set_ylabel("smallest mean error (mm)", fontsize=10)
    plain_legend(panels[0], loc="lower left")
    return figure


def _draw_shape(axes: Axes, fit: Fit) -> None:
    across, along, x_label, y_label = _planes(fit)
    measured, simulated = fit.deviation.measured, fit.deviation.simulated
    x, y = _columns(fit, measured, across, along)
    u, v = _columns(fit, simulated, across, along)
    axes.plot([x, u], [y, v], color=GRAY, linewidth=0.9, zorder=1)
    axes.plot(x, y, "o", color=BLACK, markersize=5, label="measured")
    axes.plot(u, v, "-", color=BLUE, linewidth=1.6, marker=".", markersize=7, label="simulated")
    title = fit.experiment.name
    if fit.deviation.scale != 1.0:
        title += f", simulated × {fit.deviation.scale:.3f}"
    plain_axes(axes, x=x_label, y=y_label, title=title)
    if "arc" not in x_label:
        axes.set_aspect("equal", adjustable="datalim")
    plain_legend(axes, loc="best")


def _planes(fit: Fit) -> tuple[int | None, int, str, str]:
    """Choose the measured numbers to draw: two of them in space, or one over the stations."""
    quantities = fit.experiment.measurement.quantities
    if len(quantities) == 1:
        return None, 0, "arc from the clamp (mm)", f"{quantities[0]} (mm)"
    return 0, len(quantities) - 1, f"{quantities[0]} (mm)", f"{quantities[-1]} (mm)"


def _columns(fit: Fit, values: Floats, across: int | None, along: int) -> tuple[Floats, Floats]:
    if across is not None:
        return values[:, across] * _MM, values[:, along] * _MM
    arcs = fit.experiment.measurement.arcs
    stations = np.arange(1.0, len(values) + 1) if arcs is None else arcs * _MM
    return stations, values[:, along] * _MM


def _draw_errors(axes: Axes, fit: Fit) -> None:
    errors = fit.errors * _MM
    names = [name.removeprefix("arc ").removesuffix(" mm") for name in _stations(fit)]
    positions = np.arange(len(errors))
    axes.bar(positions, errors, color=SKY, edgecolor=BLUE, linewidth=0.6, width=0.75)
    axes.axhline(errors.mean(), color=RED, linewidth=1.2)
    axes.set_xticks(positions, names)
    arcs = fit.experiment.measurement.arcs is not None
    x = "station, arc from the clamp (mm)" if arcs else "station"
    largest = f"{errors.max():.2f} mm ({fit.percent.max():.0f} %)"
    plain_axes(axes, x=x, y="error (mm)", title=f"mean {errors.mean():.2f}, largest {largest}")
    if not arcs:
        axes.tick_params(axis="x", rotation=45)


def _stations(fit: Fit) -> tuple[str, ...]:
    names: tuple[str, ...] = fit.experiment.measurement.station_names
    return names


def _draw_profile(axes: Axes, profile: Profile, bounds: tuple[float, float]) -> None:
    scale: Scale = scale_for(profile.best, profile.kind)
    values, errors = profile.values * scale.factor, profile.errors * _MM
    low, high = (bound * scale.factor for bound in bounds)
    ends = (
        low if profile.low is None else profile.low * scale.factor,
        high if profile.high is None else profile.high * scale.factor,
    )
    axes.axvspan(*ends, color=PALE, alpha=0.6, linewidth=0, label="95 % interval")
    axes.semilogx(values, errors, "o-", color=BLUE, markersize=4, label="profile")
    axes.axvline(profile.best * scale.factor, color=RED, linewidth=1.2, label="best")
    best = format_quantity(float(f"{profile.best:.4g}"), profile.kind)
    verdict = "identifiable" if profile.identifiable else "not identifiable"
    plain_axes(axes, x=scale.label(profile.name), y="", title=f"{profile.name} = {best}: {verdict}")
    plain_log_axis(axes.xaxis)
