"""Tension and length of tendons."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from voxsoft.design import Design
from voxsoft.errors import DesignError, ErrorDetail
from voxsoft.metrics.definition import NOT_NEGATIVE, Metric, Pulled, State, Target
from voxsoft.records import closest


def tendon_problems(metric: Metric, target: Target, design: Design) -> Iterator[ErrorDetail]:
    """Find why a metric cannot be measured at the tendon that a target names, or does not name."""
    if "tendon" not in metric.needs:
        return
    names = [each.name or f"tendons[{at}]" for at, each in enumerate(design.assembled.tendons)]
    if not names:
        what = f"there is no tendon in this design, and {metric.name} asks of one"
        yield ErrorDetail("tendon", what, "add [[tendons]]")
    elif target.tendon is None and len(names) > 1:
        what = f"is missing: what does {metric.name} ask of?"
        yield ErrorDetail("tendon", what, f"name one of {', '.join(names)}")
    elif target.tendon is not None and target.tendon not in names:
        what = f'there is no tendon "{target.tendon}"'
        yield ErrorDetail("tendon", what, closest(target.tendon, names))


def _named(metric: Metric, state: State, target: Target) -> Pulled:
    problems = list(tendon_problems(metric, target, state.design))
    if problems:
        raise DesignError.listing(problems)
    return state.tendons[target.tendon or next(iter(state.tendons))]


def _tension(state: State, target: Target) -> float:
    return _named(TENDON_TENSION, state, target).tension


def _length(state: State, target: Target) -> float:
    return _named(TENDON_LENGTH, state, target).length


TENDON_TENSION: Final = Metric(
    "tendon_tension", "force", _tension, None, frozenset({"tendon"}), bounds=NOT_NEGATIVE
)
TENDON_LENGTH: Final = Metric(
    "tendon_length", "length", _length, None, frozenset({"tendon"}), bounds=NOT_NEGATIVE
)
