"""Pictures of control: step responses, Bode plots, closed loops."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxsoft.plot.quantities import scale_for
from voxsoft.plot.style import (
    BLUE,
    GRAY,
    RED,
    empty_figure,
    plain_axes,
    plain_legend,
    plain_log_axis,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from voxsoft.control import FrequencyResponse, StepResponse, Track


def plot_step(response: StepResponse) -> Figure:
    """Draw a step response, with the first-order response with a delay nearest to it.

    Parameters
    ----------
    response
        Result of :func:`voxsoft.control.step_response`.
    """
    figure = empty_figure(5.0, 3.2)
    axes = figure.add_subplot()
    scale = scale_for(response.values, response.kind)
    axes.plot(response.times, response.values * scale.factor, color=BLUE, label=response.output)
    gain, constant, delay = response.first_order
    late = np.clip(response.times - delay, 0.0, None)
    rise = gain * (response.after - response.before) * (1.0 - np.exp(-late / constant))
    label = f"first order: {constant:.3g} s, delay {delay:.3g} s"
    nearest = (response.values[0] + rise) * scale.factor
    axes.plot(response.times, nearest, color=GRAY, linestyle="--", label=label)
    plain_axes(axes, x="time (s)", y=scale.label(response.output))
    plain_legend(axes)
    return figure


def plot_bode(response: FrequencyResponse) -> Figure:
    """Draw gain and phase over frequency.

    Parameters
    ----------
    response
        Result of :func:`voxsoft.control.frequency_response`.
    """
    figure = empty_figure(5.0, 4.2)
    upper, lower = figure.subplots(2, 1, sharex=True)
    upper.semilogx(response.frequencies, response.decibels, color=BLUE, marker="o", markersize=3)
    upper.axhline(-3.0, color=GRAY, linestyle="--", linewidth=0.8)
    title = f"{response.output} by {response.command}, {response.distortion:.2%} not linear"
    plain_axes(upper, x="", y="gain (dB)", title=title)
    degrees = np.degrees(response.phase)
    lower.semilogx(response.frequencies, degrees, color=BLUE, marker="o", markersize=3)
    plain_axes(lower, x="frequency (Hz)", y="phase (°)")
    plain_log_axis(lower.xaxis)
    return figure


def plot_track(track: Track) -> Figure:
    """Draw target, quantity and command of a closed loop over time.

    Parameters
    ----------
    track
        Result of :func:`voxsoft.control.track`.
    """
    figure = empty_figure(5.0, 4.2)
    upper, lower = figure.subplots(2, 1, sharex=True)
    scale = scale_for(np.array([track.values, track.targets]), track.kind)
    upper.plot(
        track.times, track.targets * scale.factor, color=GRAY, linestyle="--", label="target"
    )
    upper.plot(track.times, track.values * scale.factor, color=BLUE, label=track.output)
    plain_axes(upper, x="", y=scale.label(track.output))
    plain_legend(upper)
    scale = scale_for(track.commands, track.command_kind)
    lower.step(track.times, track.commands * scale.factor, where="pre", color=RED)
    plain_axes(lower, x="time (s)", y=scale.label(track.command))
    return figure
