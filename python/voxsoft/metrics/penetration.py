"""Penetration depth of a body into itself or its floor."""

from __future__ import annotations

from typing import Final

from voxsoft.metrics.definition import NOT_NEGATIVE, Metric, State, Target


def _value(state: State, _: Target) -> float:
    return state.penetration.depth


# Without a slope: at the first touch it has a kink, and before it there is nothing to follow.
PENETRATION: Final = Metric("penetration", "length", _value, None, bounds=NOT_NEGATIVE)
