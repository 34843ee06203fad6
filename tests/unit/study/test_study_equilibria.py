"""States that a study keeps of its designs, beside its trials."""

import os
import tomllib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from gripped_ball import GRIPPER
from pressed import pressed

from voxsoft.design import Design, families
from voxsoft.simulation import Setup, simulate
from voxsoft.study import Outcome, Study, evaluate_design
from voxsoft.study.equilibria import FOLDER, Equilibria, Equilibrium

# A bar of some length, which may be too short to hold a voxel.
BAR = """
schema = "voxsoft/1"
name = "bar"
voxel_size = "5 mm"
[parameters]
length = { value = "40 mm", min = "1 um", max = "60 mm" }
[shapes]
body = { kind = "box", size = ["= length", "10 mm", "10 mm"] }
[[parts]]
shape = "body"
material = "ecoflex-00-30-lattice"
[[clamps]]
region = { x = [0, 0] }
[[loads]]
kind = "gravity"
[probes]
tip = { x = ["= length", "= length"] }
[objectives]
sag = { minimize = "displacement", probe = "tip", axis = "z" }
"""


#: Closed on its ball, and not yet lifted far: the kept state does not depend on the way.
CLOSED = Design.from_document(tomllib.loads(GRIPPER.replace("0.15 s", "0.08 s")))
SQUEEZE = 0.4e-3


@pytest.fixture(scope="module")
def closed():
    """Results of a trial."""
    return simulate(CLOSED.with_parameters(squeeze=SQUEEZE))


@pytest.fixture(scope="module")
def rested():
    return simulate(families.beam())


def test_a_study_keeps_the_state_of_each_design_that_came_to_rest(tmp_path):
    bar = Design.from_document(tomllib.loads(BAR))
    study = Study(bar, {"length": [0.03, 0.05, 1e-5]}, folder=tmp_path)
    with ThreadPoolExecutor(1) as threads:
        result = study.grid(executor=threads)
    known = Equilibria(tmp_path / FOLDER)
    assert {trial.status for trial in result.trials} == {"ok", "failed"}
    for trial in result.trials:
        assert known.holds(trial.hash) == (trial.status == "ok")
    solved = simulate(bar.with_parameters(**result.best.parameters))
    found = known.find(result.best.hash, solved.mesh)
    np.testing.assert_array_equal(found.positions, solved.positions)
    assert found.state is None  # these are measured anew


@pytest.mark.slow
def test_a_study_keeps_all_that_was_found_of_a_design_with_contact(tmp_path, closed):
    study = Study(CLOSED, {"squeeze": [SQUEEZE]}, folder=tmp_path)
    with ThreadPoolExecutor(1) as threads:
        best = study.grid(executor=threads).best
    found = Equilibria(tmp_path / FOLDER).find(best.hash, closed.mesh)
    assert found.objects == closed.objects
    result = found.result(Setup.of(closed.design))
    np.testing.assert_array_equal(result.positions, closed.positions)
    assert result.contacts == closed.contacts
    assert len(result.contacts) == 1
    assert result.metrics == closed.metrics
    assert result.metrics["grip"] == best.objectives["grip"]
    np.testing.assert_array_equal(result.contact_field.pressure, closed.contact_field.pressure)


@pytest.mark.slow
def test_stored_states_are_a_small_part_of_a_motion(tmp_path):
    result = simulate(CLOSED, frames=True, record_interval=0.01)
    Equilibria(tmp_path).keep("a", Equilibrium.of(result))
    (file,) = tmp_path.iterdir()
    assert file.stat().st_size < 0.5 * result.recording.frames.nbytes


def test_a_trial_that_is_not_at_rest_and_a_path_keep_no_state():
    solid = families.cylinder(wall="20 mm", radius="20 mm")
    assert evaluate_design(solid).equilibrium is None
    ok = evaluate_design(families.sphere())
    assert ok.equilibrium is not None
    # Outcomes are compared by their numbers, which arrays could not be.
    assert Outcome("ok") == Outcome("ok", equilibrium=ok.equilibrium)


def test_a_state_is_that_of_one_mesh(tmp_path, rested):
    known = Equilibria(tmp_path)
    known.keep("a", Equilibrium.of(rested))
    assert known.find("a", rested.mesh) is not None
    assert known.find("b", rested.mesh) is None
    other = replace(rested.mesh, vertices=1.1 * rested.mesh.vertices)
    assert known.find("a", other) is None


@pytest.mark.parametrize("content", [b"", b"PK\3\4 no archive", b"\x93NUMPY"])
def test_a_damaged_file_is_as_none(tmp_path, rested, content):
    known = Equilibria(tmp_path)
    known.keep("a", Equilibrium.of(rested))
    (tmp_path / "a.npz").write_bytes(content)
    assert known.find("a", rested.mesh) is None


@pytest.mark.parametrize("missing", ["state", "arrays", "array0", "positions"])
def test_an_incomplete_file_gives_no_result(tmp_path, missing):
    result = simulate(pressed())
    known = Equilibria(tmp_path)
    known.keep("a", Equilibrium.of(result))
    with np.load(tmp_path / "a.npz") as content:
        left = {name: content[name] for name in content.files if name != missing}
    np.savez(tmp_path / "a.npz", **left)
    found = known.find("a", result.mesh)
    # Without the other results, its positions are no result of a design with contact.
    assert found is None or found.result(Setup.of(result.design)) is None


def test_the_oldest_are_dropped_where_there_is_no_room(tmp_path, rested):
    state = Equilibrium.of(rested)
    Equilibria(tmp_path).keep("a", state)
    size = (tmp_path / "a.npz").stat().st_size
    known = Equilibria(tmp_path, room=4 * size)
    for number, name in enumerate("abcdefgh"):
        known.keep(name, state)
        os.utime(tmp_path / f"{name}.npz", (number, number))
    kept = sorted(file.stem for file in tmp_path.iterdir())
    assert kept[-1] == "h"
    assert 0 < len(kept) <= 4
    assert sum(file.stat().st_size for file in tmp_path.iterdir()) <= 4 * size


def test_a_folder_that_cannot_be_written_costs_nothing(tmp_path, rested):
    (tmp_path / "file").write_text("")
    known = Equilibria(tmp_path / "file")
    known.keep("a", Equilibrium.of(rested))
    assert known.find("a", rested.mesh) is None
