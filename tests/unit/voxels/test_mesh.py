"""Meshes of voxels and of given tetrahedra."""

import pickle

import numpy as np
import pytest

from voxsoft.errors import MeshError
from voxsoft.mesh import Mesh
from voxsoft.voxels import Voxels

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], float)


def hollow_voxels():
    cells = np.ones((7, 7, 7), int)
    cells[1:3, 1:3, 1:4] = 0
    cells[4:6, 4:6, 4:6] = 0
    cells[:, :, 3:] *= 2
    return Voxels.from_array(cells, voxel_size=0.1)


def test_two_voxels_share_a_face():
    mesh = Voxels.from_array([[[1, 2]]], voxel_size=0.1).mesh()
    lengths = [len(mesh.vertices), len(mesh.tets), len(mesh.edges), len(mesh.triangles)]
    # 18 + 18 edges less the 5 of the shared face; 12 + 12 triangles less its 2 + 2.
    assert lengths == [12, 10, 31, 20]
    assert mesh.tet_part.tolist() == [1] * 5 + [2] * 5
    assert mesh.tet_voxel.tolist() == [0] * 5 + [1] * 5
    assert mesh.voxel_size == 0.1


def test_arrays_have_their_types_and_are_read_only():
    mesh = hollow_voxels().mesh()
    assert (mesh.vertices.dtype, mesh.tets.dtype) == (np.float64, np.int32)
    assert (mesh.tet_part.dtype, mesh.tet_voxel.dtype) == (np.uint8, np.int32)
    arrays = [mesh.vertices, mesh.tets, mesh.edges, mesh.triangles, mesh.tet_part]
    for array in [*arrays, mesh.cavities[0].triangles]:
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_a_mesh_fills_its_voxels():
    voxels = hollow_voxels()
    mesh = voxels.mesh()
    assert mesh.surface_volume == pytest.approx(voxels.volume, rel=1e-12)
    assert mesh.tet_volumes.sum() == pytest.approx(voxels.volume, rel=1e-12)
    quality = mesh.quality
    assert quality.conforming
    assert quality.watertight
    assert quality.nonmanifold_edges == ()
    assert quality.volume == pytest.approx(voxels.volume, rel=1e-12)
    assert quality.euler_number == 3
    assert quality.smallest_tet == pytest.approx(1e-3 / 6)
    assert quality.largest_tet == pytest.approx(1e-3 / 3)


def test_cavities_follow_those_of_the_voxels():
    voxels = hollow_voxels()
    for surface, cavity in zip(voxels.mesh().cavities, voxels.cavities, strict=True):
        assert surface.volume == cavity.volume
        assert surface.area == cavity.area
        assert len(surface.triangles) * 0.005 == pytest.approx(cavity.area)


def test_a_mesh_survives_pickling_and_stays_read_only():
    mesh = hollow_voxels().mesh()
    copy = pickle.loads(pickle.dumps(mesh))
    assert copy == mesh
    assert not copy.vertices.flags.writeable
    assert copy != hollow_voxels().with_cell((0, 0, 0), 0).mesh()


def test_given_tets_make_the_same_mesh_as_voxels():
    mesh = hollow_voxels().mesh()
    again = Mesh.from_tets(mesh.vertices, mesh.tets, mesh.tet_part)
    assert again.voxel_size is None
    assert again.tet_voxel is None
    assert np.array_equal(again.edges, mesh.edges)
    assert again.quality == mesh.quality
    assert [c.volume for c in again.cavities] == pytest.approx([c.volume for c in mesh.cavities])


def test_negative_tets_are_turned_round():
    mesh = Mesh.from_tets(CORNERS[:4], [[0, 2, 1, 3]])
    assert mesh.tet_volumes == pytest.approx([1 / 6])
    assert sorted(mesh.tets[0].tolist()) == [0, 1, 2, 3]
    assert mesh.surface_volume == pytest.approx(1 / 6)


def test_a_hinge_is_a_nonmanifold_edge():
    mesh = Voxels.from_array([[[1, 0], [0, 1]]], voxel_size=0.1).mesh()
    (edge,) = mesh.quality.nonmanifold_edges
    assert mesh.vertices[list(edge)][:, 1:] == pytest.approx(0.1)


def test_a_mesh_does_not_freeze_the_arrays_it_is_given():
    vertices = CORNERS[:4].copy()
    mesh = Mesh.from_tets(vertices, [[0, 1, 2, 3]])
    vertices[0] = 9.0
    assert mesh.vertices[0].tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("arguments", "match"),
    [
        ((CORNERS, np.zeros((0, 4), int)), "no tetrahedra"),
        ((CORNERS, [[0, 1, 2, 7]]), r"tets\[0\]: .* names vertex 7, but there are 5"),
        ((CORNERS, [[0, 1, 2, -1]]), "names vertex -1"),
        ((CORNERS, [[0, 1, 2, 3], [0, 1, 2, 2]]), r"tets\[1\]: .* flat"),
        ((CORNERS, [[0, 1, 2, 3], [0, 1, 2, 4]]), "overlap"),
        ((CORNERS, [[0.0, 1.0, 2.0, 3.0]]), "holds float64"),
        ((CORNERS, [[0, 1, 2]]), r"shape \(1, 3\); expected \(n, 4\)"),
        ((CORNERS, [[0, 1, 2, 2**33]]), "32 bits"),
        ((CORNERS[:, :2], [[0, 1, 2, 3]]), "vertices: has shape"),
        ((np.full((4, 3), np.nan), [[0, 1, 2, 3]]), r"vertices\[0\]: .* not finite"),
        ((CORNERS, [[0, 1, 2, 3]], [1, 1]), "2 part ids were given for 1"),
        ((CORNERS, [[0, 1, 2, 3]], [0]), "numbered 1 to 255"),
        ((CORNERS, [[0, 1, 2, 3]], [[1]]), "tet_part: has shape"),
        ((CORNERS, [[0, 1, 2, 3]]), "vertices: 1 belong to no tet, the first is 4"),
    ],
)
def test_bad_tets_are_named(arguments, match):
    with pytest.raises(MeshError, match=match):
        Mesh.from_tets(*arguments)
