"""``voxsoft respond``: both responses of an example, and a drive that is not there."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from voxsoft.cli.app import app

CYLINDER = str(Path(__file__).parents[2] / "examples/cylinder.toml")
ASKED = ["respond", CYLINDER, "--command", "pressure", "--output", "probes.top[2]"]


@pytest.mark.long
def test_step_response_has_the_gain_of_statics(tmp_path):
    figure = tmp_path / "step.png"
    given = [*ASKED, "--to", "1 kPa", "--duration", "0.4 s", "--figure", str(figure), "--json"]
    done = CliRunner().invoke(app, given)
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    still = CliRunner().invoke(
        app,
        [
            "run",
            CYLINDER,
            "--set",
            "loads[0].value=1 kPa",
            "--error",
            "off",
            "--json",
            "--out",
            str(tmp_path / "run"),
        ],
    )
    rise = json.loads(still.stdout)["probes"]["top"]["displacement"][2]
    # At rest within ten times the tolerance of 1e-4 of its way.
    assert found["gain"] == pytest.approx(rise / 1e3, rel=5e-3)
    assert figure.stat().st_size > 0


@pytest.mark.long
def test_waves_go_between_both_values():
    given = [*ASKED, "--to", "1 kPa", "--frequencies", "1,3,5", "--settle", "0 s", "--json"]
    done = CliRunner().invoke(app, given)
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert found["frequencies"] == pytest.approx([1.0, 3.0, 5.0])
    # Each wave is late, the quicker the more.
    assert 0.0 > found["phase"][0] > found["phase"][1] > found["phase"][2]


def test_unknown_drive_is_named():
    wrong = [each.replace("pressure", "pressur") for each in ASKED]
    done = CliRunner().invoke(app, [*wrong, "--to", "1 kPa"])
    assert done.exit_code == 3
    assert 'did you mean "pressure"?' in done.output
