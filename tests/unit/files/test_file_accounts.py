"""`check` of a file tells all that the file holds beside all that was taken."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from voxsoft.cli.app import app
from voxsoft.errors import UnitError
from voxsoft.files.checks import check_mesh
from voxsoft.files.meshes import write_mesh
from voxsoft.voxels import Voxels

#: A brick of 10 x 10 x 10 and a tetrahedron of 500 / 3 on its upper face, with a set of each.
DECK = """*NODE
1,0,0,0
2,10,0,0
3,10,10,0
4,0,10,0
5,0,0,10
6,10,0,10
7,10,10,10
8,0,10,10
9,40,0,0
10,50,0,0
11,40,10,0
12,40,0,10
*ELEMENT, TYPE=C3D8R, ELSET=BRICK
1,1,2,3,4,5,6,7,8
*ELEMENT, TYPE=C3D4H, ELSET=TIP
2,9,10,11,12
*NSET, NSET=FIX
1,2,3,4
"""


@pytest.fixture
def deck(tmp_path: Path) -> Path:
    path = tmp_path / "mixed.inp"
    path.write_text(DECK)
    return path


def test_check_has_the_account_in_json(deck):
    result = CliRunner().invoke(
        app, ["check", str(deck), "--unit", "mm", "--voxel-size", "1 mm", "--json"]
    )
    account = json.loads(result.stdout)["file"]
    assert account["format"] == "Abaqus input"
    assert account["meter"] == 1e-3
    assert account["held"]["cells"] == {"hexahedron": 1, "tetra": 1}
    assert account["held"]["sets"] == {"BRICK": 1, "TIP": 1}
    assert account["taken"] == {"points": 12, "triangles": 16}
    sentences = " ".join(account["differences"])
    for word in ("1 hexahedron, 1 tetrahedron", "BRICK, TIP", "FIX"):
        assert word in sentences


def test_check_prints_the_account(deck):
    result = CliRunner().invoke(app, ["check", str(deck), "--unit", "mm"])
    assert "held: points 12, cells (hexahedron 1, tetra 1)" in result.output
    assert "Sets are not taken" in result.output


def test_a_file_that_does_not_say_its_unit_is_asked_about(deck):
    with pytest.raises(UnitError, match=r"span 50 × 10 × 10.*give --unit.*mm: 50 mm long"):
        check_mesh(deck)


def test_a_body_of_an_unlikely_size_has_a_caution(deck):
    account = check_mesh(deck, unit="m", voxel_size="1 m").file
    assert account is not None
    assert account.cautions == (
        "The body is 50 m long: is the unit right? In mm it would be 50 mm long",
    )


@pytest.mark.parametrize("suffix", [".inp", ".msh", ".vtu"])
def test_our_own_files_say_their_unit(tmp_path, suffix):
    path = tmp_path / f"bar{suffix}"
    write_mesh(path, Voxels.from_array(np.ones((4, 2, 2), int), voxel_size=0.005).mesh())
    report = check_mesh(path, voxel_size="5 mm")
    assert report.voxels == 16
    assert report.file is not None
    assert report.file.meter == 1.0
