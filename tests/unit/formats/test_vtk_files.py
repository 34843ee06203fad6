"""Files of VTK: codings, counts that do not fit, labels of images, cells of all types."""

import base64
import re
import zlib
from pathlib import Path

import numpy as np
import pytest

from voxsoft.errors import FileError
from voxsoft.files.meshes import read_mesh_file
from voxsoft.formats.read import read_contents
from voxsoft.formats.vtk_arrays import Coding
from voxsoft.formats.vtk_cells import blocks_of
from voxsoft.formats.vtk_data import DataSet, contents_of
from voxsoft.formats.vtk_grids import Image, cells_of_image

FOLDER = Path(__file__).parents[2] / "data" / "files"
SAME = sorted(
    path.name
    for path in FOLDER.iterdir()
    if re.match(r"vtk-(?:ascii|base64|raw|appended|zlib|big|xml|mixed)", path.name)
)


def test_all_codings_of_one_grid_hold_one_grid():
    assert len(SAME) == 15
    expected = read_contents(FOLDER / "vtk-ascii.vtu")
    for name in SAME:
        found = read_contents(FOLDER / name)
        assert np.array_equal(found.points, expected.points)
        assert [block.kind for block in found.blocks] == [block.kind for block in expected.blocks]
        for block, other in zip(found.blocks, expected.blocks, strict=True):
            assert np.array_equal(block.nodes, other.nodes)
        assert found.arrays["material"].tolist() == [1, 1, 2, 2]


@pytest.mark.parametrize("name", ["vtk-ascii.vtu", "vtk-base64.vtu", "vtk-raw-zlib.vtu"])
def test_an_xml_file_without_its_end_is_cut_short(tmp_path, name):
    content = (FOLDER / name).read_bytes()
    (tmp_path / name).write_bytes(content[: len(content) // 2])
    with pytest.raises(FileError, match="is cut short: it has no </VTKFile>"):
        read_contents(tmp_path / name)


@pytest.mark.parametrize("name", ["vtk-mixed-4_2-text.vtk", "vtk-mixed-5_1-binary.vtk"])
def test_a_legacy_file_that_ends_within_its_numbers_is_cut_short(tmp_path, name):
    content = (FOLDER / name).read_bytes()
    (tmp_path / name).write_bytes(content[: content.index(b"POINTS") + 60])
    with pytest.raises(FileError, match=r"is cut short: it ends after \d+ of 36 numbers"):
        read_contents(tmp_path / name)


@pytest.mark.parametrize(
    ("old", "new", "match"),
    [
        ("4 1 9 5 11", "4 1 9 5 77", "is damaged: a cell has point 77, of 12 points"),
        ("CELL_TYPES 4\n12\n10", "CELL_TYPES 4\n12\n12", "is damaged: a hexahedron has fewer"),
        ("POINTS 12 double", "POINTS 12 quad", "numbers of type 'quad' are not known"),
        ("CELL_DATA 4", "CELL_DATA x", "line .*: 'x' is not 1 numbers"),
        ("CELL_TYPES 4", "CELL_KINDS 4", "the word 'CELL_KINDS' is not known here"),
        ("UNSTRUCTURED_GRID", "TREE", "DATASET TREE; known are UNSTRUCTURED_GRID"),
    ],
)
def test_legacy_files_against_their_format_are_refused_with_the_place(tmp_path, old, new, match):
    text = (FOLDER / "vtk-mixed-4_2-text.vtk").read_text()
    assert old in text
    (tmp_path / "a.vtk").write_text(text.replace(old, new))
    with pytest.raises(FileError, match=match):
        read_contents(tmp_path / "a.vtk")


@pytest.mark.parametrize(
    ("where", "match"),
    [
        (0, "an array ends within its header"),
        (4, "block 1 of 1 of an array has 64 bytes for 191"),
        (30, "block 1 of 1 of an array cannot be unpacked"),
    ],
)
def test_a_block_that_cannot_be_unpacked_is_damaged(where, match):
    coding = Coding("a.vtu", compressor="vtkZLibDataCompressor")
    packed = zlib.compress(bytes(range(64)))
    content = np.array([1, 64, 0, len(packed)], "<u4").tobytes() + packed
    assert coding.numbers_of_bytes(content, "UInt8").tolist() == list(range(64))
    broken = bytearray(content)
    broken[where] ^= 255
    with pytest.raises(FileError, match=match):
        coding.numbers_of_bytes(bytes(broken), "UInt8")


def test_a_block_of_lz4_repeats_itself():
    # Two new bytes, and a copy of 13 from two bytes back; then five new bytes, as all blocks end.
    packed = bytes([0x29, 1, 2, 2, 0, 0x50, 3, 4, 5, 6, 7])
    content = np.array([1, 20, 0, len(packed)], "<u4").tobytes() + packed
    coding = Coding("a.vtu", compressor="vtkLZ4DataCompressor")
    expected = [1, 2] * 7 + [1, 3, 4, 5, 6, 7]
    assert coding.numbers_of_bytes(content, "UInt8").tolist() == expected
    broken = content.replace(bytes([2, 2, 0]), bytes([2, 9, 0]))
    with pytest.raises(FileError, match="a copy reaches out of the block"):
        coding.numbers_of_bytes(broken, "UInt8")


def test_another_compressor_is_named():
    with pytest.raises(FileError, match="is compressed by vtkZstd; known are vtkZLib"):
        Coding("a.vtu", compressor="vtkZstd").numbers_of_bytes(bytes(8), "UInt8")


def test_strips_and_lines_become_simple_cells():
    types, offsets = np.array([6, 4, 2]), np.array([0, 5, 8, 10])
    blocks, order = blocks_of(types, offsets, np.array([0, 1, 2, 3, 4, 5, 6, 7, 8, 9]))
    assert [(block.kind, block.nodes.tolist()) for block in blocks] == [
        ("triangle", [[0, 1, 2], [2, 1, 3], [2, 3, 4]]),
        ("line", [[5, 6], [6, 7]]),
        ("vertex", [[8], [9]]),
    ]
    assert order.tolist() == [0, 0, 0, 1, 1, 2, 2]


def test_sides_of_a_cut_stay_apart_where_pieces_meet():
    # Both pieces have the place 0 twice, as a cut has it, and the place 1 once.
    points = np.array([[0, 0, 0], [0, 0, 0], [1, 0, 0]], float)
    piece = DataSet(points, np.array([5]), np.array([0, 3]), np.array([0, 1, 2]))
    assert len(contents_of("a.vtu", [piece, piece], "VTU").points) == 5


def image(values, **changes):
    array = {"values": np.asarray(values)}
    whole = {"counts": (3, 2, 2), "origin": np.zeros(3), "steps": np.eye(3)}
    return Image(**(whole | {"cell_arrays": array, "point_arrays": {}} | changes))


@pytest.mark.parametrize(
    ("values", "match"),
    [
        (np.array([0.0, 1.0]), r'3 × 2 × 2 points with "values" \(float64\)'),
        (np.array([-1000, 200]), "has negative numbers, down to -1000: these are no labels"),
        (np.array([0, 0]), "is 0 everywhere"),
        (np.array([1, 1, 1]), "has 3 numbers for 2 cells"),
    ],
)
def test_images_without_labels_are_refused(values, match):
    with pytest.raises(FileError, match=match) as caught:
        cells_of_image("scan.vti", image(values))
    assert caught.value.hint or "3 numbers" in match


def test_gray_values_are_no_labels():
    many = image(np.arange(300), counts=(301, 2, 2))
    with pytest.raises(FileError, match="has 300 different numbers; at most 255 are labels"):
        cells_of_image("scan.vti", many)


def test_an_image_lies_where_its_file_says(tmp_path):
    # Voxels of 10 x 10 x 5 mm from (1, 2, 3) mm; then x runs along y, and y against x.
    straight = read_contents(FOLDER / "vtk-labels.vti").points
    assert straight.min(axis=0).tolist() == [1, 2, 3]
    assert straight.max(axis=0).tolist() == [31, 22, 13]
    turned = read_contents(FOLDER / "vtk-labels-turned.vti").points
    np.testing.assert_allclose(turned.min(axis=0), [1 - 20, 2, 3])
    np.testing.assert_allclose(turned.max(axis=0), [1, 2 + 30, 13])
    # A label at a point is of the cell around it.
    around = read_contents(FOLDER / "vtk-labels-at-points.vti").points
    assert around.min(axis=0).tolist() == [5, -5, -2.5]
    assert around.max(axis=0).tolist() == [25, 15, 7.5]


def test_labels_of_an_image_are_parts_with_their_volumes():
    found = read_mesh_file(FOLDER / "vtk-labels.vti", unit="mm")
    volumes = {
        name: found.mesh.tet_volumes[found.mesh.tet_part == part].sum()
        for part, name in found.report.parts.items()
    }
    # Four and five voxels of 500 mm³.
    assert volumes == {"label 1": pytest.approx(2.0e-6), "label 2": pytest.approx(2.5e-6)}


def test_offsets_into_text_of_base64_are_letters(tmp_path):
    # ParaView may break the lines of appended data so.
    text = (FOLDER / "vtk-appended-base64.vtu").read_text()
    head, appended, foot = re.split(r"(?<=_)([A-Za-z0-9+/=]{100,})", text)
    broken = "\n".join(appended[at : at + 60] for at in range(0, len(appended), 60))
    assert base64.b64decode(appended[:8])
    (tmp_path / "a.vtu").write_text(head + broken + foot)
    expected = read_contents(FOLDER / "vtk-ascii.vtu").points
    assert np.array_equal(read_contents(tmp_path / "a.vtu").points, expected)
