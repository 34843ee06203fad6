"""Metrics of a body for its casting: undercuts for the molds, and the thinnest wall."""

from __future__ import annotations

from typing import Final

from voxsoft.fabrication.planning import undercut_of
from voxsoft.fabrication.walls import min_wall_thickness
from voxsoft.metrics.definition import NOT_NEGATIVE, Metric, State, Target


def _undercut(state: State, target: Target) -> float:
    axis = None if target.axis is None else "xyz".index(target.axis)
    return undercut_of(state.design, axis)


def _min_wall_thickness(state: State, _: Target) -> float:
    return min_wall_thickness(state.design)


#: Steps with the shape: zero for all bodies that molds release.
UNDERCUT: Final = Metric(
    "undercut",
    "volume",
    _undercut,
    None,
    takes=frozenset({"axis"}),
    is_costly=True,
    bounds=NOT_NEGATIVE,
)
MIN_WALL_THICKNESS: Final = Metric(
    "min_wall_thickness",
    "length",
    _min_wall_thickness,
    None,
    is_costly=True,
    bounds=NOT_NEGATIVE,
)
