"""A run with something bonded, and files that cannot be written after it."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.files.meshes import read_mesh_file

BLOCK = """
schema = "voxsoft/1"
name = "bonded"
voxel_size = "5 mm"
solver = {{ error = "off" }}
{more}
[shapes]
body = {{ kind = "box", size = ["10 mm", "10 mm", "10 mm"], corner = [0, 0, 0] }}
lid = {{ kind = "box", size = ["10 mm", "10 mm", "5 mm"], corner = [0, 0, "5 mm"] }}
plate = {{ kind = "box", size = ["10 mm", "10 mm", "5 mm"], corner = [0, 0, "10 mm"] }}
{parts}
[[parts]]
shape = "body"
material = "ecoflex-00-30"
[[clamps]]
region = {{ z = [0, 0] }}
[[loads]]
kind = "gravity"
[[objects]]
name = "plate"
shape = "plate"
[contact]
pairs = [{{ of = ["body", "plate"], kind = "bonded" }}]
[probes]
top = {{ point = ["5 mm", "5 mm", "5 mm"] }}
"""
RIGID = '[[parts]]\nshape = "lid"\nmaterial = { model = "rigid", density = "1000 kg/m^3" }'


def run(folder, *arguments, more="", parts=""):
    file = folder / "bonded.toml"
    file.write_text(BLOCK.format(more=more, parts=parts), encoding="utf-8")
    out = folder / "out"
    return out, CliRunner().invoke(app, ["run", str(file), "--out", str(out), *arguments])


@pytest.mark.parametrize(
    ("more", "parts"), [("", ""), ('fill = "fraction"', ""), ("", RIGID)], ids=["", "cut", "rigid"]
)
def test_a_bonded_run_is_written_with_all_its_fields(tmp_path, more, parts):
    out, done = run(tmp_path, more=more, parts=parts)
    assert done.exit_code == 0, done.output
    content = read_mesh_file(out / "result.vtu")
    count = len(content.mesh.vertices)
    for name, values in content.point_data.items():
        assert len(values) == count, name
    assert np.isfinite(content.point_data["stress"]).all()
    assert {"stress", "von_mises", "max_stretch", "contact_pressure"} <= content.point_data.keys()


def test_a_body_in_contact_is_soft_at_a_probe_and_has_slopes_of_its_own(tmp_path):
    run(tmp_path)
    result = vs.simulate(vs.load(tmp_path / "bonded.toml"))
    assert result.metric("compliance", probe="top", axis="z") > 0.0
    assert result.fields.max_stretch_slope().shape == result.positions.shape


def test_a_failed_write_after_the_numbers_keeps_the_numbers(tmp_path):
    (tmp_path / "out" / "result.vtu").mkdir(parents=True)
    out, done = run(tmp_path, "--json")
    assert done.exit_code == 5, done.output
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    assert summary["status"] == "ok"
    assert "top" in summary["probes"]
    printed = json.loads(done.stdout)
    assert printed["status"] == "ok"
    assert printed["problems"][0]["where"].endswith("result.vtu")
    assert (out / "thumbnail.png").exists()


def test_a_drawing_that_fails_costs_no_other_file(tmp_path, monkeypatch):
    def fail(*_, **__):
        raise ZeroDivisionError("nothing to draw")

    monkeypatch.setattr("voxsoft.plot.plot_body", fail)
    out, done = run(tmp_path, "--figure")
    assert done.exit_code == 5, done.output
    assert "body.png: was not written: nothing to draw" in done.output.replace("\n", "")
    assert (out / "result.vtu").exists()
