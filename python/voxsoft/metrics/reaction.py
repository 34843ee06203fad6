"""What the supports carry."""

from __future__ import annotations

from typing import Final

import numpy as np

from voxsoft.metrics.definition import Floats, Metric, SlopeState, State, Target
from voxsoft.metrics.vectors import component, direction


def _value(state: State, target: Target) -> float:
    return component(np.asarray(state.reaction), target)


def _slope(state: SlopeState, target: Target) -> Floats:
    """Of all loads only a pressure on an open surface changes its sum as the body moves.

    Its triangles carry ``-p A n`` each, with ``A n = (b - a) x (c - a)/2``.
    """
    slope = np.zeros_like(state.positions)
    along = direction(np.asarray(state.reaction), target)
    for triangles, pressure in state.pushed_triangles():
        a, b, c = state.positions[triangles].transpose(1, 0, 2)
        for corner, opposite in enumerate((c - b, a - c, b - a)):
            np.add.at(slope, triangles[:, corner], 0.5 * pressure * np.cross(along, opposite))
    return slope


REACTION: Final = Metric("reaction", "force", _value, _slope, takes=frozenset({"axis"}))
