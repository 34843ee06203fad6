"""Triangle meshes: closed, turned, with cavities, holes, and files that cannot be read."""

import csv
import os
import re
import sys
from pathlib import Path

import meshio
import numpy as np
import pytest

from voxsoft.errors import ShapeError
from voxsoft.shapes import Box, TriangleMesh, inside, voxelize

SHARED = Path(os.environ.get("VOXSOFT_SHARED", Path(__file__).parents[4] / "shared"))
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


FORMATS = ["stl", "obj", "ply", "off", "mesh", "msh", "vtk", "vtu", "bdf", "avs", "vol"]


@pytest.mark.parametrize("name", [f"part.{suffix}" for suffix in FORMATS])
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


@pytest.mark.parametrize("turned", [[0], [0, 1, 2], [3, 5, 8, 11], list(range(7))])
def test_mixed_winding_within_a_shell_costs_nothing(tmp_path, turned):
    mixed = FACES.copy()
    mixed[turned] = mixed[turned, ::-1]
    cube = saved(tmp_path, 10 * CORNERS, mixed)
    assert voxelize(cube, 0.001).count == 1000
    state = cube.state()
    assert state.turned == min(len(turned), 12 - len(turned))
    assert state.holes == ()


def test_a_cavity_with_mixed_winding_stays_a_cavity(tmp_path):
    points = np.vstack([10 * CORNERS, 3 + 4 * CORNERS])
    faces = np.vstack([FACES, FACES[:, ::-1] + 8])
    for triangle in (1, 4, 13, 22, 23):
        faces[triangle] = faces[triangle, ::-1]
    hollow = saved(tmp_path, points, faces)
    assert voxelize(hollow, 0.001).count == 1000 - 4**3
    assert hollow.state().turned == 5


CELLS = {
    "hexahedron": [[0, 4, 6, 2, 1, 5, 7, 3]],
    "tetra": [[0, 1, 3, 7], [0, 7, 3, 2], [0, 2, 6, 7], [0, 7, 6, 4], [0, 4, 5, 7], [0, 7, 5, 1]],
    "wedge": [[0, 4, 6, 1, 5, 7], [0, 6, 2, 1, 7, 3]],
    "pyramid": [[0, 4, 6, 2, 8], [1, 3, 7, 5, 8], [0, 1, 5, 4, 8], [2, 6, 7, 3, 8], [0, 2, 3, 1, 8], [4, 5, 7, 6, 8]],  # noqa: E501
    "quad": [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]],
}  # fmt: skip


@pytest.mark.parametrize("kind", CELLS)
def test_cells_of_every_kind_give_their_surface(tmp_path, kind):
    path = tmp_path / "cells.vtu"
    points = 10 * np.vstack([CORNERS, [[0.5, 0.5, 0.5]]])
    meshio.write(path, meshio.Mesh(points, [(kind, np.array(CELLS[kind]))]))
    cube = TriangleMesh(path=str(path), unit="mm")
    assert voxelize(cube, 0.001).count == 1000
    assert cube.state()[:2] == (0, ())


def test_cells_with_curved_edges_are_taken_by_their_corners(tmp_path):
    path = tmp_path / "curved.vtu"
    corners = 10 * CORNERS[[0, 4, 2, 1]]
    middles = [
        (corners[i] + corners[j]) / 2 for i, j in [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
    ]
    meshio.write(path, meshio.Mesh(np.vstack([corners, middles]), [("tetra10", [range(10)])]))
    tet = TriangleMesh(path=str(path), unit="mm")
    count = voxelize(tet, 0.0005).count
    assert count * 0.0005**3 == pytest.approx(0.01**3 / 6, rel=0.1)
    assert tet.state()[:2] == (0, ())


def test_an_open_surface_is_reported_with_its_hole_and_a_remedy(tmp_path):
    sheet = np.array([[i, j, 0.0] for i in range(4) for j in range(4)]) * 10
    faces = [
        [a, a + 4, a + 5] if half else [a, a + 5, a + 1]
        for a in (0, 1, 2, 4, 5, 6, 8, 9, 10)
        for half in (0, 1)
    ]
    plate = saved(tmp_path, sheet, np.array(faces), "plate.off")
    with pytest.raises(ShapeError) as reported:
        voxelize(Box(size=(0.03, 0.03, 0.03)) & plate, 0.001)
    printed = str(reported.value)
    assert "plate.off: is open: a hole of 12 edges, 30 mm wide, near (15, 15, 0) mm" in printed
    assert 'kind = "shell"' in printed
    assert "smaller voxel_size" not in printed
    # And the advice works.
    assert voxelize(plate.shell(0.004), 0.001).count > 30 * 30 * 3


def test_a_hole_is_measured(tmp_path):
    hole, *others = saved(tmp_path, 10 * CORNERS, FACES[1:]).state().holes
    assert others == []
    assert (hole.edges, hole.width) == (3, pytest.approx(0.01))
    assert hole.center == pytest.approx((0.0, 0.005, 0.005))


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


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("content", [b"", b"solid x\nfacet", b"\x00" * 90, b"\xff\xfe garbage"])
@pytest.mark.parametrize("suffix", [".stl", ".obj", ".ply", ".vtk", ".vtu"])
def test_a_file_that_cannot_be_read_is_an_error(tmp_path, content, suffix, capsys):
    path = tmp_path / f"part{suffix}"
    path.write_bytes(content)
    with pytest.raises(ShapeError, match=r"mesh\.path") as reported:
        TriangleMesh(path=str(path), unit="mm").build()
    assert capsys.readouterr() == ("", "")
    printed = str(reported.value)
    reason = f"cannot be read as {suffix[1:].upper()}|holds|does not begin with|is cut short"
    assert re.search(reason, printed)
    for noise in ("module", "Traceback", "(1)", "not enough values", "Errno", "codec"):
        assert noise not in printed


def test_damaged_stl_and_vtu_files_name_the_fault(tmp_path):
    stl, vtu = tmp_path / "part.stl", tmp_path / "part.vtu"
    stl.write_bytes(np.random.default_rng(0).bytes(1000))
    with pytest.raises(ShapeError, match='neither begins with "solid"'):
        TriangleMesh(path=str(stl), unit="mm").build()
    saved(tmp_path, 10 * CORNERS, FACES, "part.vtu")
    vtu.write_bytes(vtu.read_bytes()[:700])
    with pytest.raises(ShapeError, match=r"part\.vtu is cut short: it has no </VTKFile>"):
        TriangleMesh(path=str(vtu), unit="mm").build()


def test_a_format_that_needs_a_package_names_it(tmp_path, monkeypatch):
    (tmp_path / "part.h5m").write_bytes(b"x")
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(ShapeError, match=r"needs the package h5py.*pip install h5py"):
        TriangleMesh(path=str(tmp_path / "part.h5m"), unit="mm").build()


def test_an_unknown_suffix_and_a_wrong_unit_are_named(tmp_path):
    path = tmp_path / "part.xyz"
    path.write_text("ISO-10303-21;")
    with pytest.raises(ShapeError, match=r"unknown format '\.xyz'; known are .*\.stl"):
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


@pytest.mark.long
@pytest.mark.skipif(not FOLDER.is_dir(), reason=f"no collected shapes in {FOLDER}")
@pytest.mark.parametrize(
    "row",
    [
        # The one of most triangles; tests/integration/test_shared_shapes.py has it at 20 cells.
        pytest.param(row, id=row["name"], marks=[pytest.mark.slow] * (row["name"] == "cycloidal"))
        for row in collected()
    ],
)
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
