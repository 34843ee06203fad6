"""The PneuNet whose facing walls meet, as the command line solves it."""

import json

from typer.testing import CliRunner

from voxsoft.cli.app import app

#: Two chambers that are too small to touch: a second of work.
SMALL = ["chambers=2", "room=6 mm", "width=12 mm"]


def run(*words):
    """Output of `run --json` for the example."""
    call = ["run", "examples/pneunet_contact.toml", "--json", "--error", "off"]
    for word in words:
        call += ["--set", word]
    outcome = CliRunner().invoke(app, call)
    assert outcome.exit_code == 0, outcome.output
    return json.loads(outcome.stdout)


def test_pressure_bends_it_toward_its_paper():
    small = run(*SMALL)
    assert small["status"] == "ok"
    # CalculiX with the paper as bricks has -0.241 mm at 18.65 kPa, and ours there -0.232 mm; twice
    # as many voxels along each edge move it by 8 % (`evidence/make_pneunet_reference.py`).
    x, y, z = small["probes"]["tip"]["displacement"]
    assert -0.28e-3 < z < -0.23e-3
    assert abs(y) < 1e-9
    assert small["penetration"] == 0.0
    stretchy = run(*SMALL, "layers.0.young=65 MPa")
    # With a hundredth of the stiffness the layer stretches too: the tip goes along by 2.6 times.
    assert stretchy["probes"]["tip"]["displacement"][0] > 2 * x
