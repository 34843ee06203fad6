"""OBJ and STL: indices, groups and solids, and proof before a file is called cut short."""

import numpy as np
import pytest
import trimesh

from voxsoft.errors import FileError, ShapeError
from voxsoft.files.checks import check_mesh
from voxsoft.formats.read import read_contents
from voxsoft.shapes.surface_files import read_surface

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"


def read(tmp_path, content, name="a.obj"):
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return read_contents(path)


def test_indices_count_back_from_the_vertex_before_them(tmp_path):
    second = TRIANGLE.replace("v ", "v 1")
    found = read(tmp_path, f"{TRIANGLE}f -3 -2 -1\n{second}f -3/1 -2//2 -1/1/1\nf 1 2 3\n")
    assert found.blocks[0].nodes.tolist() == [[0, 1, 2], [3, 4, 5], [0, 1, 2]]


def test_vertices_may_follow_the_faces_that_name_them(tmp_path):
    assert read(tmp_path, f"f 1 2 3\n{TRIANGLE}").blocks[0].nodes.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize(
    ("line", "match"),
    [
        ("f 1 2 4", "is damaged: a face names vertex 4 of 3 vertices"),
        ("f 1 2 0", "line 4: names vertex 0"),
        ("f -1 -2 -4", "line 4: names vertex -4 of 3 vertices so far"),
        ("f 1 2", "line 4: f has 2 vertices; expected 3 or more"),
        ("f 1 2 x", "line 4: 'x' names no vertex"),
        ("v 1 2", "line 4: a vertex has 2 coordinates; expected 3"),
        ("v 1 2 x", "line 4: '1 2 x' is no vertex"),
        ("surf 0 1 0 1 1 2 3", r"line 4: holds a curved surface as a formula \(surf\)"),
    ],
)
def test_lines_that_cannot_be_followed_are_named(tmp_path, line, match):
    with pytest.raises(FileError, match=match):
        read(tmp_path, f"{TRIANGLE}{line}\n")


def test_groups_and_materials_are_sets_that_check_names(tmp_path):
    box = trimesh.creation.box((10, 10, 10))
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in box.vertices)
    for number, face in enumerate(box.faces):
        text += f"usemtl rubber\ng side-{number % 2}\nf {' '.join(str(i + 1) for i in face)}\n"
    (tmp_path / "box.obj").write_text(text)
    account = check_mesh(tmp_path / "box.obj", unit="mm", voxel_size="1 mm").file
    assert account.held["sets"] == {"side-0": 6, "rubber": 12, "side-1": 6}
    sentence = "Sets are not taken, the body is one: rubber, side-0, side-1"
    assert sentence in account.differences


def test_solids_of_a_text_are_sets(tmp_path):
    facet = "facet normal 0 0 1\nouter loop\n" + 3 * "vertex 0 1 2\n" + "endloop\nendfacet\n"
    text = f"solid shell\n{2 * facet}endsolid shell\nsolid core\n{facet}endsolid core\n"
    found = read(tmp_path, text, "a.stl")
    assert {name: cells.tolist() for name, cells in found.cell_sets.items()} == {
        "shell": [0, 1],
        "core": [2],
    }


def test_a_binary_stl_that_begins_as_text_is_read_by_its_length(tmp_path):
    content = trimesh.creation.box((1, 1, 1)).export(file_type="stl")
    found = read(tmp_path, b"solid by a scanner".ljust(80) + content[80:], "a.stl")
    assert len(found.blocks[0].nodes) == 12


def test_an_stl_is_called_cut_short_with_its_counts(tmp_path):
    content = trimesh.creation.box((1, 1, 1)).export(file_type="stl")
    with pytest.raises(FileError, match="it says 12 and has room for 9"):
        read(tmp_path, content[:-120], "a.stl")
    with pytest.raises(FileError, match="is cut short: it does not end with endsolid"):
        read(tmp_path, "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "b.stl")
    more = read(tmp_path, content + bytes(60), "c.stl")
    assert more.notes == ("60 bytes behind the last triangle are passed over",)


def test_gltf_is_in_meters(tmp_path):
    trimesh.creation.box((0.02, 0.01, 0.01)).export(tmp_path / "a.glb")
    assert check_mesh(tmp_path / "a.glb").file.meter == 1.0
    assert np.ptp(read_surface(tmp_path / "a.glb").points, axis=0) == pytest.approx(
        (0.02, 0.01, 0.01)
    )


@pytest.mark.parametrize(
    ("name", "way"),
    [
        ("a.3mf", "slicer such as PrusaSlicer"),
        ("a.unv", "Gmsh and save it as .msh"),
        ("a.dae", "Blender"),
        ("a.nrrd", "3D Slicer"),
        ("a.npy", "Voxels.from_array"),
    ],
)
def test_formats_that_are_not_read_have_a_way_that_works(tmp_path, name, way):
    (tmp_path / name).write_bytes(b"x")
    with pytest.raises(ShapeError, match=f"unknown format.*{way}"):
        read_surface(tmp_path / name)
