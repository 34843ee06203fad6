"""Totals over the whole body."""

from __future__ import annotations

from typing import Final

import numpy as np

from voxsoft.metrics.definition import NOT_NEGATIVE, Floats, Metric, SlopeState, State, Target


def _mass(state: State, _: Target) -> float:
    return state.mass


def _volume(state: State, _: Target) -> float:
    return state.mesh.volume


def _elastic_energy(state: State, _: Target) -> float:
    return state.elastic_energy


def _unmoved(state: SlopeState, _: Target) -> Floats:
    """Zero slope, for numbers that no motion changes."""
    return np.zeros_like(state.positions)


def _slope_of_energy(state: SlopeState, _: Target) -> Floats:
    slope: Floats = -state.elastic_forces
    return slope


MASS: Final = Metric("mass", "mass", _mass, _unmoved, bounds=NOT_NEGATIVE)
VOLUME: Final = Metric("volume", "volume", _volume, _unmoved, bounds=NOT_NEGATIVE)
ELASTIC_ENERGY: Final = Metric(
    "elastic_energy", "energy", _elastic_energy, _slope_of_energy, bounds=NOT_NEGATIVE
)
