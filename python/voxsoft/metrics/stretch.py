"""Largest stretch, its share of the tested range of the material, and smallest volume ratio."""

from __future__ import annotations

from typing import Final

import numpy as np

from voxsoft.design.tested import tested_ranges
from voxsoft.metrics.definition import NOT_NEGATIVE, Floats, Metric, SlopeState, State, Target


def _stretch(state: State, target: Target) -> float:
    return state.fields.percentile("max_stretch", target.percentile or 100.0)


def _stretch_slope(state: SlopeState, target: Target) -> Floats:
    return state.fields.max_stretch_slope(target.percentile or 100.0)


def _tested(state: State) -> Floats:
    """Return the strain up to which the material of each voxel was tested; NaN where not known."""
    ranges = tested_ranges(state.design)
    # A material tested in compression only has no tensile strain to take a share of.
    limits = [0.0 if each is None else each.largest - 1.0 for each in ranges]
    of_parts = np.array([limit if limit > 0.0 else np.nan for limit in limits])
    tested: Floats = of_parts[state.fields.parts]
    return tested


def _share(state: State, target: Target) -> float:
    fields = state.fields
    shares = (fields.max_stretch - 1.0) / _tested(state)
    voxel = fields.where_of(shares, target.percentile or 100.0)
    return float("nan") if voxel is None else float(shares[voxel])


def _share_slope(state: SlopeState, target: Target) -> Floats:
    fields, tested = state.fields, _tested(state)
    voxel = fields.where_of((fields.max_stretch - 1.0) / tested, target.percentile or 100.0)
    slope = fields.stretch_slope(voxel)
    return slope if voxel is None else slope / float(tested[voxel])


def _is_tested(state: State) -> bool:
    return any(each is not None and each.largest > 1.0 for each in tested_ranges(state.design))


def _volume_ratio(state: State, _: Target) -> float:
    return float(np.min(state.fields.volume_ratio))


MAX_STRETCH: Final = Metric(
    "max_stretch",
    "number",
    _stretch,
    _stretch_slope,
    takes=frozenset({"percentile"}),
    is_peak=True,
    bounds=NOT_NEGATIVE,
)
TESTED_SHARE: Final = Metric(
    "tested_share",
    "number",
    _share,
    _share_slope,
    takes=frozenset({"percentile"}),
    is_peak=True,
    bounds=NOT_NEGATIVE,
    is_of=_is_tested,
)
MIN_VOLUME_RATIO: Final = Metric(
    "min_volume_ratio", "number", _volume_ratio, slope=None, is_peak=True, bounds=NOT_NEGATIVE
)
