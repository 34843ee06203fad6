"""Pictures of studies: parameter space with the objective in color, history, and Pareto front."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from numpy.typing import NDArray

from voxsoft.errors import StudyError
from voxsoft.metrics import METRICS
from voxsoft.plot.quantities import Scale, scale_for
from voxsoft.plot.style import (
    BLUE,
    COLOR_MAP,
    GRAY,
    PALE,
    RED,
    empty_figure,
    plain_axes,
    plain_legend,
)
from voxsoft.records import closest
from voxsoft.simulation.runs.over import Over
from voxsoft.study import StudyResult, Trial

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Function from trials to their coordinates on the axes, one array for each axis.
Places = Callable[[Sequence[Trial]], list[NDArray[np.float64]]]

# Most values of a grid that become ticks.
_MOST_TICKS = 8

# Markers of trials without a number: hollow, so that none is taken for a low value.
_MARKERS: dict[str, str] = {
    "no-cavity": "o",
    "disconnected": "s",
    "diverged": "x",
    "not-at-rest": "^",
    "failed": "+",
}


def plot_paths(result: StudyResult, objective: str | None = None) -> Figure:
    """Draw an objective of every design along the path of the study.

    Parameters
    ----------
    result
        A study with `over`.
    objective
        Name of the objective; default: the first.

    Returns
    -------
    matplotlib.figure.Figure
        A line for each design, in the color of the number that counts; the best is red, and a path
        that was lost ends in a cross.

    Raises
    ------
    StudyError
        An unknown objective, or a study without paths.
    """
    name = _objective(result, objective)
    followed = [trial for trial in result.trials if trial.path]
    if result.over is None or not followed:
        raise StudyError("trials", "there is no path to draw", "run a study with over")
    over = Over.read(result.over)
    across = scale_for(over.values, over.kind)
    numbers = [value for trial in followed for value in trial.path[name]]
    scale = scale_for(numbers, _kind(result, name))
    figure = empty_figure(6.4, 4.4)
    axes = figure.add_subplot()
    scored = [trial.objectives[name] * scale.factor for trial in followed if trial.objectives]
    colors = ScalarMappable(Normalize(min(scored, default=0), max(scored, default=1)), COLOR_MAP)
    for trial in followed:
        x = np.array(trial.path[over.key]) * across.factor
        y = np.array(trial.path[name]) * scale.factor
        if trial.objectives:
            color = colors.to_rgba(np.array(trial.objectives[name] * scale.factor))
            axes.plot(x, y, color=color, linewidth=1.2)
        else:
            axes.plot(x, y, color=GRAY, linewidth=0.8)
            axes.plot(x[-1:], y[-1:], "x", color=GRAY)
    if result.best is not None:
        x = np.array(result.best.path[over.key]) * across.factor
        y = np.array(result.best.path[name]) * scale.factor
        label = f"best: number {result.best.number}"
        axes.plot(x, y, "o-", color=RED, markersize=3, label=label)
        plain_legend(axes)
    if scored:
        bar: Any = figure.colorbar(colors, ax=axes, shrink=0.7, pad=0.04, aspect=24)
        bar.set_label(scale.label(name), fontsize=10)
        bar.outline.set_visible(False)
    plain_axes(axes, x=across.label(over.key), y=scale.label(name))
    return figure


def plot_scatter(result: StudyResult, objective: str | None = None) -> Figure:
    """Draw every trial in the space of its parameters, the objective in color (paper, Fig. 6).

    Parameters
    ----------
    result
        A finished study of one, two or three parameters; of more, the first three are axes.
    objective
        Name of the objective; default: the first.

    Returns
    -------
    matplotlib.figure.Figure
        Trials without an objective are hollow and gray, one marker for each status; the best
        trial has a ring.

    Raises
    ------
    StudyError
        An unknown objective, or a study without a trial.
    """
    name = _objective(result, objective)
    if not result.trials:
        raise StudyError("trials", "there are none to draw", "run the study")
    names = result.parameters[:3]
    in_space = len(names) == 3
    figure = empty_figure(7.2, 5.4) if in_space else empty_figure(6.4, 4.4)
    axes: Any = figure.add_subplot(projection="3d" if in_space else None)
    places = _places_on(axes, result, names)
    scored = [trial for trial in result.trials if trial.objectives]
    scale = scale_for([trial.objectives[name] for trial in scored], _kind(result, name))
    if len(names) < 3:
        plain_axes(axes, x=axes.get_xlabel(), y=axes.get_ylabel() or scale.label(name))
    _draw_lost(axes, result, places)
    if scored:
        values = np.array([trial.objectives[name] for trial in scored]) * scale.factor
        where = places(scored) if len(names) > 1 else [*places(scored), values]
        depth = {"depthshade": False} if in_space else {}
        marks = axes.scatter(
            *where, c=values, cmap=COLOR_MAP, s=46, edgecolors="white", linewidths=0.4, **depth
        )
        if len(names) > 1:
            bar: Any = figure.colorbar(marks, ax=axes, shrink=0.7, pad=0.1, aspect=24)
            bar.set_label(scale.label(name), fontsize=10)
            bar.outline.set_visible(False)
        _ring_best(axes, result, name, places, scale, depth)
    if in_space:
        axes.view_init(elev=22, azim=-58)
        axes.set_box_aspect(None, zoom=0.92)
    if axes.get_legend_handles_labels()[0]:
        corner = {"loc": "upper left", "bbox_to_anchor": (-0.08, 1.0)}
        above = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "ncols": 3}
        axes.legend(frameon=False, fontsize=9, **(corner if in_space else above))
    return figure


def plot_history(result: StudyResult, objective: str | None = None) -> Figure:
    """Draw the objective of every trial in order, and the best so far.

    Parameters
    ----------
    result
        A finished study.
    objective
        Name of the objective; default: the first.

    Returns
    -------
    matplotlib.figure.Figure
        Trials that break a constraint are hollow; trials without an objective stand as gray
        ticks on the axis.

    Raises
    ------
    StudyError
        An unknown objective.
    """
    name = _objective(result, objective)
    figure = empty_figure(6.4, 3.6)
    axes = figure.add_subplot()
    numbers, values, best = result.history(name)
    broken = [t for t in result.trials if t.objectives and not t.feasible]
    lost = [trial.number for trial in result.trials if not trial.objectives]
    every = [*values, *(t.objectives[name] for t in broken)]
    scale = scale_for(every, _kind(result, name))
    axes.scatter(numbers, values * scale.factor, s=16, color=BLUE, label="trial", zorder=2)
    if broken:
        axes.scatter(
            [t.number for t in broken],
            [t.objectives[name] * scale.factor for t in broken],
            s=16,
            facecolors="none",
            edgecolors=BLUE,
            label="breaks a constraint",
        )
    axes.step(numbers, best * scale.factor, where="post", color=RED, linewidth=2, label="best")
    if lost:
        axes.plot(
            lost,
            np.zeros(len(lost)),
            "|",
            color=GRAY,
            markersize=9,
            transform=axes.get_xaxis_transform(),
            clip_on=False,
            label="no result",
        )
    plain_axes(axes, x="trial", y=scale.label(name))
    plain_legend(axes, ncols=4, loc="lower left", bbox_to_anchor=(0.0, 1.0))
    return figure


def plot_pareto(result: StudyResult, objectives: tuple[str, str] | None = None) -> Figure:
    """Draw two objectives against each other, with the trials that no other beats.

    Parameters
    ----------
    result
        A finished study of two or more objectives.
    objectives
        Names of the two; default: the first two.

    Raises
    ------
    StudyError
        Fewer than two objectives, or an unknown one.
    """
    if objectives is None and len(result.objectives) < 2:
        raise StudyError("objectives", "there is one; a front needs two", "use plot_history")
    first, second = objectives or tuple(result.objectives)[:2]
    names = [_objective(result, first), _objective(result, second)]
    figure = empty_figure(5.6, 4.4)
    axes = figure.add_subplot()
    feasible = [trial for trial in result.trials if trial.feasible]
    front = sorted(result.pareto_front, key=lambda trial: trial.objectives[names[0]])
    scales = [
        scale_for([trial.objectives[name] for trial in feasible], _kind(result, name))
        for name in names
    ]

    def columns(trials: Sequence[Trial]) -> list[NDArray[np.float64]]:
        return [
            np.array([trial.objectives[name] for trial in trials]) * scale.factor
            for name, scale in zip(names, scales, strict=True)
        ]

    x, y = columns(feasible)
    axes.scatter(x, y, s=18, color=PALE, edgecolors=GRAY, linewidths=0.5, label="trial")
    x, y = columns(front)
    axes.plot(x, y, "o-", color=RED, markersize=5, linewidth=1.2, label="Pareto front")
    across, along = (
        f"{scale.label(name)}, {_goal(result, name)}"
        for name, scale in zip(names, scales, strict=True)
    )
    plain_axes(axes, x=across, y=along)
    plain_legend(axes, ncols=2, loc="lower left", bbox_to_anchor=(0.0, 1.0))
    return figure


def _objective(result: StudyResult, name: str | None) -> str:
    if name is None:
        return next(iter(result.objectives))
    if name not in result.objectives:
        raise StudyError("objective", f'"{name}" is not known', closest(name, result.objectives))
    return name


def _kind(result: StudyResult, objective: str) -> str:
    """Return the kind of quantity of an objective; empty where a study measures its own metrics."""
    metric = METRICS.get(result.objectives[objective].metric)
    return "" if metric is None else metric.kind


def _goal(result: StudyResult, objective: str) -> str:
    return f"to {result.objectives[objective].direction}"


def _places_on(
    axes: Any,  # noqa: ANN401 - axes of two or three dimensions
    result: StudyResult,
    names: tuple[str, ...],
) -> Places:
    """Label an axis for each parameter; return the function that places trials on them."""
    columns: dict[int, list[float]] = {trial.number: [] for trial in result.trials}
    for name, direction in zip(names, "xyz", strict=False):
        values = [trial.parameters[name] for trial in result.trials]
        scale = (
            scale_for(values, result.kinds.get(name, "")) if _is_numeric(values) else Scale(1.0, "")
        )
        numbers = _numbers(values) * scale.factor
        ticks = np.unique(numbers)
        if not _is_numeric(values):
            texts = [str(value) for value in dict.fromkeys(values)]
            getattr(axes, f"set_{direction}ticks")(ticks, texts)
        elif len(ticks) <= _MOST_TICKS:
            getattr(axes, f"set_{direction}ticks")(ticks)
        getattr(axes, f"set_{direction}label")(scale.label(name), fontsize=10)
        for trial, number in zip(result.trials, numbers, strict=True):
            columns[trial.number].append(float(number))
    axes.tick_params(labelsize=9)
    return lambda trials: list(np.array([columns[trial.number] for trial in trials]).T)


def _is_numeric(values: Sequence[object]) -> bool:
    return all(isinstance(value, int | float) for value in values)


def _numbers(values: Sequence[Any]) -> NDArray[np.float64]:
    """Return numbers as they are; number choices in the order in which they appear."""
    if _is_numeric(values):
        return np.array(values, dtype=np.float64)
    order = {value: float(index) for index, value in enumerate(dict.fromkeys(values))}
    return np.array([order[value] for value in values])


def _draw_lost(
    axes: Any,  # noqa: ANN401 - axes of two or three dimensions
    result: StudyResult,
    places: Places,
) -> None:
    """Draw the trials without a number, a marker for each status."""
    for status, marker in _MARKERS.items():
        lost = [trial for trial in result.trials if trial.status == status]
        if not lost:
            continue
        where, options = places(lost), {}
        if len(where) == 1:  # the other axis is the objective, which they do not have
            where = [*where, np.zeros(len(lost))]
            options = {"transform": axes.get_xaxis_transform(), "clip_on": False}
        hollow = {"facecolors": "none", "edgecolors": GRAY}
        paint = {"color": GRAY} if marker in "x+" else hollow
        label = f"{status} ({len(lost)})"
        axes.scatter(*where, marker=marker, s=30, linewidths=0.8, label=label, **paint, **options)


def _ring_best(
    axes: Any,  # noqa: ANN401 - axes of two or three dimensions
    result: StudyResult,
    objective: str,
    places: Places,
    scale: Scale,
    depth: Mapping[str, bool],
) -> None:
    ranking = result.ranked_by(objective)
    if not ranking:
        return
    best = ranking[0].objectives[objective] * scale.factor
    where = places([ranking[0]])
    axes.scatter(
        *(where if len(where) > 1 else [*where, [best]]),
        s=150,
        facecolors="none",
        edgecolors=RED,
        linewidths=2,
        label=f"best: {best:.4g} {scale.unit}".rstrip(),
        **depth,
    )
