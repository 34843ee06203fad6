"""Metrics of the tangent at an equilibrium: compliance, stiffness and natural frequency."""

from __future__ import annotations

from typing import Final

import numpy as np

from voxsoft.metrics.definition import NOT_NEGATIVE, Metric, State, Target
from voxsoft.metrics.probes import place_of_target


def _compliance(state: State, target: Target) -> float:
    """Compliance along an axis, or along the softest direction, by the largest eigenvalue."""
    matrix = state.compliance_at(place_of_target(state, target))
    if target.axis is not None:
        number = "xyz".index(target.axis)
        return float(matrix[number, number])
    return float(np.linalg.eigvalsh((matrix + matrix.T) / 2.0)[-1])


def _stiffness(state: State, target: Target) -> float:
    return 1.0 / _compliance(state, target)


def _frequency(state: State, _: Target) -> float:
    return state.natural_frequency()


COMPLIANCE: Final = Metric(
    "compliance",
    "compliance",
    _compliance,
    slope=None,
    needs=frozenset({"probe"}),
    takes=frozenset({"axis"}),
)
STIFFNESS: Final = Metric(
    "stiffness",
    "stiffness",
    _stiffness,
    slope=None,
    needs=frozenset({"probe"}),
    takes=frozenset({"axis"}),
)
NATURAL_FREQUENCY: Final = Metric(
    "natural_frequency", "rate", _frequency, slope=None, is_costly=True, bounds=NOT_NEGATIVE
)
