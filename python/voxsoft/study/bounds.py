"""Constraints that trials of a study break, in words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import isfinite, nan

from voxsoft.design import Constraint
from voxsoft.metrics import METRICS
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.study.trial import Trial, violations
from voxsoft.units import format_quantity


def broken_by_all(
    trials: Sequence[Trial], constraints: Mapping[str, Constraint]
) -> Iterator[Diagnostic]:
    """Warn of each constraint that all solved designs break.

    Examples
    --------
    >>> light = {"light": Constraint(metric="mass", max="30 g")}
    >>> heavy = {"status": "ok", "message": "", "objectives": {}, "feasible": False, "hash": "",
    ...          "same_as": None, "seconds": 0.0}
    >>> trials = [Trial(n, {}, metrics={"light": 0.04 + 0.01 * n}, **heavy) for n in (0, 1)]
    >>> print(*broken_by_all(trials, light))  # doctest: +ELLIPSIS
    constraints.light: no design is allowed: it is 40 g to 50 g in all of 2, at most 30 g ...
    """
    solved = [trial for trial in trials if trial.status == "ok"]
    for name, constraint in constraints.items():
        alone = {name: constraint}
        values = [{**trial.metrics, **trial.objectives}.get(name, nan) for trial in solved]
        known = [value for value in values if isfinite(value)]
        if not known or any(max(violations({name: v}, alone)) <= 0.0 for v in known):
            continue
        low, high = (_written(end, constraint) for end in (min(known), max(known)))
        span = low if low == high else f"{low} to {high}"
        what = (
            f"no design is allowed: it is {span} in all of {len(known):,}, "
            f"{_bounds(constraint)} is allowed"
        )
        yield Diagnostic("warning", f"constraints.{name}", what, "change the bound, or the ranges")


def _bounds(constraint: Constraint) -> str:
    least, most = (
        None if end is None else _written(end, constraint)
        for end in (constraint.min, constraint.max)
    )
    if least is None:
        return f"at most {most}"
    return f"at least {least}" if most is None else f"{least} to {most}"


def _written(value: float, constraint: Constraint) -> str:
    metric = METRICS.get(constraint.metric)
    kind = constraint.kind if metric is None else metric.kind
    return format_quantity(float(f"{value:.4g}"), kind)
