"""Chambers whose wall has no thickness at an edge or a corner."""

import json

import pytest
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design import Layer, families
from voxsoft.shapes import Box
from voxsoft.simulation import Setup
from voxsoft.simulation.checks.thin_seals import thin_seals

MM = 1e-3
BLOCK = Box(size=(20 * MM,) * 3, corner=(0, 0, 0))
ROOM = Box(size=(12 * MM,) * 3, corner=(4 * MM,) * 3)
EDGE = Box(size=(4 * MM, 4 * MM, 8 * MM), corner=(0, 0, 6 * MM))
CORNER = Box(size=(4 * MM,) * 3, corner=(0, 0, 0))
LOADED = """
schema = "voxsoft/1"
name = "notched"
voxel_size = "2 mm"
[shapes]
block = { kind = "box", size = ["20 mm", "20 mm", "20 mm"] }
room = { kind = "box", size = ["12 mm", "12 mm", "12 mm"], corner = ["4 mm", "4 mm", "4 mm"] }
notch = { kind = "box", size = ["4 mm", "4 mm", "8 mm"], corner = [0, 0, "6 mm"] }
body = { kind = "difference", of = ["block", "room", "notch"] }
[[parts]]
shape = "body"
material = { model = "neo-hookean", young = "100 kPa", poisson = 0.45 }
[[clamps]]
region = { x = ["20 mm", "20 mm"] }
[[loads]]
kind = "pressure"
value = "1 kPa"
[solver]
error = "off"
"""


def seals(shape):
    return list(thin_seals(None, vs.voxelize(shape, 2 * MM).mesh()))


@pytest.mark.parametrize(
    ("notch", "words", "at"),
    [
        (EDGE, "along edges of voxels, 8 mm long, near (4, 4, 6) mm", (4, 4, 6)),
        (CORNER, "at 1 corner of voxels, near (4, 4, 4) mm", (4, 4, 4)),
    ],
)
def test_a_chamber_that_is_sealed_without_a_wall_is_named_once(notch, words, at):
    (found,) = seals(BLOCK - ROOM - notch)
    assert found.where == "cavity 0"
    assert words in found.what
    assert found.at == pytest.approx([value * MM for value in at])


def test_two_chambers_that_meet_in_an_edge_are_both_named():
    low = Box(size=(4 * MM,) * 3, corner=(4 * MM,) * 3)
    high = Box(size=(4 * MM,) * 3, corner=(8 * MM, 8 * MM, 4 * MM))
    assert [each.where for each in seals(BLOCK - low - high)] == ["cavity 0", "cavity 1"]


def test_a_wall_of_one_voxel_and_a_leak_are_no_such_seal():
    assert seals(BLOCK - ROOM) == []
    assert seals(BLOCK - ROOM - Box(size=(2 * MM, 4 * MM, 8 * MM), corner=(0, 0, 6 * MM))) == []
    hole = Box(size=(4 * MM, 2 * MM, 2 * MM), corner=(0, 8 * MM, 8 * MM))
    assert seals(BLOCK - ROOM - hole) == []


def test_the_rim_of_a_layer_that_closes_a_chamber_is_a_seal():
    cup = BLOCK - Box(size=(12 * MM, 12 * MM, 16 * MM), corner=(4 * MM, 4 * MM, 4 * MM))
    film = Layer(
        name="film", region={"z": (20 * MM, 20 * MM)}, young=1e6, thickness=1e-4, seal=True
    )
    design = families.beam().replace(
        shapes={"body": cup}, voxel_size=2 * MM, layers=(film,), loads=(), probes={},
        objectives={}, constraints={},
    )  # fmt: skip
    mesh = Setup(design, vs.mesh_of(design)).mesh
    assert len(mesh.cavities) == 1
    assert list(thin_seals(design, mesh)) == []


def test_check_and_run_say_so_with_one_line_of_hinges(tmp_path):
    file = tmp_path / "notched.toml"
    file.write_text(LOADED)
    call = CliRunner().invoke
    checked = json.loads(call(app, ["check", str(file), "--json"]).stdout)
    found = [each for each in checked["problems"] if "sealed only" in each["what"]]
    assert [each["where"] for each in found] == ["cavity 0"]
    (hinge,) = [each for each in checked["problems"] if "hinge" in each["what"]]
    assert "and 3 more hinges in other places" in hinge["what"]
    ran = json.loads(call(app, ["run", str(file), "--out", str(tmp_path / "run"), "--json"]).stdout)
    assert ran["status"] == "ok"
    assert any("sealed only along edges" in each["what"] for each in ran["warnings"])
