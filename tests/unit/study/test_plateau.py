"""Studies on voxels that do not show small steps: distinct bodies, shared ranks, plateaus."""

import json

import pytest
from typer.testing import CliRunner

from voxsoft.cli.app import app
from voxsoft.files import load
from voxsoft.study import Study

#: Widths of 3.6 to 5.0 mm are two voxels of 2 mm, 5.2 mm three: centers lie at 1, 3, 5 mm.
TEXT = """
schema = "voxsoft/1"
name = "stairs"
voxel_size = "2 mm"
FILL
[parameters]
width = { value = "4 mm", min = "3.6 mm", max = "5.2 mm", step = "0.2 mm" }
[shapes]
beam = { kind = "box", size = ["12 mm", "= width", "4 mm"] }
[[parts]]
shape = "beam"
material = { model = "neo-hookean", young = "100 kPa", poisson = 0.45, density = "1000 kg/m^3" }
[[clamps]]
region = { x = [0, 0] }
[[loads]]
kind = "gravity"
[probes]
tip = { x = ["12 mm", "12 mm"] }
[objectives]
sag = { minimize = "displacement", probe = "tip" }
[constraints]
mass = { metric = "mass", max = "1 g" }
"""


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where studies are kept
    path = tmp_path / "stairs.toml"
    path.write_text(TEXT.replace("FILL", 'fill = "binary"'))
    return path


def test_designs_that_are_one_body_are_counted_once_and_share_a_rank(file):
    result = Study(load(file)).grid()
    assert len(result.trials) == 9
    assert result.distinct == 2
    assert sorted(result.ranks) == [1, *[2] * 8]
    assert result.plateau == {}  # the widest beam alone has three voxels
    (warning,) = (each for each in result.warnings if each.where == "study")
    assert "9 solved designs are 2 distinct bodies" in warning.what
    assert 'fill = "fraction"' in warning.hint


def test_a_best_that_is_a_plateau_is_a_range(file):
    lightest = load(file).replace(objectives={"light": {"minimize": "mass"}}, constraints={})
    result = Study(lightest).grid()
    assert result.plateau == {"width": pytest.approx((3.6e-3, 5.0e-3))}
    assert result.ranks[:9] == (*[1] * 8, 9)
    best = result.summary()["best"]
    assert best["plateau"]["width"] == pytest.approx([3.6e-3, 5.0e-3])
    assert result.summary()["distinct"] == 2


def test_fractions_tell_all_of_them_apart(file):
    file.write_text(TEXT.replace("FILL", ""))
    result = Study(load(file)).grid()
    assert result.distinct == 9
    assert result.ranks == tuple(range(1, 10))
    assert not [each for each in result.warnings if each.where == "study"]


@pytest.mark.slow
def test_the_command_says_it_before_and_after(file):
    found = CliRunner().invoke(app, ["sweep", str(file), "--out", "out"])
    assert found.exit_code == 0, found.output
    text = " ".join(found.output.split())
    assert "is varied by 0.2 mm on voxels of 2 mm" in text or "is varied by 200 um" in text
    assert text.index("is varied by") < text.index("9 designs: 9 ok, 2 distinct")
    assert "mass (" in text  # the constraint stands in the table
    again = CliRunner().invoke(app, ["sweep", str(file), "--out", "out", "--json"])
    assert json.loads(again.stdout)["distinct"] == 2
