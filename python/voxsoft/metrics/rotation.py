"""How far a body turns."""

from __future__ import annotations

from typing import Final

import numpy as np

from voxsoft.errors import SimulationError
from voxsoft.geometry import mean_rotation
from voxsoft.metrics.definition import Floats, Metric, SlopeState, State, Target
from voxsoft.metrics.probes import place_of_target


def _value(state: State, target: Target) -> float:
    place = place_of_target(state, target)
    return mean_rotation(state.mesh.vertices, state.positions, place.vertices)


def _slope(state: SlopeState, target: Target) -> Floats:
    vertices = place_of_target(state, target).vertices
    slope = np.zeros_like(state.positions)
    slope[vertices] = _slope_of_angle(state.mesh.vertices[vertices], state.positions[vertices])
    return slope


def _slope_of_angle(rest: Floats, positions: Floats) -> Floats:
    """Derivative of the angle of the best rotation by the positions, (k, 3).

    With ``H = Σ before afterᵀ = Q S``, ``Q`` the rotation and ``S`` symmetric, a change of ``H``
    turns ``Q`` by the skew ``W`` with ``W S + S W = Qᵀ dH - dHᵀ Q``, and the angle about the axis
    ``n`` grows by ``n·w``, ``w`` the axial vector of ``W``.
    """
    before = rest - rest.mean(axis=0)
    after = positions - positions.mean(axis=0)
    left, values, right = np.linalg.svd(before.T @ after)
    handed = np.array([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    turned = left @ np.diag(handed) @ right
    axial = _axial(turned) / 2.0
    sine = float(np.linalg.norm(axial))
    if not sine > 1e-9 or values[1] <= 1e-12 * values[0]:
        raise SimulationError(
            "rotation",
            "is zero or not defined here, where an angle has no derivative",
            "measure it at a probe that turns",
        )
    signed = values * handed
    pairs = signed[:, None] + signed[None, :]
    slope_of_h = np.zeros((3, 3))
    for row, column in np.ndindex(3, 3):
        change = np.zeros((3, 3))
        change[row, column] = 1.0
        twist = turned.T @ change
        skew = right @ (twist - twist.T) @ right.T
        np.fill_diagonal(skew, 0.0)
        turn = right.T @ (skew / np.where(pairs == 0.0, np.inf, pairs)) @ right
        slope_of_h[row, column] = float(_axial(turn) @ axial) / (2.0 * sine)
    slope: Floats = before @ slope_of_h
    return slope


def _axial(matrix: Floats) -> Floats:
    """The vector ``(m₃₂ - m₂₃, m₁₃ - m₃₁, m₂₁ - m₁₂)``: twice that of the skew part."""
    return np.array(
        [
            matrix[2, 1] - matrix[1, 2],
            matrix[0, 2] - matrix[2, 0],
            matrix[1, 0] - matrix[0, 1],
        ]
    )


ROTATION: Final = Metric("rotation", "angle", _value, _slope, needs=frozenset({"probe"}))
