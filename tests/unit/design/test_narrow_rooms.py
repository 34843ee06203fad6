"""Narrow chambers of cut voxels stay chambers, with their volume."""

import math

import pytest

from voxsoft.design import families
from voxsoft.design.discretization.cut_voxels import CutVoxels
from voxsoft.shapes import Box, Cylinder

H = 0.002


def cavities(shape):
    design = families.beam().replace(shapes={"body": shape}, voxel_size=H, fill="fraction")
    mesh = CutVoxels.of(design).mesh()
    return [float(cavity.volume) for cavity in mesh.cavities]


BLOCK = Box(size=(10 * H, 8 * H, 8 * H), corner=(0, 0, 0))


@pytest.mark.long
@pytest.mark.parametrize("width", [1.0, 1.1, 1.4])
@pytest.mark.parametrize("shift", [0.05, 0.3, 0.5, 0.7])
def test_a_flat_room_of_a_cell_or_more_is_a_chamber(width, shift):
    room = Box(size=(6 * H, 4 * H, width * H), corner=(2 * H, 2 * H, (3 + shift) * H))
    (volume,) = cavities(BLOCK - room)
    # Planes across an axis are met exactly; at edges a small cube of H/4 is cut by one plane.
    edges = (H / 4) ** 2 / 2 * 4 * (6 * H + 4 * H + width * H)
    assert volume == pytest.approx(24 * width * H**3, abs=edges)


@pytest.mark.parametrize("shift", [0.0, 0.25, 0.5])
def test_a_bore_of_a_cell_is_a_chamber(shift):
    radius = 0.55 * H
    middle = (2 * H, (4 + shift) * H, (4 + shift) * H)
    bore = Cylinder(radius=radius, height=6 * H, base=middle, axis="x")
    (volume,) = cavities(BLOCK - bore)
    # Flat small cubes of w = H/4 lie w²/(12 R) too far out, twice that over R in the area.
    assert volume == pytest.approx(math.pi * radius**2 * 6 * H, rel=2 / 12 * (H / 4 / radius) ** 2)


def test_the_narrow_room_of_a_half_round_bender_keeps_its_volume():
    radius, wall = 8.609e-3, 3.174e-3

    def half(radius, length, floor):
        low = (-length / 2, -0.02, floor)
        round_ = Cylinder(radius=radius, height=length, base=(-length / 2, 0, 0), axis="x")
        return round_ & Box(size=(length, 0.04, 0.02), corner=low)

    (volume,) = cavities(half(radius, 0.08, 0.0) - half(radius - wall, 0.072, wall))
    inner = radius - wall
    segment = inner**2 * math.acos(wall / inner) - wall * math.sqrt(inner**2 - wall**2)
    assert segment * 0.072 == pytest.approx(1.006e-6, rel=1e-3)
    # The curvature of the arc and one small cube at each of the two sharp edges.
    arc = 2 * inner * math.acos(wall / inner) * (H / 4) ** 2 / (12 * inner)
    assert volume == pytest.approx(segment * 0.072, abs=(arc + 2 * (H / 4) ** 2 / 2) * 0.072)


@pytest.mark.parametrize("shift", [0.0, 0.1, 0.25, 0.5, 0.75, 0.9])
def test_a_room_of_a_cell_in_walls_of_a_cell_is_a_chamber_at_any_place(shift):
    corner = (shift * H,) * 3
    block = Box(size=(3 * H,) * 3, corner=corner)
    room = Box(size=(H,) * 3, corner=tuple(H + c for c in corner))
    (volume,) = cavities(block - room)
    edges = (H / 4) ** 2 / 2 * 12 * H
    assert volume == pytest.approx(H**3, abs=edges)


def test_a_groove_that_is_open_stays_full_cells():
    groove = Box(size=(6 * H, 4 * H, 1.1 * H), corner=(2 * H, 2 * H, 3.5 * H))
    slot = Box(size=(4 * H, H / 2, H / 2), corner=(7 * H, 3.7 * H, 3.8 * H))
    assert cavities(BLOCK - groove - slot) == []


def test_a_thin_wall_between_narrow_rooms_is_not_opened():
    low = Box(size=(6 * H, 4 * H, 0.6 * H), corner=(2 * H, 2 * H, 3.1 * H))
    high = Box(size=(6 * H, 4 * H, 0.6 * H), corner=(2 * H, 2 * H, 4.2 * H))
    assert len(cavities(BLOCK - low - high)) != 1
