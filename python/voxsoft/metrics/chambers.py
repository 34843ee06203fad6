"""Volume of the chambers, and its change."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from voxsoft.cavity import MeshCavity
from voxsoft.design.chamber import chosen_cavities
from voxsoft.metrics.definition import NOT_NEGATIVE, Floats, Metric, SlopeState, State, Target


def _chosen(state: State, target: Target) -> Sequence[MeshCavity]:
    cavities = state.mesh.cavities
    return [cavities[index] for index in chosen_cavities(target.cavity, state.mesh, "cavity")]


def _volume(state: State, target: Target) -> float:
    return sum(cavity.volume_at(state.positions) for cavity in _chosen(state, target))


def _change(state: State, target: Target) -> float:
    before = sum(float(cavity.volume) for cavity in _chosen(state, target))
    return _volume(state, target) - before


def _slope(state: SlopeState, target: Target) -> Floats:
    slope = np.zeros_like(state.positions)
    for cavity in _chosen(state, target):
        _add_slope(cavity, state.positions, slope)
    return slope


def _add_slope(cavity: MeshCavity, positions: Floats, slope: Floats) -> None:
    """Add ``-(b x c)/6`` at the corner a of each triangle, and so on around; then of the voids.

    The volume of a tet grows by ``((c - b) x (d - b))/6``, turned inward, at its corner a.
    """
    for triangles, weight in cavity.splits:
        a, b, c = positions[triangles].transpose(1, 0, 2)
        for corner, (one, other) in enumerate(((b, c), (c, a), (a, b))):
            np.add.at(slope, triangles[:, corner], -weight / 6.0 * np.cross(one, other))
    a, b, c, d = positions[cavity.void_tets].transpose(1, 0, 2)
    parts = cavity.void_parts[:, None] / 6.0
    edges = ((d - b, c - b), (c - a, d - a), (d - a, b - a), (b - a, c - a))
    for corner, (one, other) in enumerate(edges):
        np.add.at(slope, cavity.void_tets[:, corner], parts * np.cross(one, other))


CAVITY_VOLUME: Final = Metric(
    "cavity_volume", "volume", _volume, _slope, takes=frozenset({"cavity"}), bounds=NOT_NEGATIVE
)
CAVITY_VOLUME_CHANGE: Final = Metric(
    "cavity_volume_change", "volume", _change, _slope, takes=frozenset({"cavity"})
)
