"""Folders of molds: files that other programs read, the sheet, and the command."""

import json

import numpy as np
import pytest
import trimesh
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.errors import DesignError
from voxsoft.fabrication import Printer, make
from voxsoft.files.fabrication import write_fabrication
from voxsoft.units import mm

CUP = """
schema = "voxsoft/1"
name = "cup"
voxel_size = "2 mm"
[shapes]
outside = { kind = "cylinder", radius = "6 mm", height = "10 mm" }
inside = { kind = "cylinder", radius = "4 mm", height = "8 mm", base = [0, 0, "2 mm"] }
cup = { kind = "difference", of = ["outside", "inside"] }
[[parts]]
shape = "cup"
material = "ecoflex-00-30"
"""


@pytest.fixture(scope="module")
def design_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("cup") / "cup.toml"
    path.write_text(CUP)
    return path


def test_the_command_writes_parts_that_are_closed_in_other_programs(design_file, tmp_path):
    folder = tmp_path / "out"
    result = CliRunner().invoke(
        app, ["make", str(design_file), "--json", "--stl", "--out", str(folder)]
    )
    assert result.exit_code == 0, result.output
    summary = json.loads(result.stdout)
    # Upside down, on a pillar: its floor is level with the brim.
    assert summary["way"] == "cast"
    assert summary["problems"] == []
    assert [part["name"] for part in summary["parts"]] == ["cup-lower"]
    for part in summary["parts"]:
        mesh = trimesh.load_mesh(folder / part["file"])
        assert mesh.is_watertight
        # STL holds seven digits, in mm.
        assert mesh.volume == pytest.approx(part["volume"] * 1e9, rel=1e-5)
    volume = np.pi * (6**2 * 10 - 4**2 * 8) * mm**3
    pour = summary["pour"]
    assert pour["a"] == pour["b"] == pytest.approx(1.15 * 1070 * volume / 2, rel=0.005)
    assert pour["waste"] == pytest.approx(0.15 * 1070 * volume, rel=0.005)
    assert json.loads((folder / "make.json").read_text())["parts"] == summary["parts"]


def test_the_sheet_says_all_steps_and_masses(design_file, tmp_path):
    made = make(vs.load(design_file))
    folder = write_fabrication(made, tmp_path / "made")
    text = (folder / "sheet.html").read_text()
    assert "Ecoflex 00-30" in text
    assert f"<td>{1e3 * made.casts[0].a:.1f}" in text
    assert text.count("<img") == 1
    assert "to the brim and level it" in text
    assert sorted(p.name for p in folder.glob("*.3mf")) == ["cup-lower.3mf"]


def test_molds_with_problems_are_not_written(design_file, tmp_path):
    small = Printer(volume=(6 * mm, 6 * mm, 6 * mm))
    made = make(vs.load(design_file), printer=small)
    with pytest.raises(DesignError, match="larger than the printer"):
        write_fabrication(made, tmp_path / "none")
    assert not (tmp_path / "none").exists()


def test_a_bad_limit_and_an_unknown_way_are_named(design_file):
    wrong = CliRunner().invoke(app, ["make", str(design_file), "--printer", "walls=1 mm"])
    assert wrong.exit_code == 3
    assert "walls" in wrong.output
    room = ["--printer", "volume=6 mm, 6 mm, 6 mm"]
    large = CliRunner().invoke(app, ["make", str(design_file), *room])
    assert (large.exit_code, "larger than the printer's 6 x 6 x 6 mm" in large.output) == (3, True)
    other = CliRunner().invoke(app, ["make", str(design_file), "--body", "tail"])
    assert (other.exit_code, "'tail' is not known" in other.output) == (3, True)
    unknown = CliRunner().invoke(app, ["make", str(design_file), "--way", "forged"])
    assert unknown.exit_code == 2
    assert "expected cast, core, halves" in unknown.output


def test_options_stand_in_the_design_and_the_command_comes_before_them(design_file, tmp_path):
    text = design_file.read_text()
    design_file = tmp_path / "cup.toml"
    asked = '[molds]\nway = "printed"\nprinter = { wall = "1 mm", tube = "4 mm" }\n'
    design_file.write_text(f"{text}\n{asked}")
    plain = vs.load(design_file)
    made = make(plain)
    assert made.way == "printed"
    assert (made.printer.wall, made.printer.tube) == (1 * mm, 4 * mm)
    assert make(plain, printer=Printer(), way="core").printer.tube == 3 * mm
    # No answer depends on them.
    design_file.write_text(text)
    assert plain.hash == vs.load(design_file).hash
    design_file.write_text(f"{text}\n{asked}")
    out = tmp_path / "out"
    options = ["--printer", "tube=2 mm", "--out", str(out), "--json"]
    done = CliRunner().invoke(app, ["make", str(design_file), *options])
    assert done.exit_code == 0, done.output
    assert json.loads((out / "make.json").read_text())["way"] == "printed"
    design_file.write_text(f'{text}\n[molds]\nshrinkage = "20 %"\n')
    wrong = CliRunner().invoke(app, ["make", str(design_file)])
    assert wrong.exit_code == 3
    assert "molds.shrinkage" in wrong.output
