"""Search methods: the paper's genetic algorithm, gradients, CMA-ES, and Optuna's samplers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.calibration.descent import descend
from voxsoft.calibration.misfit import Evaluation, Misfit
from voxsoft.errors import StudyError
from voxsoft.search import Genetic
from voxsoft.search.samplers import SAMPLERS

#: One generation of candidates, evaluated.
Batch = Sequence[Evaluation]

#: Function from a misfit, generations, population and seed to batches of evaluated candidates.
Method = Callable[[Misfit, int, int, int], Iterator[Batch]]

# Standard deviation of the first CMA-ES generation: it covers the space without crowding the
# bounds, as its authors advise for a range of 1 (Hansen 2016, arXiv:1604.00772, section B.4).
_FIRST_SPREAD: Final = 0.3

# Error that CMA-ES and Optuna get for a candidate that failed, in m: worse than any beam.
_FAILED: Final = 1e3


def method_named(name: str) -> Method:
    """Return a search method by name.

    Parameters
    ----------
    name
        ``genetic``, ``gradient``, ``cma-es``, or a sampler of :mod:`voxsoft.search.samplers`.

    Raises
    ------
    StudyError
        An unknown name.
    """
    if name in _METHODS:
        return _METHODS[name]
    from voxsoft.records import closest

    if name not in METHODS:
        raise StudyError("method", f'"{name}" is not known', closest(name, METHODS))

    def search(misfit: Misfit, generations: int, population: int, seed: int) -> Iterator[Batch]:
        return _optuna(misfit, generations, population, seed, sampler=name)

    return search


def _genetic(misfit: Misfit, generations: int, population: int, seed: int) -> Iterator[Batch]:
    """Search by Algorithm 4 of the paper."""
    search = Genetic(len(misfit.space), population=population, seed=seed)
    for _ in range(generations):
        batch = misfit.many(search.ask())
        yield batch
        search.tell([candidate.fitness for candidate in batch])


def _cma_es(misfit: Misfit, generations: int, population: int, seed: int) -> Iterator[Batch]:
    """Search by covariance matrix adaptation on the error itself; stop when it has converged."""
    from cmaes import CMA

    count = len(misfit.space)
    # The package requires two dimensions or more: one modulus gets a companion without effect.
    width = max(count, 2)
    search = CMA(
        mean=np.full(width, 0.5),
        sigma=_FIRST_SPREAD,
        bounds=np.tile([0.0, 1.0], (width, 1)),
        population_size=population,
        seed=seed,
    )
    for _ in range(generations):
        asked = [search.ask() for _ in range(population)]
        batch = misfit.many(np.array(asked)[:, :count])
        yield batch
        search.tell([(genes, _loss(c)) for genes, c in zip(asked, batch, strict=True)])
        if search.should_stop():
            return


def _optuna(
    misfit: Misfit, generations: int, population: int, seed: int, *, sampler: str
) -> Iterator[Batch]:
    """Search by an Optuna sampler, a population at a time, so that workers change nothing."""
    from optuna.distributions import FloatDistribution

    from voxsoft.search.optuna_bridge import ask_in_memory
    from voxsoft.search.samplers import sampler_named

    space = {name: FloatDistribution(0.0, 1.0) for name in misfit.space.names}
    ask, tell = ask_in_memory(sampler_named(sampler, space, seed=seed), space)
    for _ in range(generations):
        trials = ask(population)
        genes = [[parameters[name] for name in space] for _, parameters in trials]
        batch = misfit.many(np.array(genes))
        yield batch
        tell({number: _loss(each) for (number, _), each in zip(trials, batch, strict=True)})


def _loss(candidate: Evaluation) -> float:
    return min(candidate.error, _FAILED)


_METHODS: Final[dict[str, Method]] = {
    "genetic": _genetic,
    "gradient": descend,
    "cma-es": _cma_es,
}

#: Names of all methods. A grid needs a step, which a modulus does not have.
METHODS: Final = (*_METHODS, *(name for name in SAMPLERS if name not in (*_METHODS, "grid")))


def errors_of(batch: Batch) -> NDArray[np.float64]:
    """Return the errors of a batch in m, infinite where a simulation failed."""
    return np.array([candidate.error for candidate in batch])
