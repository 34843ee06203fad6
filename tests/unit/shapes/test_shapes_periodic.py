"""Periodic surfaces: identities, period and metric wall thickness; strut lattices."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from voxsoft.shapes import IWP, Bcc, Cubic, Fcc, Gyroid, Neovius, Octet, SchwarzD, SchwarzP, inside

PERIOD = 0.01
POINTS = np.random.default_rng(5).uniform(-PERIOD, PERIOD, (4_000, 3))
S, C = np.sin, np.cos


def gyroid(x, y, z):
    return S(x) * C(y) + S(y) * C(z) + S(z) * C(x)


def schwarz_p(x, y, z):
    return C(x) + C(y) + C(z)


def schwarz_d(x, y, z):
    return C(x) * C(y) * C(z) - S(x) * S(y) * S(z)


def neovius(x, y, z):
    return 3 * (C(x) + C(y) + C(z)) + 4 * C(x) * C(y) * C(z)


def iwp(x, y, z):
    return 2 * (C(x) * C(y) + C(y) * C(z) + C(z) * C(x)) - C(2 * x) - C(2 * y) - C(2 * z)


WAVES = {Gyroid: gyroid, SchwarzP: schwarz_p, SchwarzD: schwarz_d, Neovius: neovius, IWP: iwp}
#: Values by places (n, 3) in periods.
FUNCTIONS = {kind: lambda p, g=g: g(*(2 * np.pi * p).T) for kind, g in WAVES.items()}
SURFACES = pytest.mark.parametrize("surface", WAVES, ids=lambda kind: kind.__name__)
STRUTS = pytest.mark.parametrize("struts", [Cubic, Bcc, Fcc, Octet], ids=lambda kind: kind.__name__)


@SURFACES
@pytest.mark.parametrize("level", [0.0, 0.4])
def test_the_solid_is_where_the_function_is_below_the_level(surface, level):
    solid = surface(period=PERIOD, form="solid", level=level)
    assert np.array_equal(solid.evaluate(POINTS) < 0, FUNCTIONS[surface](POINTS / PERIOD) < level)


@SURFACES
def test_repeats_after_a_period(surface):
    sheet = surface(period=PERIOD, thickness=0.001)
    moved = POINTS + PERIOD * np.array([1, -2, 3])
    np.testing.assert_allclose(sheet.evaluate(moved), sheet.evaluate(POINTS), rtol=0, atol=1e-14)


def points_on(surface, level, nodes=96):
    """Points where g = level crosses the edges of a grid over one period of 1, by bisection."""
    axis = np.arange(nodes) / nodes
    corners = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    excess = FUNCTIONS[surface](corners) - level
    found = []
    for direction in np.eye(3) / nodes:
        crosses = (excess < 0) != (FUNCTIONS[surface](corners + direction) < level)
        start, is_below = corners[crosses], excess[crosses] < 0
        low, high = np.zeros(len(start)), np.ones(len(start))
        for _ in range(30):
            middle = (low + high) / 2
            same = (FUNCTIONS[surface](start + middle[:, None] * direction) < level) == is_below
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        found.append(start + low[:, None] * direction)
    return np.concatenate(found) % 1.0


@pytest.mark.parametrize(
    ("surface", "level"),
    [
        pytest.param(kind, level, marks=[pytest.mark.slow] * ((kind, level) != (Gyroid, 0.4)))
        for kind in WAVES
        for level in (0.0, 0.4)
    ],
)
def test_distances_and_volumes_of_walls_are_true_at_any_thickness(surface, level):
    known = cKDTree(points_on(surface, level), boxsize=1.0)
    places = np.random.default_rng(1).uniform(0, 1, (8_000, 3))
    nearest, _ = known.query(places)
    found = np.abs(surface(period=1.0, form="solid", level=level).evaluate(places))
    # Each known point is on the surface, so the nearest is never closer than the surface (2⁻³⁰ of
    # an edge from bisection). A surface that crosses a cube crosses an edge of it within half its
    # diagonal a = √3/192; with no curvature over 6 periods⁻¹ toward the place, that point is
    # further than the closest one by at most a²(1/d + 6)/2.
    reach = np.sqrt(3) / 192
    far = found > 0.05
    assert (found - nearest).max() < 1e-9
    assert (nearest - found)[far].max() < reach**2 * (1 / 0.05 + 6) / 2
    for thickness in np.linspace(0.1, 0.9, 9):
        sheet = surface(period=1.0, thickness=thickness, level=level).evaluate(places) < 0
        # Only places between the two bounds above can be counted differently.
        assert sheet.mean() == pytest.approx((nearest < thickness / 2).mean(), abs=3e-3)


def test_a_thick_gyroid_wall_follows_steiner():
    # The volume within t/2 of a surface is A t + ∫K dA t³/12, exactly, up to the first focal point;
    # Gauss and Bonnet: ∫K dA = 2πχ = −16π for each cubic cell of the gyroid (genus 5). The area
    # is Schoen's 3.0915; the leading Fourier terms have 0.3 % more.
    cells = inside(Gyroid(period=1.0, thickness=0.2), 0.01, (100, 100, 100))
    assert cells.mean() == pytest.approx(3.0915 * 0.2 - 16 * np.pi * 0.2**3 / 12, rel=0.01)


@pytest.mark.parametrize(("level", "corner"), [(2.997, 0.0), (-2.997, 0.5)])
def test_a_small_pocket_is_not_lost(level, corner):
    # cos x + cos y + cos z = 3 − r²/2 + O(r⁴): a ball around the corners.
    radius = np.sqrt(2 * 0.003) / (2 * np.pi)
    pocket = SchwarzP(period=1.0, form="solid", level=level)
    assert abs(pocket.evaluate([[corner] * 3])[0]) == pytest.approx(radius, rel=1e-3)


def test_a_level_with_singular_points_has_distances():
    values = SchwarzP(period=1.0, form="solid", level=1.0).evaluate(POINTS / PERIOD)
    assert np.isfinite(values).all()


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
