"""Why there is no enclosed cavity: an opening, large voxels, or no void."""

import pytest

import voxsoft as vs
from voxsoft.design import families
from voxsoft.errors import NoCavityError
from voxsoft.shapes import Box, Cylinder
from voxsoft.simulation import Setup, check
from voxsoft.simulation.setup.missing_cavity import why_no_cavity

MM = 1e-3
BLOCK = Box(size=(20 * MM,) * 3, corner=(0, 0, 0))


def why(shape, size=2.0, **changes):
    design = families.beam().replace(shapes={"body": shape}, voxel_size=size * MM, **changes)
    return why_no_cavity(design, vs.mesh_of(design))


def test_the_opening_of_a_cup_is_named_and_not_its_walls():
    cup = Cylinder(radius=20 * MM, height=20 * MM) - Cylinder(radius=14 * MM, height=16 * MM)
    what, hint = why(cup)
    assert "is open: its opening is 28 mm wide, near (0, 0, 1) mm" in what
    assert "closes by contact is not known yet" in hint
    assert "voxel" not in hint


def test_the_hole_of_a_chamber_is_named_by_its_own_width():
    room = Box(size=(12 * MM,) * 3, corner=(4 * MM,) * 3)
    hole = Box(size=(4 * MM, 4 * MM, 8 * MM), corner=(8 * MM, 8 * MM, 12 * MM))
    what, _ = why(BLOCK - room - hole)
    assert "its opening is 4 mm wide, near (10, 10, 19) mm" in what


def test_a_wall_that_is_lost_is_named():
    # No center of a voxel of 2 mm is in a wall of 0.9 mm, and one of 1 mm is.
    room = Box(size=(12 * MM, 12 * MM, 15.1 * MM), corner=(4 * MM,) * 3)
    what, hint = why(BLOCK - room, fill="binary")
    assert what.endswith("mm: its wall is 1 mm thick")
    assert "voxels of 2 mm lose the chamber of some 2.2 mL near (10, 10, 11.5) mm" in what
    assert 'voxel_size = "1 mm" or smaller' in hint


def test_a_room_that_is_lost_is_named():
    room = Box(size=(0.9 * MM,) * 3, corner=(8.1 * MM,) * 3)
    what, hint = why(BLOCK - room, fill="binary")
    assert "near (8.5, 8.5, 8.5) mm: its room is 1 mm wide" in what
    assert 'voxel_size = "1 mm" or smaller' in hint


def test_a_solid_body_encloses_nothing():
    assert why(BLOCK)[0] == "the parts enclose no void"


def test_check_and_setup_say_the_same():
    cup = BLOCK - Box(size=(12 * MM, 12 * MM, 16 * MM), corner=(4 * MM,) * 3)
    design = families.beam().replace(
        shapes={"body": cup},
        voxel_size=2 * MM,
        loads=(vs.Pressure(value=1e3),),
        chambers={"room": vs.Chamber(point=(10 * MM, 10 * MM, 10 * MM))},
    )
    report = [each.what for each in check(design).findings if each.severity == "error"]
    assert any("no enclosed cavity to name: the hollow of" in each for each in report)
    plain = design.replace(chambers={})
    with pytest.raises(NoCavityError, match="its opening is 12 mm wide"):
        Setup(plain, vs.mesh_of(plain)).check()
