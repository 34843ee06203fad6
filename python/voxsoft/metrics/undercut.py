"""Undercuts of a body for the molds of its castings."""

from __future__ import annotations

from typing import Final

from voxsoft.fabrication.planning import undercut_of
from voxsoft.metrics.definition import NOT_NEGATIVE, Metric, State, Target


def _undercut(state: State, _: Target) -> float:
    return undercut_of(state.design)


#: Steps with the shape: zero for all bodies that molds release.
UNDERCUT: Final = Metric("undercut", "volume", _undercut, None, is_costly=True, bounds=NOT_NEGATIVE)
