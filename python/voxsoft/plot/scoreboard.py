"""Picture of the scoreboard: positions of measurements in their intervals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from voxsoft.plot.style import BLUE, PALE, RED, empty_figure, plain_axes
from voxsoft.scoreboard import Scoreboard

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Half-widths from the prediction at which the picture ends; farther measurements are arrows at
#: its edge.
_FARTHEST: Final = 4.0
#: Number of rows from which on they are closer: height of a row in inches, and font size.
_MANY: Final = 40
_ROOMY: Final = (0.24, 8.0)
_CLOSE: Final = (0.15, 6.0)


def plot_scoreboard(board: Scoreboard) -> Figure:
    """Draw the position of every measurement in its interval, a row for each.

    Parameters
    ----------
    board
        Result of :func:`voxsoft.scoreboard.predictions_in`.

    Returns
    -------
    matplotlib.figure.Figure
        The band is the interval; blue is inside, and an arrow marks a number beyond the edge.
    """
    count = max(1, len(board.predictions))
    height, size = _ROOMY if count < _MANY else _CLOSE
    figure = empty_figure(8.4, 1.2 + height * count)
    axes = figure.subplots()
    off = np.array([(p.measured - p.predicted) / (p.half_width or 1.0) for p in board.predictions])
    rows = np.arange(len(board.predictions))
    shown = np.clip(off, -_FARTHEST, _FARTHEST)
    inside = np.array([each.inside for each in board.predictions], dtype=bool)
    axes.axvspan(-1, 1, color=PALE, alpha=0.6, linewidth=0)
    axes.axvline(0, color="black", linewidth=0.8)
    for chosen, color, mark in (
        (inside, BLUE, "o"),
        (~inside & (np.abs(off) <= _FARTHEST), RED, "o"),
        (off > _FARTHEST, RED, ">"),
        (off < -_FARTHEST, RED, "<"),
    ):
        axes.plot(shown[chosen], rows[chosen], mark, color=color, markersize=5)
    labels = [f"{each.case}: {each.name}" for each in board.predictions]
    axes.set_yticks(rows, labels, fontsize=size)
    axes.set_ylim(count - 0.5, -0.5)
    axes.set_xlim(-_FARTHEST * 1.05, _FARTHEST * 1.05)
    share = f"{100 * board.coverage:.0f} % inside, mean width {100 * board.width:.0f} %"
    plain_axes(axes, x="measured less predicted, in half-widths of the 90 % interval", y="")
    axes.set_title(share, fontsize=10, loc="left")
    return figure
