"""Displacement of a probe, and the largest of a body."""

from __future__ import annotations

from typing import Final

import numpy as np

from voxsoft.geometry import mean_displacement
from voxsoft.metrics.definition import NOT_NEGATIVE, Floats, Metric, SlopeState, State, Target
from voxsoft.metrics.probes import place_of_target
from voxsoft.metrics.vectors import component, direction


def _moved(state: State, target: Target) -> Floats:
    place = place_of_target(state, target)
    return mean_displacement(state.mesh.vertices, state.positions, place.vertices, place.weights)


def _at_probe(state: State, target: Target) -> float:
    return component(_moved(state, target), target)


def _slope_at_probe(state: SlopeState, target: Target) -> Floats:
    place = place_of_target(state, target)
    slope = np.zeros_like(state.positions)
    along = direction(_moved(state, target), target)
    np.add.at(slope, place.vertices, np.outer(place.weights, along))
    return slope


def _largest(state: State, _: Target) -> float:
    return float(np.linalg.norm(state.positions - state.mesh.vertices, axis=1).max())


def _slope_of_largest(state: SlopeState, target: Target) -> Floats:
    slope = np.zeros_like(state.positions)
    moved = state.positions - state.mesh.vertices
    farthest = int(np.linalg.norm(moved, axis=1).argmax())
    slope[farthest] = direction(moved[farthest], target)
    return slope


DISPLACEMENT: Final = Metric(
    "displacement",
    "length",
    _at_probe,
    _slope_at_probe,
    needs=frozenset({"probe"}),
    takes=frozenset({"axis"}),
)
MAX_DISPLACEMENT: Final = Metric(
    "max_displacement", "length", _largest, _slope_of_largest, bounds=NOT_NEGATIVE
)
