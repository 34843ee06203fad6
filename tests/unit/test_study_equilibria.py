"""What a study keeps of the states of its designs, beside its trials."""

import os
import tomllib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from voxsoft.design import Design, families
from voxsoft.simulation import simulate
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
    np.testing.assert_array_equal(found, solved.positions)


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


def test_the_oldest_are_dropped_where_there_is_no_room(tmp_path, rested):
    state = Equilibrium.of(rested)
    size = state.positions.nbytes
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
