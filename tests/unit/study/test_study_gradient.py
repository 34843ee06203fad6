"""Studies along gradients: the optimum on a constraint, resumption, and refusals."""

from concurrent.futures import ThreadPoolExecutor

import lattice_families as families
import pytest

from voxsoft import Study
from voxsoft.errors import StudyError

SPACE = {"stiff": ("3 kPa", "40 kPa"), "second": ("1 kPa", "10 kPa")}
OBJECTIVES = {"energy": {"maximize": "elastic_energy"}}
CONSTRAINTS = {"sag": {"metric": "displacement", "probe": "station-9", "max": "4 mm"}}


def beam():
    return families.beam(length="40 mm").with_values(
        'parts.0.material={model="ogden", mu=["= stiff", "= second"], alpha=[1.7, -3.3]}',
        'parameters.stiff={value="10 kPa", min="2 kPa", max="40 kPa"}',
        'parameters.second={value="2 kPa", min="1 kPa", max="10 kPa"}',
    )


def run(folder, budget, space=None, **changes):
    study = Study(beam(), space or SPACE, OBJECTIVES, CONSTRAINTS, folder=folder, **changes)
    with ThreadPoolExecutor(1) as threads:
        return study.optimize("gradient", budget, executor=threads)


def test_the_optimum_lies_on_the_constraint(tmp_path):
    """The softer the more energy, until the tip sags as far as it may: one descent finds it."""
    result = run(tmp_path / "one", 14)
    assert result.counts["ok"] == 14
    best = result.best
    assert best.feasible
    # The margin by which a descent keeps inside, and as much again for its last step.
    assert best.metrics["sag"] == pytest.approx(4e-3, rel=2e-6)
    # Along the constraint stiffness trades between the constants: both slopes are parallel there.
    energy, sag = (
        [best.metrics[f"d {target} / d {name}"] for name in SPACE] for target in ("energy", "sag")
    )
    assert energy[0] / energy[1] == pytest.approx(sag[0] / sag[1], rel=0.02)


def test_a_study_that_was_stopped_goes_on_as_if_not(tmp_path):
    whole = run(tmp_path / "whole", 7)
    run(tmp_path / "cut", 3)
    resumed = run(tmp_path / "cut", 7)
    assert [t.parameters for t in resumed.trials] == [t.parameters for t in whole.trials]
    assert [t.objectives for t in resumed.trials] == [t.objectives for t in whole.trials]


def test_logarithmic_ranges_have_their_own_slopes(tmp_path):
    space = {"stiff": ("3 kPa", "40 kPa", "log"), "second": ("1 kPa", "10 kPa", "log")}
    result = run(tmp_path / "log", 14, space)
    assert result.trials[0].parameters["stiff"] == pytest.approx((3e3 * 40e3) ** 0.5)
    assert result.best.metrics["sag"] == pytest.approx(4e-3, rel=1e-4)


def test_goals_without_a_gradient_are_refused_before_any_trial(tmp_path):
    cylinder = families.cylinder()
    stepped = Study(cylinder, folder=tmp_path / "a")
    with pytest.raises(StudyError, match=r"changes the shape.*fraction"):
        stepped.optimize("gradient", 3)
    steps = {**SPACE, "second": ("1 kPa", "10 kPa", "1 kPa")}
    with pytest.raises(StudyError, match=r"space\.second: .*has a step"):
        run(tmp_path / "b", 3, steps)
    function = Study(families.cylinder, {"wall": (0.005, 0.01)}, OBJECTIVES, folder=tmp_path / "c")
    with pytest.raises(StudyError, match="the family is a function"):
        function.optimize("gradient", 3)
    two = {**OBJECTIVES, "light": {"minimize": "mass"}}
    with pytest.raises(StudyError, match="takes one objective"):
        Study(beam(), SPACE, two, folder=tmp_path / "d").optimize("gradient", 3)
