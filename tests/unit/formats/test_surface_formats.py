"""OBJ, STL and PLY: indices, groups and solids, and proof before a file is called cut short."""

import struct

import meshio
import numpy as np
import pytest
import trimesh

from voxsoft.errors import FileError, ShapeError
from voxsoft.files.checks import check_mesh
from voxsoft.files.meshes import read_mesh_file
from voxsoft.formats.read import read_contents
from voxsoft.shapes.surface_files import read_surface


def volume_within(path):
    surface = read_surface(path)
    a, b, c = (surface.points[surface.triangles[:, corner]] for corner in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


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
        ("a.amf", "slicer such as PrusaSlicer"),
        ("a.unv", "Gmsh and save it as .msh"),
        ("a.dae", "Blender"),
        ("a.mha", "3D Slicer"),
        ("a.npz", "numpy.save, as .npy"),
    ],
)
def test_formats_that_are_not_read_have_a_way_that_works(tmp_path, name, way):
    (tmp_path / name).write_bytes(b"x")
    with pytest.raises(ShapeError, match=f"unknown format.*{way}"):
        read_surface(tmp_path / name)


PLY = """ply
format ascii 1.0
comment a pyramid of four sides
element vertex 5
property float x
property float y
property float z
property uchar red
element face 5
property uchar flags
property list uchar int vertex_indices
element edge 1
property int vertex1
property int vertex2
end_header
0 0 0 255
6 0 0 255
6 6 0 255
0 6 0 255
3 3 5 0
1 4 3 2 1 0
1 3 0 1 4
1 3 1 2 4
1 3 2 3 4
1 3 3 0 4
0 1
"""


def test_a_ply_of_mixed_faces_is_read_whole(tmp_path):
    found = read(tmp_path, PLY, "a.ply")
    kinds = [(block.kind, len(block.nodes)) for block in found.blocks]
    assert kinds == [("quad", 1), ("triangle", 4)]
    assert volume_within(tmp_path / "a.ply") == pytest.approx(60, rel=1e-15)
    assert found.notes == (
        'Array "red" on points is not read',
        'Array "flags" on cells is not read',
        "1 elements of edge are not read",
    )


def test_a_ply_of_big_endian_bytes_is_read(tmp_path):
    head = PLY.partition("end_header\n")[0].replace("ascii", "binary_big_endian")
    points = [(0, 0, 0), (6, 0, 0), (6, 6, 0), (0, 6, 0), (3, 3, 5)]
    faces = [(3, 2, 1, 0), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    body = b"".join(struct.pack(">fffB", *point, 255) for point in points)
    body += b"".join(struct.pack(f">BB{len(f)}i", 1, len(f), *f) for f in faces)
    content = head.encode() + b"end_header\n" + body + struct.pack(">2i", 0, 1)
    read(tmp_path, content, "a.ply")
    assert volume_within(tmp_path / "a.ply") == pytest.approx(60, rel=1e-15)
    with pytest.raises(FileError, match="is cut short: it ends before the last face of 5"):
        read(tmp_path, content[:-20], "b.ply")


def test_a_ply_of_text_that_ends_early_is_cut_short(tmp_path):
    # Another reader goes on at the end for good.
    with pytest.raises(FileError, match="is cut short: it ends before the last face of 5"):
        read(tmp_path, PLY[:-30], "a.ply")
    with pytest.raises(FileError, match="is damaged: a face names a vertex beyond its 5"):
        read(tmp_path, PLY.replace("3 3 0 4", "3 3 0 5"), "b.ply")
    with pytest.raises(FileError, match="its head has the line 'element face x'"):
        read(tmp_path, PLY.replace("element face 5", "element face x"), "c.ply")


def test_warped_bricks_beside_tets_are_one_body_in_both_ways(tmp_path):
    # A brick with a raised corner, and two tets on its upper face, cut along the lower diagonal.
    random = np.random.default_rng(3)
    corners = np.array(
        [[x, y, z] for z in (0, 10) for x, y in ((0, 0), (10, 0), (10, 10), (0, 10))], float
    )
    corners[6, 2] = 13
    points = np.concatenate([corners, [[5, 5, 20]]])
    for _ in range(10):
        order = random.permutation(9)
        moved = np.empty_like(points)
        moved[order] = points
        # The upper face is cut from its vertex of the smallest number.
        turn = (np.arange(4) + order[4:8].argmin()) % 4 + 4
        halves = [order[[*turn[[0, 1, 2]], 8]], order[[*turn[[0, 2, 3]], 8]]]
        cells = [("hexahedron", order[None, :8]), ("tetra", np.array(halves))]
        meshio.Mesh(moved, cells).write(tmp_path / "a.vtu")
        mesh = read_mesh_file(tmp_path / "a.vtu", unit="m").mesh
        surface = read_surface(tmp_path / "a.vtu")
        assert volume_within(tmp_path / "a.vtu") == pytest.approx(mesh.volume, rel=1e-14)
        assert len(surface.triangles) == len(mesh.triangles) == 14
