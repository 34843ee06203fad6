"""Gradient search as a sampler of Optuna: sequential quadratic programming, many starts."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray
from optuna.distributions import BaseDistribution, FloatDistribution
from optuna.samplers import RandomSampler

from voxsoft.errors import StudyError
from voxsoft.search.genes import value_of_gene
from voxsoft.search.optuna_bridge import FrozenTrial, PlacingSampler

if TYPE_CHECKING:
    from optuna import Study

Floats = NDArray[np.float64]

# Relative gain, in parts of the first value, below which a step ends a descent.
_GAIN: Final = 1e-7
_STEPS: Final = 200
# Penalty of a point that cannot be solved over the worst so far, in first values: the line search
# then goes back.
_PENALTY: Final = 10.0


class Answer(NamedTuple):
    """Values and slopes of one trial: objective to minimize, constraints to keep at most 0.

    Attributes
    ----------
    value, slope
        Objective and its derivatives by the parameters, (n,).
    limits, limit_slopes
        Constraints (m,) and their derivatives, (m, n).
    """

    value: float
    slope: Floats
    limits: Floats
    limit_slopes: Floats


class GradientSampler(PlacingSampler):
    """Descend along gradients inside an Optuna study of one objective, start after start.

    Parameters
    ----------
    space
        Distribution of each parameter: ranges without steps.
    answers
        Function from a finished trial to its values and slopes, or None where it failed.
    seed
        Seed of the starts after the first, which is the middle of the space.

    Raises
    ------
    StudyError
        A parameter that is a whole number, a choice, or has a step.

    Notes
    -----
    Each descent is sequential least-squares quadratic programming (Kraft 1988, in SciPy) on ranges
    scaled to [0, 1]. The sampler holds no state beyond the study's: descents are repeated
    from the stored trials, so a study that was stopped goes on as if it had not been. Trials
    asked for before their descent can go on belong to further starts.
    """

    #: Key of a trial's point in its descent, stored as [start, index].
    place_key = "gradient:point"

    def __init__(
        self,
        space: Mapping[str, BaseDistribution],
        answers: Callable[[FrozenTrial], Answer | None],
        *,
        seed: int | None = None,
    ) -> None:
        super().__init__()
        for name, distribution in space.items():
            if not isinstance(distribution, FloatDistribution) or distribution.step is not None:
                raise StudyError(
                    f"space.{name}",
                    'is a whole number, a choice, or has a step; "gradient" searches ranges',
                    'give it a range, such as ("5 mm", "15 mm"), or use "tpe" or "genetic"',
                )
        self._space: dict[str, FloatDistribution] = dict(space)  # type: ignore[arg-type]
        self._answers = answers
        self._seed = 0 if seed is None else seed
        self._outside = RandomSampler(seed=seed)

    def infer_relative_search_space(
        self, study: Study, trial: FrozenTrial
    ) -> dict[str, BaseDistribution]:
        """Return the space given to the constructor."""
        return dict(self._space)

    def sample_relative(
        self, study: Study, trial: FrozenTrial, search_space: dict[str, BaseDistribution]
    ) -> dict[str, Any]:
        """Return the next point of the first descent that waits for one."""
        reported = self.trials_by_place(study)
        for start in itertools.count():
            trials = reported.get(start, {})
            wanted = self._next(start, trials)
            if wanted is None or wanted.index in trials:
                continue  # It has arrived, or its next point is being evaluated.
            self.give_place(study, trial, [start, wanted.index])
            return {
                name: value_of_gene(distribution, float(gene))
                for (name, distribution), gene in zip(
                    self._space.items(), wanted.genes, strict=True
                )
            }
        raise AssertionError("starts do not end")

    def sample_independent(
        self,
        study: Study,
        trial: FrozenTrial,
        param_name: str,
        param_distribution: BaseDistribution,
    ) -> Any:  # noqa: ANN401 - as Optuna declares it
        """Draw a parameter outside the space at random."""
        return self._outside.sample_independent(study, trial, param_name, param_distribution)

    def _next(self, start: int, trials: Mapping[int, FrozenTrial]) -> _Wanted | None:
        """Repeat a descent as far as its trials go; return the next point, or None at its end."""
        genes = np.full(len(self._space), 0.5)
        if start > 0:
            genes = np.random.default_rng([self._seed, start]).random(len(self._space))
        descent = _Descent(self, trials)
        from scipy.optimize import minimize  # slow to load

        # Its stubs require arrays of one dimension, which NumPy's own types do not show.
        run: Any = minimize
        first = trials.get(0)
        count = 0
        try:
            if first is not None and first.state.is_finished():
                count = descent.limits_at(genes).size
            limits: Any = {
                "type": "ineq",
                "fun": lambda x: -descent.limits_at(x),
                "jac": lambda x: -descent.limit_slopes_at(x),
            }
            run(
                descent.value_at,
                genes,
                jac=descent.slope_at,
                method="SLSQP",
                bounds=[(0.0, 1.0)] * len(genes),
                constraints=[limits] if count else [],
                options={"ftol": _GAIN, "maxiter": _STEPS},
            )
        except _Wanted as wanted:
            return wanted
        return None

    def answer(self, trial: FrozenTrial, genes: Floats) -> Answer | None:
        """Return the values of a trial, with slopes by genes in place of parameters."""
        reported = self._answers(trial)
        if reported is None:
            return None
        stretch = np.array(
            [
                value_of_gene(d, float(gene)) * np.log(d.high / d.low) if d.log else d.high - d.low
                for d, gene in zip(self._space.values(), genes, strict=True)
            ]
        )
        return reported._replace(
            slope=reported.slope * stretch, limit_slopes=reported.limit_slopes * stretch
        )


class _Wanted(Exception):
    """Next point of a descent, not evaluated yet."""

    def __init__(self, index: int, genes: Floats) -> None:
        super().__init__(index)
        self.index, self.genes = index, genes


class _Descent:
    """Objective and constraints of a descent: each new point is the next of its trials."""

    def __init__(self, sampler: GradientSampler, trials: Mapping[int, FrozenTrial]) -> None:
        self._sampler, self._trials = sampler, trials
        self._seen: dict[bytes, Answer] = {}
        self._scale = 1.0
        self._worst = 0.0

    def value_at(self, genes: Floats) -> float:
        return self._at(genes).value / self._scale

    def slope_at(self, genes: Floats) -> Floats:
        slope: Floats = self._at(genes).slope / self._scale
        return slope

    def limits_at(self, genes: Floats) -> Floats:
        return self._at(genes).limits

    def limit_slopes_at(self, genes: Floats) -> Floats:
        return self._at(genes).limit_slopes

    def _at(self, genes: Floats) -> Answer:
        genes = np.clip(np.asarray(genes, dtype=np.float64), 0.0, 1.0)
        key = genes.tobytes()
        if key not in self._seen:
            self._seen[key] = self._answer_at(len(self._seen), genes)
        return self._seen[key]

    def _answer_at(self, index: int, genes: Floats) -> Answer:
        trial = self._trials.get(index)
        if trial is None or not trial.state.is_finished():
            raise _Wanted(index, genes)
        reported = self._sampler.answer(trial, genes)
        if reported is None:
            last = next(reversed(self._seen.values()), None)
            value = self._worst + _PENALTY * self._scale
            flat = np.zeros(len(genes))
            if last is None:
                return Answer(value, flat, np.zeros(0), np.zeros((0, len(genes))))
            return last._replace(value=value, slope=flat)
        if not self._seen:
            self._scale, self._worst = abs(reported.value) or 1.0, reported.value
        self._worst = max(self._worst, reported.value)
        return reported
