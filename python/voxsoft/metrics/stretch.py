"""How far a body is stretched, and how far its voxels are pressed."""

from __future__ import annotations

from typing import Final

import numpy as np

from voxsoft.metrics.definition import Floats, Metric, SlopeState, State, Target


def _stretch(state: State, target: Target) -> float:
    return state.fields.percentile("max_stretch", target.percentile or 100.0)


def _stretch_slope(state: SlopeState, target: Target) -> Floats:
    return state.fields.max_stretch_slope(target.percentile or 100.0)


def _volume_ratio(state: State, _: Target) -> float:
    return float(np.min(state.fields.volume_ratio))


MAX_STRETCH: Final = Metric(
    "max_stretch",
    "number",
    _stretch,
    _stretch_slope,
    takes=frozenset({"percentile"}),
    is_peak=True,
)
MIN_VOLUME_RATIO: Final = Metric(
    "min_volume_ratio", "number", _volume_ratio, slope=None, is_peak=True
)
