"""Every verb of the command line: its files, its output and its exit code."""

import json
import subprocess
import sys
from pathlib import Path

import meshio
import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from voxsoft.calibration import Experiment, Measurement
from voxsoft.cli.app import app
from voxsoft.cli.calibrate import _on_a_line
from voxsoft.errors import MeasurementError
from voxsoft.files import load
from voxsoft.files.cards import load_card_file
from voxsoft.jobs import MeasuredTable
from voxsoft.simulation import simulate

ROOT = Path(__file__).parents[2]
CYLINDER, BEAM = ROOT / "examples" / "cylinder.toml", ROOT / "examples" / "beam.toml"
DATA = ROOT / "examples" / "data" / "paper_beams" / "ecoflex-00-30.csv"
FEW = ["--set", "parameters.radius.min=20 mm", "--set", "parameters.height.min=30 mm"]


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def call(*arguments):
    """Run the command line in this process; standard error stays apart."""
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def printed(*arguments, code=0):
    """The object that ``--json`` prints."""
    outcome = call(*arguments, "--json")
    assert outcome.exit_code == code, outcome.stderr
    return json.loads(outcome.stdout)


def test_help_is_quick_and_loads_nothing_heavy():
    script = (
        "import sys, voxsoft.cli; heavy = {'numpy', 'scipy', 'optuna', 'matplotlib', 'pandas'};"
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.stdout.strip() == "[]", done.stderr
    outcome = call("--help")
    assert outcome.exit_code == 0
    assert all(verb in outcome.stdout for verb in ("new", "sweep", "calibrate", "export"))


def test_version():
    assert call("--version").stdout.startswith("voxsoft ")


@pytest.mark.long
@pytest.mark.parametrize("template", ["beam", "cylinder", "finger", "pneunet", "sphere"])
def test_new_writes_a_commented_design_that_checks(template):
    assert call("new", "mine", "-t", template).exit_code == 0
    text = Path("mine.toml").read_text()
    assert text.startswith("# ")
    assert load("mine.toml").name == "mine"
    assert printed("check", "mine.toml")["valid"]


@pytest.mark.parametrize("feature", ["bellows", "chamber-row", "finger", "fold"])
def test_a_new_design_begins_with_a_feature(feature):
    assert call("new", "mine", "--feature", feature).exit_code == 0
    assert printed("check", "mine.toml")["valid"]


def test_a_new_design_has_one_beginning():
    outcome = call("new", "mine", "--feature", "fold", "--template", "beam")
    assert outcome.exit_code == 2
    assert "starts from one of the two" in outcome.stderr


def test_new_keeps_existing_files():
    assert call("new", "mine").exit_code == 0
    Path("mine.toml").write_text("kept")
    outcome = call("new", "mine")
    assert outcome.exit_code == 2
    assert "--force" in outcome.stderr
    assert Path("mine.toml").read_text() == "kept"
    assert call("new", "mine", "--force", "--folder", ".").exit_code == 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [(["a", "-t", "arm"], "is not one of"), (["a/b"], "--folder")],
)
def test_new_refuses(arguments, words):
    outcome = call("new", *arguments)
    assert outcome.exit_code == 2
    assert words in " ".join(outcome.stderr.split())


def test_check_prints_figures_and_findings():
    report = printed("check", CYLINDER)
    assert report["valid"]
    assert report["voxels"] == 300
    assert report["cavities"][0]["volume"] == pytest.approx(32.5e-6)
    assert {"where", "what", "try"} <= report["problems"][0].keys()
    words = call("check", CYLINDER)
    assert words.stdout == ""
    assert "a hinge" in words.stderr
    assert "cavity 0: 32.5 mL" in words.stderr


def test_check_reports_faults_and_returns_3():
    report = printed(
        "check", CYLINDER, "--set", "wall=25 mm", "--set", "parameters.wall.max=25 mm", code=3
    )
    assert not report["valid"]
    assert any("no enclosed cavity" in problem["what"] for problem in report["problems"])


def test_mesh_writes_and_prints():
    figures = printed("mesh", CYLINDER, "-o", "c.vtu")
    assert figures["conforming"]
    assert figures["watertight"]
    assert (
        figures["tets"]
        == 5 * figures["voxels"]
        == len(meshio.read("c.vtu").get_cells_type("tetra"))
    )
    assert "smallest tet: " in call("mesh", BEAM).stderr


def test_run_writes_a_folder_and_prints_si():
    summary = printed("run", CYLINDER, "--out", "r", "--figure")
    assert summary["status"] == "ok"
    assert summary["solver"] == "xpbd"
    top = summary["probes"]["top"]["displacement"]
    assert summary["metrics"]["rise"] == top[2] > 0.001
    assert summary["cavities"][0]["pressure"] == 4000.0
    names = {path.name for path in Path("r").iterdir()}
    results = {"design.toml", "summary.json", "result.vtu", "body.png", "thumbnail.png"}
    assert names == results | {"job.toml", "inputs"}
    moved = meshio.read("r/result.vtu").point_data["displacement"]
    assert moved[:, 2].max() >= top[2]


def test_run_names_its_folder_by_design_and_hash():
    outcome = call("run", BEAM, "--set", "length=50 mm")
    assert outcome.exit_code == 0, outcome.stderr
    name = f"beam-{load(BEAM, length='50 mm').hash[:8]}"
    assert Path("runs", name, "summary.json").exists()
    assert "sag: " in outcome.stderr


def test_run_returns_4_when_not_at_rest():
    timed = ["--set", "solver.max_time=0.02 s", "--set", "solver.time_step=10 ms"]
    summary = printed("run", BEAM, *timed, "--out", "r", code=4)
    assert summary["status"] == "not-at-rest"
    assert Path("r", "result.vtu").exists(), "the last state is kept"


def test_sweep_ends_in_a_table_figures_and_a_folder_and_resumes():
    outcome = call("sweep", CYLINDER, *FEW, "--out", "s", "--workers", 2)
    assert outcome.exit_code == 0, outcome.stderr
    assert "12 designs" in outcome.stderr
    assert "ok" in outcome.stderr
    assert "wall (mm)" in outcome.stderr
    assert "rise (mm)" in outcome.stderr
    names = {path.name for path in Path("s").iterdir()}
    assert {"table.csv", "summary.json", "scatter.png", "history.png", "study.journal"} <= names
    table = Path("s", "table.csv").read_text()
    again = call("sweep", CYLINDER, *FEW, "--out", "s", "--workers", 2, "--json")
    assert "12 designs were solved before and not again; 0 are new" in again.stderr
    found = json.loads(again.stdout)
    assert found["trials"] == sum(found["counts"].values()) == 12
    assert found["best"]["parameters"]["wall"] == 0.005
    assert found["folder"] == "s"
    assert Path("s", "table.csv").read_text() == table


@pytest.mark.long
def test_optimize_finds_and_goes_further():
    first = printed("optimize", CYLINDER, "--sampler", "random", "--budget", 4, "--workers", 1)
    more = printed("optimize", CYLINDER, "--sampler", "random", "--budget", 6, "--workers", 1)
    assert (first["trials"], more["trials"]) == (4, 6)
    assert first["folder"] == more["folder"] == str(Path("runs", "cylinder-optimize"))


def test_a_study_folder_of_another_study_is_refused():
    small = [*FEW, "--set", "parameters.wall.max=5 mm", "--out", "s", "--workers", 1]
    assert call("sweep", CYLINDER, *small).exit_code == 0
    outcome = call("sweep", CYLINDER, *small, "--set", "parts.0.material=ecoflex-00-50")
    assert outcome.exit_code == 2
    assert "another study" in outcome.stderr


@pytest.mark.long
def test_calibrate_prints_the_object_and_writes_a_card():
    quick = ["--method", "genetic", "--generations", 3, "--population", 6, "--workers", 1]
    outcome = call("calibrate", BEAM, DATA, *quick, "--seed", 1, "--out", "c", "--json")
    assert outcome.exit_code == 0, outcome.stderr
    found = json.loads(outcome.stdout)
    due = {
        "parameters",
        "mean_error",
        "max_error",
        "fitness",
        "evaluations",
        "identifiable",
        "scale",
    }
    assert due <= found.keys()
    assert 0.001 < found["mean_error"] < found["max_error"] < 0.03
    assert any("taken for marks on the lower edge" in each for each in found["warnings"])
    names = {path.name for path in Path("c").iterdir()}
    assert {"ecoflex-00-30.toml", "fitness.png", "shape.png", "profile.png", "shapes.csv"} <= names


def test_the_line_of_marks_is_asked_for_where_somebody_answers(monkeypatch):
    marks = MeasuredTable(name="strip.csv", text="arc_mm,dz_mm\n30,-9\n")
    probes = MeasuredTable(name="tip.csv", text="probe,dz_mm\ntip,-9\n")
    named = MeasuredTable(name="old.csv", text="# line: upper-edge\narc_mm,dz_mm\n30,-9\n")
    asked = []
    monkeypatch.setattr(typer, "prompt", lambda text, default: asked.append(text) or "centerline")
    tables = [marks, probes, named]
    assert _on_a_line(tables, None, asks=False) == tables
    assert _on_a_line([probes, named], None, asks=True) == [probes, named]
    assert not asked
    found = _on_a_line(tables, None, asks=True)
    assert asked == ["lower-edge, centerline or upper-edge"]
    assert [table.read().line for table in found] == ["centerline", None, "upper-edge"]
    with pytest.raises(MeasurementError, match='"centerline" and "upper-edge"'):
        _on_a_line([named], "centerline", asks=False)[0].read()


@pytest.mark.slow
def test_calibration_by_gradients_finds_the_modulus_of_a_beam():
    """A process of its own; the data are from the other solver, and carry no noise."""
    rubber = 'parts.0.material={model="neo-hookean", young="%s kPa", poisson=0.49}'
    short = ["--set", "length=50 mm", "--set"]
    made = load(BEAM, assignments=["length=50 mm", rubber % 30])
    arcs = (0.01, 0.02, 0.03, 0.04)
    blank = Measurement(quantities=("x", "dz"), values=[[arc, 0.0] for arc in arcs], arcs=arcs)
    experiment = Experiment(made, blank)
    seen = experiment.seen_at(simulate(experiment.setup, method="xpbd").positions)
    rows = [f"{arc:g},{x:.9g},{z:.9g}" for arc, (x, z) in zip(arcs, seen, strict=True)]
    Path("made.csv").write_text("\n".join(["arc_position_from_clamp_m,x_m,dz_m", *rows]) + "\n")
    command = [sys.executable, "-c", "from voxsoft.cli import main; main()", "calibrate"]
    command += [str(BEAM), "made.csv", "--method", "gradient", *short, rubber % 200]
    command += ["--out", "g", "--json"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    # The two solvers agree within 0.5 % on ten designs, and stay far below that on one element.
    # The search alone: a simplex follows it, and would fix errors of wrong slopes.
    assert found["search"]["parameters"]["young"] == pytest.approx(30e3, rel=5e-3)
    assert (found["method"], found["settings"]["solver"]) == ("gradient", "statics")
    # A search that knows no slopes takes 30 for its first generation alone.
    assert found["search"]["evaluations"] <= 20
    assert found["identifiable"] == {"young": True}
    # Cards keep four digits.
    assert load_card_file(Path("g", "made.toml")).material.young() == pytest.approx(30e3, rel=5e-3)


@pytest.mark.parametrize("name", ["a.vtu", "a.msh", "a.stl", "a.obj", "a.npy", "a.toml"])
def test_export_of_a_design(name):
    assert call("export", CYLINDER, name).exit_code == 0
    path = Path(name)
    if path.suffix == ".npy":
        assert np.count_nonzero(np.load(path)) == 300
    elif path.suffix == ".toml":
        assert load(path).hash == load(CYLINDER).hash
        assert '"= ' not in path.read_text()
    else:
        points = meshio.read(path).points
        height = 35.0 if path.suffix in (".stl", ".obj") else 0.035  # mm, or m
        # Surfaces have the volume of the voxels, 0.5 % more than that of the shapes.
        rel = 0.01 if path.suffix in (".stl", ".obj") else 1e-6
        assert np.ptp(points[:, 2]) == pytest.approx(height, rel=rel)


def test_export_of_a_computation_tells_all_that_it_holds():
    refused = call("export", CYLINDER, "a.inp")
    assert refused.exit_code == 3
    assert 'no "lattice" material' in refused.output
    assert call("mesh", CYLINDER, "--out", "mesh.inp").exit_code == 0
    assert np.ptp(meshio.read("mesh.inp").points[:, 2]) == pytest.approx(0.035)
    asked = ["export", CYLINDER, "a.inp", "--unit", "mm", "--element", "C3D8I"]
    found = call(*asked, "--set", "parts.0.material=ecoflex-00-30")
    assert found.exit_code == 0, found.output
    assert "wrote a.inp, in mm" in found.output
    assert "holds: loads[0]: pressure in all cavities" in found.output
    assert "lost: fill: is binary here" in found.output
    assert "*ELEMENT, TYPE=C3D8I" in Path("a.inp").read_text(encoding="ascii")


def test_export_of_a_run():
    assert call("run", CYLINDER, "-o", "r").exit_code == 0
    assert call("export", "r", "rest.stl", "--unit", "mm").exit_code == 0
    for name, option in (("bent.stl", []), ("stairs.stl", ["--voxels"])):
        arguments = ["export", "r", name, "--unit", "mm", "--deformed", *option]
        assert call(*arguments).exit_code == 0
    assert call("export", "r", "bent.vtu", "--deformed").exit_code == 0
    assert call("export", "r", "probes.csv").exit_code == 0
    heights = [np.ptp(meshio.read(f"{name}.stl").points[:, 2]) for name in ("rest", "bent")]
    assert heights[0] == pytest.approx(35.0, rel=0.01)
    assert heights[1] > 36.0
    stairs = np.ptp(meshio.read("stairs.stl").points[:, 2])
    assert stairs == pytest.approx(heights[1], rel=0.01)
    assert np.ptp(meshio.read("bent.vtu").points[:, 2]) == pytest.approx(stairs / 1e3)
    header, top = Path("probes.csv").read_text().splitlines()
    assert header == "probe,dx_m,dy_m,dz_m"
    summary = json.loads(Path("r", "summary.json").read_text())
    rise = summary["probes"]["top"]["displacement"][2]
    assert float(top.split(",")[3]) == pytest.approx(rise)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([CYLINDER, "a.step"], "unknown format"),
        ([CYLINDER, "a.csv"], "holds no result"),
        ([CYLINDER, "a.stl", "--deformed"], "holds no result"),
        ([CYLINDER, "a.vtu", "--unit", "mm"], "always in m"),
        ([CYLINDER, "a.stl", "--unit", "kPa"], "expected a length"),
        ([".", "a.stl"], "no run folder"),
    ],
)
def test_export_reports_impossible_requests(arguments, words):
    outcome = call("export", *arguments)
    assert outcome.exit_code == 3
    assert words in outcome.stderr
    assert not list(Path().iterdir())
