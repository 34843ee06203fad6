"""Studies that follow each design along a path."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import pytest

import voxsoft as vs
from voxsoft.design import Constraint, Objective, families
from voxsoft.errors import SimulationError, StudyError
from voxsoft.files import write_study
from voxsoft.plot import plot_paths
from voxsoft.study import Study, evaluate_design

OVER = "loads[0].value=0..2..1 kPa/4"
DOWN = {"probe": "tip", "axis": "z"}


def study_in(folder, **changes):
    family = families.pneunet(chambers=2)
    objectives = {
        "last": Objective(minimize="displacement", **DOWN),
        "deepest": Objective(minimize="displacement", along="smallest", **DOWN),
    }
    settings = {
        "objectives": objectives,
        "constraints": {
            "mean": Constraint(metric="displacement", along="mean", min="-50 mm", **DOWN)
        },
        "folder": folder,
        "over": OVER,
    }
    return Study(family, {"length": ["40 mm", "44 mm"]}, **(settings | changes))


def run(study):
    with ThreadPoolExecutor(1) as threads:
        return study.grid(executor=threads)


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    """The folder of a study, and its result: tests read it."""
    folder = tmp_path_factory.mktemp("study")
    return folder, run(study_in(folder))


@pytest.mark.slow
def test_a_trial_has_the_path_and_the_number_that_counts(stored):
    folder, found = stored
    assert found.counts["ok"] == 2
    for trial in found.trials:
        path = vs.follow(families.pneunet(chambers=2).with_parameters(**trial.parameters), OVER)
        tip = path.columns["tip.z"][1]
        assert trial.path["loads[0].value"] == (0.0, 1000.0, 2000.0, 1000.0)
        assert trial.path["last"] == pytest.approx(tip, abs=1e-9)
        assert trial.objectives["last"] == trial.path["last"][-1]
        assert trial.objectives["deepest"] == min(trial.path["deepest"]) < trial.objectives["last"]
        assert trial.metrics["mean"] == pytest.approx(sum(tip) / len(tip), rel=1e-6)
    # Stored, and not solved again.
    again = run(study_in(folder))
    assert [each.path for each in again.trials] == [each.path for each in found.trials]
    assert [each.seconds for each in again.trials] == [each.seconds for each in found.trials]


@pytest.mark.long
def test_its_folder_holds_the_paths_and_their_picture(stored, tmp_path):
    _, found = stored
    names = {file.name for file in write_study(found, tmp_path)}
    assert {"paths.csv", "paths.png"} <= names
    table = found.paths()
    assert list(table.columns) == ["number", "loads[0].value", "last", "deepest", "mean"]
    assert len(table) == 8
    lines = plot_paths(found, "deepest").axes[0].lines
    assert len(lines) == 3  # two designs, and the best once more
    without = run(study_in(tmp_path / "once", over=None))
    assert without.paths().empty
    with pytest.raises(StudyError, match="no path to draw"):
        plot_paths(without)


@pytest.mark.slow
def test_a_path_that_is_lost_is_not_ok(tmp_path):
    # No pneunet holds a hundred atmospheres.
    found = run(study_in(tmp_path, over="loads[0].value=0..10 MPa/3"))
    assert all(trial.status != "ok" and not trial.objectives for trial in found.trials)
    assert all("lost at loads[0].value" in trial.message for trial in found.trials)


def test_another_path_is_another_study(stored):
    folder, _ = stored
    with pytest.raises(StudyError, match="holds another study"):
        run(study_in(folder, over="loads[0].value=0..1 kPa/4"))


def test_invalid_paths_are_refused_before_the_first_trial(tmp_path):
    with pytest.raises(SimulationError, match="no key with a range"):
        study_in(tmp_path, over="pressure")
    with pytest.raises(StudyError, match="beside an evaluate"):
        study_in(tmp_path, evaluate=evaluate_design)
    one = {"last": Objective(minimize="displacement", **DOWN)}
    study = study_in(tmp_path, objectives=one)
    with pytest.raises(StudyError, match="no slopes along a path"):
        study.optimize("gradient", 4)
