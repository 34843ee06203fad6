"""The algebra of operators: de Morgan, inverse transforms, distances."""

import math

import numpy as np
import pytest

from voxsoft.shapes import (
    Array,
    Bend,
    Blend,
    Box,
    Cylinder,
    Difference,
    Expression,
    Grade,
    Gyroid,
    HalfSpace,
    Intersection,
    Offset,
    Sphere,
    Taper,
    Twist,
    Union,
    inside,
    voxelize,
)

POINTS = np.random.default_rng(3).uniform(-0.03, 0.03, (5_000, 3))
A = Box(size=(0.02, 0.03, 0.01), center=(0.002, 0, 0))
B = Sphere(radius=0.012, center=(0.005, 0.005, 0))
CLOSE = {"rtol": 0, "atol": 1e-15}


def is_in(shape, names=None):
    return shape.evaluate(POINTS, names) < 0


def test_booleans_are_those_of_sets():
    assert np.array_equal(is_in(A | B), is_in(A) | is_in(B))
    assert np.array_equal(is_in(A & B), is_in(A) & is_in(B))
    assert np.array_equal(is_in(A - B), is_in(A) & ~is_in(B))


def test_de_morgan():
    everything = Box(size=(1, 1, 1), center=(0, 0, 0))
    left = (everything - (A | B)).evaluate(POINTS)
    right = ((everything - A) & (everything - B)).evaluate(POINTS)
    assert np.array_equal(left, right)


def test_long_sums_stay_shallow():
    total = A
    for i in range(500):
        total = total | B.translate((i * 1e-3, 0, 0))
    assert len(total.of) == 501
    assert total.evaluate([[0.5, 0.005, 0]])[0] < 0


@pytest.mark.parametrize(
    "there_and_back",
    [
        lambda s: s.translate((0.01, -0.02, 0.003)).translate((-0.01, 0.02, -0.003)),
        lambda s: s.rotate(1.0, (1, 2, 3), (0, 0.01, 0)).rotate(-1.0, (1, 2, 3), (0, 0.01, 0)),
        lambda s: s.rotate("90 deg", "x").rotate("270 deg", "x"),
        lambda s: s.mirror((1, 1, 0), (0.01, 0, 0)).mirror((1, 1, 0), (0.01, 0, 0)),
        lambda s: s.scale(3.0, (0.01, 0, 0)).scale(1 / 3, (0.01, 0, 0)),
        lambda s: s.offset(0.001).offset(-0.001),
        lambda s: Twist(of=Twist(of=s, angle=1.0, height=0.05), angle=-1.0, height=0.05),
    ],
)
def test_inverse_transforms_cancel(there_and_back):
    np.testing.assert_allclose(there_and_back(A).evaluate(POINTS), A.evaluate(POINTS), **CLOSE)


def test_rotation_is_right_handed():
    turned = Box(size=(0.02, 0.002, 0.002)).rotate("90 deg", "z")
    assert turned.evaluate([[-0.001, 0.01, 0.001]])[0] < 0


def test_shell_is_the_rule_of_algorithm_1():
    s = B.evaluate(POINTS)
    assert np.array_equal(is_in(B.shell(0.004)), np.abs(s) < 0.002)


@pytest.mark.parametrize(
    ("combine", "sharp"), [(Union, np.minimum), (Intersection, np.maximum)], ids=["union", "common"]
)
def test_smooth_edges_differ_only_near_the_seam(combine, sharp):
    smooth = combine(of=(A, B), smooth=0.004).evaluate(POINTS)
    a, b = A.evaluate(POINTS), B.evaluate(POINTS)
    far = np.abs(a - b) >= 0.004
    np.testing.assert_allclose(smooth[far], sharp(a, b)[far], **CLOSE)
    assert np.abs(smooth - sharp(a, b)).max() == pytest.approx(0.001, rel=0.05)


def test_smooth_difference_removes_more_than_the_sharp_one():
    sharp, smooth = is_in(A - B), is_in(Difference(of=(A, B), smooth=0.004))
    assert smooth.sum() < sharp.sum()
    assert not (smooth & ~sharp).any()


def test_twist_turns_a_section_by_its_share_of_the_angle():
    bar = Box(size=(0.02, 0.004, 0.04), center=(0, 0, 0.02))
    twisted = Twist(of=bar, angle="90 deg", height=0.04)
    middle = 0.009 / math.sqrt(2)
    assert twisted.evaluate([[middle, middle, 0.02], [0.009, 0, 0.02]]).tolist() == pytest.approx(
        bar.evaluate([[0.009, 0, 0.02], [middle, -middle, 0.02]]).tolist()
    )


def test_a_bar_bent_to_a_quarter_circle_ends_at_its_radius():
    radius = 0.04
    bar = Box(size=(0.002, 0.002, radius * math.pi / 2), center=(0, 0, radius * math.pi / 4))
    bent = Bend(of=bar, radius=radius, axis="z", toward="x")
    end = [radius - 1e-6, 0, radius]
    past = [radius + 1e-6, 0, radius]
    assert (bent.evaluate([end, past]) < 0).tolist() == [True, False]


def test_taper_scales_a_section():
    tapered = Taper(of=Cylinder(radius=0.01, height=0.04), factor=0.5, height=0.04)
    radii = [[r, 0, 0.02] for r in (0.00749, 0.00751)]
    assert (tapered.evaluate(radii) < 0).tolist() == [True, False]


def test_arrays_repeat():
    ball = Sphere(radius=0.002)
    row = Array(of=ball, count=(3, 2, 1), spacing=(0.01, 0.01, 0))
    voxels = voxelize(row, 0.0005)
    assert voxels.count == 6 * voxelize(ball, 0.0005).count
    half_turn = ball.translate((0.01, 0, 0)).polar_array(3, angle="180 deg")
    assert (half_turn.evaluate([[0.01, 0, 0], [0, 0.01, 0], [-0.01, 0, 0]]) < 0).all()


def test_blend_goes_from_one_shape_to_the_other():
    for weight, expected in [(0, A), (1, B), ("x*0 + 1", B)]:
        blended = Blend(of=(A, B), weight=weight).evaluate(POINTS)
        np.testing.assert_allclose(blended, expected.evaluate(POINTS), **CLOSE)


def test_grading_by_a_constant_is_the_lattice_itself():
    plain = Gyroid(period=0.01, thickness=0.001)
    graded = Grade(of=plain, thickness="0.001", period=Expression(text="0.01"))
    np.testing.assert_allclose(graded.evaluate(POINTS), plain.evaluate(POINTS), **CLOSE)


def test_graded_thickness_holds_at_each_place():
    wall = Grade(of=HalfSpace(normal="z").shell(0.001), thickness="0.002 + 0.1*x")
    at = [[0.01, 0, 0.00149], [0.01, 0, 0.00151], [0.02, 0, 0.00199], [0.02, 0, 0.00201]]
    assert (wall.evaluate(at) < 0).tolist() == [True, False, True, False]


def test_operands_by_name():
    names = {"outer": A, "hole": B, "again": Union(of=["outer"])}
    assert np.array_equal(is_in(Difference(of=["again", "hole"]), names), is_in(A - B))


@pytest.mark.parametrize(
    "shape",
    [
        A | B,
        A.offset(0.003),
        (A & B).offset(0.002),
        Offset(of=Union(of=(A, B), smooth=0.01), distance=0.002),
        A.rotate(0.7, (1, 1, 1)),
        Bend(of=A, radius=0.05, axis="x", toward="z"),
        Taper(of=A, factor=0.5, height=0.02),
        A.scale((1, 2, 0.5)).shell(0.004),
    ],
    ids=lambda shape: shape.kind,
)
def test_bounds_are_conservative(shape):
    low, high = np.array(shape.bounds())
    points = np.random.default_rng(0).uniform(-0.06, 0.06, (50_000, 3))
    found = points[shape.evaluate(points) < 0]
    assert len(found) > 100
    assert (found >= low - 1e-12).all()
    assert (found <= high + 1e-12).all()
    assert np.prod(high - low) < 60 * len(found) / 50_000 * 0.12**3


def test_inside_takes_any_grid():
    cells = inside(B, 0.001, (30, 20, 10), (-0.01, -0.01, 0.0))
    index = np.stack(np.meshgrid(*map(np.arange, (30, 20, 10)), indexing="ij"), axis=-1)
    centers = np.array((-0.01, -0.01, 0.0)) + (index + 0.5) * 0.001
    expected = B.evaluate(centers.reshape(-1, 3)) < -1e-12
    assert np.array_equal(cells.ravel(), expected)
