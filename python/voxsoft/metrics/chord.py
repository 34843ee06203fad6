"""Rotation of the line from a base to a tip, and the curvature of the arc between them.

Assumes a body that is straight at rest and bends to an arc of constant curvature from a base that
keeps its direction: the chord turns by half of the angle of the tip (Webster and Jones 2010,
doi 10.1177/0278364910368147).
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from voxsoft.errors import DesignError, SimulationError
from voxsoft.metrics.definition import Floats, Metric, SlopeState, State, Target
from voxsoft.metrics.probes import place_of_target
from voxsoft.records import closest


class _Chord(NamedTuple):
    """Line at rest and now, (3,) each, m; the angle between them in rad, and its axis."""

    rest: Floats
    now: Floats
    angle: float
    axis: Floats


def _base(state: State, target: Target) -> str:
    """Return the name of the probe at the base; default: the only other probe."""
    others = [name for name in state.places if name != target.probe]
    if target.base is None and target.probe is not None and len(others) == 1:
        return others[0]
    if target.base is None:
        what = f"is missing: where does the line of {target.metric} begin?"
        raise DesignError("base", what, f"name one of {', '.join(others) or 'two probes'}")
    if target.base not in state.places:
        raise DesignError("base", f'"{target.base}" is not a probe', closest(target.base, others))
    if target.base == target.probe:
        raise DesignError("base", f'is the probe "{target.base}" itself', "name another one")
    return target.base


def _chord(state: State, target: Target) -> _Chord:
    tip, base = place_of_target(state, target), state.places[_base(state, target)]
    rest, now = (
        tip.weights @ positions[tip.vertices] - base.weights @ positions[base.vertices]
        for positions in (state.mesh.vertices, state.positions)
    )
    axis = None if target.axis is None else np.eye(3)["xyz".index(target.axis)]
    flat_rest, flat_now = (
        line if axis is None else line - (line @ axis) * axis for line in (rest, now)
    )
    cross = np.cross(flat_rest, flat_now)
    sine = float(np.linalg.norm(cross)) if axis is None else float(cross @ axis)
    if axis is None:
        axis = cross / sine if sine > 0.0 else np.zeros(3)
    return _Chord(flat_rest, flat_now, float(np.arctan2(sine, flat_rest @ flat_now)), axis)


def _angle(state: State, target: Target) -> float:
    return _chord(state, target).angle


def _curvature(state: State, target: Target) -> float:
    chord = _chord(state, target)
    return 2.0 * float(np.sin(chord.angle) / np.linalg.norm(chord.now))


def _slope_of_angle(state: SlopeState, target: Target) -> Floats:
    chord = _chord(state, target)
    return _spread(state, target, _turn(chord, target))


def _slope_of_curvature(state: SlopeState, target: Target) -> Floats:
    chord = _chord(state, target)
    long = float(np.linalg.norm(chord.now))
    slope = 2.0 * np.cos(chord.angle) / long * _turn(chord, target)
    return _spread(state, target, slope - 2.0 * np.sin(chord.angle) / long**3 * chord.now)


def _turn(chord: _Chord, target: Target) -> Floats:
    """Differentiate the angle by the end of the line, (3,), 1/m."""
    if not chord.axis.any():
        raise SimulationError(
            target.metric,
            "is zero, where an angle without an axis has no derivative",
            "name the axis that it turns about",
        )
    turn: Floats = np.cross(chord.axis, chord.now) / (chord.now @ chord.now)
    return turn


def _spread(state: SlopeState, target: Target, by_end: Floats) -> Floats:
    """Turn a derivative by the end of the line into one by all positions, (n, 3)."""
    slope = np.zeros_like(state.positions)
    tip, base = place_of_target(state, target), state.places[_base(state, target)]
    np.add.at(slope, tip.vertices, np.outer(tip.weights, by_end))
    np.add.at(slope, base.vertices, np.outer(base.weights, -by_end))
    return slope


CHORD_ANGLE: Final = Metric(
    "chord_angle",
    "angle",
    _angle,
    _slope_of_angle,
    needs=frozenset({"probe", "base"}),
    takes=frozenset({"axis"}),
)
CURVATURE: Final = Metric(
    "curvature",
    "curvature",
    _curvature,
    _slope_of_curvature,
    needs=frozenset({"probe", "base"}),
    takes=frozenset({"axis"}),
)
