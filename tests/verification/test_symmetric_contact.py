"""A part of a symmetric body with contact, solved alone, is the whole body."""

from __future__ import annotations

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Body, Contact, Object, Symmetry
from voxsoft.simulation import Setup
from voxsoft.simulation.setup.contact import Touching
from voxsoft.units import kPa, mm

RUBBER = vs.NeoHookean(young=100 * kPa, poisson=0.45, density=1000)
X, Y = Symmetry(plane="x"), Symmetry(plane="y")
#: Contact settles to the precision that the tolerance asks for: at 1e-11 what sticks creeps by less
#: than 1e-7 voxels.
TIGHT = {"tolerance": 1e-11}
#: Of the size of the body: a voxel is a quarter of it or less.
SAME = 1e-7
#: Of forces and energies: bounds of friction are right to 3e-6 of the largest one then.
SAME_FORCE = 1e-5


def block(height: float = 12 * mm, **entries: object) -> vs.Design:
    """A block that stands on the plane z = 0, in the middle of x and y."""
    shape = vs.Box(size=(12 * mm, 12 * mm, height), center=(0, 0, height / 2))
    given = {
        "name": "block",
        "voxel_size": 3 * mm,
        "parts": [vs.Part(shape=shape, material=RUBBER)],
        "clamps": [vs.Clamp(region=vs.Region(z=(0, 0)))],
        "contact": Contact(friction=0.5),
        "solver": vs.Solver(method="statics"),
    }
    return vs.Design(**(given | entries))


def whole_with_symmetric_objects(design: vs.Design, planes: list[Symmetry]) -> Setup:
    """The whole, whose objects have the triangles that they have beside planes.

    Traced triangles are not symmetric, and press a body a little to one side.
    """
    setup = Setup.of(design, allow_loose=True)
    part = Setup(design.replace(symmetry=planes), setup.mesh)
    assert part.sector_touching is not None
    touching = Touching(setup.design, setup.mesh)
    touching.__dict__["surfaces"] = part.sector_touching.surfaces
    setup.__dict__["touching"] = touching
    return setup


def require_same(
    design: vs.Design,
    planes: list[Symmetry],
    within: float = SAME,
    pressed_within: float = 0.0,
    **settings: object,
) -> vs.Result:
    """A part and the whole agree in all that a result says; returns the part's.

    `pressed_within` is what their forces along a contact may differ by, in parts of them.
    """
    whole = vs.simulate(whole_with_symmetric_objects(design, planes), **settings)
    part = vs.simulate(design.replace(symmetry=planes), **settings)
    assert (part.status, whole.status) == ("ok", "ok")
    size = float(np.ptp(whole.mesh.vertices, axis=0).max())
    assert np.abs(part.positions - whole.positions).max() <= within * size
    assert np.abs(whole.displacements).max() > 1e-3 * size
    pressed = max(each.pressed for each in whole.contacts)
    forces = within / SAME * SAME_FORCE * pressed
    assert [each.of for each in part.contacts] == [each.of for each in whole.contacts]
    for mine, its in zip(part.contacts, whole.contacts, strict=True):
        for name in ("force", "friction", "pressed", "pressure", "bound"):
            off = np.abs(np.subtract(getattr(mine, name), getattr(its, name))).max()
            allowed = pressed_within * pressed if name == "pressed" else forces
            assert off <= max(forces, allowed), (mine.of, name)
        assert mine.area == pytest.approx(its.area, rel=1e-9)
        assert mine.gap == pytest.approx(its.gap, abs=within * size)
    for name, pose in whole.objects.items():
        assert part.objects[name].position == pytest.approx(pose.position, abs=within * size)
        assert np.allclose(part.objects[name].rotation, pose.rotation, rtol=0.0, atol=10 * within)
    for name in ("reaction", "load"):
        off = np.abs(np.subtract(getattr(part, name), getattr(whole, name))).max()
        assert off <= forces, name
    arm = float(np.abs(whole.mesh.vertices).max())
    for name in ("reaction_moment", "load_moment"):
        off = np.abs(np.subtract(getattr(part, name), getattr(whole, name))).max()
        assert off <= forces * arm, name
    assert part.elastic_energy == pytest.approx(
        whole.elastic_energy, rel=within / SAME * SAME_FORCE
    )
    assert part.mass == pytest.approx(whole.mass, rel=1e-12)
    mine, its = part.contact_field, whole.contact_field
    assert mine is not None
    assert its is not None
    carried = [each.pressure * each.area for each in (mine, its)]
    assert np.abs(carried[0] - carried[1]).max() <= forces
    # Squares of half a voxel, an eighth of the size, change by twice what their corners are off.
    assert mine.area == pytest.approx(its.area, rel=16 * within)
    for name, moved in whole.probes.items():
        assert part.probes[name] == pytest.approx(moved, abs=within * size)
    return part


#: A quarter cuts the planes of half a body, and once more; the half alone is slow.
ONE_OR_TWO = pytest.mark.parametrize("planes", [pytest.param([X], marks=pytest.mark.slow), [X, Y]])

PLATE = Object(
    name="plate",
    shape=vs.Box(size=(20 * mm, 20 * mm, 4 * mm), center=(0, 0, 14 * mm)),
    motion=vs.Motion(displacement=(0, 0, -1 * mm)),
)


@pytest.mark.slow
@ONE_OR_TWO
def test_a_plate_presses_a_block(planes: list[Symmetry]) -> None:
    part = require_same(block(objects=[PLATE]), planes, **TIGHT)
    [contact] = part.contacts
    # It slips at its edge and sticks in the middle: both are compared.
    assert 0.1 < contact.slipping < 0.9
    half = "a half" if len(planes) == 1 else "a quarter"
    assert part.message.endswith(f"solved for {half} of the body")


@pytest.mark.slow
@ONE_OR_TWO
def test_a_block_lies_on_a_floor(planes: list[Symmetry]) -> None:
    top = vs.Force(region=vs.Region(z=(9 * mm, "inf")), value=(0, 0, -0.5))
    design = block(9 * mm, clamps=[], floor=vs.Floor(), loads=[vs.Gravity(), top])
    require_same(design, planes, **TIGHT)


def pads(friction: float = 0.5, **left: object) -> vs.Design:
    """Two pads that pinch a block, images of each other."""
    each = [
        Object(
            name=name,
            shape=vs.Box(size=(2 * mm, 8 * mm, 8 * mm), center=(sign * 7.01 * mm, 0, 6 * mm)),
            motion=vs.Motion(displacement=(-sign * 0.5 * mm, 0, 0)),
        )
        for name, sign in (("right", 1.0), ("left", -1.0))
    ]
    each[1] = each[1].replace(**left)
    return block(objects=each, contact=Contact(friction=friction))


#: With the default tolerance what sticks creeps by up to 1e-4 voxels, a quarter of that in sizes of
#: the body, in the part and in the whole. Bounds of friction are right to 0.3 % in each, which is
#: what the same number allows for forces.
DEFAULT = 5e-5


@pytest.mark.slow
def test_pads_that_are_images_pinch_a_block() -> None:
    require_same(pads(friction=0.0), [X], **TIGHT)
    require_same(pads(), [X], DEFAULT)


@pytest.mark.long
@ONE_OR_TWO
def test_a_free_object_is_cut_by_planes(planes: list[Symmetry]) -> None:
    shape = vs.Box(size=(16 * mm, 16 * mm, 8 * mm), center=(0, 0, 10.01 * mm))
    weight = Object(name="weight", shape=shape, motion="free", mass=0.05)
    require_same(block(6 * mm, objects=[weight], loads=[vs.Gravity()]), planes, DEFAULT)


def test_of_two_free_objects_one_is_solved_for() -> None:
    each = [
        Object(
            name=name,
            shape=vs.Box(size=(5 * mm, 4 * mm, 4 * mm), center=(sign * 3 * mm, 0, 8.01 * mm)),
            motion="free",
            mass=0.02,
        )
        for name, sign in (("right", 1.0), ("left", -1.0))
    ]
    part = require_same(block(6 * mm, objects=each, loads=[vs.Gravity()]), [X], DEFAULT)
    right, left = part.objects["right"], part.objects["left"]
    mirrored = (-right.position[0], *right.position[1:])
    assert left.position == pytest.approx(mirrored, rel=1e-12)
    flip = np.diag([-1.0, 1.0, 1.0])
    assert np.array_equal(np.array(left.rotation), flip @ np.array(right.rotation) @ flip)


@pytest.mark.long
@pytest.mark.parametrize("friction", [pytest.param(0.0, marks=pytest.mark.slow), 0.5])
def test_a_body_meets_its_own_image(friction: float) -> None:
    """Two legs that are pressed onto each other across the plane, with 1.5 mm between them."""
    legs = vs.Box(size=(12 * mm, 6 * mm, 12 * mm), center=(0, 0, 6 * mm)) - vs.Box(
        size=(3 * mm, 6 * mm, 9 * mm), center=(0, 0, 7.5 * mm)
    )
    loads = [
        vs.Force(
            region=vs.Region(x=(sign * 6 * mm,) * 2, z=(9 * mm, "inf")),
            value=(-sign * 0.02, 0, 0),  # lightly: each snaps for itself under more
        )
        for sign in (1.0, -1.0)
    ]
    design = block(
        parts=[vs.Part(shape=legs, material=RUBBER)],
        voxel_size=1.5 * mm,
        contact=Contact(friction=friction),
        loads=loads,
    )
    # What moves alike has no friction: with it the whole only creeps, and presses as without.
    part = vs.simulate(design.replace(symmetry=[X]), **TIGHT)
    whole = vs.simulate(design.replace(contact=Contact(friction=0.0)), **TIGHT)
    assert np.abs(part.positions - whole.positions).max() <= SAME * 12 * mm
    [mine], [its] = part.contacts, whole.contacts
    assert mine.of == its.of == ("body", "body")
    # With friction the path has other steps; the default allows 0.3 %.
    assert mine.pressed == pytest.approx(its.pressed, rel=1e-4)
    assert mine.area == pytest.approx(its.area, rel=1e-9)
    assert np.linalg.norm(mine.friction) == 0.0


def gripper(**changes: object) -> vs.Design:
    """Two fingers, images of each other, that close on a cube and hold it against its weight."""
    finger = vs.Design(
        name="finger",
        voxel_size=3 * mm,
        parts=[
            vs.Part(
                shape=vs.Box(size=(6 * mm, 6 * mm, 18 * mm), center=(3 * mm, 0, -9 * mm)),
                material=RUBBER,
            )
        ],
        clamps=[
            vs.Clamp(region=vs.Region(z=(0, 0)), motion=vs.Motion(displacement=(-0.6 * mm, 0, 0)))
        ],
        probes={"tip": vs.Probe(point=(0, 0, -18 * mm))},
    )
    cube = Object(
        name="cube",
        shape=vs.Box(size=(9.9 * mm, 8 * mm, 6 * mm), center=(0, 0, -13.3 * mm)),
        motion="free",
        mass=0.0005,
    )
    given = {
        "name": "gripper",
        "voxel_size": 3 * mm,
        "bodies": [
            Body(name="right", design=finger, position=(5 * mm, 0, 0)),
            Body(name="left", design=finger, mirror="x", position=(-5 * mm, 0, 0)),
        ],
        "objects": [cube],
        "loads": [vs.Gravity()],
        "contact": Contact(friction=0.8),
        "solver": vs.Solver(method="statics"),
    }
    return vs.Design(**(given | changes))


#: A step is kept where friction is off its line by 5 % of its bounds. The sum of forces that press
#: and rub is then off by a part of that: of p sqrt(1 + mu^2), mu^2 / (1 + mu^2) with mu = 0.8.
SLIPPING = 0.05 * 0.8**2 / (1.0 + 0.8**2)


@pytest.mark.parametrize("planes", [[X], pytest.param([X, Y], marks=pytest.mark.slow)])
def test_two_fingers_that_are_images_grip(planes: list[Symmetry]) -> None:
    part = require_same(gripper(), planes, DEFAULT, SLIPPING)
    right, left = (each for each in part.contacts if each.of[1] == "cube")
    assert right.force[2] + left.force[2] == pytest.approx(-0.0005 * 9.81, rel=1e-6)
    assert right.pressure == pytest.approx(left.pressure, rel=1e-12)


@pytest.mark.long
@ONE_OR_TWO
def test_a_plate_presses_over_time(planes: list[Symmetry]) -> None:
    down = vs.Motion(
        displacement=(0, 0, -1 * mm), history=vs.History(time=(0, 0.05), factor=(0, 1))
    )
    design = block(objects=[PLATE.replace(motion=down)], solver=vs.Solver())
    ways = {"end_time": 0.1, "time_step": 0.01}
    part = require_same(design, planes, DEFAULT, **ways)
    whole = vs.simulate(whole_with_symmetric_objects(design, planes), **ways)
    mine, its = part.recording, whole.recording
    assert np.array_equal(mine.times, its.times)
    for name in ("elastic_energy", "kinetic_energy"):
        most = float(getattr(its, name).max())
        assert np.abs(getattr(mine, name) - getattr(its, name)).max() <= 6e-3 * most, name
    for number, (place, turn) in its.objects.items():
        assert np.allclose(mine.objects[number][0], place, rtol=0.0, atol=1e-12)
        assert np.allclose(mine.objects[number][1], turn, rtol=0.0, atol=1e-12)
    for some, other in zip(mine.contacts, its.contacts, strict=True):
        assert [each.of for each in some] == [each.of for each in other]


@pytest.mark.slow
@ONE_OR_TWO
def test_a_balloon_grows_against_a_wall(planes: list[Symmetry]) -> None:
    ball = vs.Sphere(radius=15 * mm) - vs.Sphere(radius=10 * mm)
    wall = vs.Box(size=(80 * mm, 80 * mm, 5 * mm), center=(0, 0, 18.5 * mm))
    design = vs.Design(
        name="balloon",
        voxel_size=5 * mm,
        parts=[vs.Part(shape=ball, material=vs.NeoHookean(young=60 * kPa, poisson=0.49))],
        clamps=[vs.Clamp(region=vs.Region(z=("-inf", -14.9 * mm)))],
        loads=[vs.Pressure(value=10 * kPa)],
        objects=[Object(name="wall", shape=wall)],
        contact=Contact(),
        solver=vs.Solver(control="volume", volume_ratio=1.8, steps=8),
    )
    part = require_same(design, planes, DEFAULT, **TIGHT)
    assert part.contacts[0].pressed > 0.0


@pytest.mark.parametrize(
    ("design", "where", "what"),
    [
        (
            block(
                objects=[
                    PLATE.replace(
                        shape=vs.Box(size=(20 * mm, 20 * mm, 4 * mm), center=(mm, 0, 14 * mm))
                    )
                ]
            ),
            "objects[0]",
            '"plate" has no image across x, "plate" is 2 mm off',
        ),
        (
            block(objects=[PLATE.replace(motion=vs.Motion(displacement=(mm, 0, -1 * mm)))]),
            "objects[0].motion",
            'it moves 2 mm away from "plate", its image across x',
        ),
        (
            pads(motion=vs.Motion(displacement=(0.4 * mm, 0, 0))),
            "objects[0].motion",
            "it moves 0.1 mm",
        ),
        (pads(motion="free", mass=1.0), "objects[0]", "it is not held, or not as heavy, as"),
        (
            pads().replace(contact=Contact(pairs=[{"of": ["body", "left"], "friction": 0.2}])),
            "contact",
            '"body" and "right" touch otherwise than their images across x',
        ),
        (
            block(
                objects=[PLATE],
                contact=Contact(pairs=[{"of": ["body", "plate"], "kind": "bonded"}]),
            ),
            "contact.pairs[0]",
            "is not known together with planes of symmetry yet",
        ),
        (
            gripper(bodies=[gripper().bodies[0]], objects=[]),
            "symmetry[0]",
            'the body "right" has no image across x',
        ),
    ],
)
def test_asymmetric_designs_are_refused(design: vs.Design, where: str, what: str) -> None:
    with pytest.raises(vs.VoxSoftError) as caught:
        Setup.of(design.replace(symmetry=[X]))
    assert what in str(caught.value)
    assert caught.value.problems[0].where == where


@pytest.mark.parametrize("settings", [{"control": "arc-length"}, {"control": "volume"}])
def test_controls_that_are_not_known_are_refused(settings: dict[str, str]) -> None:
    design = block(objects=[PLATE], symmetry=[X], solver=vs.Solver(**settings))
    with pytest.raises(vs.VoxSoftError, match="is not known together with contact"):
        vs.simulate(design)


def test_a_path_beside_a_plane_is_that_of_the_whole() -> None:
    block_with_chamber = vs.Box(size=(12 * mm, 12 * mm, 12 * mm), center=(0, 0, 6 * mm)) - vs.Box(
        size=(6 * mm, 6 * mm, 6 * mm), center=(0, 0, 6 * mm)
    )
    design = block(
        parts=[vs.Part(shape=block_with_chamber, material=RUBBER)],
        objects=[PLATE.replace(motion="fixed")],
        contact=Contact(),
        loads=[vs.Pressure(value=1 * kPa)],
    )
    over = "loads[0].value=0..20 kPa/2"
    whole, part = (vs.follow(each, over) for each in (design, design.replace(symmetry=[X])))
    for its, mine in zip(whole.results, part.results, strict=True):
        assert (its.status, mine.status) == ("ok", "ok")
        # Without friction the triangles of the plate, which is flat, decide nothing.
        assert np.abs(mine.positions - its.positions).max() <= SAME * 12 * mm
        pressed = [each.contacts[0].pressed for each in (mine, its)]
        assert pressed[0] == pytest.approx(pressed[1], rel=SAME_FORCE)
