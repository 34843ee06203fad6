"""Reaction of the supports: of all, of a clamp, of a region, or of an object."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from voxsoft.design import Design
from voxsoft.design.clamp import clamp_names
from voxsoft.errors import DesignError, ErrorDetail
from voxsoft.metrics.contact import force_on_bodies
from voxsoft.metrics.definition import Floats, Metric, SlopeState, State, Target
from voxsoft.metrics.vectors import component, direction
from voxsoft.records import closest

#: Keys of a target that select the supports of a reaction.
_CHOICES: Final = ("clamp", "region", "object")


def support_problems(metric: Metric, target: Target, design: Design) -> Iterator[ErrorDetail]:
    """Find why a metric cannot be measured at the supports that a target names."""
    if "clamp" not in metric.takes:
        return
    chosen = _chosen(target)
    for other in chosen[1:]:
        what = f"stands beside {chosen[0]}, and a reaction is that of one of them"
        yield ErrorDetail(other, what, f"leave {other} or {chosen[0]} out")
    names = clamp_names(design.assembled.clamps)
    if target.clamp is not None and target.clamp not in names:
        what = f'there is no clamp "{target.clamp}"'
        hint = closest(target.clamp, names) if names else "add [[clamps]]"
        yield ErrorDetail("clamp", what, hint or f"name one of {', '.join(names)}")


def _chosen(target: Target) -> list[str]:
    return [name for name in _CHOICES if getattr(target, name) is not None]


def _reaction(state: State, target: Target) -> Floats:
    if target.clamp is not None:
        return np.asarray(state.clamp_reactions[target.clamp])
    if target.region is not None:
        return np.asarray(state.reaction_in(target.region))
    if target.object is not None:
        return force_on_bodies(REACTION, state, target)
    return np.asarray(state.reaction)


def _value(state: State, target: Target) -> float:
    problems = list(support_problems(REACTION, target, state.design))
    if problems:
        raise DesignError.listing(problems)
    return component(_reaction(state, target), target)


def _slope(state: SlopeState, target: Target) -> Floats:
    """Differentiate by the positions: only pressure on an open surface changes the sum of loads.

    Its triangles carry ``-p A n`` each, with ``A n = (b - a) x (c - a)/2``.
    """
    if chosen := _chosen(target):
        what = "has no derivative for some of the supports"
        hint = f"leave {chosen[0]} out, or search without derivatives"
        raise DesignError("reaction", what, hint)
    slope = np.zeros_like(state.positions)
    along = direction(np.asarray(state.reaction), target)
    for triangles, pressure in state.pushed_triangles():
        a, b, c = state.positions[triangles].transpose(1, 0, 2)
        for corner, opposite in enumerate((c - b, a - c, b - a)):
            np.add.at(slope, triangles[:, corner], 0.5 * pressure * np.cross(along, opposite))
    return slope


REACTION: Final = Metric(
    "reaction", "force", _value, _slope, takes=frozenset({"axis", "clamp", "region", "object"})
)
