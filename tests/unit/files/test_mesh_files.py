"""Mesh files: every format keeps all that it can hold, and bad files are named."""

import errno

import meshio
import numpy as np
import pytest
from forms import NAMES

from voxsoft.errors import FileError
from voxsoft.files.meshes import read_mesh, read_mesh_file, write_mesh
from voxsoft.mesh import Mesh
from voxsoft.voxels import Voxels


def two_chambers():
    cells = np.ones((7, 7, 7), int)
    cells[3:] = 2
    cells[1:3, 1:3, 1:4] = 0
    cells[4:6, 4:6, 4:6] = 0
    return Voxels.from_array(cells, voxel_size=0.005).mesh()


REGIONS = {"base": np.array([0, 1, 2, 8]), "tip-2": np.array([100, 7])}


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".inp"])
def test_regions_of_any_name_are_kept(tmp_path, suffix):
    names = [*NAMES, "part-1", "CAVITY-1", "All-Nodes", "Plain", "tip_left", "tip_left-2"]
    regions = {name: [number] for number, name in enumerate(names)}
    mesh, path = two_chambers(), tmp_path / f"mesh{suffix}"
    write_mesh(path, mesh, regions=regions)
    read = read_mesh_file(path)
    assert {name: found.tolist() for name, found in read.regions.items()} == regions
    assert len(read.mesh.cavities) == 2
    assert set(read.mesh.tet_part.tolist()) == {1, 2}
    if suffix != ".vtu":
        assert path.read_bytes().isascii()


def faces(triangles):
    return {tuple(sorted(triangle)) for triangle in triangles.tolist()}


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".inp"])
def test_parts_regions_and_cavities_are_kept(tmp_path, suffix):
    mesh, path = two_chambers(), tmp_path / f"mesh{suffix}"
    write_mesh(path, mesh, regions=REGIONS)
    read = read_mesh_file(path)
    assert np.array_equal(read.mesh.vertices, mesh.vertices)
    # Voxels are in C order, so grouping by part does not change the order of these tets.
    assert np.array_equal(read.mesh.tets, mesh.tets)
    assert np.array_equal(read.mesh.tet_part, mesh.tet_part)
    assert {name: v.tolist() for name, v in read.regions.items()} == {
        "base": [0, 1, 2, 8],
        "tip-2": [7, 100],
    }
    assert len(read.mesh.cavities) == 2
    for found, expected in zip(read.mesh.cavities, mesh.cavities, strict=True):
        assert faces(found.triangles) == faces(expected.triangles)
        assert found.volume == pytest.approx(expected.volume)
        assert found.area == pytest.approx(expected.area)


def test_the_cavities_of_a_file_keep_their_order(tmp_path):
    # Not largest first: the loads of a file refer to its numbers.
    mesh = two_chambers()
    swapped = Mesh(
        *(getattr(mesh, name) for name in ("vertices", "tets", "edges", "triangles")),
        *(mesh.tet_part, mesh.tet_voxel, mesh.voxel_size, mesh.cavities[::-1]),
    )
    for suffix in (".vtu", ".msh", ".inp"):
        write_mesh(tmp_path / f"mesh{suffix}", swapped)
        volumes = [c.volume for c in read_mesh(tmp_path / f"mesh{suffix}").cavities]
        assert volumes == pytest.approx([c.volume for c in swapped.cavities])


def test_vtu_keeps_voxels_and_data(tmp_path):
    mesh, path = two_chambers(), tmp_path / "mesh.vtu"
    displacement = np.arange(mesh.vertices.size, dtype=float).reshape(-1, 3)
    stretch = np.linspace(1, 2, len(mesh.tets))
    write_mesh(
        path, mesh, point_data={"displacement": displacement}, cell_data={"stretch": stretch}
    )
    read = read_mesh_file(path)
    assert np.array_equal(read.mesh.tet_voxel, mesh.tet_voxel)
    assert read.mesh.voxel_size == mesh.voxel_size
    assert np.array_equal(read.point_data["displacement"], displacement)
    assert np.array_equal(read.cell_data["stretch"], stretch)
    assert set(read.cell_data) == {"stretch"}


def two_chambers_between(mesh):
    """Count the triangles between tetrahedra of two parts."""
    corners = mesh.tets[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]].reshape(-1, 3)
    _, index = np.unique(np.sort(corners, axis=1), axis=0, return_inverse=True)
    part = np.repeat(mesh.tet_part, 4)
    pairs = np.unique(np.column_stack([index.ravel(), part]), axis=0)[:, 0]
    return int((np.bincount(pairs) == 2).sum())


@pytest.mark.parametrize("suffix", [".stl", ".obj"])
def test_surfaces_are_written_closed(tmp_path, suffix):
    mesh, path = two_chambers(), tmp_path / f"mesh{suffix}"
    write_mesh(path, mesh)
    surface = meshio.read(path)
    triangles = np.concatenate([b.data for b in surface.cells if b.type == "triangle"])
    faces_between = (len(triangles) - len(mesh.triangles)) / 2
    assert faces_between == two_chambers_between(mesh)
    a, b, c = (surface.points[triangles[:, corner]].astype(float) for corner in range(3))
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    assert volume == pytest.approx(mesh.surface_volume, rel=1e-5)
    with pytest.raises(FileError, match="holds a surface, not tetrahedra"):
        read_mesh(path)


def test_abaqus_surfaces_point_at_the_faces_of_the_cavity(tmp_path):
    mesh, path = two_chambers(), tmp_path / "mesh.inp"
    write_mesh(path, mesh)
    lines = path.read_text().splitlines()
    start = lines.index("*SURFACE, NAME=CAVITY-1, TYPE=ELEMENT")
    assert lines[start + 1].startswith("CAVITY-1-S")
    again = read_mesh(path)
    points = again.vertices[again.cavities[0].triangles]
    normals = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    center = points.mean(axis=(0, 1))
    # Out of the material is into the chamber.
    assert (np.einsum("ij,ij->i", normals, center - points.mean(axis=1)) > 0).all()


def test_files_of_other_programs_are_read(tmp_path):
    mesh = two_chambers()
    surface = mesh.triangles[:10]
    data = meshio.Mesh(
        mesh.vertices,
        [("triangle", surface), ("tetra", mesh.tets)],
        cell_data={
            "gmsh:physical": [np.full(10, 7), np.full(len(mesh.tets), 1000)],
            "gmsh:geometrical": [np.full(10, 7), np.full(len(mesh.tets), 1000)],
        },
        field_data={"inlet": np.array([7, 2]), "rubber": np.array([1000, 3])},
    )
    meshio.write(tmp_path / "other.msh", data, file_format="gmsh22", binary=False)
    read = read_mesh_file(tmp_path / "other.msh", unit="m")
    assert read.mesh.tet_part.tolist() == [1] * len(mesh.tets)
    assert read.regions["inlet"].tolist() == np.unique(surface).tolist()
    assert [c.volume for c in read.mesh.cavities] == pytest.approx(
        [c.volume for c in mesh.cavities]
    )


@pytest.mark.parametrize("suffix", [".mesh", ".vtk", ".vol", ".avs", ".su2"])
def test_tetrahedra_of_every_format_of_meshio_are_taken(tmp_path, suffix):
    mesh, path = two_chambers(), tmp_path / f"other{suffix}"
    meshio.write(path, meshio.Mesh(mesh.vertices, [("tetra", mesh.tets)]))
    read = read_mesh(path, unit="m")
    assert np.array_equal(read.tets, mesh.tets)
    np.testing.assert_allclose(read.vertices, mesh.vertices, rtol=1e-12)
    assert len(read.cavities) == 2


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".inp"])
@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 0.999])
def test_truncated_files_are_named(tmp_path, suffix, share, capsys):
    mesh, path = two_chambers(), tmp_path / f"mesh{suffix}"
    write_mesh(path, mesh, regions=REGIONS)
    content = path.read_bytes()
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(FileError, match=rf"mesh{suffix}: "):
        read_mesh(path)
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".inp"])
def test_noise_is_not_a_mesh(tmp_path, suffix):
    path = tmp_path / f"noise{suffix}"
    path.write_bytes(np.random.default_rng(0).bytes(1000))
    with pytest.raises(FileError, match="noise"):
        read_mesh(path)


def test_a_mesh_without_tets_is_refused(tmp_path):
    path = tmp_path / "surface.vtu"
    meshio.Mesh(np.eye(3), [("triangle", [[0, 1, 2]])]).write(path)
    with pytest.raises(FileError, match="holds no volume cells, but 1 triangle"):
        read_mesh(path)


def test_flat_tets_of_a_file_are_named_with_the_file(tmp_path):
    path = tmp_path / "flat.vtu"
    meshio.Mesh(np.zeros((4, 3)), [("tetra", [[0, 1, 2, 3]])]).write(path)
    with pytest.raises(FileError, match=r"flat.vtu: tets\[0\]: .* is flat"):
        read_mesh(path, unit="m")


@pytest.mark.parametrize(
    ("name", "arguments", "match"),
    [
        ("mesh.xyz", {}, "unknown format '.xyz'; allowed are .vtu"),
        ("mesh.stl", {"regions": REGIONS}, ".stl cannot hold regions"),
        (
            "mesh.msh",
            {"point_data": {"t": np.zeros(len(two_chambers().vertices))}},
            ".msh cannot hold data",
        ),
        ("mesh.vtu", {"point_data": {"t": np.zeros(3)}}, r"point_data\['t'\] has shape \(3,\)"),
        ("mesh.vtu", {"cell_data": {"t": ["a"]}}, "cell_data"),
        ("mesh.vtu", {"regions": {"a\0b": [0]}}, "holds a control character"),
        ("mesh.vtu", {"regions": {"far": [10**6]}}, "must hold vertex indices from 0 to"),
        ("mesh.vtu", {"regions": {"none": []}}, "region 'none' has no vertex"),
        ("missing/mesh.vtu", {}, "cannot be written: No such file"),
    ],
)
def test_values_that_cannot_be_written_are_named(tmp_path, name, arguments, match):
    with pytest.raises(FileError, match=match):
        write_mesh(tmp_path / name, two_chambers(), **arguments)
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_leaves_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "mesh.vtu"
    write_mesh(path, two_chambers())
    before = path.read_bytes()

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("meshio.vtu.write", full)
    with pytest.raises(FileError, match="No space left on device"):
        write_mesh(path, two_chambers())
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_an_abaqus_file_cut_between_two_lines_is_named(tmp_path):
    path = tmp_path / "mesh.inp"
    write_mesh(path, two_chambers())
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(lines[: len(lines) // 2]))
    with pytest.raises(FileError, match="is cut short"):
        read_mesh(path)
