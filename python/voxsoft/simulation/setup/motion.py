"""Prescribed positions of clamped vertices."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Clamp, Motion

if TYPE_CHECKING:
    from voxsoft.simulation.setup.setup import Setup


def held_axes(setup: Setup) -> NDArray[np.bool_]:
    """Mark the coordinates that clamps hold, (n, 3)."""
    held = np.zeros(setup.mesh.vertices.shape, dtype=bool)
    for clamp, vertices in zip(setup.design.clamps, setup.clamped, strict=True):
        held[vertices] |= _axes(clamp)
    return held


def held_positions(setup: Setup) -> NDArray[np.float64]:
    """Compute final prescribed positions of clamped vertices, m, (n, 3); others stay unloaded.

    The later of two clamps that hold the same axis of a vertex decides.

    Parameters
    ----------
    setup
        The prepared design.
    """
    rest = setup.mesh.vertices
    placed = rest.copy()
    for clamp, vertices in zip(setup.design.clamps, setup.clamped, strict=True):
        moved = moved_by(clamp.motion, rest[vertices])
        placed[vertices] = np.where(_axes(clamp), moved, placed[vertices])
    return placed


def _axes(clamp: Clamp) -> NDArray[np.bool_]:
    return np.array([axis in clamp.axes for axis in "xyz"])


def moved_by(motion: Motion | None, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Move points by the final rotation and displacement of a motion, (n, 3), m.

    They are first rotated, then displaced, both times the last factor of the history.
    """
    if motion is None:
        return points
    factor = motion.history.factors[-1] if motion.history else 1.0
    moved = points
    if motion.rotation is not None:
        axis = np.asarray(motion.rotation.axis) / np.linalg.norm(motion.rotation.axis)
        center = np.asarray(motion.rotation.center)
        angle = factor * motion.rotation.angle
        arm = points - center
        # Rodrigues' formula.
        moved = (
            center
            + np.cos(angle) * arm
            + np.sin(angle) * np.cross(axis, arm)
            + (1.0 - np.cos(angle)) * np.outer(arm @ axis, axis)
        )
    return np.asarray(moved + factor * np.asarray(motion.displacement))
