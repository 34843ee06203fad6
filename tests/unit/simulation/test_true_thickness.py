"""Shells and offsets of shapes whose function is no distance are told of, and no others."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import families
from voxsoft.shapes import (
    Box,
    Cylinder,
    Expression,
    Gyroid,
    RoundedBox,
    Sphere,
    Taper,
    Torus,
    Twist,
)
from voxsoft.simulation.checks.thickness import doubtful_thickness

mm = 1e-3
BALL = Sphere(radius=10 * mm)
TRUE = {
    "sphere": BALL,
    "box": Box(size=(20 * mm, 10 * mm, 30 * mm)),
    "rounded": RoundedBox(size=(20 * mm, 12 * mm, 30 * mm), radius=3 * mm),
    "cylinder": Cylinder(radius=10 * mm, height=30 * mm),
    "torus": Torus(radius=20 * mm, tube_radius=5 * mm),
    "union": BALL | BALL.translate((12 * mm, 0, 0)),
    "difference": BALL - BALL.translate((12 * mm, 0, 0)),
    "turned": Box(size=(20 * mm, 10 * mm, 30 * mm)).rotate(0.3, axis=(1, 2, 3)),
    "scaled": BALL.scale(2),
    "gyroid": Gyroid(period=10 * mm, thickness=3 * mm),
}


def reported(shape):
    design = families.beam().replace(shapes={"solid": shape}, parts=[PART])
    return list(doubtful_thickness(design, MESH))


PART = {"shape": "solid", "material": "ecoflex-00-30"}
MESH = vs.mesh_of(families.beam())


@pytest.mark.parametrize("name", TRUE)
def test_true_distances_are_not_reported(name):
    assert reported(TRUE[name].shell(1 * mm)) == []
    assert reported(TRUE[name].offset(1 * mm)) == []


def test_an_unequal_scale_thickens_a_shell_by_its_ratio():
    # s is the distance over the largest ratio of scales: along z, three times the distance counts
    # as one. At the poles the wall is three times as thick, at the equator as written.
    (found,) = reported(BALL.scale((1, 1, 3)).shell(1 * mm))
    assert found.where == "shapes.solid"
    low, high = _times(found.what)
    assert low == pytest.approx(1, abs=0.05)
    # The quantile of 90 % of the points: short of the pole.
    assert 1.5 < high < 3
    assert abs(found.at[2]) > 20 * mm


def test_an_expression_is_off_by_its_slope():
    # |grad (x^2 + y^2 + z^2 - r^2)| = 2 r.
    sheet = Expression(text=f"x**2 + y**2 + z**2 - {(10 * mm) ** 2}").offset(1e-6)
    (found,) = reported(sheet)
    assert _times(found.what) == pytest.approx((1 / (2 * 10 * mm),) * 2, rel=0.02)


def test_a_bar_that_is_twisted_and_one_that_is_tapered_are_reported():
    bar = Box(size=(20 * mm, 20 * mm, 60 * mm), center=(0, 0, 30 * mm))
    assert reported(Twist(of=bar, angle=3 * np.pi, height=60 * mm).shell(1 * mm))
    # Its sides are within 2 %; its end, some hundredth of it, is 1/0.3 times as thick.
    assert reported(Taper(of=bar, factor=0.3, height=60 * mm).offset(1 * mm))


def test_it_is_reported_by_check_and_by_the_result():
    egg = BALL.scale((1, 1, 3)).shell(8 * mm)
    design = families.sphere().replace(
        shapes={"solid": egg},
        parts=[PART],
        clamps=[{"region": {"z": ["-inf", 0]}}],
        loads=[{"kind": "gravity"}],
        probes={},
        objectives={},
    )
    reported = "times as thick as written (8 mm)"
    assert any(reported in str(found) for found in vs.check(design).findings)
    assert any(reported in str(found) for found in vs.simulate(design).warnings)


def _times(what):
    words = what.split(" times")[0].split()
    numbers = [float(w) for w in words if w.replace(".", "").isdigit()]
    return (numbers[0], numbers[-1])


def test_edges_that_a_hollow_leaves_are_no_slopes():
    """Points beside an edge run into it, where the mean of both slopes is that of no surface."""
    solid = Box(size=(40 * mm, 40 * mm, 40 * mm))
    hollow = vs.Difference(of=(solid, solid.offset(-10 * mm)))
    design = families.beam().replace(shapes={"solid": hollow}, parts=[PART])
    mesh = vs.mesh_of(design)
    assert list(doubtful_thickness(design, mesh)) == []
