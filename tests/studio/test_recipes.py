"""What "Copy as Python" and "Copy the command" give does the job again, with the same answer."""

import json
import shlex
import subprocess
import sys

import lattice_families as families
import pytest

from voxsoft.errors import FileError
from voxsoft.studio.commands import CalibrateSpec, MeasuredData, RunSpec, SpaceRange, StudySpec
from voxsoft.studio.recipes import recipe_of
from voxsoft.studio.task import Table, Task

CLI = "from voxsoft.cli.app import app; app()"
TABLE = "arc_position_from_clamp_mm,dz_mm\n30,-15\n60,-44\n90,-75\n"
OWN_RANGES = {
    "radius": SpaceRange(low=0.01, high=0.02, step=0.005),
    "height": SpaceRange(low=0.02, high=0.03, step=0.005),
    "wall": SpaceRange(low=0.005, high=0.015, step=0.005),
}


def task_in(folder, spec, family="paper-cylinder", tables=()):
    folder.mkdir(parents=True)
    text = families.family_text(family)
    task = Task(folder.name, folder.name, text, str(folder), spec, list(tables))
    task.write(folder)
    return task


def do(folder):
    """Do the job as the studio does: in a process of its own."""
    command = [sys.executable, "-m", "voxsoft.studio.worker", str(folder)]
    # It stops once nobody is there to tell it anything any more.
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL) as process:
        assert process.wait() == 0


def again(recipe, folder, *more):
    """Do the job again by its command, and give what it answers."""
    voxsoft = [sys.executable, "-c", CLI, *shlex.split(recipe.command)[1:]]
    command = [*voxsoft, "--out", str(folder), "--json", *more]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


def script(recipe, folder):
    """What the script prints."""
    file = folder / "again.py"
    file.write_text(recipe.python)
    run = subprocess.run(
        [sys.executable, str(file)], check=True, capture_output=True, text=True, cwd=folder
    )
    return run.stdout


@pytest.mark.slow
@pytest.mark.parametrize("sampler", ["tpe", "grid"])
def test_a_study_is_done_again_with_the_same_best(tmp_path, sampler):
    spec = StudySpec(sampler=sampler, budget=6, seed=7, workers=2, space=OWN_RANGES)
    folder = tmp_path / "runs" / "arm"
    task_in(folder, spec)
    do(folder)
    best = json.loads((folder / "summary.json").read_text())["best"]
    recipe = recipe_of(folder)
    assert recipe.seed == 7
    assert recipe.version
    assert str(best["parameters"]) in script(recipe, tmp_path)
    assert again(recipe, tmp_path / "out")["best"]["parameters"] == best["parameters"]


@pytest.mark.slow
def test_a_calibration_is_done_again_with_the_same_constants(tmp_path):
    spec = CalibrateSpec(
        data=[MeasuredData(name="tip.csv")], method="cma-es", generations=2, population=4
    )
    folder = tmp_path / "runs" / "fit"
    task_in(folder, spec, "paper-beam", [Table("tip.csv", TABLE)])
    do(folder)
    told = json.loads((folder / "summary.json").read_text())
    recipe = recipe_of(folder)
    assert str(told["parameters"]) in script(recipe, tmp_path)
    assert again(recipe, tmp_path / "out")["parameters"] == told["parameters"]


@pytest.mark.slow
def test_a_run_is_done_again_with_the_same_rise(tmp_path):
    folder = tmp_path / "runs" / "one"
    task_in(folder, RunSpec(solver={"method": "xpbd"}))
    do(folder)
    told = json.loads((folder / "summary.json").read_text())["metrics"]["rise"]
    recipe = recipe_of(folder)
    assert f"'rise': {told}" in script(recipe, tmp_path)
    assert again(recipe, tmp_path / "out")["metrics"]["rise"] == told
    assert recipe.seed is None


@pytest.mark.parametrize(
    "changes",
    [
        {"space": {"radius": SpaceRange(low=0.01, high=0.02)}},
        {"space": {"radius": [0.01, 0.02]}},
        {"objectives": {"rise": {"maximize": "volume"}}},
        {"batch": 3},
    ],
)
def test_what_the_command_line_cannot_say_is_left_to_python(tmp_path, changes):
    task_in(tmp_path / "arm", StudySpec(**changes))
    recipe = recipe_of(tmp_path / "arm")
    assert recipe.command == ""
    compile(recipe.python, "again.py", "exec")


def test_a_folder_that_the_studio_did_not_write_is_said(tmp_path):
    with pytest.raises(FileError, match="holds no job"):
        recipe_of(tmp_path)
