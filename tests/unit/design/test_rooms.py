"""Rooms of cut voxels: the determinant of the mean gradient as volumes of tetrahedra."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft import _core
from voxsoft.design.discretization.cut_cells import WHOLE, measures_of
from voxsoft.design.discretization.cut_voxels import CutVoxels
from voxsoft.design.discretization.rooms import ROOM_TETS, room_parts
from voxsoft.geometry import tet_volumes

CORNERS = np.array([[c >> 2 & 1, c >> 1 & 1, c & 1] for c in range(8)], dtype=float)
# Means within the voxel, and beyond it where a neighbor's material lies.
MEANS = np.array([[0.2, -0.5, 0.1, -0.05, 0.0, -0.2], [1.4, 0.3, -0.9, -0.3, -1.2, 0.4]])
PARTS = np.array([0.4, -0.15])


def mean_gradient(means, positions):
    """F of the trilinear motion of a unit cube, by its modes."""
    x, y, z = (2 * CORNERS - 1).T
    modes = [
        np.einsum("c,ci->i", sign, positions) / 4
        for sign in (x, y, z, y * z, z * x, x * y, x * y * z)
    ]
    f, w, last = modes[:3], modes[3:6], modes[6]
    columns = []
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        columns.append(f[i] + w[j] * means[k] + w[k] * means[j] + last * means[3 + i])
    return np.column_stack(columns)


def test_the_tetrahedra_sum_up_to_the_determinant_of_the_mean_gradient():
    positions = CORNERS + 0.3 * np.random.default_rng(3).standard_normal(CORNERS.shape)
    factors = room_parts(PARTS, MEANS)
    volumes = tet_volumes(positions, ROOM_TETS.astype(np.int32))
    for part, means, row in zip(PARTS, MEANS, factors, strict=True):
        expected = part * np.linalg.det(mean_gradient(means, positions))
        assert row @ volumes == pytest.approx(expected, rel=1e-12)  # rounding of 35 terms


def test_products_of_coordinates_over_a_cut_cell():
    # Below x + y = 1 of a unit cell, in halves of an edge from its center: the lower triangle.
    half = vs.HalfSpace(point=(0.5, 0.5, 0), normal=(1, 1, 0))
    box = vs.Box(size=(8, 8, 8), corner=(-4, -4, -4))
    design = vs.Design(
        name="half", voxel_size=1.0, parts=[{"shape": half & box, "material": "ecoflex-00-30"}]
    )
    cell, none = np.zeros((1, 3), dtype=np.intp), np.full((1, 3, 2), -1)
    (found,), _ = measures_of(design, cell, 1.0, (0, 0, 0), none, np.array([True]))
    # Over the triangle ξ + η < 0 of area 2 of 4: means -1/3, <ξ²> = 1/3, <ξη> = 0.
    expected = [0.5, -1 / 6, -1 / 6, 0, 1 / 6, 1 / 6, 1 / 6, 0, 0, 0]
    # Halves across a diagonal have a center 6 % off, in each of the four small cubes that are cut.
    assert found == pytest.approx(np.array(expected), abs=2e-3)


def test_room_and_material_make_a_whole_cell():
    filled = np.random.default_rng(5).uniform(size=(3, 64))
    normals = np.random.default_rng(6).standard_normal((3, 64, 3))
    both = _core.material_integrals(filled, normals)
    both += _core.material_integrals(1.0 - filled, -normals)
    # Volume and center are exact; the second moments of the two halves are an approximation.
    assert both[:, :4] == pytest.approx(np.tile(WHOLE[:4], (3, 1)), abs=1e-12)
    assert np.abs(both[:, 4:] - WHOLE[4:]).max() < 0.02


def test_a_uniform_motion_grows_a_cut_chamber_by_its_determinant():
    ball = vs.Sphere(radius=2.7) - vs.Sphere(radius=1.6)
    design = vs.Design(
        name="ball",
        voxel_size=1.0,
        fill="fraction",
        parts=[{"shape": ball, "material": "ecoflex-00-30"}],
    )
    mesh = CutVoxels.of(design).mesh()
    motion = np.eye(3) + 0.4 * np.random.default_rng(9).standard_normal((3, 3))
    grown = mesh.cavities[0].volume_at(mesh.vertices @ motion.T)
    assert grown == pytest.approx(np.linalg.det(motion) * mesh.cavities[0].volume, rel=1e-12)
