"""Formats of files: each entry of the registry names functions that exist, and keeps its word."""

from typing import get_type_hints

import numpy as np
import pytest

from voxsoft.cli.export import export
from voxsoft.errors import FileError
from voxsoft.files.meshes import read_mesh_file, write_mesh
from voxsoft.formats.read import known_suffixes
from voxsoft.formats.registry import FORMATS, MEASURED, READ, WRITTEN, function
from voxsoft.studio.outputs.exports import FORMATS as EXPORTS
from voxsoft.voxels import Voxels

MESHES = [suffix for suffix, form in WRITTEN.items() if form.has_shape]


@pytest.fixture(scope="module")
def hollow():
    """A body of two parts around a cavity."""
    labels = np.ones((4, 3, 3), np.uint8)
    labels[2:] = 2
    labels[1, 1, 1] = 0
    return Voxels.from_array(labels, voxel_size=0.01).mesh()


def test_each_reader_and_writer_exists():
    names = [name for form in FORMATS for name in (form.reader, form.writer) if name is not None]
    assert all(callable(function(name)) for name in names)
    with pytest.raises(AttributeError):
        function("voxsoft.formats.stl:missing")


def test_each_suffix_is_read_by_one_format():
    read = [form for form in FORMATS if form.reader is not None]
    for found, is_measured in ((READ, False), (MEASURED, True)):
        forms = [form for form in read if (form.kind == "measured") == is_measured]
        suffixes = [suffix for form in forms for suffix in form.suffixes]
        assert len(suffixes) == len(set(suffixes)) == len(found)
    assert set(READ) <= set(known_suffixes())
    # One suffix may be a body and a measurement; the reader asked for says which.
    assert {*READ} & {*MEASURED} <= {".mat"}


@pytest.mark.parametrize("suffix", MESHES)
def test_a_written_file_holds_as_much_as_its_format_says(suffix, hollow, tmp_path):
    form, path = WRITTEN[suffix], tmp_path / f"body{suffix}"
    values = {"height": hollow.vertices[:, 2]}
    if "values" not in form.holds:
        with pytest.raises(FileError, match="cannot hold data"):
            write_mesh(path, hollow, point_data=values)
        values = {}
    regions = {"tip": [0, 1, 2]}
    if "regions" not in form.holds:
        with pytest.raises(FileError, match="cannot hold regions"):
            write_mesh(path, hollow, regions=regions)
        regions = {}
    write_mesh(path, hollow, point_data=values, regions=regions)
    if form.kind == "surface":
        with pytest.raises(FileError, match="holds a surface"):
            read_mesh_file(path)
        return
    again = read_mesh_file(path)
    assert again.mesh.vertices == pytest.approx(hollow.vertices, abs=1e-15)
    assert ("parts" in form.holds) == np.array_equal(again.mesh.tet_part, hollow.tet_part)
    assert ("cavities" in form.holds) == (len(again.mesh.cavities) == 1)
    assert {k: v.tolist() for k, v in again.regions.items()} == regions
    assert all(np.array_equal(again.point_data[k], v) for k, v in values.items())


def test_lists_of_formats_follow_the_registry():
    target = get_type_hints(export, include_extras=True)["target"].__metadata__[0]
    assert target.help == f"File to write: {' '.join(WRITTEN)}"
    assert {f".{name}" for name in EXPORTS} - set(WRITTEN) == {".molds", ".run", ".png", ".html"}
