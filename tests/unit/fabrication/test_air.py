"""Openings at all highest places, and air that stays without them."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from voxsoft.design.printer import Printer
from voxsoft.fabrication.air import openings_of, trapped_air
from voxsoft.fabrication.sampled import Grid


def test_a_bridge_with_two_towers_has_an_opening_in_each():
    cavity = np.zeros((24, 5, 20), dtype=bool)
    cavity[2:22, 1:4, 2:5] = True
    cavity[2:7, 1:4, 5:15] = True
    cavity[17:22, 1:4, 5:12] = True
    grid = Grid((0.0, 0.0, 0.0), 0.001, cavity.shape)
    openings = openings_of(cavity, grid, 0.02, Printer())
    heights = sorted(each.column[2] for each in openings)
    assert heights == [11, 14]
    assert trapped_air(cavity, grid, openings) == 0.0
    # Without the lower tower's vent all of it above the bridge stays full of air.
    left = tuple(each for each in openings if each.column[2] == 14)
    assert round(trapped_air(cavity, grid, left) * 1e9) == 5 * 3 * 7


def test_a_funnel_leaves_a_wall_to_a_higher_tower_beside_it():
    cavity = np.zeros((40, 60, 80), dtype=bool)
    cavity[2:24, 2:58, 2:6] = True
    cavity[2:14, 2:58, 2:20] = True
    cavity[15:22, 2:58, 2:60] = True
    grid = Grid((0.0, 0.0, 0.0), 0.0005, cavity.shape)
    printer = Printer()
    pour = next(each for each in openings_of(cavity, grid, 0.042, printer) if each.kind == "pour")
    tower = grid.along(0)[15] - grid.step / 2
    assert pour.bore.radius < pour.bore.top_radius
    assert pour.bore.center[0] + pour.bore.top_radius <= tower - printer.wall + 1e-12


@settings(max_examples=25, deadline=None)
@given(arrays.arrays(bool, (5, 4, 6), elements=st.booleans()))
def test_air_is_trapped_where_no_way_up_leads_to_an_opening(cells):
    grid = Grid((0.0, 0.0, 0.0), 1.0, cells.shape)
    openings = openings_of(cells, grid, 6.0, Printer())
    out = {each.column for each in openings}
    trapped = 0
    for start in map(tuple, np.argwhere(cells)):
        seen, ahead = {start}, [start]
        while ahead:
            at = ahead.pop()
            for axis in range(3):
                for way in (-1, 1):
                    to = tuple(c + way * (k == axis) for k, c in enumerate(at))
                    inside = all(0 <= c < n for c, n in zip(to, cells.shape, strict=True))
                    if inside and to not in seen and cells[to] and to[2] >= start[2]:
                        seen.add(to)
                        ahead.append(to)
        trapped += not seen & out
    assert round(trapped_air(cells, grid, openings)) == trapped
