"""Contact meets the surface of shapes, not the faces of the voxels that they filled."""

import csv
from pathlib import Path

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Contact, ContactPair, Object
from voxsoft.design.discretization.discretize import mesh_of
from voxsoft.errors import DesignError
from voxsoft.files import load, save
from voxsoft.simulation import Setup, simulate
from voxsoft.simulation.setup.skin import skin_of
from voxsoft.units import kPa, mm

RADIUS, DEPTH = 20.0, 2.0
REFERENCE = Path(__file__).parents[3] / "data" / "contact" / "sphere_on_plane.csv"
RUBBER = vs.NeoHookean(young=100 * kPa, poisson=0.45)


def box(low, high):
    sides = [b - a for a, b in zip(low, high, strict=True)]
    middle = [(a + b) / 2 for a, b in zip(low, high, strict=True)]
    return vs.Box(size=[s * mm for s in sides], center=[m * mm for m in middle])


def pressed_ball(surface, **changes):
    """A quarter of half a ball, its equator moved down onto a rigid plane."""
    ball = vs.Sphere(radius=RADIUS * mm, center=(0, 0, RADIUS * mm))
    down = vs.Motion(displacement=(0, 0, -DEPTH * mm))
    equator = vs.Region(z=(RADIUS * mm, RADIUS * mm))
    whole = {
        "name": "ball-on-plane",
        "voxel_size": 2.5 * mm,
        "parts": [vs.Part(shape=ball & box((0, 0, 0), (RADIUS,) * 3), material=RUBBER)],
        "clamps": [
            vs.Clamp(region=equator, axes="z", motion=down),
            *(vs.Clamp(region=vs.Region(**{axis: (0, 0)}), axes=axis) for axis in "xy"),
        ],
        "objects": [Object(name="plane", shape=box((-5, -5, -5), (35, 35, 0)))],
        "contact": Contact(pairs=(ContactPair(of=("body", "body"), kind="none"),), surface=surface),
    }
    return vs.Design(**(whole | changes))


@pytest.fixture(scope="module")
def reference():
    with REFERENCE.open(newline="", encoding="utf-8") as lines:
        rows = [
            {key: float(text or "nan") for key, text in row.items()}
            for row in csv.DictReader(lines)
        ]
    return next(row for row in rows if row["poisson"] == 0.45 and row["depth_mm"] == DEPTH)


@pytest.fixture(scope="module")
def result():
    return simulate(pressed_ball("smooth", fill="binary"))


@pytest.mark.long
def test_a_ball_presses_as_a_ball(result, reference):
    (contact,) = result.contacts
    # Eight voxels along the radius are 3 % off; the disc that voxels make of its pole is 58 %.
    assert 4 * contact.pressed == pytest.approx(reference["force_N"], rel=0.05)
    (stairs,) = simulate(pressed_ball("voxels", fill="binary")).contacts
    assert stairs.pressed > 1.4 * contact.pressed


def test_points_between_those_that_press_are_in_contact(result, reference):
    # The circle of contact is 2.6 voxels wide, and its rim half a voxel uncertain; of its points
    # one in four presses.
    (contact,) = result.contacts
    radius = 1e3 * np.sqrt(4 * contact.area / np.pi)
    assert radius == pytest.approx(reference["radius_mm"], rel=0.3)


def test_pressures_are_on_the_vertices_of_the_faces(result):
    field = result.contact_field
    (contact,) = result.contacts
    # No friction: all forces are along their normals.
    assert (field.pressure * field.area).sum() == pytest.approx(contact.pressed, rel=1e-9)
    assert field.pressure.min() >= 0.0
    assert field.area.min() >= 0.0
    outer = np.zeros(len(field.area), dtype=bool)
    outer[result.mesh.triangles] = True
    assert not field.area[~outer].any()


def test_cut_voxels_meet_the_same_surface(reference):
    cut = simulate(pressed_ball("smooth", fill="fraction"))
    (contact,) = cut.contacts
    # Tolerance of full ones, where contact with whole faces is 69 % off.
    assert 4 * contact.pressed == pytest.approx(reference["force_N"], rel=0.06)
    field = cut.contact_field
    assert (field.pressure * field.area).sum() == pytest.approx(contact.pressed, rel=1e-9)


def test_overlap_at_rest_is_judged_by_the_contact_surface():
    # The ball ends at 0, its voxels below 1.25 mm are empty.
    plane = Object(name="plane", shape=box((-5, -5, -5), (35, 35, 0.5)))
    with pytest.raises(DesignError, match=r"0\.5 mm deep in the body"):
        Setup.of(pressed_ball("smooth", objects=[plane]))
    far = vs.Sphere(radius=RADIUS * mm, center=(0, 0, (RADIUS + 0.9) * mm))
    raised = [vs.Part(shape=far & box((0, 0, 0), (RADIUS,) * 3), material=RUBBER)]
    assert Setup.of(pressed_ball("smooth", objects=[plane], parts=raised)).touching is not None


def test_walls_of_chambers_are_smooth_and_bonds_are_not_surfaces():
    inner, middle, outer = (vs.Sphere(radius=r * mm) for r in (6, 9, 12))
    design = vs.Design(
        name="shells",
        voxel_size=1.5 * mm,
        parts=[
            vs.Part(shape=middle - inner, material=RUBBER),
            vs.Part(shape=outer - middle, material=vs.NeoHookean(young=50 * kPa, poisson=0.45)),
        ],
        clamps=[vs.Clamp(region=vs.Region(z=(-12 * mm, -10 * mm)))],
    )
    skin = skin_of(design, mesh_of(design))
    assert skin is not None
    radii = 1e3 * np.linalg.norm(skin.points, axis=1)
    near = np.abs(radii[:, None] - [6, 9, 12])
    # Chords of half a voxel, where points are not on the surface itself.
    assert near[:, [0, 2]].min(axis=1).max() < 1.5**2 / (8 * 6)
    assert {0, 2} == set(near.argmin(axis=1).tolist())


def test_bodies_that_no_shape_filled_have_the_faces_of_their_voxels():
    design = pressed_ball("smooth", fill="binary")
    assert skin_of(design, mesh_of(design)) is not None
    assert skin_of(design, mesh_of(design, refine=2)) is None
    assert Setup.of(pressed_ball("voxels")).touching.skins == (None,)


def test_the_surface_is_saved_and_read_back(tmp_path):
    for surface in ("smooth", "voxels"):
        path = tmp_path / f"{surface}.toml"
        save(pressed_ball(surface), path)
        assert load(path).contact.surface == surface
    with pytest.raises(DesignError, match=r"surface: \"round\" came"):
        pressed_ball("round")


def two_balls(**changes):
    """Balls of 5.4 mm, 3.2 mm apart, whose voxels are 2 mm apart: they stick out of the poles."""
    balls = [vs.Sphere(radius=5.4 * mm, center=(0, 0, z * mm)) for z in (-7, 7)]
    ends = [vs.Region(z=(z * mm, (z + 5) * mm)) for z in (-12, 7)]
    down = vs.Motion(displacement=(0, 0, -4.2 * mm))
    whole = {
        "name": "two-balls",
        "voxel_size": 2 * mm,
        "parts": [vs.Part(shape=balls[0] | balls[1], material=RUBBER)],
        "clamps": [vs.Clamp(region=ends[0]), vs.Clamp(region=ends[1], motion=down)],
        "contact": Contact(),
    }
    return vs.Design(**(whole | changes))


def test_voxels_that_stick_out_of_skins_that_touch_do_not_overlap():
    result = simulate(two_balls())
    (contact,) = result.contacts
    assert contact.of == ("body", "body")
    assert contact.pressed > 0.0
    assert not result.penetration.overlaps
    # Through each other they do.
    apart = Contact(pairs=(ContactPair(of=("body", "body"), kind="none"),))
    through = simulate(two_balls(contact=apart))
    assert through.penetration.depth == pytest.approx(1 * mm, abs=0.2 * mm)


def test_voxels_that_stick_out_of_a_skin_are_not_below_the_floor():
    ball = vs.Sphere(radius=5.4 * mm, center=(0, 0, 7 * mm))
    design = two_balls(
        parts=[vs.Part(shape=ball, material=RUBBER)],
        clamps=[
            vs.Clamp(
                region=vs.Region(z=(7 * mm, 13 * mm)),
                motion=vs.Motion(displacement=(0, 0, -1 * mm)),
            )
        ],
        floor=vs.Floor(z=1.6 * mm),
    )
    result = simulate(design)
    assert [contact.of for contact in result.contacts] == [("body", "floor")]
    assert not result.penetration.overlaps
