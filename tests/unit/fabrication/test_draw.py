"""Undercuts, parting planes and cuts against closed forms and brute force."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from voxsoft.fabrication.cutting import _planes, best_cut
from voxsoft.fabrication.draw import ABOVE, BESIDE, draw_along
from voxsoft.fabrication.sampled import Grid
from voxsoft.shapes import Box, Cylinder, Shape, Sphere
from voxsoft.units import mm

STEP = 0.5 * mm


def sampled(shape: Shape) -> tuple[np.ndarray, Grid, float, float]:
    built = shape.build({})
    low, high = (np.array(corner) for corner in built.bounds())
    grid = Grid.around(low, high, STEP, 3 * mm)
    return grid.values(built), grid, float(high[2]), float(low[2])


def test_a_ball_parts_at_its_middle_without_an_undercut():
    found = draw_along(*sampled(Sphere(radius=8 * mm)))
    assert found.undercut == 0.0
    # Samples tell the height of the outline to half a step.
    assert found.parting == pytest.approx(0.0, abs=STEP / 2)
    assert not found.is_open
    assert not found.has_recess


def test_a_bar_is_poured_openly_to_its_top():
    found = draw_along(*sampled(Box(size=(20 * mm, 8 * mm, 6 * mm))))
    assert found.is_open
    assert found.parting == 6 * mm


def test_a_shallow_recess_in_the_top_needs_a_lid():
    bar = Box(size=(20 * mm, 8 * mm, 6 * mm))
    bar -= Box(size=(12 * mm, 4 * mm, 0.4 * mm), corner=(4 * mm, 2 * mm, 5.6 * mm))
    found = draw_along(*sampled(bar))
    assert found.parting == 6 * mm
    assert not found.is_open


def test_a_waist_is_an_undercut_of_its_volume():
    wide = Cylinder(radius=8 * mm, height=4 * mm)
    spool = wide | Cylinder(radius=4 * mm, height=12 * mm) | wide.translate((0, 0, 8 * mm))
    found = draw_along(*sampled(spool))
    # Samples stand for half a step, 0.25 mm, on all sides of the ring; it loses 0.1 mm, the depth
    # that counts as none.
    least = np.pi * (7.65**2 - 4.35**2) * 3.3 * mm**3
    most = np.pi * (8.15**2 - 3.85**2) * 4.05 * mm**3
    assert least < found.undercut < most
    assert found.place[2] == pytest.approx(6 * mm, abs=STEP)


def test_a_cup_has_a_recess_for_the_upper_part():
    cup = Cylinder(radius=8 * mm, height=10 * mm)
    cup -= Cylinder(radius=5 * mm, height=8 * mm, base=(0, 0, 2 * mm))
    values, grid, top, bottom = sampled(cup)
    found = draw_along(values, grid, top, bottom)
    assert found.has_recess
    assert not found.is_open
    inside = found.sides[grid.nearest(np.array([[0.0, 0.0, 6 * mm], [0.0, 0.0, -1 * mm]]))]
    assert inside.tolist() == [ABOVE, BESIDE]


def test_a_closed_chamber_is_cut_at_the_end_away_from_the_clamp():
    body = Cylinder(radius=8 * mm, height=14 * mm)
    body -= Cylinder(radius=5 * mm, height=10 * mm, base=(0, 0, 2 * mm))
    values, grid, _, _ = sampled(body)
    ends = np.array([[[-5, -5, 2], [5, 5, 12]]]) * mm
    held = np.zeros(3)
    center = np.array([0, 0, 7]) * mm
    assert best_cut(values, grid, ends, held, center).axis == 2
    assert best_cut(values, grid, ends, held, center).at == 12 * mm
    held = np.array([0, 0, 14]) * mm
    assert best_cut(values, grid, ends, held, center).at == 2 * mm
    seam = best_cut(values, grid, ends, held, center).seam
    # Ring of radii 5 and 8 mm, in squares of samples along both circles.
    assert seam == pytest.approx(np.pi * (8**2 - 5**2) * mm**2, rel=0.05)


def test_no_plane_opens_a_ball_in_a_shell_in_a_shell():
    onion = Sphere(radius=10 * mm) - Sphere(radius=8 * mm)
    # A stem in each direction holds the inner ball, so that every cut leaves it in the way.
    ball = Sphere(radius=5 * mm) - Sphere(radius=3 * mm)
    hook = Sphere(radius=1.5 * mm, center=(6.5 * mm, 0, 3 * mm))
    values, grid, _, _ = sampled(onion | ball | hook.translate((0, 0, 0)))
    assert best_cut(values, grid, np.zeros((0, 2, 3)), np.full(3, np.nan), np.zeros(3)) is None


@settings(max_examples=60, deadline=None)
@given(arrays.arrays(bool, (3, 2, 7), elements=st.booleans()))
def test_caught_volumes_are_those_of_a_search_plane_by_plane(cells):
    grid = Grid((0.0, 0.0, 0.0), 1.0, cells.shape)
    values = np.where(cells, -1.0, 1.0)
    found = _planes(values, grid, 2)
    for plane in range(6):
        caught = 0
        for part in (cells[..., : plane + 1], cells[..., plane + 1 :]):
            for i, j, k in np.argwhere(~part):
                column = part[i, j]
                caught += bool(column[:k].any() and column[k + 1 :].any())
        assert found.caught[plane] == caught
