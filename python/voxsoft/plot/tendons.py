"""Tendons in pictures of bodies: lines drawn through the material."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from voxsoft.plot.camera import Camera
from voxsoft.plot.style import SERIES
from voxsoft.simulation.setup.tendons import TendonState

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_tendons(
    axes: Axes, tendons: Mapping[str, TendonState], camera: Camera, finer: int
) -> None:
    """Draw each tendon: a triangle where it is pulled, a dot at its anchor, dashed where slack.

    Parameters
    ----------
    axes
        Axes of the picture, whose coordinates are its pixels.
    tendons
        Tendons of a result, by name.
    camera
        Camera of the picture.
    finer
        Oversampling factor of the picture.
    """
    for number, (name, tendon) in enumerate(tendons.items()):
        across, down = camera.project(tendon.points)[:, :2].T / finer
        color = SERIES[(1 + number) % len(SERIES)]
        line = "--" if tendon.slack > 0.0 else "-"
        axes.plot(across, down, line, color=color, linewidth=1.6, label=name)
        axes.plot(across[:1], down[:1], ">", color=color, markersize=6)
        axes.plot(across[-1:], down[-1:], "o", color=color, markersize=5)
