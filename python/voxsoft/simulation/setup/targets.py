"""Check of objectives and constraints: metrics, units and places."""

from __future__ import annotations

from collections.abc import Iterator

from voxsoft.design import Constraint, Design, Objective
from voxsoft.errors import DesignError, ErrorDetail
from voxsoft.metrics import METRICS
from voxsoft.metrics.contact import object_problems
from voxsoft.metrics.reaction import support_problems
from voxsoft.metrics.tendon import tendon_problems
from voxsoft.records import closest
from voxsoft.units import KINDS, describe_dimension


def check_targets(design: Design) -> None:
    """Check that every objective and constraint names a metric, in its unit, and a place for it.

    Parameters
    ----------
    design
        The design.

    Raises
    ------
    DesignError
        An unknown metric, a probe that is missing, an axis for a number without direction, or a
        bound in a unit of another kind.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> check_targets(families.cylinder().with_values("objectives.rise.maximize=displacment"))
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: objectives.rise.maximize: "displacment" is not a metric. Try: \
did you mean "displacement"?
    """
    problems = [
        *_problems_of_objectives(design),
        *_problems_of_constraints(design),
    ]
    if problems:
        raise DesignError.listing(problems)


def _problems_of_objectives(design: Design) -> Iterator[ErrorDetail]:
    for name, objective in design.objectives.items():
        where = f"objectives.{name}"
        yield from _problems(objective, where, objective.direction, design)


def _problems_of_constraints(design: Design) -> Iterator[ErrorDetail]:
    for name, constraint in design.constraints.items():
        where = f"constraints.{name}"
        yield from _problems(constraint, where, "metric", design)
        if constraint.metric not in METRICS:
            continue
        due = KINDS[METRICS[constraint.metric].kind]
        came = KINDS[constraint.kind].dimension
        if came != due.dimension and any((constraint.min, constraint.max)):
            yield ErrorDetail(
                where,
                f"the bounds are {describe_dimension(came)}; {constraint.metric} is "
                f"{describe_dimension(due.dimension)}",
                f"write bounds such as {due.example}",
            )


def _problems(
    target: Objective | Constraint, where: str, key: str, design: Design
) -> Iterator[ErrorDetail]:
    name = target.metric
    if name not in METRICS:
        yield ErrorDetail(f"{where}.{key}", f'"{name}" is not a metric', closest(name, METRICS))
        return
    metric, probes = METRICS[name], design.probes
    if target.probe is not None and target.probe not in probes:
        hint = closest(target.probe, probes)
        yield ErrorDetail(f"{where}.probe", f'"{target.probe}" is not a probe', hint)
    if "probe" in metric.needs and target.probe is None and len(probes) != 1:
        known = f"one of {', '.join(probes)}" if probes else "a probe, under [probes]"
        yield ErrorDetail(
            f"{where}.probe", f"is missing: where is {name} measured?", f"name {known}"
        )
    found = (
        *object_problems(metric, target, design),
        *tendon_problems(metric, target, design),
        *support_problems(metric, target, design),
    )
    for problem in (*metric.refusals(target), *found):
        yield ErrorDetail(f"{where}.{problem.where}", problem.what, problem.hint)
