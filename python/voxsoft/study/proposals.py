"""Next trials to evaluate: all points of a grid, or the suggestions of a sampler."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from optuna.distributions import BaseDistribution
from optuna.samplers import BaseSampler

from voxsoft.search.genetic_sampler import GeneticSampler
from voxsoft.search.gradient_sampler import GradientSampler
from voxsoft.search.optuna_bridge import FrozenTrial, StoredStudy, TrialState
from voxsoft.search.samplers import Answers, grid_values, sampler_named
from voxsoft.study.trial import OUTCOME_KEY, rounded

#: Trials a sampler suggests before it sees their outcomes, unless the user says otherwise.
DEFAULT_BATCH = 8

Distributions = Mapping[str, BaseDistribution]


@dataclass(frozen=True)
class Proposal:
    """Trial that is to be evaluated."""

    number: int
    parameters: Mapping[str, Any]


#: Batches of proposals; each is taken once the trials of the one before are stored.
Proposals = Iterator[Iterable[Proposal]]


def grid_proposals(study: StoredStudy, space: Distributions) -> Proposals:
    """Propose every point of a grid that the study does not hold, in one batch.

    The last parameter of the space varies fastest. Trials that an earlier run left unfinished
    come first.
    """
    yield unfinished(study, space)
    values = grid_values(space)
    there = {_key(trial.params) for trial in study.trials()}
    points = (
        dict(zip(values, point, strict=True)) for point in itertools.product(*values.values())
    )
    # Lazily: a trial enters the storage only when a worker is about to be free.
    yield (_create(study, space, point) for point in points if _key(point) not in there)


def sampled_proposals(
    study: StoredStudy,
    space: Distributions,
    budget: int,
    batch: int | None,
    sampler: Callable[[int], BaseSampler],
) -> Proposals:
    """Propose trials from a sampler, in batches, until the study holds `budget` trials.

    Parameters
    ----------
    study
        Study in which suggestions become trials.
    space
        Distribution of each parameter.
    budget
        Number of trials in the end, those of earlier runs included.
    batch
        Trials suggested before their outcomes are seen; default: a generation for the genetic
        algorithm, 1 along gradients, else :data:`DEFAULT_BATCH`. Batches start at multiples of
        it, so that a study that was stopped and resumed gives the same suggestions.
    sampler
        Function from the number of the next trial to the sampler that suggests it.
    """
    study.use(sampler(0))
    yield unfinished(study, space)
    while (held := len(study.trials())) < budget:
        suggesting = sampler(held)
        size = batch or DEFAULT_BATCH
        room = size - held % size
        if batch is None and isinstance(suggesting, GeneticSampler):
            study.use(suggesting)
            room = study.room(suggesting.room)
        if batch is None and isinstance(suggesting, GradientSampler):
            room = 1
        numbers = range(held, min(held + room, budget))
        yield [_ask(study, space, sampler(number)) for number in numbers]


def seeded_samplers(
    name: str,
    space: Distributions,
    seed: int,
    constraints: Callable[[FrozenTrial], tuple[float, ...]] | None,
    answers: Answers | None = None,
) -> Callable[[int], BaseSampler]:
    """Make a sampler anew for each trial, seeded by the study's seed and the trial's number.

    A study that was stopped and resumed then suggests the same trials as one that ran through.
    Optuna's samplers keep their state in the study, not in themselves.
    """
    if name in ("genetic", "gradient"):
        # Generations are bred from one stream of random numbers; starts have seeds of their own.
        one = sampler_named(name, space, seed=seed, constraints=constraints, answers=answers)
        return lambda number: one

    def sampler(number: int) -> BaseSampler:
        (own_seed,) = np.random.SeedSequence([seed, number]).generate_state(1)
        return sampler_named(name, space, seed=int(own_seed), constraints=constraints)

    return sampler


def unfinished(study: StoredStudy, space: Distributions) -> list[Proposal]:
    """Take up the trials that an earlier run began and did not finish."""
    return [
        _completed(study, space, trial)
        for trial in study.trials(TrialState.RUNNING)
        if OUTCOME_KEY not in trial.user_attrs
    ]


def _completed(study: StoredStudy, space: Distributions, trial: FrozenTrial) -> Proposal:
    """Give a trial the parameters it lacks, if the earlier run stopped while it was set up."""
    if set(trial.params) >= set(space):
        return Proposal(trial.number, rounded(trial.params))
    return Proposal(trial.number, rounded(study.complete(trial.number, space)))


def _create(study: StoredStudy, space: Distributions, point: Mapping[str, Any]) -> Proposal:
    """Put a given point into the storage, with a single write."""
    return Proposal(study.add(space, point), dict(point))


def _ask(study: StoredStudy, space: Distributions, sampler: BaseSampler) -> Proposal:
    study.use(sampler)
    number, parameters = study.ask(space)
    return Proposal(number, rounded(parameters))


def _key(parameters: Mapping[str, Any]) -> frozenset[tuple[str, Any]]:
    return frozenset(rounded(parameters).items())
