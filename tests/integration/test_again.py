"""``voxsoft again``: every kind of job is repeated to the bit, and differences are reported."""

import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import lattice_families as families
import meshio
import numpy as np
import pytest
from typer.testing import CliRunner
from waiting import until

from voxsoft import jobs
from voxsoft.cli.app import app
from voxsoft.cli.exits import DIFFERS, INTERRUPTED, INVALID, NOT_AT_REST
from voxsoft.files.cards import save_card
from voxsoft.jobs.folder import JOB
from voxsoft.materials import load_card

ROOT = Path(__file__).parents[2]
CYLINDER, BEAM = ROOT / "examples" / "cylinder.toml", ROOT / "examples" / "beam.toml"
DATA = ROOT / "examples" / "data" / "paper_beams" / "ecoflex-00-30.csv"
FEW = ["--set", "parameters.radius.min=20 mm", "--set", "parameters.height.min=30 mm"]
RANDOM = ["--sampler", "random", "--seed", "3", "--workers", "2"]
FIT = ["--method", "cma-es", "--generations", "2", "--population", "4", "--workers", "1"]
SMALL = ["--set", "radius=15 mm", "--set", "height=20 mm"]
ONE_SPLIT = ["--outside", "none", "--voxel-sizes", "none", "--splits", "1", "--solvers", "xpbd"]
SCRIPT = "from voxsoft.cli import main; main()"


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def call(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def done(*arguments, code=0):
    outcome = call(*arguments)
    assert outcome.exit_code == code, outcome.stderr
    return outcome


def printed(*arguments, code=0):
    return json.loads(done(*arguments, "--json", code=code).stdout)


def tampered(file, before, after):
    text = Path(file).read_text()
    assert before in text
    Path(file).write_text(text.replace(before, after, 1))


@pytest.mark.long
@pytest.mark.parametrize(
    "job",
    [
        pytest.param(["run", CYLINDER, "--set", "wall=10 mm"], id="run"),
        pytest.param(
            ["run", BEAM, "--solver", "xpbd", "--set", "solver.end_time=0.05 s"], id="motion"
        ),
        pytest.param(["sweep", CYLINDER, *FEW, "--workers", 1], id="sweep"),
        pytest.param(
            ["optimize", CYLINDER, *RANDOM, "--budget", 6, "--confirm", 1],
            id="confirmed",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            ["optimize", CYLINDER, *RANDOM, "--budget", 6],
            id="optimize",
            marks=pytest.mark.slow,  # a study as the sweep is
        ),
        pytest.param(
            ["calibrate", BEAM, DATA, *FIT, "--name", "job"],
            id="calibrate",
            marks=pytest.mark.slow,  # test_a_parameter_that_was_changed_is_reported repeats one
        ),
        pytest.param(
            ["compare", CYLINDER, *SMALL, *ONE_SPLIT],
            id="compare",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_a_job_is_repeated_to_the_same_bits_from_a_moved_folder(job):
    first = printed(*job, "--out", "first")
    Path("elsewhere").mkdir()
    shutil.move("first", "elsewhere/moved")
    again = printed("again", "elsewhere/moved")
    assert (again["same"], again["differences"]) == (True, [])
    assert again["folder"] == str(Path("elsewhere", "moved-again"))
    kept = {"seconds", "folder", "report", "runs"}
    assert {k: v for k, v in again.items() if k in first.keys() - kept} == {
        k: v for k, v in first.items() if k not in kept
    }
    names = [{p.name for p in Path("elsewhere", f).iterdir()} for f in ("moved", "moved-again")]
    assert names[0] == names[1]
    if job[0] == "run":  # a repetition is a job itself
        assert printed("again", "elsewhere/moved-again", "--out", "third")["same"]


@pytest.mark.slow
def test_a_study_that_was_resumed_is_repeated_the_way_it_went():
    """A budget that was raised leaves a cut batch: other suggestions than those in one go."""
    # The third changes nothing.
    for sampler, budget in (("tpe", 12), ("tpe", 16), ("tpe", 16), ("random", 17), ("random", 18)):
        search = ["--sampler", sampler, "--budget", budget, "--workers", 2]
        done("optimize", CYLINDER, *search, "--out", "s")
    reported = jobs.load("s").spec
    stages = [(stage.sampler, stage.budget) for stage in reported.earlier]
    assert stages == [("tpe", 12), ("tpe", 16), ("random", 17)]
    assert printed("again", "s")["same"]
    went = [trial.parameters for trial in jobs.run_job(reported, "s").found.trials]
    in_one_go = jobs.run_job(reported.replace(sampler="tpe", budget=16, earlier=()), "one")
    assert [trial.parameters for trial in in_one_go.found.trials] != went[:16]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
def test_an_interrupted_study_keeps_its_tables_and_is_repeated_once_done():
    command = [sys.executable, "-c", SCRIPT, "sweep", str(CYLINDER)]
    command += ["--out", "s", "--workers", "1"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True)
    journal = Path("s", "study.journal")

    def has_stored_three():
        assert process.poll() is None, process.stderr.read()
        return journal.is_file() and journal.read_text().count('"outcome"') >= 3

    until(has_stored_three, "three trials")
    os.killpg(process.pid, signal.SIGINT)
    _, reported = process.communicate(timeout=120)
    assert process.returncode == INTERRUPTED, reported
    assert "which are kept in s" in reported
    assert Path("s", JOB).is_file()
    kept = len(Path("s", "table.csv").read_text().splitlines()) - 1
    assert 3 <= kept < 105
    # The folder holds less than the whole study: a repetition says so.
    assert printed("again", "s", code=DIFFERS)["trials"] == 105
    done("sweep", CYLINDER, "--out", "s", "--workers", "2")
    assert printed("again", "s")["same"]


MESHED = """
name = "scan"
voxel_size = "5 mm"
[shapes]
body = { kind = "mesh", path = "scan.stl", unit = "mm" }
[parameters]
load = { value = "1 kPa", min = "1 kPa", max = "2 kPa", step = "1 kPa" }
[[parts]]
shape = "body"
material = "cards/mine.toml"  # of the same tube
[[clamps]]
region = { z = ["0 mm", "0 mm"] }
[[loads]]
kind = "gravity"
[probes]
top = { z = ["20 mm", "20 mm"] }
[objectives.sag]
minimize = "displacement"
probe = "top"
"""


@pytest.fixture
def meshed(tmp_path):
    """A design of a mesh and a card of its own."""
    home = tmp_path / "home"
    (home / "cards").mkdir(parents=True)
    save_card(load_card("ecoflex-00-30"), home / "cards" / "mine.toml")
    points = np.array([[x, y, z] for x in (0.0, 10.0) for y in (0.0, 10.0) for z in (0.0, 20.0)])
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]]
    faces += [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    meshio.Mesh(points, [("triangle", np.array(faces))]).write(home / "scan.stl")
    (home / "design.toml").write_text(MESHED)
    return home


@pytest.mark.slow
def test_meshes_and_cards_go_with_the_folder(meshed):
    done("run", meshed / "design.toml", "--out", "r")
    done("sweep", meshed / "design.toml", "--out", "s", "--workers", 1)
    # Their first place does not count any more, nor does the place where the folders were made.
    meshed.rename(meshed.parent / "gone")
    for name in ("r", "s"):
        shutil.move(name, f"moved-{name}")
        assert printed("again", f"moved-{name}")["same"]
    text = Path("moved-r", "inputs", "design.toml").read_text()
    assert "# of the same tube" in text
    assert str(meshed) not in Path("moved-r", "design.toml").read_text() + text
    assert printed("run", "moved-r/design.toml", "--out", "r2")["status"] == "ok"
    # A study that was moved goes on, too.
    outcome = jobs.run_job(jobs.load("moved-s").spec, "moved-s")
    assert outcome.earlier == len(outcome.found.trials) == 2


def test_a_mesh_that_changed_makes_another_study(meshed):
    done("sweep", meshed / "design.toml", "--out", "s", "--workers", 1)
    mesh = meshio.read(meshed / "scan.stl")
    mesh.points *= 2.0
    mesh.write(meshed / "scan.stl")
    outcome = call("sweep", meshed / "design.toml", "--out", "s", "--workers", 1)
    assert outcome.exit_code == 2
    assert "another study" in outcome.stderr


@pytest.fixture(scope="module")
def jobs_done(tmp_path_factory):
    """A run and a calibration, which each test takes a copy of: folders of jobs can be moved."""
    folder = tmp_path_factory.mktemp("done")
    done("run", BEAM, "--out", folder / "beam")
    done("calibrate", BEAM, DATA, *FIT, "--out", folder / "fit")
    return folder


@pytest.fixture
def beam(jobs_done):
    return Path(shutil.copytree(jobs_done / "beam", "beam"))


@pytest.fixture
def fit(jobs_done):
    return Path(shutil.copytree(jobs_done / "fit", "fit"))


@pytest.mark.slow
def test_a_result_that_was_changed_is_reported(beam):
    tampered(beam / "summary.json", '"sag": ', '"sag": 1')
    assert (
        "differs: summary.json, metrics.sag: was 10.0" in done("again", beam, code=DIFFERS).stderr
    )
    (found,) = printed("again", beam, code=DIFFERS)["differences"]
    assert (found["file"], found["where"]) == ("summary.json", "metrics.sag")


@pytest.mark.long
def test_a_state_that_differs_in_one_bit_is_reported(beam):
    file = beam / "result.vtu"
    content = meshio.read(file)
    moved = content.point_data["displacement"]
    moved[7, 2] = np.nextafter(moved[7, 2], 1.0)
    content.write(file)
    found = printed("again", beam, code=DIFFERS)
    assert not found["same"]
    assert [(each["file"], each["where"]) for each in found["differences"]] == [
        ("result.vtu", "displacement[7][2]")
    ]
    file.unlink()
    assert printed("again", beam)["same"], "what is not there cannot differ"
    file.write_text("no file of ParaView")
    assert "damaged" in done("again", beam, code=DIFFERS).stderr


def test_a_resolved_design_that_was_changed_is_reported(beam):
    tampered(beam / "design.toml", 'voxel_size = "5 mm"', 'voxel_size = "4 mm"')
    (found,) = printed("again", beam, code=DIFFERS)["differences"]
    assert found == {
        "file": "design.toml",
        "where": "voxel_size",
        "before": "4 mm",
        "after": "5 mm",
    }


@pytest.mark.slow
def test_a_trial_that_was_changed_is_reported():
    done("sweep", CYLINDER, *FEW, "--out", "s", "--workers", 1)
    tampered("s/table.csv", ",ok,", ",diverged,")
    (found,) = printed("again", "s", code=DIFFERS)["differences"]
    assert (found["file"], found["where"]) == ("table.csv", "[0].status")


@pytest.mark.long
def test_a_parameter_that_was_changed_is_reported(fit):
    tampered(fit / "ecoflex-00-30.toml", "bulk = ", 'bulk = "1 kPa" # ')
    (found,) = printed("again", fit, code=DIFFERS)["differences"]
    assert (found["file"], found["where"]) == ("ecoflex-00-30.toml", "material.bulk")


@pytest.mark.parametrize(
    ("folder", "file"),
    [("beam", "inputs/design.toml"), ("fit", "design.toml"), ("fit", "measured/1.csv")],
)
def test_inputs_of_a_job_must_be_unchanged(folder, file, request):
    request.getfixturevalue(folder)
    with Path(folder, file).open("a") as text:
        text.write("# a word\n")
    outcome = done("again", folder, code=INVALID)
    assert f"{Path(file).name}: was changed since the job was begun" in outcome.stderr
    Path(folder, file).unlink()
    reported = printed("again", folder, code=INVALID)
    assert "is missing" in reported["problems"][0]["what"]
    assert not Path(f"{folder}-again").exists()


def test_another_version_and_machine_are_reported_as_reasons(beam):
    tampered(beam / "summary.json", '"sag": ', '"sag": 1')
    tampered(beam / JOB, 'version = "', 'version = "0.0.')
    tampered(beam / JOB, 'machine = "', 'machine = "VAX ')
    outcome = done("again", beam, code=DIFFERS)
    assert "the VoxSoft was another: 0.0." in outcome.stderr
    assert "the machine was another: VAX" in outcome.stderr


def test_a_run_that_never_came_to_rest_is_the_same_again():
    timed = ["--set", "solver.max_time=0.02 s", "--set", "solver.time_step=10 ms"]
    done("run", BEAM, *timed, "--out", "r", code=NOT_AT_REST)
    assert printed("again", "r")["status"] == "not-at-rest"


def test_a_job_that_cannot_be_repeated_is_reported(beam):
    Path("empty").mkdir()
    assert "holds no job.toml" in done("again", "empty", code=INVALID).stderr
    assert "is not empty" in done("again", beam, "--out", beam, code=5).stderr
    tampered(beam / JOB, "kept = false", "kept = true")
    assert "kept from the studio's screen" in done("again", beam, code=INVALID).stderr
    tampered(beam / JOB, "voxsoft-job/1", "voxsoft-job/9")
    assert 'expected "voxsoft-job/1"' in done("again", beam, code=INVALID).stderr
    assert done("again", "nowhere", code=2)


@pytest.mark.slow
def test_a_job_of_the_studio_before_job_toml_is_repeated(tmp_path):
    """The studio kept its jobs as job.json, with the text of the design and of the tables."""
    text = families.family_text("paper-beam")
    table = "arc_position_from_clamp_mm,dz_mm\n30,-15\n60,-44\n90,-75\n"
    spec = {"kind": "calibrate", "data": [{"name": "tip.csv"}], "method": "cma-es", "name": None}
    spec |= {"generations": 2, "population": 4, "bounds": {"edge": [5e3, 80e3]}, "workers": None}
    folder = tmp_path / "old"
    folder.mkdir()
    job = {"id": "old", "name": "old", "design": text, "base": str(tmp_path), "spec": spec}
    job |= {"tables": [{"name": "tip.csv", "text": table, "select": None}], "version": "0.1.0"}
    (folder / "job.json").write_text(json.dumps(job))
    (folder / "design.toml").write_text(text)
    found = printed("again", folder, "--out", "new", code=DIFFERS)
    assert [each["file"] for each in found["differences"]] == ["summary.json"], "it never ended"
    for name in ("summary.json", "shapes.csv"):
        shutil.copy(Path("new", name), folder)
    assert printed("again", folder)["same"]
