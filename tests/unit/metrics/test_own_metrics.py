"""Metrics that a user adds with `vs.metric`."""

import importlib
import multiprocessing
import os
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import families
from voxsoft.errors import DesignError, SimulationError, StudyError
from voxsoft.metrics import METRICS, Metric
from voxsoft.metrics.registry import _ALL

SOFT = 'parts.0.material={model="neo-hookean", young="60 kPa"}'
SMALL = families.cylinder(radius="20 mm", height="30 mm").with_values(SOFT, "loads.0.value=1 kPa")


@pytest.fixture(autouse=True, scope="module")
def own_metrics():
    """The metrics of that module, for these tests and no others."""
    before = dict(_ALL)
    sys.modules.pop("own_metrics", None)
    yield importlib.import_module("own_metrics")
    _ALL.clear()
    _ALL.update(before)


@pytest.fixture(scope="module")
def pressed(own_metrics):
    return vs.simulate(SMALL)


def asking(**objectives):
    return SMALL.replace(objectives=objectives)


def test_a_result_measures_it_in_si_units(pressed, own_metrics):
    assert isinstance(own_metrics.tip_height, Metric)
    assert pressed.metric("tip_height") == pressed.positions[:, 2].max()
    assert pressed.metrics["tip_height"] == pressed.metric("tip_height")


def test_a_metric_at_a_probe_learns_which(pressed):
    rise = pressed.metric("displacement", axis="z")
    assert pressed.metric("lean", axis="z") == pytest.approx(rise, rel=1e-12)
    assert "lean" not in pressed.metrics
    with pytest.raises(DesignError, match="lean is not measured in a cavity"):
        pressed.metric("lean", cavity=0)


def test_objectives_and_constraints_take_it():
    design = SMALL.replace(
        objectives={"tall": {"maximize": "tip_height"}},
        constraints={"low": {"metric": "mean_height", "max": "25 mm"}},
    )
    found = vs.simulate(design).metrics
    assert found["tall"] > 0.03
    assert 0.01 < found["low"] < 0.025
    wrong = SMALL.replace(constraints={"low": {"metric": "mean_height", "max": "1 kPa"}})
    with pytest.raises(DesignError, match="mean_height is a length"):
        vs.simulate(wrong)


def test_its_slope_gives_exact_gradients():
    """Along the load of the design, beside central differences of whole simulations."""
    solver = {"method": "statics", "tolerance": 1e-10}
    design = asking(mean={"maximize": "mean_height"}).replace(solver=solver)
    slope = vs.gradient(vs.simulate(design), "mean", "loads.0.value")
    step = 10.0
    high, low = (
        vs.simulate(design.with_values(f"loads.0.value={1000 + sign * step} Pa")).metrics["mean"]
        for sign in (1, -1)
    )
    found = slope if isinstance(slope, float) else slope["mean"]["loads.0.value"]
    # The second order of the step, (10 Pa / 1 kPa)², and the tolerance over the step.
    assert found == pytest.approx((high - low) / (2 * step), rel=1e-3)


@pytest.mark.long
def test_worker_processes_know_it(tmp_path):
    study = vs.Study(
        asking(where={"maximize": "process"}),
        {"wall": ("10 mm", "11 mm", "1 mm")},
        folder=tmp_path,
    )
    # A process for each task, so that none has learned the metric from another.
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=spawn, max_tasks_per_child=1) as executor:
        result = study.grid(executor=executor, workers=1)
    assert result.counts["ok"] == 2
    assert len({trial.objectives["where"] for trial in result.trials} | {os.getpid()}) == 3


@pytest.mark.slow
def test_a_script_may_hold_its_metrics_itself(tmp_path):
    script = tmp_path / "study.py"
    script.write_text(SCRIPT, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, script], capture_output=True, text=True, cwd=tmp_path, check=True
    )
    assert done.stdout == "2 ok\n"


@pytest.mark.long
def test_a_metric_that_workers_cannot_know_is_refused_before_any_trial(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], capture_output=True, text=True, cwd=tmp_path
    )
    assert "workers: do not know the metric widest of __main__" in done.stderr
    assert "executor=ThreadPoolExecutor()" in done.stderr
    assert '"outcome"' not in (tmp_path / "studies" / "wide" / "study.journal").read_text()


SCRIPT = """
import voxsoft as vs
from voxsoft.design import families

@vs.metric(kind="length")
def widest(state):
    return state.positions[:, 0].max()

if __name__ == "__main__":
    design = families.cylinder(radius="20 mm", height="30 mm")
    design = design.replace(objectives={"wide": {"maximize": "widest"}})
    study = vs.Study(design, {"wall": ("10 mm", "11 mm", "1 mm")}, name="wide")
    result = study.grid(workers=1)
    print(result.counts["ok"], result.trials[0].status)
"""


def test_threads_know_shapes_typed_into_a_session(tmp_path):
    @vs.metric(kind="length")
    def here(state):
        return 1.0

    with ThreadPoolExecutor(1) as threads:
        study = vs.Study(
            asking(one={"maximize": "here"}), {"wall": ["10 mm"]}, folder=tmp_path, name="n"
        )
        assert study.grid(executor=threads).best.objectives == {"one": 1.0}


def test_a_study_is_not_resumed_with_another_metric_of_the_same_name(tmp_path):
    def define(function):
        vs.metric(name="changed")(function)
        return vs.Study(
            asking(one={"maximize": "changed"}), {"wall": ["10 mm"]}, folder=tmp_path, name="n"
        )

    def one(state):
        return 1.0

    define(one)
    define(one)
    one.__code__ = (lambda state: 2.0).__code__
    with pytest.raises(StudyError, match=r"holds another study: metrics.changed.source"):
        define(one)


@pytest.mark.parametrize(
    ("options", "function", "words"),
    [
        ({"name": "mass"}, lambda state: 1.0, "metric mass: is the name of a metric of VoxSoft"),
        ({"name": "lean"}, lambda state: 1.0, "is the name of the metric of own_metrics:_lean"),
        ({"name": "n", "kind": "lenght"}, lambda state: 1.0, 'did you mean "length"'),
        ({"name": "n", "needs": {"prob"}}, lambda state: 1.0, 'did you mean "probe"'),
        ({"name": "n", "needs": {"probe"}}, lambda state: 1.0, "expected state and target"),
        ({"name": "n"}, lambda state, target: 1.0, "takes state, target; expected state"),
        ({"name": "n"}, lambda *all: 1.0, "expected state"),
        ({"name": "n\0"}, lambda state: 1.0, "control character"),
    ],
)
def test_invalid_metrics_cannot_be_registered(options, function, words):
    with pytest.raises(DesignError, match=words):
        vs.metric(**options)(function)
    assert "n" not in METRICS


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (lambda state: np.zeros(3), r"metric n: returned an array of the shape \(3,\)"),
        (lambda state: None, "returned None; expected one number in SI units"),
        (lambda state: {}["left"], "metric n: failed: KeyError: 'left'"),
    ],
)
def test_invalid_values_of_a_metric_are_refused(pressed, function, words):
    vs.metric(name="n")(function)
    with pytest.raises(SimulationError, match=words):
        pressed.metric("n")


def test_the_lists_of_the_studio_hold_it(tmp_path):
    from voxsoft.studio.server.catalog import hello

    found = {each.name: each.kind for each in hello(tmp_path).metrics}
    assert found["tip_height"] == "length"
