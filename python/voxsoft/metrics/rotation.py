"""Mean rotation at a probe."""

from __future__ import annotations

from typing import Final

import numpy as np

from voxsoft.errors import SimulationError
from voxsoft.geometry import mean_rotation_vector
from voxsoft.metrics.definition import Floats, Metric, SlopeState, State, Target
from voxsoft.metrics.probes import place_of_target
from voxsoft.metrics.vectors import component, direction

#: rad; below this the series of the inverse Jacobian is exact to rounding in its first term.
SMALL: Final = 1e-4


def _value(state: State, target: Target) -> float:
    place = place_of_target(state, target)
    turned = mean_rotation_vector(state.mesh.vertices, state.positions, place.vertices)
    return component(turned, target)


def _slope(state: SlopeState, target: Target) -> Floats:
    vertices = place_of_target(state, target).vertices
    rest, positions = state.mesh.vertices, state.positions
    slope = np.zeros_like(positions)
    vector = mean_rotation_vector(rest, positions, vertices)
    by_vector = direction(vector, target)
    slope[vertices] = _slope_of_turn(rest[vertices], positions[vertices], vector, by_vector)
    return slope


def _slope_of_turn(rest: Floats, positions: Floats, vector: Floats, by_vector: Floats) -> Floats:
    """Differentiate a number by the positions, (k, 3), given its derivative by the rotation vector.

    With ``H = Σ before afterᵀ = Q S``, ``Q`` the rotation of rows and ``S`` symmetric, a change of
    ``H`` turns ``Q`` by the skew ``W`` with ``W S + S W = Qᵀ dH - dHᵀ Q``. That is a turn by ``w``,
    the axial vector of ``W``, after ``Q``; the vector of ``Q`` changes by the inverse of the right
    Jacobian of the exponential (Chirikjian 2012, doi 10.1007/978-0-8176-4944-9) times ``w``, and
    that of the rotation is its negative.
    """
    before = rest - rest.mean(axis=0)
    after = positions - positions.mean(axis=0)
    left, values, right = np.linalg.svd(before.T @ after)
    handed = np.array([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    if not values[1] > 1e-12 * values[0]:
        raise SimulationError(
            "rotation",
            "is not defined here, and has no derivative",
            "measure it at a probe with three vertices that are not on a line",
        )
    turned = left @ np.diag(handed) @ right
    by_turn = -by_vector @ _inverse_jacobian(-vector)
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
        slope_of_h[row, column] = float(by_turn @ _axial(turn)) / 2.0
    slope: Floats = before @ slope_of_h
    return slope


def _inverse_jacobian(vector: Floats) -> Floats:
    """Change of a rotation vector for a small turn after it, (3, 3): the inverse right Jacobian."""
    angle = float(np.linalg.norm(vector))
    cross = np.cross(np.eye(3), vector)  # v × is its matrix
    # 1/12 to the first order, where the difference is rounding.
    share = 1.0 / 12.0
    if angle > SMALL:
        share = 1.0 / angle**2 - (1.0 + np.cos(angle)) / (2.0 * angle * np.sin(angle))
    inverse: Floats = np.eye(3) + 0.5 * cross + share * cross @ cross
    return inverse


def _axial(matrix: Floats) -> Floats:
    """The vector ``(m₃₂ - m₂₃, m₁₃ - m₃₁, m₂₁ - m₁₂)``: twice that of the skew part."""
    return np.array(
        [
            matrix[2, 1] - matrix[1, 2],
            matrix[0, 2] - matrix[2, 0],
            matrix[1, 0] - matrix[0, 1],
        ]
    )


ROTATION: Final = Metric(
    "rotation",
    "angle",
    _value,
    _slope,
    needs=frozenset({"probe"}),
    takes=frozenset({"axis"}),
)
