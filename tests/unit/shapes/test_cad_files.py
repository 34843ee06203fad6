"""CAD models are refused with a remedy, wherever they are opened."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.files import read_mesh
from voxsoft.shapes.cad_files import HINT
from voxsoft.studio.documents.opening import document_at
from voxsoft.studio.documents.uploads import safe_name

STEP = "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n"


@pytest.fixture(params=["finger.step", "FINGER.STP", "finger.iges", "finger.SLDPRT"])
def cad(request, tmp_path):
    file = tmp_path / request.param
    file.write_text(STEP)
    return file


@pytest.mark.parametrize(
    "opened",
    [
        lambda file: vs.TriangleMesh(path=str(file), unit="mm").build(),
        read_mesh,
        vs.load,
        lambda file: vs.files.check_mesh(file, unit="mm"),
        lambda file: document_at(file, Path()),
        lambda file: safe_name(file.name),
    ],
    ids=["shape", "mesh", "design", "check", "studio", "upload"],
)
def test_python_and_the_studio_say_to_export_triangles(cad, opened):
    with pytest.raises(vs.VoxSoftError, match="is a CAD model, whose faces are formulas") as caught:
        opened(cad)
    assert caught.value.hint == HINT
    assert "STL or OBJ" in HINT


@pytest.mark.parametrize("verb", ["check", "run", "mesh", "export"])
def test_every_verb_says_so(cad, verb, tmp_path):
    more = [str(tmp_path / "out.stl")] if verb == "export" else []
    answer = CliRunner().invoke(app, [verb, str(cad), *more])
    assert answer.exit_code != 0
    printed = " ".join(answer.output.split())
    assert "is a CAD model" in printed
    assert "open it in FreeCAD" in printed
