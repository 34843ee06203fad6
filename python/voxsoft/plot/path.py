"""Picture of a path: its numbers over the varied value."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from voxsoft.comparison.error_bar import ErrorBars
from voxsoft.comparison.path_bars import bars_of
from voxsoft.errors import SimulationError
from voxsoft.plot.quantities import scale_for
from voxsoft.plot.style import BLUE, RED, empty_figure, plain_axes, plain_legend
from voxsoft.records import closest
from voxsoft.simulation import LoadPath

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Most numbers of a picture that was not asked for others.
_MOST: Final = 4


def plot_path(
    path: LoadPath, bars: Sequence[ErrorBars] = (), names: Sequence[str] | None = None
) -> Figure:
    """Draw numbers along a path, with their error bars as bands.

    Parameters
    ----------
    path
        Result of :func:`voxsoft.follow`.
    bars
        Result of :func:`voxsoft.comparison.path_error_bars`; without it there are no bands.
    names
        Columns of the path; default: the objectives and constraints of the design, or else the
        components of displacements that change most.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each number.

    Raises
    ------
    SimulationError
        A column that the path does not have.
    """
    columns = path.columns
    shown = list(names) if names is not None else _chosen(path)
    for name in shown:
        if name not in columns:
            raise SimulationError(name, "is no column of the path", closest(name, columns))
    wide = 2 if len(shown) > 1 else 1
    high = -(-len(shown) // wide)
    figure = empty_figure(4.6 * wide, 3.2 * high)
    panels = figure.subplots(high, wide, squeeze=False).ravel()
    for axes, name in zip(panels, shown, strict=False):
        _draw(axes, path, bars, name)
    for axes in panels[len(shown) :]:
        axes.set_axis_off()
    return figure


def _chosen(path: LoadPath) -> list[str]:
    design, columns = path.design, path.columns
    asked = [*design.objectives, *design.constraints]
    if asked:
        return asked[:_MOST]
    moved = [name for name in columns if name.rpartition(".")[2] in ("x", "y", "z")]
    moved.sort(key=lambda name: -float(np.ptp(columns[name][1])))
    return moved[:_MOST] or ["max_displacement"]


def _draw(axes: Axes, path: LoadPath, bars: Sequence[ErrorBars], name: str) -> None:
    kind, values = path.columns[name]
    scale, across = scale_for(values, kind), scale_for(path.values, path.over.kind)
    x = np.array(path.values) * across.factor
    y = np.array(values) * scale.factor
    axes.plot(x, y, "o-", color=BLUE, markersize=3, label="these voxels")
    known = [(at, bar) for at, bar in zip(x, bars_of(name, bars), strict=False) if bar is not None]
    if known:
        places = [at for at, _ in known]
        middle = np.array([bar.estimate for _, bar in known]) * scale.factor
        error = np.array([bar.error for _, bar in known]) * scale.factor
        axes.fill_between(places, middle - error, middle + error, color=RED, alpha=0.2, linewidth=0)
        axes.plot(places, middle, color=RED, linewidth=1, label="estimate with its error bar")
    if path.status != "ok":
        axes.axvline(x[-1], color=RED, linestyle=":", linewidth=1, label="lost from here on")
    plain_axes(axes, x=across.label(path.over.key), y=scale.label(name))
    plain_legend(axes)
