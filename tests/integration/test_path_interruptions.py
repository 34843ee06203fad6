"""A path that is killed half way goes on where it was, with the same table."""

import signal
import subprocess
import sys

import pytest
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design.contact import Contact
from voxsoft.jobs.kept_path import FOLDER
from voxsoft.simulation.runs import load_path
from voxsoft.units import kPa, mm

RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.45, density=1070.0)
END = vs.Region(x=("20 mm", "20 mm"))
BEAM = vs.Design(
    name="beam",
    voxel_size=5 * mm,
    parts=[vs.Part(shape=vs.Box(size=("20 mm", "10 mm", "10 mm")), material=RUBBER)],
    clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
    loads=[vs.Gravity(), vs.Force(region=END, value=(0, 0, "-10 mN"))],
    probes={"tip": vs.Probe(x=("20 mm", "20 mm"))},
    solver={"error": "off"},
)
TOP = vs.Region(z=("10 mm", "10 mm"))
#: A block that is pressed on a floor and pushed along it by its top.
RUBBED = BEAM.replace(
    parts=[vs.Part(shape=vs.Box(size=("10 mm", "10 mm", "10 mm")), material=RUBBER)],
    clamps=[
        vs.Clamp(region=TOP, axes="xy", motion=vs.Motion(displacement=(2 * mm, 0, 0))),
        vs.Clamp(region=TOP, axes="z", motion=vs.Motion(displacement=(0, 0, -0.5 * mm))),
    ],
    floor=vs.Floor(z=0.0),
    contact=Contact(friction=0.5),
    loads=[],
    probes={"foot": vs.Probe(z=(0, 0))},
    solver={"method": "statics", "error": "off"},
)
#: A job that a signal ends as soon as its third equilibrium is there.
KILLED = """
import os, signal, sys
from voxsoft.jobs import DesignSource, RunSpec, run_job
from voxsoft.jobs.events import Progress

def notify(event):
    if isinstance(event, Progress) and event.of == "equilibria" and event.done == 3:
        os.kill(os.getpid(), getattr(signal, sys.argv[4]))

file, folder, over = sys.argv[1:4]
run_job(RunSpec(design=DesignSource.of_file(file, []), over=over), folder, notify)
"""
#: A beam of rubber that relaxes, whose load falls while it creeps.
CREEPING = BEAM.replace(
    parts=[
        vs.Part(
            shape=BEAM.parts[0].shape,
            material=RUBBER.replace(prony=[{"g": 0.2, "tau": "2 s"}, {"g": 0.2, "tau": "50 s"}]),
        )
    ],
    loads=[
        vs.Gravity(),
        vs.Force(
            region=END,
            value=(0, 0, "-10 mN"),
            history={"time": [0, "30 s", "40 s"], "factor": [1, 1, 0.5]},
        ),
    ],
    solver={"method": "statics", "error": "off"},
)
DESIGNS = {"beam": BEAM, "rubbed": RUBBED, "creeping": CREEPING}
OVER = {
    "creeping": "time=0..100 s/5",
    "beam": "loads[1].value[2]=0..-20 mN/5",
    "rubbed": "clamps[0].motion.displacement[0]=0..2 mm/5",
}


def killed(design, folder, signal_name="SIGKILL"):
    """Follow the path of a design in a process that is killed; its file."""
    file = folder.with_name("design.toml")
    vs.save(design, file)
    over = next(OVER[key] for key, known in DESIGNS.items() if known is design)
    command = [sys.executable, "-c", KILLED, str(file), str(folder), over, signal_name]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ended.returncode == -getattr(signal, signal_name), ended.stderr
    return file


def follow(file, folder, over, *more):
    arguments = ["run", str(file), "--over", over, "--out", str(folder), *more]
    return CliRunner().invoke(app, arguments)


@pytest.fixture
def solved(monkeypatch):
    """The instants that are solved for from here on."""
    found, find = [], load_path.find_equilibrium

    def counted(*arguments, **settings):
        found.append(settings["stretch"].until)
        return find(*arguments, **settings)

    monkeypatch.setattr(load_path, "find_equilibrium", counted)
    return found


@pytest.mark.long
@pytest.mark.parametrize(
    "signal_name", ["SIGKILL", pytest.param("SIGTERM", marks=pytest.mark.slow)]
)
def test_a_path_that_is_killed_half_way_goes_on(tmp_path, solved, signal_name):
    folder, whole, over = tmp_path / "killed", tmp_path / "whole", OVER["beam"]
    file = killed(BEAM, folder, signal_name)
    # Three equilibria and the head: the results are there, and so is the remedy.
    assert len((folder / "path.csv").read_text().splitlines()) == 4
    assert (folder / "job.toml").exists()
    assert len(list((folder / FOLDER).iterdir())) == 3
    done = follow(file, folder, over)
    assert done.exit_code == 0, done.output
    assert solved == [3.0, 4.0]
    assert not (folder / FOLDER).exists()
    assert follow(file, whole, over).exit_code == 0
    assert (folder / "path.csv").read_bytes() == (whole / "path.csv").read_bytes()


@pytest.mark.long
@pytest.mark.parametrize("signal_name", ["SIGKILL", "SIGINT"])
def test_a_creep_that_is_stopped_goes_on_to_the_same_table(tmp_path, solved, signal_name):
    folder, whole, over = tmp_path / "stopped", tmp_path / "whole", OVER["creeping"]
    file = killed(CREEPING, folder, signal_name)
    kept = sorted(file.name for file in (folder / FOLDER).iterdir())
    assert kept == ["0000.npz", "0001.npz", "0002.npz", "creep-0002.npz"]
    done = follow(file, folder, over)
    assert done.exit_code == 0, done.output
    assert solved == [75.0, 100.0]
    assert not (folder / FOLDER).exists()
    assert follow(file, whole, over).exit_code == 0
    assert (folder / "path.csv").read_bytes() == (whole / "path.csv").read_bytes()


@pytest.mark.long
def test_a_creep_without_its_viscous_stress_begins_anew(tmp_path, solved):
    folder, over = tmp_path / "stopped", OVER["creeping"]
    file = killed(CREEPING, folder)
    damaged = folder / FOLDER / "creep-0002.npz"
    damaged.write_bytes(damaged.read_bytes()[:200])
    assert follow(file, folder, over).exit_code == 0
    assert solved[0] == 0.0


@pytest.mark.slow
def test_another_path_in_the_same_folder_begins_anew(tmp_path, solved):
    folder = tmp_path / "killed"
    file = killed(BEAM, folder)
    assert follow(file, folder, OVER["beam"], "--set", "clamps[0].axes=xz").exit_code != 2
    assert solved[0] == 0.0


def test_a_kept_equilibrium_that_is_damaged_is_solved_again(tmp_path, solved):
    folder = tmp_path / "killed"
    file = killed(BEAM, folder)
    last = sorted((folder / FOLDER).iterdir())[-1]
    last.write_bytes(last.read_bytes()[:200])
    assert follow(file, folder, OVER["beam"]).exit_code == 0
    assert solved == [2.0, 3.0, 4.0]


@pytest.mark.slow
def test_contact_goes_its_way_again_to_the_same_table(tmp_path, solved):
    folder, whole, over = tmp_path / "killed", tmp_path / "whole", OVER["rubbed"]
    file = killed(RUBBED, folder)
    for place in (folder, whole):
        done = follow(file, place, over)
        assert done.exit_code == 0, done.output
    assert solved == 2 * [0.0, 1.0, 2.0, 3.0, 4.0]
    assert (folder / "path.csv").read_bytes() == (whole / "path.csv").read_bytes()


def test_the_reached_part_of_a_path_is_shown(tmp_path):
    file = tmp_path / "beam.toml"
    vs.save(BEAM, file)
    done = follow(file, tmp_path / "run", OVER["beam"])
    assert "loads[1].value[2] = 0 reached" in done.stderr.replace("\n", "")
