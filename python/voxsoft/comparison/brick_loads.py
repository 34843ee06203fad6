"""Loads and prescribed motions on bricks, with their histories."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Clamp, History

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class FacePressure:
    """Pressure in Pa that follows some faces of bricks: rows (brick, face)."""

    faces: Ints
    value: float


@dataclass(frozen=True, eq=False)
class BrickLoad:
    """One load of a design on bricks, without its history.

    Attributes
    ----------
    number
        Number of the load in the design.
    history
        Its factor over time; None for 1.
    gravity
        Acceleration in m/s², (3,).
    forces
        Dead forces in N, (n, 3).
    pressures
        Pressures on faces.
    """

    number: int
    history: History | None
    gravity: Floats
    forces: Floats = field(repr=False)
    pressures: tuple[FacePressure, ...] = field(repr=False)


@dataclass(frozen=True, eq=False)
class BrickMotion:
    """Prescribed displacement of the nodes of one clamp, without its history.

    Attributes
    ----------
    clamp
        Number of the clamp in the design.
    nodes
        Held nodes, (k,).
    columns
        Held components, 0 to 2.
    values
        Displacement in m, (k, 3).
    history
        Its factor over time; None for 1.
    turns
        True where the nodes turn about an axis.
    """

    clamp: int
    nodes: Ints = field(repr=False)
    columns: tuple[int, ...]
    values: Floats = field(repr=False)
    history: History | None
    turns: bool


def prescribed(clamp: Clamp, points: Floats, factor: float | None = None) -> Floats:
    """Displacement in m that a clamp gives to points in m, (n, 3); by default at its end."""
    moved = np.zeros_like(points)
    motion = clamp.motion
    if motion is None:
        return moved
    if factor is None:
        factor = 1.0 if motion.history is None else motion.history.factors[-1]
    if motion.rotation is not None:
        axis = np.asarray(motion.rotation.axis) / np.linalg.norm(motion.rotation.axis)
        arms = points - np.asarray(motion.rotation.center)
        angle = factor * motion.rotation.angle
        along = np.outer(arms @ axis, axis)
        moved += (np.cos(angle) - 1) * (arms - along) + np.sin(angle) * np.cross(axis, arms)
    return moved + factor * np.asarray(motion.displacement)
