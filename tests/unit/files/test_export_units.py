"""The unit of exported surfaces."""

import numpy as np
import pytest
import trimesh
from typer.testing import CliRunner

from voxsoft.cli.app import app
from voxsoft.design import families
from voxsoft.errors import FileError
from voxsoft.files import export


@pytest.fixture
def design(tmp_path):
    families.beam().save(tmp_path / "beam.toml")
    return tmp_path / "beam.toml"


def length_of(file):
    return np.ptp(trimesh.load(file).vertices, axis=0).max()


@pytest.mark.parametrize("suffix", [".stl", ".obj"])
@pytest.mark.parametrize(("unit", "length"), [(None, 100.0), ("m", 0.1), ("cm", 10.0)])
def test_a_surface_is_in_mm_or_in_the_unit_that_is_asked_for(design, suffix, unit, length):
    file = design.with_suffix(suffix)
    export(design, file, unit=unit)
    assert length_of(file) == pytest.approx(length, rel=1e-6)


def test_the_command_says_the_unit(design):
    file = design.with_suffix(".stl")
    outcome = CliRunner().invoke(app, ["export", str(design), str(file)])
    assert outcome.output.replace("\n", "").endswith("beam.stl, in mm")
    assert length_of(file) == pytest.approx(100.0, rel=1e-6)


@pytest.mark.parametrize(
    ("suffix", "why"),
    [
        (".toml", "says the unit of each number"),
        (".npy", "no lengths"),
        (".vtu", "is always in m"),
    ],
)
def test_a_format_that_takes_no_unit_says_why(design, suffix, why):
    with pytest.raises(FileError, match=why):
        export(design, design.with_name("out").with_suffix(suffix), unit="mm")
