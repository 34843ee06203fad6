"""Bad input to the command line: a code, a message that helps, and no traceback."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import meshio
import numpy as np
import pytest
from bad_designs import NO_DESIGN, NO_TEXT, NOT_SOLVABLE
from typer.testing import CliRunner
from waiting import until

from voxsoft.cli.app import app

ROOT = Path(__file__).parents[2]
CYLINDER, BEAM = ROOT / "examples" / "cylinder.toml", ROOT / "examples" / "beam.toml"


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def call(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.mark.parametrize(
    ("change", "words"), [*NO_DESIGN, *NOT_SOLVABLE, ("radius", "is not an assignment")]
)
def test_a_bad_design_is_reported_in_words(change, words):
    outcome = call("run", CYLINDER, "--set", change, "--json")
    assert outcome.exit_code == 3, outcome.stderr
    assert words in outcome.stderr
    assert isinstance(outcome.exception, SystemExit)
    problem = json.loads(outcome.stdout)["problems"][0]
    assert problem["what"]
    assert not Path("runs").exists()


def test_a_piece_that_nothing_holds_is_named():
    design = Path("two.toml")
    text = (
        CYLINDER.read_text()
        .replace(
            "[[parts]]",
            '[shapes.far]\nkind = "sphere"\nradius = "10 mm"\ncenter = ["0 m", "0 m", "80 mm"]\n\n'
            '[shapes.both]\nkind = "union"\nof = ["body", "far"]\n\n[[parts]]',
            1,
        )
        .replace('shape = "body"', 'shape = "both"')
    )
    design.write_text(text)
    outcome = call("run", design)
    assert outcome.exit_code == 3
    assert "touches no clamp" in outcome.stderr


@pytest.mark.parametrize("content", NO_TEXT.values(), ids=NO_TEXT)
@pytest.mark.parametrize("verb", ["check", "mesh", "run", "sweep", "optimize"])
def test_a_broken_file_is_invalid(verb, content):
    Path("broken.toml").write_bytes(content)
    outcome = call(verb, "broken.toml", "--json")
    assert outcome.exit_code == 3
    assert json.loads(outcome.stdout)["problems"]
    reported = outcome.stdout + outcome.stderr
    assert "broken.toml" in reported or "is missing" in reported


@pytest.mark.parametrize(
    "arguments",
    [
        ["fly"],
        ["run"],
        ["run", "-"],
        ["run", "no-such.toml"],
        ["run", "."],
        ["sweep", CYLINDER, "--workers", "0"],
        ["sweep", CYLINDER, "--workers", "many"],
        ["optimize", CYLINDER, "--budget", "0"],
        ["optimize", CYLINDER, "--sampler", "magic"],
        ["sweep", CYLINDER, "--scheduler", "nowhere"],
        ["check", CYLINDER, "--unit", "mm"],
    ],
)
def test_a_wrong_call_returns_2(arguments):
    outcome = call(*arguments)
    assert outcome.exit_code == 2
    assert outcome.stderr.strip()
    assert outcome.stdout == ""


HEADER = "arc_position_from_clamp_mm,x_mm,dz_mm\n"


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", "holds no table"),
        (HEADER, "no rows"),
        (HEADER + "10,9,nan\n20,18,-5\n30,25,-9\n", "not a finite number"),
        (HEADER + "10,9,-1\n20,18\n", "cut off"),
        (HEADER + "10,9,-1\n", "for 2 parameters"),
        (HEADER.replace("mm", "m") + "30,9,-1\n60,18,-5\n90,25,-9\n", "_mm"),
        ("arc,x_mm\n10,2\n", "arc"),
        ("\0\0", "not a text file"),
    ],
)
def test_a_bad_measurement_is_reported_in_words(content, words):
    Path("data.csv").write_text(content)
    outcome = call("calibrate", BEAM, "data.csv", "--json")
    assert outcome.exit_code == 3
    assert words in outcome.stderr
    assert json.loads(outcome.stdout)["problems"]


def write_cube(name, *, side=20.0, faces=12):
    corners = side * np.array(np.meshgrid([0, 1], [0, 1], [0, 1], indexing="ij")).reshape(3, -1).T
    triangles = [
        (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
        (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
    ]  # fmt: skip
    meshio.Mesh(corners, [("triangle", np.array(triangles)[:faces])]).write(name)


def test_a_mesh_asks_for_its_unit_and_shows_the_choice():
    write_cube("cube.stl")
    outcome = call("check", "cube.stl", "--json")
    assert outcome.exit_code == 3
    assert "--unit" in outcome.stderr
    assert "mm: 20 mm long" in outcome.stderr
    assert json.loads(outcome.stdout)["valid"] is False


def test_a_mesh_is_checked_as_a_body():
    write_cube("cube.stl")
    outcome = call("check", "cube.stl", "--unit", "mm", "--voxel-size", "2 mm", "--json")
    assert outcome.exit_code == 0
    assert json.loads(outcome.stdout)["voxels"] == 1000
    chosen = call("check", "cube.stl", "--unit", "mm")
    assert chosen.exit_code == 0
    assert "0.4 mm was chosen" in chosen.stderr


def test_a_mesh_with_a_hole_is_checked_with_a_warning():
    write_cube("open.stl", faces=11)
    outcome = call("check", "open.stl", "--unit", "mm", "--voxel-size", "2 mm")
    assert outcome.exit_code == 0
    assert "the surface is open: a hole of 3 edges, 20 mm wide" in outcome.stderr


def test_a_mesh_without_inside_is_not_valid():
    write_cube("face.stl", faces=1)
    outcome = call("check", "face.stl", "--unit", "mm", "--json")
    assert outcome.exit_code == 3
    report = json.loads(outcome.stdout)
    assert not report["valid"]
    assert "encloses nothing" in report["problems"][0]["what"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--unit", "kPa"], "expected a length"),
        (["--unit", "mm", "--voxel-size", "2"], "has no unit"),
        (["--unit", "mm", "--voxel-size", "0 mm"], "no size"),
        (["--unit", "mm", "--voxel-size", "1 um"], "more than the limit of"),
    ],
)
def test_bad_options_of_a_mesh(arguments, words):
    write_cube("cube.stl")
    outcome = call("check", "cube.stl", *arguments)
    assert outcome.exit_code == 3
    assert words in outcome.stderr


def test_a_truncated_mesh_is_not_readable():
    write_cube("cube.vtu")
    content = Path("cube.vtu").read_bytes()
    Path("cube.vtu").write_bytes(content[: len(content) // 2])
    outcome = call("check", "cube.vtu", "--unit", "mm")
    assert outcome.exit_code == 3
    assert "is cut short" in outcome.stderr


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
def test_interrupt_keeps_finished_trials_and_says_how_to_resume():
    # Voxels of 2.5 mm make each design slow enough to be caught in the middle.
    command = [sys.executable, "-c", "from voxsoft.cli import main; main()", "sweep", str(CYLINDER)]
    command += ["--set", "voxel_size=2.5 mm", "--out", "s", "--workers", "2"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    journal = Path("s", "study.journal")

    def has_stored_five():
        stored = journal.exists() and journal.read_text().count("outcome") >= 5
        return stored or process.poll() is not None

    until(has_stored_five, "five trials")
    os.kill(process.pid, signal.SIGINT)
    stdout, stderr = process.communicate(timeout=60)
    assert process.returncode == 130, stderr
    assert "Traceback" not in stderr
    assert stdout == ""
    assert "run the same study again to go on" in stderr
    assert journal.read_text().count("outcome") >= 5


def test_a_closed_pipe_is_no_error():
    script = "from voxsoft.cli import main; main()"
    command = f'{sys.executable} -c "{script}" check {CYLINDER} --json | true'
    done = subprocess.run(command, shell=True, capture_output=True, text=True)
    assert done.stderr == ""
