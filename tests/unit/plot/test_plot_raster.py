"""The depth buffer: things in front are seen, and light and colors follow the surface."""

import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter

from voxsoft.plot.boundary import beyond, boundary_of
from voxsoft.plot.camera import Camera
from voxsoft.plot.raster import rasterize
from voxsoft.plot.shading import _blurred, depth_contrast, lit, normals_of
from voxsoft.voxels import Voxels

# Two squares of two triangles each, one in front of the other, rows downwards.
SQUARE = np.array([[1.0, 1], [1, 9], [9, 9], [9, 1]])
QUADS = np.array([[0, 1, 2], [0, 2, 3]])


def two_squares(near, far):
    points = np.vstack([np.column_stack([SQUARE, np.full(4, d)]) for d in (near, far)])
    return points, np.vstack([QUADS, QUADS + 4])


@given(st.permutations(range(4)))
def test_the_nearer_square_is_seen_whatever_the_order(order):
    points, triangles = two_squares(1.0, 2.0)
    seen = rasterize(points, triangles[list(order)], 10, 10)
    assert np.isin(np.array(order)[seen.triangle], (0, 1)).all()
    assert len(seen.pixels) == 64, "a square of 8 by 8 pixels"
    np.testing.assert_allclose(seen.depth, 1.0)


def test_triangles_that_face_away_are_left_out():
    points, triangles = two_squares(1.0, 2.0)
    turned = np.vstack([triangles[:2, ::-1], triangles[2:]])
    np.testing.assert_allclose(rasterize(points, turned, 10, 10).depth, 2.0)


def test_values_are_interpolated_to_the_centers_of_pixels():
    points, triangles = two_squares(1.0, 2.0)
    seen = rasterize(points, triangles, 10, 10)
    columns = seen.interpolate(points[triangles][:, :, 0])
    np.testing.assert_allclose(columns, seen.pixels % 10 + 0.5)
    picture = seen.spread(columns, -1.0)
    assert picture.shape == (10, 10)
    assert picture[0, 0] == -1.0


def test_edges_along_rows_and_beyond_the_picture_are_drawn():
    """Along a row a weight may not change at all: such an edge bounds no span."""
    points = np.array([[0.5, -20.0, 1], [0.5, 30, 1], [9.5, 30, 1], [9.5, -20, 1]])
    with np.errstate(all="raise"), warnings.catch_warnings():
        warnings.simplefilter("error")
        seen = rasterize(points, QUADS, 10, 10)
        sliver = np.array([[2.0, 2.6, 1], [2.0, 2.9, 1], [8.0, 2.9, 1]])
        nothing = rasterize(sliver, np.array([[0, 1, 2]]), 10, 10)
        level = np.array([[1.0, 1, 1], [1, 9, 1], [9, 9, 1]])
        half = rasterize(level, np.array([[0, 1, 2]]), 10, 10)
    assert len(seen.pixels) == 100
    assert len(nothing.pixels) == 0
    assert len(half.pixels) == 36, "a half of 8 by 8 pixels, with its diagonal"


def test_many_triangles_are_cut_into_portions(monkeypatch):
    points, triangles = two_squares(1.0, 2.0)
    whole = rasterize(points, triangles, 10, 10)
    monkeypatch.setattr("voxsoft.plot.raster._PORTION", 7)
    cut = rasterize(points, triangles, 10, 10)
    np.testing.assert_array_equal(cut.triangle, whole.triangle)


def test_a_ball_covers_the_area_of_its_shadow():
    voxels = Voxels.empty((40, 40, 40), voxel_size=0.001).fill_sphere((0.02, 0.02, 0.02), 0.018)
    mesh = voxels.mesh()
    camera = Camera.around(mesh.vertices, (0.0, 0.0), 400)
    surface = boundary_of(mesh, np.ones(len(mesh.tets), dtype=bool))
    seen = rasterize(camera.project(mesh.vertices), surface.triangles, camera.width, camera.height)
    shadow = voxels.array.any(axis=0).sum() * 0.001**2
    assert len(seen.pixels) * camera.pixel**2 == pytest.approx(shadow, rel=0.01)


def test_light_comes_from_above():
    camera = Camera.around(np.eye(3), (-60.0, 25.0), 100)
    up, down = lit(np.array([[0.0, 0, 1], [0, 0, -1]]), camera)
    assert up > down


def test_a_pit_is_darker_than_its_rim():
    square = np.array([[0.0, 0], [0, 100], [100, 100], [100, 0]])
    points = np.vstack(
        [
            np.column_stack([square, np.full(4, 1.0)]) * [0.5, 1, 1],
            np.column_stack([square, np.full(4, 20.0)]),
        ]
    )
    seen = rasterize(points, np.vstack([QUADS, QUADS + 4]), 100, 100)
    brightness = seen.spread(depth_contrast(seen), 0.0)
    assert brightness[50, 51] < 0.9 < brightness[50, 90]
    assert brightness[50, 20] == 1.0


def test_a_triangle_without_area_has_no_normal():
    flat = np.zeros((1, 3, 3))
    assert normals_of(flat).tolist() == [[0.0, 0.0, 0.0]]


def test_the_boundary_is_that_of_the_mesh_and_knows_its_cavity():
    solid = np.ones((5, 5, 5), dtype=np.uint8)
    solid[2, 2, 2] = 0
    mesh = Voxels.from_array(solid, voxel_size=0.005).mesh()
    surface = boundary_of(mesh, np.ones(len(mesh.tets), dtype=bool))
    assert len(surface.triangles) == len(mesh.triangles)
    assert np.count_nonzero(surface.cavity == 0) == len(mesh.cavities[0].triangles)
    a, b, c = mesh.vertices[surface.triangles].transpose(1, 0, 2)
    enclosed = np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0
    assert enclosed == pytest.approx(mesh.quality.volume), "all triangles point outward"


@pytest.mark.parametrize("side", [-1, 1])
def test_a_cut_keeps_whole_voxels(side):
    mesh = Voxels.from_array(np.ones((4, 2, 2), dtype=np.uint8), voxel_size=0.005).mesh()
    kept = beyond(mesh, "x", 0.0099, side)
    voxels = np.unique(mesh.tet_voxel[kept])
    assert np.count_nonzero(kept) == 5 * len(voxels)
    # A plane just before the face between the second and third voxel cuts neither.
    assert len(voxels) == 8


@pytest.mark.parametrize(("shape", "spread"), [((90, 120), 2.9), ((30, 40), 20.0), ((7, 5), 3.0)])
def test_a_blurred_image_is_that_of_scipy(shape, spread):
    # Spreads beyond the image are mirrored at its border again and again.
    image = np.random.default_rng(0).random(shape)
    assert np.abs(_blurred(image, spread) - gaussian_filter(image, spread)).max() < 1e-12
