"""Unknown constraints count as broken, and samplers learn from designs without an answer."""

from __future__ import annotations

import itertools
import math
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from voxsoft.design import Constraint, Design, families
from voxsoft.study import Outcome, Study
from voxsoft.study.trial import violations

sys.path.insert(0, str(Path(__file__).parents[3] / "evidence"))
from unsolvable import shares

WALLS = {"wall": ("5 mm", "8 mm", "1 mm")}
LIMITS = {
    "safety": Constraint(metric="mass", max=0.0),
    "light": Constraint(metric="mass", max="10 kg"),
    "stiff": Constraint(metric="mass", min="1 g"),
}


@pytest.mark.parametrize("unknown", [math.nan, None, math.inf])
@pytest.mark.parametrize("order", list(itertools.permutations(LIMITS)))
def test_unknown_is_broken_in_any_order(order: tuple[str, ...], unknown: float | None):
    metrics = {"safety": unknown, "light": 0.1, "stiff": 0.1}
    found = violations(metrics, {name: LIMITS[name] for name in order})
    assert not any(map(math.isnan, found))
    assert max(found) == math.inf


def evaluate(design: Design) -> Outcome:
    wall = float(design.parameters["wall"].value)
    safety = math.nan if wall > 0.0055 else -1.0
    return Outcome("ok", metrics={"weight": -wall, "safety": safety, "light": 0.1, "stiff": 0.1})


@pytest.mark.parametrize("sampler", ["tpe", "nsga-ii", "nsga-iii", "genetic", "random"])
@pytest.mark.parametrize("order", [("safety", "light"), ("light", "safety")])
def test_searches_go_on_with_unknown_values(sampler: str, order: tuple[str, ...], tmp_path: Path):
    study = Study(
        families.sphere(),
        WALLS,
        {"weight": {"minimize": "mass"}},
        {name: LIMITS[name] for name in order},
        evaluate=evaluate,
        seed=1,
        folder=tmp_path,
    )
    with ThreadPoolExecutor(1) as thread:
        result = study.optimize(sampler, budget=12, executor=thread)
    assert {trial.status for trial in result.trials} == {"ok"}
    # Only the thinnest wall has a known safety, however much better the others look.
    for trial in result.trials:
        assert trial.feasible == (trial.metrics["safety"] == -1.0)
    if any(trial.feasible for trial in result.trials):
        assert result.best is not None
        assert result.best.metrics["safety"] == -1.0


#: Same kind as the quick ones, and as those of tests/unit/study/test_study_unknown.py.
SLOWER = [pytest.param(name, marks=pytest.mark.slow) for name in ("tpe", "nsga-ii", "nsga-iii")]


@pytest.mark.parametrize("sampler", ["cma-es", "genetic", *SLOWER])
def test_samplers_learn_to_avoid_unsolvable_designs(sampler: str):
    # One design in five can be solved. Random search has at most 0.2 + 3 sqrt(0.2 0.8 / 50) = 0.37
    # of the last 50, once in a thousand.
    assert shares(sampler, seed=0)[1] > 0.37
