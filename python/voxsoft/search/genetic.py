"""The paper's genetic algorithm, with an ask-and-tell interface."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from voxsoft.errors import StudyError


class Individual(NamedTuple):
    """One candidate with its fitness.

    Attributes
    ----------
    genes
        Genes in [0, 1], (n,).
    fitness
        Fitness, never negative; larger is better.
    """

    genes: NDArray[np.float64]
    fitness: float


class Genetic:
    r"""A genetic algorithm with elites, roulette-wheel selection and uniform crossover.

    Every generation is a matrix of N individuals with n genes each, all in [0, 1]; the caller
    maps genes to its own ranges (moduli: on a log scale). From one generation with fitness
    :math:`f_i \ge 0` the next consists of

    1. the E fittest, unchanged (the elites);
    2. N - E children. Both parents are drawn by the roulette wheel, individual i with probability

       .. math:: p_i = f_i / \sum_j f_j;

       each gene comes from either parent with probability 1/2 (uniform crossover) and is then
       replaced, with probability m, by a fresh uniform draw from [0, 1] (mutation).

    Parameters
    ----------
    genes
        Number n of genes, at least 1.
    population
        Number N of individuals, at least 2.
    elites
        Number E of individuals kept unchanged, 0 to N - 1. With at least one, the best
        individual is never lost.
    mutation
        Probability m with which a gene is drawn afresh, 0 to 1.
    seed
        Seed; with the same fitness it gives the same generations, bit for bit. None draws a
        seed from the operating system.

    Attributes
    ----------
    generation : int
        Index of the generation that :meth:`ask` returns; it rises by one with each :meth:`tell`.

    Raises
    ------
    StudyError
        A number outside its range.

    Notes
    -----
    Source: Algorithm 4 of the VoxSoft paper (Ahmad and Wurdemann), with its values as defaults:
    N = 30, E = 2, m = 0.05; it runs 50 generations. Uniform crossover is due to Syswerda,
    "Uniform crossover in genetic algorithms", Proc. 3rd Int. Conf. on Genetic Algorithms, 1989.

    The algorithm leaves some choices open, which are read like this:

    - the two parents are drawn independently, so that one individual can be both;
    - mutation is decided for each gene on its own, and elites never mutate;
    - individuals of equal fitness rank in the order of their index;
    - where every fitness is zero, the wheel has no widths and parents are drawn uniformly.

    The paper counts N evaluations per generation. Elites come back unchanged and first, so a caller
    whose fitness has no noise can keep their fitness. That makes N + (G - 1)(N - E) evaluations
    for G generations instead of N G.

    Examples
    --------
    >>> import numpy as np
    >>> search = Genetic(genes=2, seed=1)
    >>> for _ in range(50):
    ...     candidates = search.ask()
    ...     distance = np.linalg.norm(candidates - [0.3, 0.7], axis=1)
    ...     search.tell(np.exp(-10 * distance))
    >>> search.best.genes.round(1)
    array([0.3, 0.7])
    """

    def __init__(
        self,
        genes: int,
        *,
        population: int = 30,
        elites: int = 2,
        mutation: float = 0.05,
        seed: int | None = None,
    ) -> None:
        _require(genes >= 1, "genes", genes, "at least 1")
        _require(population >= 2, "population", population, "at least 2")
        _require(0 <= elites < population, "elites", elites, f"from 0 to {population - 1}")
        _require(0.0 <= mutation <= 1.0, "mutation", mutation, "a probability from 0 to 1")
        self.population, self.genes = population, genes
        self.elites, self.mutation = elites, mutation
        self.generation = 0
        self._random = np.random.default_rng(seed)
        self._current = self._random.random((population, genes))
        self._best: Individual | None = None

    def ask(self) -> NDArray[np.float64]:
        """Return the individuals of the current generation, (N, n); elites come first.

        Calling it again before :meth:`tell` returns the same individuals.
        """
        return self._current.copy()

    @property
    def best(self) -> Individual:
        """Fittest individual of all generations so far.

        Raises
        ------
        StudyError
            No generation was evaluated yet.
        """
        if self._best is None:
            raise StudyError("best", "no generation has been evaluated", "call tell(fitness) first")
        return self._best

    def tell(self, fitness: ArrayLike) -> None:
        """Set the fitness of the current generation, and breed the next one.

        Parameters
        ----------
        fitness
            One number for each individual, finite and not negative, (N,).

        Raises
        ------
        StudyError
            Another shape, or a number that is negative, infinite or NaN.
        """
        fitness = self._checked(fitness)
        order = np.argsort(-fitness, kind="stable")
        fittest = order[0]
        if self._best is None or fitness[fittest] > self._best.fitness:
            self._best = Individual(self._current[fittest].copy(), float(fitness[fittest]))
        kept = order[: self.elites]
        self._current = np.concatenate([self._current[kept], self._children(fitness)])
        self.generation += 1

    def _children(self, fitness: NDArray[np.float64]) -> NDArray[np.float64]:
        shape = (self.population - self.elites, self.genes)
        odds = _roulette_odds(fitness)
        mothers, fathers = self._random.choice(self.population, size=(2, shape[0]), p=odds)
        from_mother = self._random.random(shape) < 0.5
        children = np.where(from_mother, self._current[mothers], self._current[fathers])
        mutates = self._random.random(shape) < self.mutation
        return np.where(mutates, self._random.random(shape), children)

    def _checked(self, fitness: ArrayLike) -> NDArray[np.float64]:
        values = np.asarray(fitness, dtype=np.float64)
        if values.shape != (self.population,):
            raise StudyError(
                "fitness",
                f"has the shape {values.shape}; expected one number for each of the "
                f"{self.population} individuals",
            )
        wrong = np.flatnonzero(~(np.isfinite(values) & (values >= 0)))
        if wrong.size:
            raise StudyError(
                "fitness",
                f"individual {wrong[0]} of generation {self.generation} has {values[wrong[0]]}; "
                "expected finite numbers of at least 0",
                "give a candidate that failed the fitness 0",
            )
        return values


def _roulette_odds(fitness: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the probability of each individual to be a parent, (N,)."""
    largest = fitness.max()
    if largest == 0.0:
        return np.full(len(fitness), 1.0 / len(fitness))
    # Scaled first, so that neither the smallest nor the largest floats spoil the sum.
    widths = fitness / largest
    odds: NDArray[np.float64] = widths / widths.sum()
    return odds


def _require(holds: bool, name: str, value: float, allowed: str) -> None:
    if not holds:
        raise StudyError(name, f"{value} is not possible; {allowed} is")
