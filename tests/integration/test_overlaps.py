"""Bodies in themselves are told of on the command line: runs, and the best designs of a study."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from voxsoft.cli.app import app

ROOT = Path(__file__).parents[2]
DATA = ROOT / "tests" / "data"
#: The template's body of the paper's material, which comes to rest in a second.
PNEUNET = [
    ROOT / "examples" / "pneunet.toml",
    *("--set", "parts.1.material=ecoflex-00-30-lattice"),
    *("--set", 'materials.firm={model="lattice", edge="200 kPa", bulk="1 MPa"}'),
]


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def call(*arguments):
    outcome = CliRunner().invoke(app, [str(argument) for argument in arguments])
    assert outcome.exit_code == 0, outcome.stderr
    return outcome


def overlaps(reported):
    return {each["where"]: each for each in reported["warnings"] if "overlap" in each["what"]}


@pytest.mark.long
def test_a_gripper_in_its_ball_and_in_itself_is_reported():
    """Fingers are in the ball by millimeters, and chambers in their neighbors."""
    reported = json.loads(call("run", DATA / "gripper.toml", "--json", "--error", "off").stdout)
    assert reported["status"] == "ok"
    assert reported["penetration"] > 2e-3
    found = {frozenset(where.split(" and ")) for where in overlaps(reported)}
    assert {frozenset({"ball", "right"}), frozenset({"ball", "left"})} <= found
    assert {frozenset({"right"}), frozenset({"left"})} <= found
    for warning in overlaps(reported).values():
        assert warning["what"].endswith("contact is not simulated")
        x, y, z = warning["at"]  # on the unloaded body
        assert abs(x) <= 0.0375
        assert abs(y) <= 0.01
        assert -0.06 <= z <= 0.0
    # Both fingers are one another's image, and so are their reports.
    depths = [
        each["what"].split(" near")[0]
        for each in reported["warnings"]
        if each["where"] in ("left", "right")
    ]
    assert depths[0] == depths[1]


@pytest.mark.slow
def test_chambers_that_meet_are_distinguished_from_the_load_where_they_do():
    free = json.loads(call("run", *PNEUNET, "--json", "--error", "off").stdout)
    assert free["penetration"] == 0.0
    assert overlaps(free) == {}
    outcome = call("run", *PNEUNET, "--error", "off", "--set", "loads.0.value=5 kPa")
    line = next(line for line in outcome.stderr.splitlines() if "overlap" in line)
    assert line.startswith("warning: chambers: walls overlap by ")
    assert "contact is not simulated. Try: lower the load" in line


@pytest.mark.slow
def test_best_designs_that_overlap_are_not_green():
    outcome = call("sweep", DATA / "pushed.toml", "--workers", "1")
    printed = [line for line in outcome.stderr.splitlines() if line.startswith("warning: rank")]
    assert len(printed) == 1
    assert printed[0].startswith("warning: rank 1: ")
    assert "overlap by 2 mm near" in printed[0]
    reported = json.loads(call("sweep", DATA / "pushed.toml", "--json").stdout)
    assert "overlap by 2 mm near" in reported["best"]["warnings"][0]
    table = Path(reported["folder"], "table.csv").read_text().splitlines()
    assert "penetration" in table[0]
    assert "warnings" in table[0]
    assert sum("contact is not simulated" in row for row in table) == 1
