"""Optuna's samplers, and the paper's genetic algorithm, by name."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from importlib.util import find_spec
from typing import Final

import optuna
from optuna.distributions import BaseDistribution, CategoricalDistribution
from optuna.samplers import BaseSampler

from voxsoft.errors import MissingPackageError, StudyError
from voxsoft.records import closest
from voxsoft.search.genetic_sampler import GeneticSampler
from voxsoft.search.gradient_sampler import Answer, GradientSampler
from voxsoft.search.optuna_bridge import FrozenTrial
from voxsoft.units import round_significant

Constraints = Callable[[FrozenTrial], Sequence[float]]
Answers = Callable[[FrozenTrial], Answer | None]

#: Names that :func:`sampler_named` knows, with the use of each.
SAMPLERS: Final[Mapping[str, str]] = {
    "grid": "every combination of the steps and choices",
    "random": "uniform draws",
    "tpe": "tree-structured Parzen estimator; one or several objectives",
    "cma-es": "covariance matrix adaptation; one objective, numbers only",
    "gp": "Gaussian process; one or several objectives; needs PyTorch",
    "nsga-ii": "non-dominated sorting; several objectives",
    "nsga-iii": "non-dominated sorting with reference points; three objectives or more",
    "genetic": "the paper's genetic algorithm; one objective",
    "gradient": "along exact slopes, from many starts; one objective, ranges without steps",
}


#: Number of designs in a generation of NSGA, as in the paper: Optuna's 50 leave a budget
#: of 100 with two generations, the first of which is drawn at random.
_POPULATION: Final = 30
#: Mutation probability of NSGA, as in the paper. Optuna's 1 / parameters is one half in two
#: dimensions, so that a fresh draw leads back to points that cannot be solved.
_MUTATION: Final = 0.05

#: Samplers that take one objective only.
SINGLE_OBJECTIVE: Final = frozenset({"cma-es", "genetic", "gradient"})


def sampler_named(
    name: str,
    space: Mapping[str, BaseDistribution],
    *,
    seed: int | None = None,
    constraints: Constraints | None = None,
    answers: Answers | None = None,
) -> BaseSampler:
    """Make a sampler.

    Parameters
    ----------
    name
        Key of :data:`SAMPLERS`.
    space
        Distribution of each parameter.
    seed
        Seed of the sampler; the same seed and the same answers give the same suggestions.
    constraints
        Function from a finished trial to numbers that are at most 0 where a constraint holds. It
        reaches the samplers that know constraints: all but ``grid``, ``random`` and ``cma-es``.
    answers
        Function from a finished trial to its values and slopes, which ``gradient`` needs.

    Raises
    ------
    StudyError
        An unknown name, a grid over a range without a step, or ``cma-es`` in a space that it
        cannot search.
    MissingPackageError
        ``gp`` without PyTorch; the message holds the pip command.

    Examples
    --------
    >>> from optuna.distributions import IntDistribution
    >>> type(sampler_named("tpe", {"count": IntDistribution(1, 9)}, seed=0)).__name__
    'TPESampler'
    """
    if name not in SAMPLERS:
        raise StudyError("sampler", f'"{name}" is not known', closest(name, SAMPLERS))
    if name == "gradient":
        if answers is None:
            what = '"gradient" needs trials that report their slopes'
            raise StudyError("sampler", what, 'use it with Study.optimize("gradient", ...)')
        return GradientSampler(space, answers, seed=seed)
    with warnings.catch_warnings():
        # Multivariate TPE and others are marked as subject to change; the tests run them all.
        warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
        # Optuna 5 moves constraints from the sampler to the trial; Optuna 4 knows only this way.
        warnings.filterwarnings("ignore", message=".*constraints_func", category=FutureWarning)
        return _make(name, dict(space), seed, constraints)


def _make(
    name: str,
    space: dict[str, BaseDistribution],
    seed: int | None,
    constraints: Constraints | None,
) -> BaseSampler:
    match name:
        case "grid":
            return optuna.samplers.GridSampler(grid_values(space), seed=seed)
        case "random":
            return optuna.samplers.RandomSampler(seed=seed)
        case "tpe":
            return optuna.samplers.TPESampler(
                seed=seed, multivariate=True, constant_liar=True, constraints_func=constraints
            )
        case "cma-es":
            _require_numbers(space)
            # The margin keeps the search from freezing on stepped ranges (Hamano et al. 2022,
            # doi:10.1145/3512290.3528827).
            return optuna.samplers.CmaEsSampler(
                seed=seed, warn_independent_sampling=False, with_margin=_all_stepped(space)
            )
        case "gp":
            return _gaussian_process(seed, constraints)
        case "nsga-ii":
            return optuna.samplers.NSGAIISampler(
                population_size=_POPULATION,
                mutation_prob=_MUTATION,
                seed=seed,
                constraints_func=constraints,
            )
        case "nsga-iii":
            return optuna.samplers.NSGAIIISampler(
                population_size=_POPULATION,
                mutation_prob=_MUTATION,
                seed=seed,
                constraints_func=constraints,
            )
        case _:
            return GeneticSampler(space, seed=seed, constraints_func=constraints)


def _require_numbers(space: Mapping[str, BaseDistribution]) -> None:
    """Refuse a space in which Optuna would quietly draw at random instead."""
    choices = [name for name, d in space.items() if isinstance(d, CategoricalDistribution)]
    if choices:
        what = f'"cma-es" searches numbers, and {", ".join(choices)} is a list of choices'
        raise StudyError("sampler", what, 'use "tpe" or "genetic"')
    if len(space) < 2:
        what = '"cma-es" needs at least two parameters, and there is one'
        raise StudyError("sampler", what, 'use "tpe"')


def _gaussian_process(seed: int | None, constraints: Constraints | None) -> BaseSampler:
    if find_spec("torch") is None:
        raise MissingPackageError(
            "sampler", '"gp" needs PyTorch, which is not installed', "pip install torch"
        )
    return optuna.samplers.GPSampler(
        seed=seed,
        constraints_func=constraints,
        deterministic_objective=True,
        warn_independent_sampling=False,
    )


def grid_values(
    space: Mapping[str, BaseDistribution],
) -> dict[str, list[bool | float | str | None]]:
    """List the values of each parameter that a grid tries.

    Raises
    ------
    StudyError
        A range without a step.

    Examples
    --------
    >>> from optuna.distributions import IntDistribution
    >>> grid_values({"count": IntDistribution(1, 3)})
    {'count': [1, 2, 3]}
    """
    return {name: _steps(name, distribution) for name, distribution in space.items()}


def _steps(name: str, distribution: BaseDistribution) -> list[bool | float | str | None]:
    if isinstance(distribution, CategoricalDistribution):
        return list(distribution.choices)
    step = getattr(distribution, "step", None)
    if step is None:
        raise StudyError(
            f"space.{name}",
            "has no step, so a grid over it has no end",
            "give it a step, or use another sampler",
        )
    low, high = distribution.low, distribution.high  # type: ignore[attr-defined]
    values = [low + index * step for index in range(round((high - low) / step) + 1)]
    return [round_significant(value) if isinstance(value, float) else value for value in values]


def _all_stepped(space: Mapping[str, BaseDistribution]) -> bool:
    return all(getattr(distribution, "step", None) is not None for distribution in space.values())
