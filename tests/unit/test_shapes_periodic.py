"""Periodic surfaces: identities, period and metric wall thickness; strut lattices."""

import numpy as np
import pytest

from voxsoft.shapes import IWP, Bcc, Cubic, Fcc, Gyroid, Neovius, Octet, SchwarzD, SchwarzP, inside

PERIOD = 0.01
POINTS = np.random.default_rng(5).uniform(-PERIOD, PERIOD, (4_000, 3))
X, Y, Z = 2 * np.pi / PERIOD * POINTS.T
S, C = np.sin, np.cos

DEFINITIONS = {
    Gyroid: S(X) * C(Y) + S(Y) * C(Z) + S(Z) * C(X),
    SchwarzP: C(X) + C(Y) + C(Z),
    SchwarzD: C(X) * C(Y) * C(Z) - S(X) * S(Y) * S(Z),
    Neovius: 3 * (C(X) + C(Y) + C(Z)) + 4 * C(X) * C(Y) * C(Z),
    IWP: 2 * (C(X) * C(Y) + C(Y) * C(Z) + C(Z) * C(X)) - C(2 * X) - C(2 * Y) - C(2 * Z),
}
SURFACES = pytest.mark.parametrize("surface", DEFINITIONS, ids=lambda kind: kind.__name__)
STRUTS = pytest.mark.parametrize("struts", [Cubic, Bcc, Fcc, Octet], ids=lambda kind: kind.__name__)


@SURFACES
@pytest.mark.parametrize("level", [0.0, 0.4])
def test_the_solid_is_where_the_function_is_below_the_level(surface, level):
    solid = surface(period=PERIOD, form="solid", level=level)
    assert np.array_equal(solid.evaluate(POINTS) < 0, DEFINITIONS[surface] < level)


@SURFACES
def test_repeats_after_a_period(surface):
    sheet = surface(period=PERIOD, thickness=0.001)
    moved = POINTS + PERIOD * np.array([1, -2, 3])
    np.testing.assert_allclose(sheet.evaluate(moved), sheet.evaluate(POINTS), rtol=0, atol=1e-14)


def wall_thickness(surface, thickness):
    """Measure along the normal of the middle surface how far the wall reaches on both sides."""
    solid = surface(period=PERIOD, form="solid")
    points = POINTS.copy()
    step = 1e-8
    for _ in range(30):  # Newton steps onto the middle surface
        values = solid.evaluate(points)
        slope = gradient(solid, points, step)
        points -= (values / (slope**2).sum(axis=1))[:, None] * slope
    on_surface = np.abs(solid.evaluate(points)) < 1e-12
    points = points[on_surface]
    assert len(points) > 0.9 * len(POINTS)
    normals = gradient(solid, points, step)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    sheet = surface(period=PERIOD, thickness=thickness)
    return sum(reach(sheet, points, side * normals, thickness) for side in (1, -1))


def reach(sheet, points, directions, most):
    low, high = np.zeros(len(points)), np.full(len(points), most)
    for _ in range(40):
        middle = (low + high) / 2
        within = sheet.evaluate(points + middle[:, None] * directions) < 0
        low, high = np.where(within, middle, low), np.where(within, high, middle)
    return low


def gradient(shape, points, step):
    return np.stack(
        [
            (shape.evaluate(points + step * e) - shape.evaluate(points - step * e)) / (2 * step)
            for e in np.eye(3)
        ],
        axis=1,
    )


@SURFACES
def test_walls_have_the_thickness_asked_for(surface):
    thin, thick = (np.abs(wall_thickness(surface, t) / t - 1) for t in (PERIOD / 100, PERIOD / 20))
    # A relative error of second order: 25 times smaller for a wall 5 times thinner.
    assert np.median(thin) < 0.002
    assert np.quantile(thin, 0.95) < 0.02
    assert np.median(thin) < np.median(thick) / 15
    assert np.median(thick) < 0.03


@STRUTS
def test_bars_are_round_and_repeat(struts):
    lattice = struts(period=PERIOD, thickness=0.002)
    assert lattice.evaluate([[0, 0, 0]])[0] == pytest.approx(-0.001)
    moved = POINTS + PERIOD * np.array([2, 0, -1])
    np.testing.assert_allclose(lattice.evaluate(moved), lattice.evaluate(POINTS), atol=1e-14)


@STRUTS
def test_distance_is_that_to_the_nearest_bar(struts):
    half = PERIOD / 2
    corners = np.array(np.meshgrid(*[[-1, 0, 1]] * 3)).reshape(3, -1).T * 2 * half
    faces = [half * np.array(v) for v in [(0, 1, 1), (1, 0, 1), (1, 1, 0)]]
    bars = {
        Cubic: [(c, c + 2 * half * e) for c in corners for e in np.eye(3)],
        Bcc: [
            (c, c + half * np.array(d))
            for c in corners
            for d in np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T
        ],
        Fcc: [
            (c, c + f * np.array(d))
            for c in corners
            for f in faces
            for d in np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T
        ],
    }
    signs = np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T
    octahedra = [
        (c + s * p, c + s * q)
        for c in corners
        for s in signs
        for p, q in [(faces[0], faces[1]), (faces[1], faces[2]), (faces[2], faces[0])]
    ]
    bars[Octet] = bars[Fcc] + octahedra
    points = POINTS[:300] * 0.5
    nearest = np.min([distance_to_segment(points, a, b) for a, b in bars[struts]], axis=0)
    lattice = struts(period=PERIOD, thickness=0.002)
    np.testing.assert_allclose(lattice.evaluate(points), nearest - 0.001, rtol=0, atol=1e-15)


def distance_to_segment(points, a, b):
    along = np.clip((points - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
    return np.linalg.norm(points - a - along[:, None] * (b - a), axis=1)


def test_the_gyroid_halves_space():
    cells = inside(Gyroid(period=1.0, form="solid"), 0.01, (100, 100, 100), (0.003, 0.003, 0.003))
    assert cells.mean() == pytest.approx(0.5, abs=1e-3)


def test_a_thin_gyroid_wall_has_the_area_of_the_gyroid():
    # Area per cubic cell 3.0915 a² (Schoen, NASA TN D-5541, 1970).
    cells = inside(Gyroid(period=1.0, thickness=0.05), 0.005, (200, 200, 200))
    assert cells.mean() / 0.05 == pytest.approx(3.0915, rel=0.01)
