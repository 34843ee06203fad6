"""Hints of errors, that they can work."""

from dataclasses import replace

import pytest
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.cli.output import console
from voxsoft.cli.run import _show_path
from voxsoft.design import families
from voxsoft.errors import DesignError, ShapeError
from voxsoft.records import closest
from voxsoft.shapes import TriangleMesh


@pytest.mark.parametrize("known", [["shear"], ["shear", "sheer"], ["young"], []])
def test_a_suggestion_is_never_the_word_itself(known):
    assert '"shear"' not in closest("shear", known)


@pytest.mark.parametrize("model", ["neo-hookean", "yeoh", "lattice"])
def test_a_key_of_another_material_is_not_suggested(model):
    material = {"model": model, "mu": "20 kPa", "shear": "20 kPa"}
    with pytest.raises(DesignError) as caught:
        families.beam().replace(parts=[{"shape": "body", "material": material}])
    hints = {each.where: each.hint for each in caught.value.problems}
    assert hints["parts[0].material.shear"]
    for name in ("edge_compliance", "mu", "alpha"):
        assert f'"{name}"' not in hints["parts[0].material.shear"]


def test_a_body_that_has_no_name_is_not_to_be_named():
    with pytest.raises(DesignError, match=r"there is one body.*leave body out"):
        families.beam().replace(probes={"x": {"body": "body", "x": (0, 0)}}, objectives={})


def test_a_format_that_nothing_converts_is_not_sent_to_a_converter(tmp_path):
    (tmp_path / "a.unv").write_text("")
    with pytest.raises(ShapeError) as caught:
        TriangleMesh(path=tmp_path / "a.unv", unit="mm").build()
    assert "meshio" not in str(caught.value)
    assert "open it in Gmsh and save it as .msh" in str(caught.value)


def test_a_new_design_may_be_called_as_its_file(tmp_path):
    outcome = CliRunner().invoke(app, ["new", "q.toml", "--folder", str(tmp_path)])
    assert outcome.exit_code == 0
    assert [file.name for file in tmp_path.iterdir()] == ["q.toml"]
    assert vs.load(tmp_path / "q.toml").name == "q"


def test_a_design_that_is_not_valid_has_no_mass():
    report = vs.check(families.beam().replace(clamps=[]))
    assert not report.valid
    assert report.mass is None
    assert report.summary()["mass"] is None
    assert "mass" not in str(report)
    assert vs.check(families.beam()).mass == pytest.approx(0.0107)


def test_the_check_of_an_invalid_design_prints_no_mass(tmp_path):
    families.beam().replace(clamps=[]).save(tmp_path / "a.toml")
    outcome = CliRunner().invoke(app, ["check", str(tmp_path / "a.toml")])
    assert "80 voxels" in outcome.output
    assert "mass" not in outcome.output


@pytest.mark.parametrize("status", ["ok", "not-at-rest"])
def test_a_path_shows_statuses_as_words_and_no_empty_column(status, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    console.cache_clear()
    path = vs.follow(families.beam(), "loads[0].value=0..1 m/s^2/2")
    last = replace(path.results[-1], status=status)
    _show_path(replace(path, results=(*path.results[:-1], last)), ())
    console.cache_clear()
    printed = capsys.readouterr().err
    header = next(line for line in printed.splitlines() if line.startswith("┃"))
    assert all(column.strip() for column in header.strip().strip("┃").split("┃"))
    assert "[red]" not in printed.partition("The last")[0]
    assert ("status" in header, "not-at-rest" in printed) == (status != "ok",) * 2


def test_a_wrong_name_brings_the_commands_of_a_simulator():
    line = {"through": [[0, 0.005, 0.005], [0.1, 0.005, 0.005]], "tension": "0.1 N"}
    beam = families.beam().replace(loads=[], tendons=[{"name": "flexor", **line}])
    simulator = vs.Simulator(beam, time_step="20 ms")
    with pytest.raises(vs.VoxSoftError, match=r'"flxor" is no command.*did you mean "flexor"'):
        simulator.step({"flxor": "0.3 N"})
    assert simulator.step().time > 0.0
