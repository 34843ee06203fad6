"""Every primitive against its definition in NumPy, and its volume against the closed form."""

import math

import numpy as np
import pytest

from voxsoft.shapes import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    Prism,
    Revolve,
    RoundedBox,
    Sphere,
    Torus,
    Tube,
    voxelize,
)

POINTS = np.random.default_rng(7).uniform(-0.03, 0.03, (20_000, 3))
RHO = np.hypot(POINTS[:, 0], POINTS[:, 1])
X, Y, Z = POINTS.T
RADIUS = np.linalg.norm(POINTS, axis=1)
L_SHAPE = [(0, 0), (0.02, 0), (0.02, 0.01), (0.01, 0.01), (0.01, 0.02), (0, 0.02)]


def in_l_shape():
    return (X > 0) & (Y > 0) & (((X < 0.02) & (Y < 0.01)) | ((X < 0.01) & (Y < 0.02)))


MEMBERS = {
    "box": (
        Box(size=(0.02, 0.01, 0.03), center=(0.001, 0, 0)),
        (abs(X - 0.001) < 0.01) & (abs(Y) < 0.005) & (abs(Z) < 0.015),
    ),
    "rounded box": (
        RoundedBox(size=(0.02, 0.02, 0.02), center=(0, 0, 0), radius=0.01),
        RADIUS < 0.01,
    ),
    "sphere": (Sphere(radius=0.02), RADIUS < 0.02),
    "ellipsoid": (
        Ellipsoid(radii=(0.02, 0.01, 0.005)),
        (X / 0.02) ** 2 + (Y / 0.01) ** 2 + (Z / 0.005) ** 2 < 1,
    ),
    "cylinder": (
        Cylinder(radius=0.01, height=0.02, base=(0, 0, -0.005)),
        (RHO < 0.01) & (Z > -0.005) & (Z < 0.015),
    ),
    "cylinder along y": (
        Cylinder(radius=0.01, height=0.02, axis="y"),
        (np.hypot(X, Z) < 0.01) & (Y > 0) & (Y < 0.02),
    ),
    "tube": (
        Tube(radius=0.02, wall=0.005, height=0.02),
        (RHO < 0.02) & (RHO > 0.015) & (Z > 0) & (Z < 0.02),
    ),
    "cone": (
        Cone(radius=0.02, top_radius=0.01, height=0.02),
        (RHO < 0.02 - Z / 2) & (Z > 0) & (Z < 0.02),
    ),
    "pointed cone": (Cone(radius=0.02, height=0.02), (RHO < 0.02 - Z) & (Z > 0)),
    "torus": (Torus(radius=0.015, tube_radius=0.005), np.hypot(RHO - 0.015, Z) < 0.005),
    "half-space": (HalfSpace(point=(0, 0, 0.01), normal=(1, 1, 0)), X + Y < 0),
    "prism": (Prism(points=L_SHAPE, height=0.01), in_l_shape() & (Z > 0) & (Z < 0.01)),
    "revolve": (
        Revolve(points=[(0.01, 0), (0.02, 0), (0.02, 0.01), (0.01, 0.01)]),
        (RHO > 0.01) & (RHO < 0.02) & (Z > 0) & (Z < 0.01),
    ),
    "capsule": (
        Capsule(start=(-0.01, 0, 0), end=(0.01, 0, 0), radius=0.005),
        np.hypot(np.hypot(np.maximum(abs(X) - 0.01, 0), Y), Z) < 0.005,
    ),
}


@pytest.mark.parametrize("name", MEMBERS)
def test_holds_exactly_the_points_of_its_definition(name):
    shape, expected = MEMBERS[name]
    assert 0 < expected.sum() < len(POINTS)
    assert np.array_equal(shape.evaluate(POINTS) < 0, expected)


EXACT = [shape for name, (shape, _) in MEMBERS.items() if name != "ellipsoid"]


@pytest.mark.parametrize("shape", EXACT, ids=lambda shape: shape.kind)
def test_a_true_distance_has_a_gradient_of_length_one(shape):
    step = 1e-7
    slopes = [
        (shape.evaluate(POINTS + step * e) - shape.evaluate(POINTS - step * e)) / (2 * step)
        for e in np.eye(3)
    ]
    lengths = np.linalg.norm(slopes, axis=0)
    # Only on medial surfaces, which a random point meets with probability near 1e-5, is it less.
    assert np.quantile(abs(lengths - 1), 0.995) < 1e-5


@pytest.mark.parametrize("name", [name for name in MEMBERS if name != "half-space"])
def test_bounds_contain_the_shape_and_touch_it(name):
    shape, _ = MEMBERS[name]
    low, high = shape.bounds()
    inside = POINTS[shape.evaluate(POINTS) < 0]
    assert (inside >= low).all()
    assert (inside <= high).all()
    # 20,000 points in a cube of 60 mm lie about 2 mm apart.
    assert (inside.min(axis=0) - low < 0.006).all()
    assert (np.array(high) - inside.max(axis=0) < 0.006).all()


VOLUMES = {
    "sphere": (Sphere(radius=0.01), 4 / 3 * math.pi * 0.01**3),
    "cylinder": (Cylinder(radius=0.01, height=0.02), math.pi * 0.01**2 * 0.02),
    "oblique": (
        Cylinder(radius=0.01, height=0.02, axis=(1, 2, 3)),
        math.pi * 0.01**2 * 0.02,
    ),
    "tube": (Tube(radius=0.01, wall=0.004, height=0.02), math.pi * (0.01**2 - 0.006**2) * 0.02),
    "cone": (Cone(radius=0.01, height=0.02), math.pi * 0.01**2 * 0.02 / 3),
    "torus": (Torus(radius=0.01, tube_radius=0.004), 2 * math.pi**2 * 0.01 * 0.004**2),
    "ellipsoid": (Ellipsoid(radii=(0.01, 0.008, 0.005)), 4 / 3 * math.pi * 0.01 * 0.008 * 0.005),
    "rounded box": (
        RoundedBox(size=(0.01, 0.01, 0.01), radius=0.002),
        0.006**3 + 6 * 0.006**2 * 0.002 + 3 * math.pi * 0.002**2 * 0.006
        + 4 / 3 * math.pi * 0.002**3,
    ),
    "prism": (Prism(points=L_SHAPE, height=0.01), 3e-4 * 0.01),
}  # fmt: skip


@pytest.mark.parametrize("name", VOLUMES)
def test_volume_is_that_of_the_closed_form(name):
    shape, volume = VOLUMES[name]
    # Flat faces of these sizes fall on faces of cells; round ones are cut by them.
    size = 0.00125 / 4
    assert voxelize(shape, size).count * size**3 == pytest.approx(volume, rel=0.01)


def test_volume_converges_with_the_square_of_the_voxel_size():
    # Errors of single cells on a curved surface average out: measured at several places.
    errors = []
    for size in (0.002, 0.001, 0.0005):
        balls = [Sphere(radius=0.01, center=(0.1 * size * i, 0, 0)) for i in range(10)]
        volumes = [voxelize(ball, size).count * size**3 for ball in balls]
        errors.append(np.abs(np.array(volumes) / (4 / 3 * math.pi * 0.01**3) - 1).mean())
    assert errors[1] < errors[0] / 2
    assert errors[2] < errors[1] / 2


def test_a_box_fills_its_cells_exactly():
    voxels = voxelize(Box(size=(0.1, 0.01, 0.01)), 0.005)
    assert voxels.shape == (20, 2, 2)
    assert voxels.count == 80
    assert voxels.origin == (0.0, 0.0, 0.0)


def test_the_grid_passes_through_the_origin_unless_the_body_fits_elsewhere():
    box = Box(size=(0.01, 0.01, 0.011), corner=(0.003, -0.012, 0))
    voxels = voxelize(box, 0.005)
    assert voxels.origin == pytest.approx((0.003, -0.012, 0))
    assert voxels.shape == (2, 2, 3)
    there = voxelize(box, 0.005, phase=(0, 0, 0))
    assert there.origin == pytest.approx((0, -0.015, 0))
    assert there.shape == (3, 3, 3)
