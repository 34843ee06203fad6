"""Outcome of one evaluation of a design."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from voxsoft.design import Design
from voxsoft.errors import DisconnectedError, NoCavityError, VoxSoftError
from voxsoft.metrics.own import OwnMetric, missing_metrics
from voxsoft.simulation import Result, Status, follow, simulate
from voxsoft.study.equilibria import Equilibrium
from voxsoft.study.indexed_cavities import IndexedCavities


@dataclass(frozen=True)
class Outcome:
    """Status of an evaluation, and its numbers.

    Attributes
    ----------
    status
        ``ok``, or the reason why the numbers cannot be compared.
    message
        The status in a sentence.
    metrics
        Metrics in SI units. An ``ok`` outcome holds every objective and constraint under its name.
    seconds
        Wall-clock time of the evaluation.
    warnings
        Warnings about the numbers, each in a sentence.
    cavities
        Centers of the cavities, if the design selects any by an index.
    path
        Path of equilibria, if one was followed: the values of the varied key, by that key, and
        those of each objective and constraint beside them.
    equilibrium
        Equilibrium under the loads of the design, if one was found.
    """

    status: Status
    message: str = ""
    metrics: Mapping[str, float] = field(default_factory=dict)
    seconds: float = 0.0
    warnings: tuple[str, ...] = ()
    cavities: IndexedCavities = field(default_factory=IndexedCavities)
    path: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    equilibrium: Equilibrium | None = field(default=None, repr=False, compare=False)


#: Function that evaluates a design in a worker process; it is sent there by pickle.
Evaluate = Callable[[Design], Outcome]


def evaluate_design(design: Design) -> Outcome:
    """Simulate a design and give a status to every result, errors included.

    Parameters
    ----------
    design
        Design with the objectives and constraints of the study.

    Returns
    -------
    Outcome
        An error that VoxSoft raises on purpose becomes a status; all others are raised.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> evaluate_design(families.cylinder(wall="20 mm", radius="20 mm")).status
    'no-cavity'
    """
    return _outcome(lambda: _at_rest(design))


def evaluate_path(over: str, design: Design) -> Outcome:
    """Follow the equilibria of a design along a path; see :func:`evaluate_design`.

    Parameters
    ----------
    over
        Varied key and its values, as in :func:`voxsoft.follow`.
    design
        Design with the objectives and constraints of the study; each selects by `along` the number
        of the path that counts.

    Returns
    -------
    Outcome
        Outcome with a path. A path that is lost is not ``ok``.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> found = evaluate_path("loads[0].value=0..1 kPa/3", families.pneunet(chambers=2))
    >>> found.status, list(found.path)
    ('ok', ['loads[0].value', 'bend'])
    """
    return _outcome(lambda: _along(over, design))


def _outcome(evaluate: Callable[[], Outcome]) -> Outcome:
    started = time.perf_counter()
    try:
        outcome = evaluate()
    except NoCavityError as error:
        outcome = Outcome("no-cavity", str(error))
    except DisconnectedError as error:
        outcome = Outcome("disconnected", str(error))
    except VoxSoftError as error:
        outcome = Outcome("failed", str(error))
    return replace(outcome, seconds=time.perf_counter() - started)


def _at_rest(design: Design) -> Outcome:
    result = simulate(design)
    return outcome_of_result(result, dict(result.metrics))


def _along(over: str, design: Design) -> Outcome:
    path = follow(design, over)
    last = path.results[-1]
    columns = path.columns
    asked = {name: columns[name][1] for name in (*design.objectives, *design.constraints)}
    warnings = dict.fromkeys(str(each) for result in path.results for each in result.warnings)
    return replace(
        outcome_of_result(last, dict(path.metrics)),
        message=path.message,
        warnings=tuple(warnings),
        path={path.over.key: path.values, **asked},
        equilibrium=None,  # the end of the path need not have the loads of the design
    )


def evaluate_with_metrics(
    wanted: tuple[OwnMetric, ...], evaluate: Evaluate, design: Design
) -> Outcome:
    """Evaluate a design after the user's metrics are imported, for workers that do not know them.

    Parameters
    ----------
    wanted
        User's metrics that the study asks for.
    evaluate, design
        Evaluation, and its design.
    """
    missing = missing_metrics(wanted)
    if missing:
        return Outcome("failed", f"the worker does not know the metric {', '.join(missing)}")
    return evaluate(design)


def outcome_of_result(result: Result, metrics: Mapping[str, float]) -> Outcome:
    """Make an outcome of a result, with its warnings.

    Parameters
    ----------
    result
        Result of the simulation.
    metrics
        Metrics of the result in SI units.
    """
    warnings = tuple(str(warning) for warning in result.warnings)
    cavities = IndexedCavities.of(result.design, result.mesh)
    rest = Equilibrium.of(result) if result.status == "ok" else None
    return Outcome(
        result.status, result.message, metrics, 0.0, warnings, cavities, equilibrium=rest
    )
