"""One evaluated design of a study."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf, isnan, nan
from typing import Any

from voxsoft.design import Constraint
from voxsoft.search.optuna_bridge import FrozenTrial
from voxsoft.simulation import Status
from voxsoft.study.indexed_cavities import IndexedCavities
from voxsoft.study.outcome import Outcome
from voxsoft.units import round_significant

#: Key of the outcome of a trial among the user attributes of Optuna's trial.
OUTCOME_KEY = "outcome"


@dataclass(frozen=True)
class Trial:
    """One evaluated design, whatever its status.

    Attributes
    ----------
    number
        Number of the trial in the study, from 0.
    parameters
        Parameters by name, in SI units.
    status, message
        Status of the evaluation; only ``ok`` trials have objectives that may be compared.
    objectives
        Objectives by name, in SI units; empty unless the status is ``ok``.
    metrics
        All other metrics, if any were measured.
    feasible
        True if the status is ``ok`` and every constraint holds.
    hash
        Hash of the design; empty if there was none.
    same_as
        Number of the trial with the same design whose outcome this trial shares, or None if it
        was evaluated itself.
    seconds
        Wall-clock time of the evaluation; 0 for a shared outcome.
    warnings
        Warnings about the numbers, each in a sentence.
    cavities
        Centers of the cavities, if the design selects any by an index.
    path
        Values of the varied key in a study along a path, and the objectives and constraints
        beside them, in SI units.
    """

    number: int
    parameters: Mapping[str, Any]
    status: Status
    message: str
    objectives: Mapping[str, float]
    metrics: Mapping[str, float]
    feasible: bool
    hash: str
    same_as: int | None
    seconds: float
    warnings: tuple[str, ...] = ()
    cavities: IndexedCavities = field(default_factory=IndexedCavities)
    path: Mapping[str, tuple[float, ...]] = field(default_factory=dict)


def rounded(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Round numbers to the 12 digits that identify a design.

    Optuna adds up the steps of a range, which leaves 0.034999999999999996 for 35 mm.

    Examples
    --------
    >>> rounded({"height": 0.005 + 3 * 0.01, "count": 3})
    {'height': 0.035, 'count': 3}
    """
    return {
        name: round_significant(value) if isinstance(value, float) else value
        for name, value in parameters.items()
    }


def record_of(outcome: Outcome, design_hash: str, same_as: int | None) -> dict[str, Any]:
    """Write an outcome as plain data, for :func:`read_trial`."""
    record = {
        "status": outcome.status,
        "message": outcome.message,
        "metrics": {name: _number(value) for name, value in outcome.metrics.items()},
        "seconds": outcome.seconds,
        "warnings": list(outcome.warnings),
        "hash": design_hash,
        "same_as": same_as,
        "cavities": outcome.cavities.record(),
    }
    if outcome.path:
        record["path"] = {name: list(values) for name, values in outcome.path.items()}
    return record


def outcome_of(record: Mapping[str, Any]) -> Outcome:
    """Read back the outcome that :func:`record_of` wrote."""
    return Outcome(
        record["status"],
        record["message"],
        record["metrics"],
        record["seconds"],
        _warnings(record),
        IndexedCavities.read(record.get("cavities")),
        _path(record),
    )


def read_trial(
    stored: FrozenTrial, objectives: Mapping[str, Any], constraints: Mapping[str, Constraint]
) -> Trial:
    """Read a finished trial from Optuna's.

    Parameters
    ----------
    stored
        A trial with an outcome among its attributes.
    objectives, constraints
        Objectives and constraints of the study, by name.
    """
    record = stored.user_attrs[OUTCOME_KEY]
    metrics, ok = record["metrics"], record["status"] == "ok"
    return Trial(
        number=stored.number,
        parameters=rounded(stored.params),
        status=record["status"],
        message=record["message"],
        objectives={name: metrics[name] for name in objectives} if ok else {},
        metrics={
            name: value for name, value in metrics.items() if name not in objectives or not ok
        },
        feasible=ok and max(violations(metrics, constraints), default=0.0) <= 0.0,
        hash=record["hash"],
        same_as=record["same_as"],
        seconds=record["seconds"],
        warnings=_warnings(record),
        cavities=IndexedCavities.read(record.get("cavities")),
        path=_path(record),
    )


def _number(value: float | None) -> float:
    """Return a metric as a number; None, as a user's evaluation may return, is unknown (NaN)."""
    return nan if value is None else float(value)


def _warnings(record: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the warnings of a record; journals that are older than warnings have none."""
    return tuple(record.get("warnings", ()))


def _path(record: Mapping[str, Any]) -> dict[str, tuple[float, ...]]:
    return {name: tuple(values) for name, values in record.get("path", {}).items()}


def violations(
    metrics: Mapping[str, float], constraints: Mapping[str, Constraint]
) -> tuple[float, ...]:
    """Return the violation of each bound: at most 0 where it holds, infinite if unknown.

    A metric that is missing, None or NaN is unknown: comparisons with NaN are all false, so that
    the largest of some numbers would depend on their order.

    Examples
    --------
    >>> light = Constraint(metric="mass", max="30 g")
    >>> violations({"light": 0.0625}, {"light": light})
    (0.0325,)
    >>> violations({"light": float("nan")}, {"light": light})
    (inf,)
    """
    found = []
    for name, constraint in constraints.items():
        value = _number(metrics.get(name))
        if constraint.min is not None:
            found.append(inf if isnan(value) else constraint.min - value)
        if constraint.max is not None:
            found.append(inf if isnan(value) else value - constraint.max)
    return tuple(found)
