""" "Copy as Python" and "Copy the command" repeat the job, with the same answer."""

import json
import shlex
import subprocess
import sys

import lattice_families as families
import pytest

from voxsoft.errors import FileError
from voxsoft.jobs import DesignSource, MeasuredTable, RunSpec
from voxsoft.jobs.copies import with_copies
from voxsoft.jobs.folder import write_job
from voxsoft.studio.protocol import commands
from voxsoft.studio.running.asked import spec_of
from voxsoft.studio.running.recipes import recipe_of

CLI = "from voxsoft.cli.app import app; app()"
TABLE = "arc_position_from_clamp_mm,dz_mm\n30,-15\n60,-44\n90,-75\n"
OWN_RANGES = {
    "radius": commands.SpaceRange(low=0.01, high=0.02, step=0.005),
    "height": commands.SpaceRange(low=0.02, high=0.03, step=0.005),
    "wall": [0.005, 0.01],
}


def begun(folder, asked, family="paper-cylinder", tables=()):
    """Write the job that a tab asks for, as the studio does before it starts it."""
    design = DesignSource(text=families.family_text(family), folder=str(folder))
    spec = spec_of(asked, design, [MeasuredTable(name=n, text=t) for n, t in tables])
    write_job(with_copies(spec, folder), folder)
    return folder


def do(folder):
    """Do the job as the studio does: in a process of its own."""
    command = [sys.executable, "-m", "voxsoft.studio.running.worker", str(folder)]
    # It stops once nobody is there to tell it anything any more.
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL) as process:
        assert process.wait() == 0


def again(recipe, folder):
    """Do the job again by its command, and give its output."""
    voxsoft = [sys.executable, "-c", CLI, *shlex.split(recipe.command)[1:]]
    command = [*voxsoft, "--out", str(folder), "--json"]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


def script(recipe, folder):
    """Output of the script."""
    file = folder / "again.py"
    file.write_text(recipe.python)
    run = subprocess.run(
        [sys.executable, str(file)], check=True, capture_output=True, text=True, cwd=folder
    )
    return run.stdout


@pytest.mark.slow
@pytest.mark.parametrize("sampler", ["tpe", "grid"])
def test_a_study_is_done_again_with_the_same_best(tmp_path, sampler):
    asked = commands.StudySpec(sampler=sampler, budget=6, seed=7, workers=2, space=OWN_RANGES)
    folder = begun(tmp_path / "runs" / "arm", asked)
    do(folder)
    best = json.loads((folder / "summary.json").read_text())["best"]
    recipe = recipe_of(folder)
    assert recipe.seed == 7
    assert recipe.version
    assert str(best["parameters"]) in script(recipe, tmp_path)
    reported = again(recipe, tmp_path / "out")
    assert reported["same"]
    assert reported["best"]["parameters"] == best["parameters"]


@pytest.mark.slow
def test_a_calibration_is_done_again_with_the_same_constants(tmp_path):
    asked = commands.CalibrateSpec(
        data=[commands.MeasuredData(name="tip.csv")],
        method="cma-es",
        generations=2,
        population=4,
        bounds={"edge": (5e3, 80e3)},
        refine=False,
    )
    folder = begun(tmp_path / "runs" / "fit", asked, "paper-beam", [("tip.csv", TABLE)])
    do(folder)
    reported = json.loads((folder / "summary.json").read_text())
    recipe = recipe_of(folder)
    assert str(reported["parameters"]) in script(recipe, tmp_path)
    assert again(recipe, tmp_path / "out")["same"]


@pytest.mark.slow
def test_a_run_is_done_again_with_the_same_rise(tmp_path):
    folder = begun(tmp_path / "runs" / "one", commands.RunSpec(solver={"method": "xpbd"}))
    do(folder)
    reported = json.loads((folder / "summary.json").read_text())["metrics"]["rise"]
    recipe = recipe_of(folder)
    assert f"'rise': {reported}" in script(recipe, tmp_path)
    found = again(recipe, tmp_path / "out")
    assert found["same"]
    assert found["metrics"]["rise"] == reported
    assert recipe.seed is None


@pytest.mark.slow
def test_the_design_of_a_kept_state_can_be_solved_again(tmp_path):
    design = DesignSource(text=families.family_text("paper-cylinder"))
    write_job(with_copies(RunSpec(design=design, kept=True), tmp_path), tmp_path)
    recipe = recipe_of(tmp_path)
    assert shlex.split(recipe.command) == ["voxsoft", "run", f"{tmp_path}/inputs/design.toml"]
    assert again(recipe, tmp_path / "out")["status"] == "ok"


def test_a_folder_without_a_job_is_reported(tmp_path):
    with pytest.raises(FileError, match="holds no job"):
        recipe_of(tmp_path)
