"""Misfit between a simulated and a measured body, and its fitness."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Final, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from voxsoft.calibration.experiment import Experiment
from voxsoft.calibration.linearization import seen_slopes
from voxsoft.calibration.space import Space
from voxsoft.errors import MaterialError
from voxsoft.materials import Material
from voxsoft.simulation import Ensemble, Settled, Status, balance, relax
from voxsoft.simulation.runs.many import settled_of

T = TypeVar("T")
U = TypeVar("U")

#: Factor k of the paper's fitness, for errors in m.
FITNESS_FACTOR: Final = -10.0

#: Relative residual at which a candidate counts as at rest.
TOLERANCE: Final = 1e-6
# A beam of 72 voxels needs 800 to 10,000 steps; a lattice that is a thousand times softer along its
# edges than in bulk would take millions, and no data call for one.
_MAX_STEPS: Final = 30_000

# Range of a free scale: photographs are scaled wrong by some percent, not by more than this.
_SCALES: Final = (0.5, 2.0)


@dataclass(frozen=True)
class Deviation:
    """Simulated numbers beside the measured ones.

    Attributes
    ----------
    simulated, measured
        Simulated and measured numbers, (n, q), m; `simulated` is scaled already.
    scale
        Factor on the simulated shape; 1 unless it was freed.
    positions
        Vertices of the simulated body at rest under load, before scaling, (v, 3), m.
    """

    simulated: NDArray[np.float64]
    measured: NDArray[np.float64]
    scale: float
    positions: NDArray[np.float64] = field(repr=False)

    @property
    def errors(self) -> NDArray[np.float64]:
        """Length of the error vector at each station, (n,), m."""
        lengths: NDArray[np.float64] = np.linalg.norm(self.simulated - self.measured, axis=1)
        return lengths


@dataclass(frozen=True)
class Evaluation:
    """One candidate with its error and fitness.

    Attributes
    ----------
    genes
        Coordinates in the search space, each from 0 to 1.
    status
        Status of its simulations; the first that is not ``ok`` counts.
    error
        Mean over the experiments of the mean error, m; infinite if a simulation failed.
    fitness
        ``exp(S)``, zero if a simulation failed.
    scales
        The factor on the simulated shape in each experiment.
    """

    genes: tuple[float, ...]
    status: Status
    error: float
    fitness: float
    scales: tuple[float, ...]


@dataclass(frozen=True)
class Linearized:
    """Candidate with its derivatives by the logarithms of the constants.

    Attributes
    ----------
    evaluation
        Error and fitness of the candidate.
    deviations
        Deviation from the measurement in each experiment.
    slopes
        Derivatives of the simulated numbers before scaling, (n, q, k) for each experiment, m.
    """

    evaluation: Evaluation
    deviations: tuple[Deviation, ...]
    slopes: tuple[NDArray[np.float64], ...]


#: Deviation and state of each experiment, or the status of the first that failed.
_Solved = list[tuple[Deviation, Settled]] | Status
#: Function that runs a task for each input, in some order.
_Runner = Callable[
    [Callable[[Material], Settled], Sequence[Material]],
    list[Settled],
]


def _one_by_one(task: Callable[[Material], Settled], inputs: Sequence[Material]) -> list[Settled]:
    return [task(each) for each in inputs]


def best_scale(simulated: NDArray[np.float64], measured: NDArray[np.float64]) -> float:
    """Find the factor ``s`` that minimizes the sum over stations of ``|s simulated - measured|``.

    The sum is convex in ``s``, so that a search along one line finds it.

    Parameters
    ----------
    simulated, measured
        Numbers at the stations, (n, q), m.

    Examples
    --------
    >>> shape = np.array([[0.01, -0.002], [0.02, -0.01], [0.03, -0.02]])
    >>> round(best_scale(shape, 1.1 * shape), 9)
    1.1
    """
    from scipy.optimize import minimize_scalar  # slow to load

    def total(scale: float) -> float:
        return float(np.linalg.norm(scale * simulated - measured, axis=1).sum())

    found = minimize_scalar(total, bounds=_SCALES, method="bounded", options={"xatol": 1e-10})
    return float(found.x)


class Misfit:
    r"""Function that a calibration minimizes, with a cache of evaluated candidates.

    Parameters
    ----------
    experiments
        Experiments to compare; each has the same weight.
    space
        Ranges of the constants.
    free_scale
        True if each experiment has a factor of its own on the simulated shape.
    workers
        Number of simulations at a time; the answers do not depend on it.
    tolerance
        Relative residual at which a body counts as at rest.
    statics
        True to solve by statics in place of relaxation; both find the same state.
    lanes
        True to solve several candidates at a time by statics, one in each lane of the processor,
        where that is quicker (:class:`voxsoft.simulation.Ensemble`). Candidates left open are
        solved as without.

    Notes
    -----
    With :math:`r` the error vector of a station, the paper's fitness is :math:`e^S` with
    :math:`S = k \sum |r|` over the stations and :math:`k = -10` per meter. For several
    experiments :math:`S = k \bar n \, \overline{|r|}`, where the mean error of each
    experiment has the same weight and :math:`\bar n` is the mean number of stations; for one
    experiment the two are the same.
    """

    def __init__(
        self,
        experiments: Sequence[Experiment],
        space: Space,
        *,
        free_scale: bool = False,
        workers: int = 1,
        tolerance: float = TOLERANCE,
        statics: bool = False,
        lanes: bool = True,
    ) -> None:
        self.experiments = tuple(experiments)
        self.space = space
        self.free_scale = free_scale
        self.workers = workers
        self.tolerance = tolerance
        self.statics = statics
        self._ensembles = [
            Ensemble.of(experiment.setup) if lanes else None for experiment in self.experiments
        ]
        self._seen: dict[tuple[float, ...], Evaluation] = {}
        self._lock = threading.Lock()
        self._pool: ThreadPoolExecutor | None = None

    @property
    def evaluations(self) -> int:
        """Number of candidates that were simulated; equal genes count once."""
        return len(self._seen)

    @property
    def numbers(self) -> int:
        """Number of measured numbers in all experiments together."""
        return sum(experiment.measurement.values.size for experiment in self.experiments)

    @contextmanager
    def pool(self) -> Iterator[None]:
        """Hold `workers` threads open; solvers free the interpreter lock while they work."""
        with ThreadPoolExecutor(self.workers, "calibrate") as self._pool:
            try:
                yield
            except BaseException:
                self._pool.shutdown(cancel_futures=True)
                raise
            finally:
                self._pool = None

    def many(self, genes: NDArray[np.float64]) -> list[Evaluation]:
        """Evaluate candidates side by side, (m, n) → m evaluations in the same order."""
        with self._lock:
            new = [key for key in dict.fromkeys(map(_key, genes)) if key not in self._seen]
        solved = self._solved_many(new, self.side_by_side)
        evaluations = {key: self._worth(key, found) for key, found in zip(new, solved, strict=True)}
        with self._lock:
            self._seen.update(evaluations)
        return [self.at(row) for row in genes]

    def side_by_side(self, task: Callable[[T], U], inputs: Sequence[T]) -> list[U]:
        """Run a task for each input on the open threads; results in the order of the inputs."""
        if self._pool is None:
            return [task(each) for each in inputs]
        return list(self._pool.map(task, inputs))

    def at(self, genes: ArrayLike) -> Evaluation:
        """Evaluate one candidate, (n,)."""
        key = _key(genes)
        with self._lock:
            known = self._seen.get(key)
        if known is None:
            known = self._evaluate(key)
            with self._lock:
                self._seen[key] = known
        return known

    def compare(self, genes: ArrayLike) -> list[Deviation] | Status:
        """Simulate every experiment and compare it with its measurement.

        Returns the status of the first simulation that failed, if one did.
        """
        solved = self._solved(genes)
        return solved if isinstance(solved, str) else [deviation for deviation, _ in solved]

    def linearized(self, genes: ArrayLike) -> Linearized | Status:
        """Evaluate one candidate, (n,), and its slopes; return the status of a failed one."""
        key = _key(genes)
        solved = self._solved(key)
        evaluation = self._worth(key, solved)
        with self._lock:
            evaluation = self._seen.setdefault(key, evaluation)
        if isinstance(solved, str):
            return solved
        material = self.space.material_at(key)
        slopes = tuple(
            seen_slopes(experiment, self.space, material, result.positions)
            for experiment, (_, result) in zip(self.experiments, solved, strict=True)
        )
        return Linearized(evaluation, tuple(deviation for deviation, _ in solved), slopes)

    @property
    def ways(self) -> tuple[str, ...]:
        """Solver of each experiment, in words."""
        alone = "statics" if self.statics else "xpbd relaxation"
        return tuple("statics in lanes" if each else alone for each in self._ensembles)

    def _solved(self, genes: ArrayLike) -> _Solved:
        return self._solved_many([_key(genes)], _one_by_one)[0]

    def _solved_many(self, keys: Sequence[tuple[float, ...]], run: _Runner) -> list[_Solved]:
        """Simulate every experiment with each candidate, experiment by experiment."""
        found: list[_Solved] = [[] for _ in keys]
        materials: dict[int, Material] = {}
        for index, key in enumerate(keys):
            try:
                materials[index] = self.space.material_at(key)
            except MaterialError:  # constants that are valid each, and not together
                found[index] = "failed"
        for experiment, ensemble in zip(self.experiments, self._ensembles, strict=True):
            settled = self._settled(experiment, ensemble, list(materials.values()), run)
            for index, result in zip(list(materials), settled, strict=True):
                here = found[index]
                if result.status != "ok" or isinstance(here, str):
                    found[index] = result.status
                    del materials[index]
                    continue
                simulated = experiment.seen_at(result.positions)
                measured = experiment.measurement.values
                scale = best_scale(simulated, measured) if self.free_scale else 1.0
                compared = Deviation(scale * simulated, measured, scale, result.positions)
                here.append((compared, result))
        return found

    def _settled(
        self,
        experiment: Experiment,
        ensemble: Ensemble | None,
        materials: Sequence[Material],
        run: _Runner,
    ) -> list[Settled]:
        found: list[Settled | None] = [None] * len(materials)
        if ensemble is not None:
            found = ensemble.settle(materials, [1.0] * len(materials), self.tolerance)
        open_ones = [material for material, each in zip(materials, found, strict=True) if not each]
        alone = iter(run(lambda material: self._settle(experiment, material), open_ones))
        return [next(alone) if each is None else each for each in found]

    def _settle(self, experiment: Experiment, material: Material) -> Settled:
        setup = experiment.setup
        problem = setup.problem_with([material] * len(experiment.design.parts))
        if self.statics:
            return settled_of(setup, balance(setup, problem, self.tolerance))
        return settled_of(setup, relax(setup, problem, self.tolerance, _MAX_STEPS))

    def fitness(self, error: float) -> float:
        """Fitness of a mean error in m."""
        stations = sum(len(experiment.measurement) for experiment in self.experiments)
        return float(np.exp(FITNESS_FACTOR * error * stations / len(self.experiments)))

    def _evaluate(self, genes: tuple[float, ...]) -> Evaluation:
        return self._worth(genes, self._solved(genes))

    def _worth(self, genes: tuple[float, ...], solved: _Solved) -> Evaluation:
        if isinstance(solved, str):
            return Evaluation(genes, solved, np.inf, 0.0, (1.0,) * len(self.experiments))
        error = float(np.mean([deviation.errors.mean() for deviation, _ in solved]))
        scales = tuple(deviation.scale for deviation, _ in solved)
        return Evaluation(genes, "ok", error, self.fitness(error), scales)


def _key(genes: ArrayLike) -> tuple[float, ...]:
    return tuple(float(gene) for gene in np.atleast_1d(np.asarray(genes, dtype=np.float64)))
