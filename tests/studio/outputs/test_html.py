"""Pages that are alive without a server."""

import base64
import html
import json
import re
from pathlib import Path

import lattice_families as families
import pytest
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.errors import DesignError, FileError
from voxsoft.files import write_run
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.motion.player import Player
from voxsoft.studio.outputs.html import export_page, page_of
from voxsoft.studio.protocol import commands
from voxsoft.studio.protocol.wire import MessageKind

CYLINDER = families.family_text("paper-cylinder")


def scene_of(page):
    packed = re.search(
        r'<script id="voxsoft-scene" type="application/octet-stream;base64">([^<]*)</script>', page
    )
    return base64.b64decode(packed[1], validate=True)


def notes_of(page):
    """The notes are text behind magic and version: its length, seven bits a byte, and its bytes."""
    scene = scene_of(page)
    assert scene[:4] == b"VXSC"
    length, at, shift = 0, 8, 0
    while True:
        length |= (scene[at] & 0x7F) << shift
        at, shift, more = at + 1, shift + 7, scene[at] & 0x80
        if not more:
            return json.loads(scene[at : at + length])


def test_a_page_holds_its_scene_and_a_description():
    design = families.cylinder()
    page = design.show().text
    notes = notes_of(page)
    assert notes["name"] == "cylinder"
    assert "= radius - wall" in notes["text"]
    assert notes["body"]["voxels"] == 300
    assert notes["body"]["loads"][0]["value"] == 4000.0
    assert len(notes["fields"]) == 9
    assert "<title>cylinder · VoxSoft</title>" in page


def test_a_page_loads_nothing_from_elsewhere():
    page = families.beam().show().text
    outside = re.findall(
        r"""(?:src|href)=["'](?!data:|blob:|#)([^"']+)""", page.split("<script")[0]
    )
    assert outside == []


def test_a_result_shows_its_sentence_and_a_notebook_an_iframe():
    result = vs.simulate(families.beam())
    shown = result.show()
    assert "At rest after" in notes_of(shown.text)["sentence"]
    cell = shown._repr_html_()
    assert cell.startswith("<iframe srcdoc=")
    assert 'sandbox="allow-scripts"' in cell
    inner = html.unescape(re.search(r'srcdoc="([^"]*)"', cell)[1])
    assert inner == shown.text


def test_pressure_in_several_cavities_is_one_slider():
    two = CYLINDER.replace(
        'body   = { kind = "difference", of = ["outer", "cavity"] }',
        'ball   = { kind = "sphere", radius = "5 mm", center = [0, 0, "60 mm"] }\n'
        'tower  = { kind = "cylinder", radius = "15 mm", height = "80 mm" }\n'
        'both   = { kind = "union", of = ["outer", "tower"] }\n'
        'body   = { kind = "difference", of = ["both", "cavity", "ball"] }',
    )
    import tomllib

    design = vs.Design.from_document(tomllib.loads(two))
    loads = notes_of(page_of(design).text)["body"]["loads"]
    assert [load["index"] for load in loads] == [0]
    body = StudioBody.of(design, 1, 1)
    assert len(body.mesh.cavities) == 2
    player = Player(body)
    player.do(commands.Load(seq=1, index=0, value=0.0))
    player.do(commands.Play(seq=2))
    while player.moving:
        player.advance(1 / 60, 1.0)
    assert player.state == "at-rest"
    assert abs(player.positions() - body.mesh.vertices).max() < 1e-12


def test_a_body_with_a_layer_has_a_page():
    page = vs.load(Path(__file__).parents[3] / "examples" / "bender.toml").show()
    body = notes_of(page.text)["body"]
    (fabric,) = body["layers"]
    assert fabric["name"] == "fabric"
    assert fabric["stiffness"] == pytest.approx(9000.0)
    # Two triangles on each of 20 x 6 faces, all among the drawn ones.
    assert len(fabric["triangles"]) == 3 * 2 * 20 * 6
    assert set(fabric["triangles"]) <= set(range(body["surface_vertices"]))
    assert fabric["center"] == pytest.approx([0.04, 0.012, 0.0])


def test_a_page_holds_the_smooth_surface_of_its_shapes():
    notes = notes_of(families.cylinder().show().text)
    message = base64.b64decode(notes["smooth"], validate=True)
    kind, topology = message[4], int.from_bytes(message[8:12], "little")
    assert (kind, topology) == (MessageKind.SMOOTH, notes["body"]["topology"])
    vertices, triangles = (int.from_bytes(message[at : at + 4], "little") for at in (24, 28))
    # The closed surface of a body with a chamber: two spheres of it, by Euler's formula.
    assert vertices - triangles / 2 == 4


def test_designs_that_cannot_move_live_are_reported():
    with pytest.raises(DesignError, match="nothing holds the body"):
        families.cylinder().with_values("clamps=[]").show()


def test_the_command_writes_a_page_of_a_file_and_of_a_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    families.beam().save(tmp_path / "beam.toml")
    runner = CliRunner()
    done = runner.invoke(
        app, ["export", "beam.toml", "--html", "beam.html", "--set", "length=60 mm"]
    )
    assert done.exit_code == 0, done.stderr
    assert notes_of((tmp_path / "beam.html").read_text())["body"]["voxels"] == 48
    assert runner.invoke(app, ["run", "beam.toml", "--out", "run"]).exit_code == 0
    done = runner.invoke(app, ["export", "run", "beam.stl", "--html", "run.html"])
    assert done.exit_code == 0, done.stderr
    assert notes_of((tmp_path / "run.html").read_text())["name"] == "beam"
    assert (tmp_path / "beam.stl").is_file()
    assert runner.invoke(app, ["export", "beam.toml"]).exit_code == 2
    assert runner.invoke(app, ["export", "run", "--html", "a.html", "--set", "a=1"]).exit_code == 3


def test_a_missing_viewer_is_reported(monkeypatch, tmp_path):
    monkeypatch.setattr("voxsoft.studio.outputs.page.ARCHIVE", tmp_path / "page.zip")
    with pytest.raises(FileError, match="make studio"):
        families.beam().show()


def test_a_page_knows_where_the_body_is_in_itself_at_first():
    pushed = vs.load(Path(__file__).parents[2] / "data" / "pushed.toml")
    notes = notes_of(vs.simulate(pushed).show().text)
    assert notes["overlap"]["sentence"].endswith("contact is not simulated")
    assert notes["overlap"]["topology"] == notes["body"]["topology"]
    assert notes_of(pushed.show().text)["overlap"] is None
    apart = vs.simulate(pushed.with_values("push=9 mm"))
    assert notes_of(apart.show().text)["overlap"] is None


@pytest.mark.slow
def test_a_page_of_a_result_knows_where_its_objects_are_at_first():
    pinch = vs.load(Path(__file__).parents[3] / "examples" / "pinch.toml")
    result = vs.simulate(pinch.replace(solver={"method": "dynamics", "end_time": "0.1 s"}))
    moment = notes_of(result.show().text)["moment"]
    assert moment["frame"] == 0
    assert moment["poses"][0]["position"] == list(result.objects["plate"].position)
    assert moment["contacts"][0]["of"] == ["body", "plate"]
    assert notes_of(pinch.show().text)["moment"] is None


def test_a_page_of_a_result_lists_its_numbers(tmp_path):
    result = vs.simulate(families.cylinder())
    found = notes_of(result.show().text)["equilibrium"]
    assert found["t"] == "equilibrium"
    # The page shows that state as its first frame, and looks for no error bars itself.
    assert (found["frame"], found["looking"], found["askable"]) == (0, False, False)
    moved_by = {each["name"]: each["displacement"] for each in found["probes"]}
    assert moved_by.keys() == result.probes.keys()
    for name, moved in result.probes.items():
        assert moved_by[name] == pytest.approx(list(moved))
    # A run folder has the state of the run, and its page the numbers.
    write_run(result, tmp_path / "run")
    export_page(tmp_path / "run", tmp_path / "run.html")
    again = notes_of((tmp_path / "run.html").read_text())
    assert again["at_rest"]
    for probe in again["equilibrium"]["probes"]:
        assert probe["displacement"] == pytest.approx(moved_by[probe["name"]], abs=1e-9)


def test_a_page_of_a_design_has_no_numbers_of_a_result():
    assert notes_of(families.beam().show().text)["equilibrium"] is None
