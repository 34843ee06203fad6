"""Surface in cut voxels: its frame and areas, and the material moved inward where it is oblique."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

import voxsoft as vs
from voxsoft import _core
from voxsoft.design.discretization.cut_surfaces import obliquity, surfaces
from voxsoft.design.discretization.cut_voxels import LEAST_FILLED, CutVoxels
from voxsoft.shapes import HalfSpace
from voxsoft.units import mm

NORMALS = [v / np.linalg.norm(v) for v in np.random.default_rng(3).normal(size=(20, 3))]
RUBBER = {"model": "neo-hookean", "young": "100 kPa", "poisson": 0.45}


def sums_of(*walls):
    """Sums of a unit cell below all given planes, each with a point and a normal."""
    shape = None
    for point, normal in walls:
        wall = HalfSpace(point=tuple(point), normal=tuple(normal))
        shape = wall if shape is None else shape & wall
    none = np.full((1, 3, 2), -1, dtype=np.int32)
    corners, gives = np.zeros((1, 3)), np.array([False])
    return _core.cut_measures([shape.build()], corners, 1.0, none, none, gives)[1]


def frame_of(found):
    return Rotation.from_rotvec(found[:3]).as_matrix(), found[3:].reshape(3, 2)


@pytest.mark.parametrize("normal", NORMALS)
def test_an_axis_of_the_frame_is_the_normal_of_a_plane(normal):
    (found,) = surfaces(sums_of(((0.5, 0.5, 0.5), normal)))
    frame, areas = frame_of(found)
    axis, side = np.unravel_index(areas.argmax(), areas.shape)
    out = frame[:, axis] * (1 if side else -1)
    # A small cube takes slopes of the exact plane: only rounding, and the sweeps, are between.
    assert out @ normal > 0.9999
    # One to three faces of a cell, by the way it lies; none across the plane.
    assert 0.9 < areas[axis, side] < 1.8
    assert areas.sum() - areas[axis, side] < 0.03


@pytest.mark.parametrize("turn", [0.0, 17.0, 45.0])
@pytest.mark.parametrize("tilt", [0.0, 33.0])
def test_a_right_angled_edge_gives_both_normals(turn, tilt):
    both = Rotation.from_euler("zx", [turn, tilt], degrees=True).as_matrix()
    middle = np.full(3, 0.53)
    (found,) = surfaces(sums_of((middle, both[:, 0]), (middle, both[:, 1])))
    frame, areas = frame_of(found)
    for normal in both[:, :2].T:
        along = frame.T @ normal
        axis = np.abs(along).argmax()
        # A small cube with the edge in it has one of the two normals.
        assert abs(along[axis]) > 0.998
        assert areas[axis, int(along[axis] > 0)] > 0.3


def test_a_surface_between_small_cubes_counts():
    for height in (0.25, 0.5, 0.5001):
        (found,) = surfaces(sums_of(((0, 0, height), (0, 0, 1))))
        assert_allclose(found, [0, 0, 0, 0, 0, 0, 0, 0, 1], atol=1e-3)


@pytest.mark.parametrize("angle", [0.0, 10.0, 22.5, 45.0])
def test_obliquity_is_the_square_of_twice_the_sine(angle):
    cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    (found,) = obliquity(sums_of(((0.5, 0.5, 0.5), (cos, sin, 0))))
    square = np.sin(2 * np.radians(angle)) ** 2
    # Cubes that are cut by a little have their facet shared with the next.
    assert_allclose(found, [square, square, 0], atol=3e-3)


def block(turn):
    shape = vs.Box(size=(21.3 * mm, 9.7 * mm, 12.2 * mm), center=(2 * mm, 1 * mm, 0)).rotate(
        turn, axis="z"
    )
    return vs.Design(
        name="block",
        voxel_size=2 * mm,
        fill="fraction",
        parts=[{"shape": shape, "material": RUBBER}],
        clamps=[{"region": {"z": ("-inf", -6 * mm)}}],
    )


@pytest.mark.parametrize("turn", [0.0, 0.3, 0.785])
def test_material_keeps_its_mass_and_center(turn):
    cut = CutVoxels.of(block(turn))
    size = cut.voxels.voxel_size
    filled = np.argwhere(cut.voxels.array > 0)
    places = np.asarray(cut.voxels.origin) + (filled + 0.5 + cut.moments[:, :3] / 2) * size
    volume = cut.fractions.sum() * size**3
    # Small cubes with a corner of the box in them are met by one plane.
    assert volume == pytest.approx(21.3 * 9.7 * 12.2 * mm**3, rel=5e-3)
    center = (cut.fractions[:, None] * places).sum(axis=0) / cut.fractions.sum()
    exact = Rotation.from_rotvec([0, 0, turn]).apply([2 * mm, 1 * mm, 0])
    assert np.abs(center - exact).max() < 0.05 * mm


def test_an_oblique_wall_gives_to_the_voxels_behind_it_and_keeps_the_least():
    straight, turned = CutVoxels.of(block(0.0)), CutVoxels.of(block(0.6))
    assert straight.fractions.max() < 1.0 + LEAST_FILLED
    assert turned.fractions.max() > 1.1
    assert turned.fractions.min() > LEAST_FILLED / 2 - 1e-12


def test_surfaces_change_little_as_a_wall_passes_through_a_voxel():
    areas = []
    for height in np.linspace(0.2, 0.8, 61):
        (found,) = surfaces(sums_of(((0, 0, height), (0.1, 0.2, 1))))
        areas.append(found[3:].max())
    assert np.abs(np.diff(areas)).max() < 0.12


def test_a_box_on_the_grid_has_the_frame_of_its_voxels():
    shape = vs.Box(size=(12 * mm, 8 * mm, 10 * mm), corner=(0, 0, 0)) - vs.Box(
        size=(4 * mm, 4 * mm, 6 * mm), corner=(4 * mm, 2 * mm, 2 * mm)
    )
    design = block(0.0).replace(parts=[{"shape": shape, "material": RUBBER}])
    cut = CutVoxels.of(design)
    # A small cube with a corner in it is met by one plane.
    assert cut.fractions.min() > 1.0 - 1.0 / 3000.0
    # Rounding would turn some by 1e-29.
    assert (cut.surfaces[:, :3] == 0.0).all()
    assert cut.surfaces[:, 3:].max() == pytest.approx(1.0)
