"""Designs that cannot be solved, and constraints that are unknown, in a study."""

import math
from concurrent.futures import ThreadPoolExecutor

import pytest
from hypothesis import given
from hypothesis import strategies as st
from study_families import FALL, SPACE, block, bowl, parameters

from voxsoft.comparison.confirmation import Confirmation, Confirmed
from voxsoft.comparison.richardson import Estimate
from voxsoft.design import Constraint
from voxsoft.search.genetic_sampler import GeneticSampler
from voxsoft.search.optuna_bridge import TrialState
from voxsoft.study import Outcome, Study
from voxsoft.study.trial import violations

NAN, INF = float("nan"), float("inf")
LIMITS = {"light": {"metric": "mass", "max": 10}, "stiff": {"metric": "mass", "max": 10}}
VALUES = st.sampled_from([None, NAN, INF, -1.0, 0.0, 1.0])


@given(st.permutations("abcd"), st.dictionaries(st.sampled_from("abcd"), VALUES))
def test_unknown_is_broken_in_every_order(order, metrics):
    limit = Constraint(metric="mass", max=0.5)
    found = violations(metrics, dict.fromkeys(order, limit))
    held = all(value is not None and value <= 0.5 for value in map(metrics.get, "abcd"))
    assert not any(math.isnan(value) for value in found)
    assert (max(found) <= 0) is held


def unsure(design):
    """A constraint is unknown where the best designs are."""
    x, _ = parameters(design)
    unknown = NAN if x < 0.55 else -1.0
    return Outcome("ok", "", {**bowl(design).metrics, "light": 0.0, "stiff": unknown})


@pytest.mark.long
@pytest.mark.parametrize("order", [("light", "stiff"), ("stiff", "light")])
@pytest.mark.parametrize("sampler", ["tpe", "nsga-ii", "nsga-iii", "genetic", "cma-es"])
def test_a_study_with_unknown_constraints_ends_with_a_best_that_holds(tmp_path, sampler, order):
    limits = {name: LIMITS[name] for name in order}
    study = Study(block, SPACE, FALL, limits, evaluate=unsure, folder=tmp_path)
    with ThreadPoolExecutor(1) as thread:
        result = study.optimize(sampler, budget=40, executor=thread)
    assert result.best.parameters["x"] > 0.55
    assert any(trial.status == "ok" and not trial.feasible for trial in result.trials)
    assert all(trial.feasible == (trial.metrics["stiff"] <= 0) for trial in result.trials)


@pytest.mark.parametrize("order", [(0.0, NAN), (NAN, 0.0)])
def test_the_genetic_sampler_takes_nan_as_broken(order):
    class Finished:
        state, values = TrialState.COMPLETE, [1.0]

    sampler = GeneticSampler({"x": None}, constraints_func=lambda trial: order)
    assert math.isnan(sampler._value(Finished()))


def narrow(design):
    """One in five of the designs can be solved."""
    x, y = parameters(design)
    if x > 0.2:
        return Outcome("diverged", "too wide")
    return Outcome("ok", "", {"a": y, "b": -x, "c": y - x})


@pytest.mark.long
@pytest.mark.parametrize(
    ("sampler", "names"),
    [
        ("nsga-ii", "ab"),
        ("tpe", "a"),
        ("genetic", "a"),
        pytest.param("nsga-ii", "a", marks=pytest.mark.slow),
        pytest.param("nsga-iii", "abc", marks=pytest.mark.slow),
        pytest.param("tpe", "ab", marks=pytest.mark.slow),
    ],
)
def test_samplers_learn_from_designs_that_cannot_be_solved(tmp_path, sampler, names):
    objectives = {name: {"minimize": "mass"} for name in names}
    space = {"x": (0.0, 1.0), "y": (1.0, 10.0)}
    study = Study(block, space, objectives, evaluate=narrow, seed=0, folder=tmp_path)
    with ThreadPoolExecutor(1) as thread:
        trials = study.optimize(sampler, budget=200, executor=thread).trials
    share = sum(trial.status == "ok" for trial in trials[-50:]) / 50
    # Uniform draws: 0.2, with a standard deviation of sqrt(0.2 * 0.8 / 50) = 0.057.
    assert share > 0.2 + 4 * 0.057


def test_one_design_that_was_solved_again_is_no_failure():
    again = Confirmed(None, Estimate.__new__(Estimate))
    object.__setattr__(again.estimate, "values", (1.0, 2.0))
    found = Confirmation("rise", {}, (0.002, 0.001), (again,), maximize=True)
    assert found.sentence == "the design was solved again; one alone has no ranking"
