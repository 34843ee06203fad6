"""Thinnest walls of castings against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.fabrication.body import Body
from voxsoft.fabrication.walls import Wall, min_wall_thickness, thinnest_walls
from voxsoft.units import mm

BALL = vs.Sphere(radius=10 * mm) - vs.Sphere(radius=8.35 * mm)
TUBE = vs.Cylinder(radius=9 * mm, height=20 * mm) - vs.Cylinder(radius=6.7 * mm, height=20 * mm)
OFF_CENTER = vs.Cylinder(radius=9 * mm, height=20 * mm) - vs.Cylinder(
    radius=6 * mm, height=20 * mm, base=(1.2 * mm, 0, 0)
)
ROOM = vs.Box(size=(30 * mm, 20 * mm, 10 * mm)) - vs.Box(
    size=(20 * mm, 14 * mm, 6 * mm), corner=(5 * mm, 4 * mm, 1.7 * mm)
)


def fold(waist: float) -> vs.Shape:
    """Two cones, foot to foot, 10 mm wider there."""
    lower = vs.Cone(radius=waist, top_radius=waist + 10 * mm, height=7 * mm)
    upper = vs.Cone(radius=waist + 10 * mm, top_radius=waist, height=7 * mm, base=(0, 0, 7 * mm))
    return lower | upper


#: Fold of a bellows, whose skin is 3 mm thick along the radius; open at both ends.
FOLD = fold(12 * mm) - fold(9 * mm)


def walls_of(shape: vs.Shape, voxel: float = 2 * mm) -> list[Wall]:
    part = vs.Part(shape=shape, material="ecoflex-00-30", name="body")
    design = vs.Design(name="walls", voxel_size=voxel, parts=[part])
    return list(thinnest_walls(Body.of(design, voxel / 3.0)))


@pytest.mark.parametrize(
    ("shape", "thickness", "slack"),
    [
        (BALL, 1.65 * mm, 1e-6),
        (TUBE, 2.3 * mm, 1e-6),
        (TUBE.rotate("33 deg", axis="x").rotate("20 deg", axis="y"), 2.3 * mm, 1e-6),
        (ROOM, 1.7 * mm, 1e-6),
        (ROOM.rotate("17 deg", axis="z").translate((0.13 * mm, 0, 0.71 * mm)), 1.7 * mm, 1e-6),
        (vs.Sphere(radius=10 * mm), 20 * mm, 1e-6),
        # Rays a step, 0.67 mm, apart miss the thinnest place by half of it at most, where the
        # wall is thicker by (0.33 mm)² (1/6 - 1/9) / 2 /mm = 0.003 mm.
        (OFF_CENTER, 1.8 * mm, 0.003 / 1.8),
        (FOLD, 3 * mm * 7 / np.hypot(7, 10), 1e-6),
    ],
)
def test_a_wall_is_as_thick_as_its_shapes_say(shape: vs.Shape, thickness: float, slack: float):
    (wall,) = walls_of(shape)
    assert wall.thickness == pytest.approx(thickness, rel=slack)


def test_a_wall_is_at_its_place():
    (wall,) = walls_of(ROOM)
    x, y, z = wall.place
    assert 5 * mm < x < 25 * mm
    assert 4 * mm < y < 18 * mm
    assert z == pytest.approx(0.85 * mm, rel=1e-6)


@pytest.mark.parametrize("voxel", [1 * mm, 2.1 * mm, 4 * mm])
def test_a_wall_does_not_depend_on_voxels(voxel: float):
    (wall,) = walls_of(TUBE, voxel)
    assert wall.thickness == pytest.approx(2.3 * mm, rel=1e-6)


def test_corners_and_edges_are_no_walls():
    bracket = vs.Box(size=(20 * mm, 20 * mm, 4 * mm)) | vs.Box(size=(5 * mm, 20 * mm, 20 * mm))
    (wall,) = walls_of(bracket)
    assert wall.thickness == pytest.approx(4 * mm, rel=1e-6)


def test_each_component_has_its_own_wall_and_rigid_ones_none():
    cap = vs.Cylinder(radius=9 * mm, height=1 * mm, base=(0, 0, 20 * mm))
    foot = vs.Cylinder(radius=9 * mm, height=1.5 * mm, base=(0, 0, -1.5 * mm))
    parts = [
        vs.Part(shape=TUBE, material="ecoflex-00-30", name="tube"),
        vs.Part(shape=cap, material=vs.Rigid(), name="cap"),
        vs.Part(shape=foot, material="dragon-skin-30", name="foot"),
    ]
    design = vs.Design(name="stack", voxel_size=2 * mm, parts=parts)
    found = {each.component: each for each in thinnest_walls(Body.of(design, 0.5 * mm))}
    assert set(found) == {"tube", "foot"}
    assert found["foot"].thickness == pytest.approx(1.5 * mm, rel=1e-6)
    assert min_wall_thickness(design) == pytest.approx(1.5 * mm, rel=1e-6)


def test_a_study_can_ask_for_walls_and_for_a_direction_of_draw():
    stem = vs.Cylinder(radius=4 * mm, height=20 * mm)
    flanges = [
        vs.Cylinder(radius=8 * mm, height=4 * mm, base=(0, 0, height * mm)) for height in (0, 8, 16)
    ]
    spool = stem | flanges[0] | flanges[1] | flanges[2]
    design = vs.Design(
        name="spool",
        voxel_size=4 * mm,
        parts=[vs.Part(shape=spool, material="ecoflex-00-30")],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        constraints={
            "wall": vs.Constraint(metric="min_wall_thickness", min="3 mm"),
            "aside": vs.Constraint(metric="undercut", axis="x", max=0.0),
            "upright": vs.Constraint(metric="undercut", axis="z", max=0.0),
        },
    )
    found = vs.simulate(design).metrics
    assert found["wall"] == pytest.approx(4 * mm, rel=1e-6)
    assert found["aside"] == 0.0
    # A plane across the axis releases one groove; the other, 4 mm high, is held. Its outside is
    # known to half a sample of 1.33 mm: 0.67 mm of 4 mm, and as much in radius.
    groove = np.pi * (8**2 - 4**2) * 4 * mm**3
    assert found["upright"] == pytest.approx(groove, rel=0.2)
