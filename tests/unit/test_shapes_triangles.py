"""Triangle meshes: closed, turned, with cavities, holes, and files that cannot be read."""

import csv
import os
from pathlib import Path

import meshio
import numpy as np
import pytest

from voxsoft.errors import ShapeError
from voxsoft.shapes import Box, TriangleMesh, inside, voxelize

SHARED = Path(os.environ.get("VOXSOFT_SHARED", Path(__file__).parents[3] / "shared"))
FOLDER = SHARED / "data" / "shapes"

CORNERS = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)], dtype=float)
FACES = np.array(
    [
        [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
    ]
)  # fmt: skip
POINTS = np.random.default_rng(2).uniform(-0.005, 0.015, (500, 3))


def saved(tmp_path, points, faces, name="part.stl"):
    path = tmp_path / name
    meshio.write(path, meshio.Mesh(points, [("triangle", faces)]))
    return TriangleMesh(path=str(path), unit="mm")


@pytest.mark.parametrize("name", ["part.stl", "part.obj", "part.ply", "part.vtk", "part.vtu"])
def test_a_cube_is_a_box_in_every_format(tmp_path, name):
    cube = saved(tmp_path, 10 * CORNERS, FACES, name)
    box = Box(size=(0.01, 0.01, 0.01))
    np.testing.assert_allclose(cube.evaluate(POINTS), box.evaluate(POINTS), atol=1e-9)
    np.testing.assert_allclose(cube.bounds(), box.bounds(), atol=1e-9)
    assert voxelize(cube, 0.001).count == 1000
    assert voxelize(cube.shell(0.002), 0.0005).count > voxelize(cube, 0.0005).count * 0.5


def test_turned_faces_do_not_spoil_the_inside(tmp_path):
    turned = saved(tmp_path, 10 * CORNERS, FACES[:, ::-1])
    assert voxelize(turned, 0.001).count == 1000


def test_an_inner_shell_of_opposite_orientation_is_a_cavity(tmp_path):
    points = np.vstack([10 * CORNERS, 3 + 4 * CORNERS])
    faces = np.vstack([FACES, FACES[:, ::-1] + 8])
    hollow = voxelize(saved(tmp_path, points, faces), 0.001)
    assert hollow.count == 1000 - 4**3


def test_a_hole_is_closed(tmp_path):
    # Without one of twelve triangles the winding number near the hole is near one half.
    holed = voxelize(saved(tmp_path, 10 * CORNERS, FACES[1:]), 0.001)
    assert 800 < holed.count <= 1000


def test_a_broken_mesh_is_classified_cell_by_cell(tmp_path):
    # The sign flips across the missing face, where no triangle is near to tell a block of it.
    holed = saved(tmp_path, 10 * CORNERS, FACES[2:])
    size, cells = 0.012 / 40, (40, 40, 40)
    index = np.stack(np.meshgrid(*map(np.arange, cells), indexing="ij"), axis=-1)
    centers = -0.001 + (index.reshape(-1, 3) + 0.5) * size
    found = inside(holed, size, cells, (-0.001, -0.001, -0.001))
    low, high = map(np.array, holed.bounds())
    within = ((centers > low) & (centers < high)).all(axis=1)
    expected = (holed.evaluate(centers) < -1e-9 * size) & within
    assert expected.sum() > 1000
    assert np.array_equal(found.ravel(), expected)


def test_tets_give_their_surface(tmp_path):
    path = tmp_path / "tets.vtu"
    tets = np.array(
        [[0, 1, 3, 7], [0, 7, 3, 2], [0, 2, 6, 7], [0, 7, 6, 4], [0, 4, 5, 7], [0, 7, 5, 1]]
    )
    meshio.write(path, meshio.Mesh(10 * CORNERS, [("tetra", tets)]))
    assert voxelize(TriangleMesh(path=str(path), unit="mm"), 0.001).count == 1000


def test_a_soup_encloses_nothing(tmp_path):
    points = np.random.default_rng(0).uniform(size=(90, 3))
    soup = saved(tmp_path, points, np.arange(90).reshape(-1, 3))
    with pytest.raises(ShapeError, match="encloses nothing: 90 of 90 edges"):
        soup.build()


@pytest.mark.parametrize("content", [b"", b"solid x\nfacet", b"\x00" * 90, b"\xff\xfe garbage"])
@pytest.mark.parametrize("suffix", [".stl", ".obj", ".ply", ".vtk", ".vtu"])
def test_a_file_that_cannot_be_read_is_an_error(tmp_path, content, suffix, capsys):
    path = tmp_path / f"part{suffix}"
    path.write_bytes(content)
    with pytest.raises(ShapeError, match=r"mesh\.path"):
        TriangleMesh(path=str(path), unit="mm").build()
    assert capsys.readouterr() == ("", "")


def test_an_unknown_suffix_and_a_wrong_unit_are_named(tmp_path):
    path = tmp_path / "part.step"
    path.write_text("ISO-10303-21;")
    with pytest.raises(ShapeError, match=r"none of \.stl"):
        TriangleMesh(path=str(path), unit="mm").build()
    with pytest.raises(ShapeError, match="unit"):
        TriangleMesh(path=str(path), unit="kPa")


def test_a_changed_file_is_read_again(tmp_path):
    cube = saved(tmp_path, 10 * CORNERS, FACES)
    assert cube.bounds()[1][0] == pytest.approx(0.01)
    saved(tmp_path, 20 * CORNERS, FACES)
    os.utime(tmp_path / "part.stl", ns=(1, 1))
    assert cube.bounds()[1][0] == pytest.approx(0.02)


def collected():
    if not FOLDER.is_dir():
        return []
    with (FOLDER / "manifest.csv").open(newline="") as table:
        return list(csv.DictReader(table))


@pytest.mark.skipif(not FOLDER.is_dir(), reason=f"no collected shapes in {FOLDER}")
@pytest.mark.parametrize("row", collected(), ids=lambda row: row["name"])
def test_collected_shapes_keep_their_volume(row):
    shape = TriangleMesh(path=str(FOLDER / row["file"]), unit="mm")
    if row["name"] == "soup":
        with pytest.raises(ShapeError, match="encloses nothing"):
            shape.build()
        return
    low, high = shape.bounds()
    size = max(np.subtract(high, low)) / 40
    voxels = voxelize(shape, size)
    assert voxels.count > 0
    volume = abs(float(row["tet_volume"] or row["signed_volume"] or "nan")) * 1e-9
    if row["watertight"] == "1" and row["components"] == "1":
        # A face lies within half a voxel of where the centers put it.
        slack = float(row["surface_area"]) * 1e-6 * size / 2
        assert abs(voxels.count * size**3 - volume) < slack
