"""Surfaces with names as STL, OBJ, 3MF and GLB, read back by trimesh and, for 3MF, by lib3mf."""

import re
import zipfile

import numpy as np
import pytest
import trimesh

from voxsoft.errors import FileError, UnitError
from voxsoft.files import write_mesh, write_surfaces
from voxsoft.formats.read import read_contents
from voxsoft.voxels import Voxels

#: Factor from m to the numbers of a file.
FACTORS = {".stl": 1e3, ".obj": 1e3, ".glb": 1.0}


def box(low, high):
    made = trimesh.creation.box(bounds=(low, high))
    return np.array(made.vertices), np.array(made.faces)


#: Two boxes of 8 mL and 4 mL that share a face.
PARTS = {
    "soft skin": box((0, 0, 0), (0.02, 0.02, 0.02)),
    "core": box((0.02, 0, 0), (0.03, 0.02, 0.02)),
}


def named_volumes(path, factor):
    # trimesh joins the objects of an OBJ unless it is asked to split them by their groups.
    options = {"split_groups": True} if path.suffix == ".obj" else {}
    scene = trimesh.load_scene(path, **options)
    return {
        re.sub(r"[ _]+", " ", name): abs(body.volume) / factor**3 * 1e6
        for name, body in scene.geometry.items()
        if body.is_watertight and body.is_winding_consistent and body.volume > 0
    }


@pytest.mark.parametrize("suffix", list(FACTORS))
def test_each_surface_is_closed_under_its_name(tmp_path, suffix):
    path = tmp_path / f"two{suffix}"
    write_surfaces(path, PARTS)
    found = named_volumes(path, FACTORS[suffix])
    assert found == {"soft skin": pytest.approx(8.0), "core": pytest.approx(4.0)}


@pytest.mark.parametrize("suffix", [".stl", ".obj"])
def test_a_unit_of_choice_divides_the_numbers(tmp_path, suffix):
    path = tmp_path / f"one{suffix}"
    write_surfaces(path, {"core": PARTS["core"]}, unit="inch")
    assert trimesh.load(path).extents == pytest.approx([10 / 25.4, 20 / 25.4, 20 / 25.4])


def test_one_surface_is_a_binary_stl(tmp_path):
    path = tmp_path / "one.stl"
    write_surfaces(path, {"core": PARTS["core"]})
    assert path.stat().st_size == 84 + 12 * 50


def test_glb_stands_upright_where_y_is_up(tmp_path):
    path = tmp_path / "tall.glb"
    write_surfaces(path, {"tall": box((0, 0, 0), (0.01, 0.02, 0.05))})
    assert trimesh.load_scene(path).bounds.tolist() == [
        pytest.approx([0.0, 0.0, -0.02], abs=1e-8),
        pytest.approx([0.01, 0.05, 0.0], abs=1e-8),
    ]


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".3mf", ".glb"])
def test_a_written_file_is_read_at_the_same_places(tmp_path, suffix):
    path = tmp_path / f"two{suffix}"
    write_surfaces(path, PARTS)
    found = read_contents(path)
    points = found.points * (found.unit or 1e-3)
    assert found.unit == {".3mf": 1e-3, ".glb": 1.0}.get(suffix)
    assert points.min(axis=0) == pytest.approx([0, 0, 0], abs=1e-9)
    assert points.max(axis=0) == pytest.approx([0.03, 0.02, 0.02], rel=1e-6)
    assert {name.replace("_", " "): len(v) for name, v in found.cell_sets.items()} == {
        "soft skin": 12,
        "core": 12,
    }


def test_3mf_is_in_mm_with_its_parts_as_components_of_one_item(tmp_path):
    path = tmp_path / "two.3mf"
    write_surfaces(path, PARTS)
    with zipfile.ZipFile(path) as archive:
        model = archive.read("3D/3dmodel.model").decode()
    assert 'unit="millimeter"' in model
    assert re.findall(r'name="([^"]*)"', model)[-2:] == ["soft skin", "core"]
    assert re.findall(r'<component objectid="(\d)"', model) == ["1", "2"]
    assert re.findall(r'<item objectid="(\d)"', model) == ["3"]


def test_lib3mf_reads_a_3mf_without_a_warning(tmp_path, lib3mf):
    write_surfaces(tmp_path / "two.3mf", PARTS)
    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(tmp_path / "two.3mf"))
    assert reader.GetWarningCount() == 0
    objects = model.GetMeshObjects()
    names = []
    while objects.MoveNext():
        body = objects.GetCurrentMeshObject()
        names.append((body.GetName(), body.IsManifoldAndOriented(), body.GetTriangleCount()))
    assert names == [("soft skin", True, 12), ("core", True, 12)]


def test_two_writes_give_the_same_bytes(tmp_path):
    for name in ("a.3mf", "b.3mf"):
        write_surfaces(tmp_path / name, PARTS)
    assert (tmp_path / "a.3mf").read_bytes() == (tmp_path / "b.3mf").read_bytes()


def test_a_name_of_any_text_stays_valid(tmp_path):
    name = 'a <"b"> & \x07ü'
    write_surfaces(tmp_path / "a.3mf", {name: PARTS["core"]})
    with zipfile.ZipFile(tmp_path / "a.3mf") as archive:
        model = archive.read("3D/3dmodel.model").decode()
    assert "name='a &lt;\"b\"&gt; &amp; ü'" in model


def test_vertices_that_become_one_in_32_bits_are_joined(tmp_path):
    vertices, triangles = box((0, 0, 0), (0.01, 0.01, 0.01))
    near = np.vstack([vertices, vertices[:1] + 1e-12])
    # The first triangle goes to a copy of its corner, and a sliver closes the gap.
    faces = triangles.copy()
    row, column = np.argwhere(faces == 0)[0]
    _, b, c = np.roll(faces[row], -column)
    faces[row] = (8, b, c)
    slivers = [(0, b, 8), (0, 8, c)]
    write_surfaces(tmp_path / "a.stl", {"a": (near, np.vstack([faces, slivers]))})
    assert trimesh.load(tmp_path / "a.stl").is_watertight


def test_a_mesh_writes_the_faces_of_each_part(tmp_path):
    mesh = Voxels.from_array([[[1, 1, 2]]], voxel_size=0.01).mesh()
    write_mesh(tmp_path / "two.obj", mesh)
    found = named_volumes(tmp_path / "two.obj", 1.0)
    assert found == {"part-1": pytest.approx(2.0), "part-2": pytest.approx(1.0)}
    write_mesh(tmp_path / "two.3mf", mesh)
    with zipfile.ZipFile(tmp_path / "two.3mf") as archive:
        assert 'x="10"' in archive.read("3D/3dmodel.model").decode()


@pytest.mark.parametrize(
    ("surfaces", "unit", "name", "match"),
    [
        ({}, None, "a.stl", "no surface"),
        (PARTS, None, "a.vtu", "no format of surfaces"),
        (PARTS, "cm", "a.3mf", "is in mm, and says so"),
        (PARTS, "mm", "a.glb", "is always in m"),
        ({"a": ([[0, 0, 0]], [[0, 0, 1]])}, None, "a.stl", "names vertex 1; there are 1"),
        ({"a": ([[0, 0, np.nan]] * 3, [[0, 1, 2]])}, None, "a.stl", "not finite"),
        ({"a": ([[0, 0, 0]] * 3, [[0, 1, 2]])}, None, "a.stl", "has no area"),
        ({"a": ([[0, 0]] * 3, [[0, 1, 2]])}, None, "a.stl", r"vertices \(3, 2\)"),
        ({"a": ([[0, 0, 0]] * 3, [[0.5, 1, 2]])}, None, "a.stl", "whole numbers"),
    ],
)
def test_invalid_surfaces_are_named(tmp_path, surfaces, unit, name, match):
    with pytest.raises(FileError, match=match):
        write_surfaces(tmp_path / name, surfaces, unit)


def test_an_angle_is_no_unit_of_surfaces(tmp_path):
    with pytest.raises(UnitError):
        write_surfaces(tmp_path / "a.stl", PARTS, unit="deg")
