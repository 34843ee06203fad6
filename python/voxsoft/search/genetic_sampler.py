"""The paper's genetic algorithm as a sampler of Optuna."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from optuna.distributions import BaseDistribution
from optuna.samplers import RandomSampler

from voxsoft.errors import StudyError
from voxsoft.search.genes import value_of_gene
from voxsoft.search.genetic import Genetic
from voxsoft.search.optuna_bridge import (
    FrozenTrial,
    PlacingSampler,
    StudyDirection,
    TrialState,
)

if TYPE_CHECKING:
    from optuna import Study

# Fitness of the worst trial that finished; the best has 1 and a failed one 0.
_LEAST_FITNESS = 0.1


class GeneticSampler(PlacingSampler):
    """Search with :class:`~voxsoft.search.Genetic` inside any Optuna study of one objective.

    Parameters
    ----------
    space
        Distribution of each parameter; one gene each.
    population, elites, mutation, seed
        See :class:`~voxsoft.search.Genetic`.
    constraints_func
        Function from a finished trial to numbers that are at most 0 where a constraint holds.

    Raises
    ------
    StudyError
        An empty space, or a number outside its range.

    Notes
    -----
    Roulette-wheel selection needs fitness that is not negative, while an objective is any number.
    Within each generation the objective is scaled linearly: the best trial has fitness 1, the
    worst that finished 0.1; a trial that failed, was pruned, or breaks a constraint has 0.

    Elites keep their value and are not evaluated again, so the first generation takes N trials
    and each later one N - E. The sampler holds no state beyond the study's: generations are
    bred again from the stored trials, so a study that was stopped goes on as if it had not been.

    The next generation can be bred only once every trial of the current one has finished. A
    trial asked for before that (`n_jobs` of Optuna) gets a random point outside the generations;
    :meth:`room` counts the trials that can be asked for without that.

    Examples
    --------
    >>> import optuna
    >>> optuna.logging.set_verbosity(optuna.logging.WARNING)
    >>> space = {"x": optuna.distributions.FloatDistribution(-5, 5)}
    >>> study = optuna.create_study(sampler=GeneticSampler(space, seed=1))
    >>> study.optimize(lambda trial: trial.suggest_float("x", -5, 5) ** 2, n_trials=300)
    >>> study.best_value < 0.1
    True
    """

    #: Key of a trial's individual, stored as [generation, index].
    place_key = "genetic:individual"

    def __init__(
        self,
        space: Mapping[str, BaseDistribution],
        *,
        population: int = 30,
        elites: int = 2,
        mutation: float = 0.05,
        seed: int | None = None,
        constraints_func: Callable[[FrozenTrial], Sequence[float]] | None = None,
    ) -> None:
        super().__init__()
        if not space:
            raise StudyError("space", "is empty", "name at least one parameter")
        self._space = dict(space)
        self._search = Genetic(
            len(space), population=population, elites=elites, mutation=mutation, seed=seed
        )
        self._elite_values = np.zeros(0)
        self._constraints_func = constraints_func
        self._outside = RandomSampler(seed=seed)

    def room(self, study: Study) -> int:
        """Count the individuals of the current generation that no trial evaluates yet."""
        return len(self._unassigned(self._advance(study)))

    def infer_relative_search_space(
        self, study: Study, trial: FrozenTrial
    ) -> dict[str, BaseDistribution]:
        """Return the space given to the constructor."""
        return dict(self._space)

    def sample_relative(
        self, study: Study, trial: FrozenTrial, search_space: dict[str, BaseDistribution]
    ) -> dict[str, Any]:
        """Return the next individual of the current generation."""
        free = self._unassigned(self._advance(study))
        if not free:
            return {}
        self.give_place(study, trial, [self._search.generation, free[0]])
        genes = self._search.ask()[free[0]]
        return {
            name: value_of_gene(distribution, float(gene))
            for (name, distribution), gene in zip(self._space.items(), genes, strict=True)
        }

    def sample_independent(
        self,
        study: Study,
        trial: FrozenTrial,
        param_name: str,
        param_distribution: BaseDistribution,
    ) -> Any:  # noqa: ANN401 - as Optuna declares it
        """Draw a parameter outside the space, or outside the generations, at random."""
        return self._outside.sample_independent(study, trial, param_name, param_distribution)

    def _advance(self, study: Study) -> dict[int, FrozenTrial]:
        """Breed up to the first generation that has unfinished individuals; return its trials."""
        if len(study.directions) > 1:
            raise StudyError(
                "sampler",
                f"the genetic algorithm takes one objective, and there are {len(study.directions)}",
                'use "nsga-ii" or "nsga-iii"',
            )
        generations = self.trials_by_place(study)
        while True:
            trials = generations.get(self._search.generation, {})
            if any(i not in trials or not trials[i].state.is_finished() for i in self._new()):
                return trials
            self._breed(trials, study.direction)

    def _breed(self, trials: Mapping[int, FrozenTrial], direction: StudyDirection) -> None:
        values = np.concatenate(
            [self._elite_values, [self._value(trials[index]) for index in self._new()]]
        )
        fitness = _scaled(values if direction == StudyDirection.MAXIMIZE else -values)
        # Ranked as Genetic does: equal fitness by index.
        elites = np.argsort(-fitness, kind="stable")[: self._search.elites]
        self._search.tell(fitness)
        self._elite_values = values[elites]

    def _value(self, trial: FrozenTrial) -> float:
        if trial.state != TrialState.COMPLETE:
            return np.nan
        limits = () if self._constraints_func is None else self._constraints_func(trial)
        # Written without "> 0": NaN is unknown, and unknown counts as broken.
        if not all(broken <= 0 for broken in limits):
            return np.nan
        return float(trial.values[0])

    def _new(self) -> range:
        """Return the indices of individuals that are no elites of the generation before."""
        return range(len(self._elite_values), self._search.population)

    def _unassigned(self, trials: Mapping[int, FrozenTrial]) -> list[int]:
        return [index for index in self._new() if index not in trials]


def _scaled(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Scale values, larger being better and NaN meaning failed, to fitness, (N,)."""
    finished = np.isfinite(values)
    if not finished.any():
        return np.zeros(len(values))
    low, high = values[finished].min(), values[finished].max()
    share = (values - low) / (high - low) if high > low else np.ones(len(values))
    return np.where(finished, _LEAST_FITNESS + (1.0 - _LEAST_FITNESS) * share, 0.0)
