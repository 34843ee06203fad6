"""Von Mises stress of a body."""

from __future__ import annotations

from typing import Final

from voxsoft.metrics.definition import NOT_NEGATIVE, Metric, State, Target


def _stress(state: State, target: Target) -> float:
    return state.fields.percentile("von_mises", target.percentile or 100.0)


MAX_STRESS: Final = Metric(
    "max_stress",
    "pressure",
    _stress,
    slope=None,
    takes=frozenset({"percentile"}),
    is_peak=True,
    bounds=NOT_NEGATIVE,
)
