"""Designs of a study that are one body: sizes that differ by less than the voxels can show."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from typing import Any

from voxsoft.design import Design
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.study.space import Choices, Domain, Range
from voxsoft.study.trial import Trial
from voxsoft.units import format_quantity


def alike(trials: Iterable[Trial]) -> list[list[Trial]]:
    """Group trials whose metrics are equal to the last digit, in the order of the first of each.

    Two bodies that differ in one voxel differ in their mass; designs that are equal in all metrics
    are one body on its grid, or differ in a parameter without effect.
    """
    groups: dict[tuple[tuple[str, float], ...], list[Trial]] = {}
    for trial in trials:
        groups.setdefault(tuple(sorted(trial.metrics.items())), []).append(trial)
    return list(groups.values())


def spans(trials: Iterable[Trial]) -> dict[str, tuple[float, float]]:
    """Return the lowest and highest value of each numeric parameter that differs among trials."""
    rows = [trial.parameters for trial in trials]
    found = {}
    for name in rows[0] if rows else ():
        values: list[Any] = [row[name] for row in rows]
        if all(isinstance(v, int | float) and not isinstance(v, bool) for v in values):
            low, high = min(values), max(values)
            if low < high:
                found[name] = (float(low), float(high))
    return found


def repeated(trials: Iterable[Trial]) -> Iterator[Diagnostic]:
    """Warn where designs with different parameters came to the same numbers."""
    solved = [trial for trial in trials if trial.status == "ok" and trial.same_as is None]
    groups = alike(solved)
    if len(groups) == len(solved):
        return
    largest = max(groups, key=len)
    what = (
        f"{len(solved):,} solved designs are {len(groups):,} distinct bodies: designs "
        f"{', '.join(str(trial.number) for trial in largest[:6])}"
        f"{' and more' if len(largest) > 6 else ''} have equal numbers to the last digit"
    )
    hint = (
        "make the voxels smaller, or the steps at least a voxel; smaller steps are followed by cut "
        'voxels (fill = "fraction", the default of rubber)'
    )
    yield Diagnostic("warning", "study", what, hint)


def below_voxels(design: Design, space: Mapping[str, Domain]) -> Iterator[Diagnostic]:
    """Warn of lengths that are varied by less than a voxel, before any trial is solved.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> walls = {"wall": Range(low=0.01, high=0.02, step=0.001)}
    >>> whole = families.cylinder().replace(fill="binary")
    >>> print(*below_voxels(whole, walls))  # doctest: +ELLIPSIS
    parameters.wall: is varied by 1 mm on voxels of 5 mm, so that several values are one body...
    """
    if design.has_cut_voxels or design.bodies:
        return
    for name, domain in space.items():
        parameter = design.parameters.get(name)
        if parameter is None or parameter.kind != "length":
            continue
        step = _step(domain)
        if step is not None and step < design.voxel_size * (1.0 - 1e-9):
            by, size = (format_quantity(v, "length") for v in (step, design.voxel_size))
            what = f"is varied by {by} on voxels of {size}, so that several values are one body"
            hint = 'set fill = "fraction", make the voxels smaller, or the steps at least a voxel'
            yield Diagnostic("warning", f"parameters.{name}", what, hint)


def _step(domain: Domain) -> float | None:
    """Return the least difference of two tried values; the whole range where any may be."""
    if isinstance(domain, Range):
        return float(domain.step or domain.high - domain.low)
    assert isinstance(domain, Choices)
    numbers = sorted(v for v in domain.values if isinstance(v, float))
    steps = [b - a for a, b in pairwise(numbers) if b > a]
    return min(steps, default=None)
