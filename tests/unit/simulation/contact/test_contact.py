"""Contact in equilibrium: objects that press, slits that close, and refusals."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Contact, ContactPair, Object, Solver
from voxsoft.errors import DesignError, SimulationError
from voxsoft.files import load, save
from voxsoft.simulation import Setup, simulate
from voxsoft.simulation.runs.state import result_at
from voxsoft.simulation.setup.rigid_objects import surface_of
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.outputs.html import page_of_body
from voxsoft.units import kPa, mm

SIDE, PRESS = 12 * mm, 1.5 * mm
RUBBER = vs.NeoHookean(young=100 * kPa, poisson=0.45)
BLOCK = vs.Box(size=(SIDE, SIDE, SIDE))


def plate(bottom):
    """A box above the block, as wide as the block is after it has bulged, and its height."""
    return vs.Box(size=(20 * mm, 20 * mm, 4 * mm), center=(SIDE / 2, SIDE / 2, bottom + 2 * mm))


def pressed(bottom=SIDE + 0.5 * mm, way=-PRESS - 0.5 * mm, **changes):
    """A block under a plate that comes down on it."""
    down = vs.Motion(displacement=(0, 0, way))
    whole = {
        "name": "pressed",
        "voxel_size": 4 * mm,
        "parts": [vs.Part(shape=BLOCK, material=RUBBER)],
        "clamps": [vs.Clamp(region=vs.Region(z=(0, 0)))],
        "objects": [Object(name="plate", shape=plate(bottom), motion=down)],
        "probes": {"top": vs.Probe(z=(SIDE, SIDE))},
    }
    return vs.Design(**(whole | changes))


@pytest.fixture(scope="module")
def result():
    return simulate(pressed())


def test_a_plate_presses_as_a_clamp_does_that_leaves_the_sides_free(result):
    top = vs.Clamp(
        region=vs.Region(z=(SIDE, SIDE)),
        axes="z",
        motion=vs.Motion(displacement=(0, 0, -PRESS)),
    )
    foot = vs.Clamp(region=vs.Region(z=(0, 0)))
    clamped = simulate(pressed(objects=[], clamps=[foot, top]))
    expected = clamped.reactions[clamped.mesh.vertices[:, 2] > SIDE - 1e-9, 2].sum()
    (contact,) = result.contacts
    assert result.status == "ok"
    assert contact.of == ("body", "plate")
    # The clearance is 1e-4 voxels, and the traced plate flat to 1e-3 of them: 4 µm of 1.5 mm.
    assert contact.force[2] == pytest.approx(expected, rel=5e-3)
    assert contact.area == pytest.approx(SIDE**2, rel=1e-9)
    assert 0.0 < contact.gap < 1e-3 * 4 * mm
    assert result.probes["top"][2] == pytest.approx(-PRESS, abs=8e-6)


def test_forces_balance_and_the_plate_is_where_it_was_sent(result):
    (contact,) = result.contacts
    # The foot carries the force of the plate, and nothing else does.
    foot = result.reactions[:, 2].sum()
    assert foot == pytest.approx(-contact.force[2], rel=1e-6)
    assert result.residual < 1e-6
    pose = result.objects["plate"]
    assert pose.position[2] == pytest.approx(SIDE + 2 * mm - PRESS, abs=1e-5)
    assert np.array(pose.rotation) == pytest.approx(np.eye(3), abs=1e-12)
    summary = result.summary()
    assert summary["contacts"][0]["of"] == ["body", "plate"]
    assert summary["objects"]["plate"]["position"][2] == pose.position[2]
    assert "body touches plate with" in str(result)


def test_friction_keeps_the_top_from_bulging(result):
    rough = simulate(pressed(contact=Contact(friction=5.0)))
    (smooth,), (held,) = result.contacts, rough.contacts
    assert held.slipping < 0.05
    assert abs(held.force[2]) > 1.02 * abs(smooth.force[2])


def test_a_pair_that_does_not_touch_passes_through():
    free = ContactPair(of=("body", "plate"), kind="none")
    found = simulate(pressed(contact=Contact(pairs=(free,))))
    assert found.contacts == ()
    assert abs(found.probes["top"][2]) < 1e-12


def slit(contact):
    """Two lips with a gap of one voxel between them; the upper one is pressed down."""
    size = 2 * mm
    lips = vs.Box(size=(20 * mm, 4 * mm, 10 * mm)) - vs.Box(
        size=(16 * mm, 4 * mm, size), center=(12 * mm, 2 * mm, 5 * mm)
    )
    down = vs.Motion(displacement=(0, 0, -1.5 * size))
    return vs.Design(
        name="slit",
        voxel_size=size,
        parts=[vs.Part(shape=lips, material=RUBBER)],
        clamps=[
            vs.Clamp(region=vs.Region(z=(0, 0))),
            vs.Clamp(region=vs.Region(x=(14 * mm, 16 * mm), z=(10 * mm, 10 * mm)), motion=down),
        ],
        contact=contact,
    )


def test_lips_of_a_slit_meet_and_do_not_pass_through_each_other():
    through, kept = simulate(slit(None)), simulate(slit(Contact()))
    assert through.penetration.depth > 0.1 * mm
    assert kept.status == "ok"
    # The contact surfaces are the bilinear faces of voxels; the test for overlaps takes each as two
    # triangles, which stand out of a face that is warped.
    assert kept.penetration.depth < 0.01 * 2 * mm
    (contact,) = kept.contacts
    assert contact.of == ("body", "body")
    assert contact.pressed > 0.0


def test_a_design_with_contact_is_saved_and_read_back(tmp_path):
    design = pressed(contact=Contact(friction=0.5, pairs=[{"of": ["body", "plate"]}]))
    file = tmp_path / "pressed.toml"
    save(design, file)
    assert load(file) == design


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"contact": {"friction": -0.1}}, "friction"),
        ({"contact": {"pairs": [{"of": ["body", "plat"]}]}}, 'no object "plat".*"plate"'),
        ({"objects": [{"name": "body", "shape": BLOCK}]}, 'the name "body" is taken'),
        ({"objects": [{"name": "a", "shape": "nothing"}]}, "nothing"),
    ],
)
def test_invalid_entries_are_refused_with_their_place(changes, message):
    with pytest.raises(DesignError, match=message):
        pressed(**changes)


def test_an_object_in_the_unloaded_body_is_refused_with_its_depth():
    with pytest.raises(DesignError, match=r"objects\[0\]: is 1(\.0\d*)? mm deep in the body at"):
        simulate(pressed(bottom=SIDE - 1 * mm))


def test_an_object_that_no_vertex_of_the_body_is_in_is_refused_too():
    bead = Object(
        name="bead",
        shape=vs.Sphere(radius=1 * mm, center=(6 * mm, 6 * mm, 6 * mm)),
        voxel_size=0.5 * mm,
    )
    with pytest.raises(DesignError, match=r"objects\[0\]: is .* mm deep in the body at"):
        simulate(pressed(objects=[bead]))


def test_an_object_may_touch_the_unloaded_body():
    found = simulate(pressed(bottom=SIDE, way=-0.5 * mm))
    assert found.status == "ok"
    assert found.probes["top"][2] == pytest.approx(-0.5 * mm, abs=8e-6)


@pytest.mark.parametrize(
    "settings",
    [
        {"method": "xpbd", "end_time": "0.1 s"},
        {"method": "relaxation"},
    ],
)
def test_methods_that_know_no_contact_refuse_it(settings):
    with pytest.raises(SimulationError, match="found by statics and by implicit dynamics"):
        simulate(pressed(solver=Solver(**settings)))


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_an_arc_along_which_a_plate_moves_ends_where_load_control_does(friction):
    by_load = simulate(pressed(contact=Contact(friction=friction)))
    # With friction a step takes at most a twentieth of the way.
    arc = Solver(control="arc-length", steps=60)
    by_arc = simulate(pressed(contact=Contact(friction=friction), solver=arc))
    assert by_arc.status == "ok", by_arc.message
    assert by_arc.load_factor == 1.0
    assert by_arc.limit_factor is None
    assert by_arc.stable is True
    off = np.abs(by_arc.positions - by_load.positions).max()
    # The clearance of contact is 1e-4 voxels; friction depends on the steps, in each of which the
    # plate moves so far.
    step = abs(by_load.probes["top"][2]) / 20
    assert off < (1e-4 * by_load.design.voxel_size if friction == 0.0 else step)


def test_solvers_without_contact_say_so(result):
    with pytest.raises(DesignError, match="objects: is not known to states"):
        result_at(Setup.of(pressed()), result.positions)
    lattice = vs.Part(shape=BLOCK, material=vs.Lattice(edge=25 * kPa, bulk=100 * kPa))
    with pytest.raises(DesignError, match="objects: is not known to exported pages"):
        page_of_body(StudioBody.of(pressed(parts=[lattice]), 1, 1))


def test_a_side_of_an_object_that_goes_through_samples_is_there():
    """The plate's faces are samples of a grid of 3 mm; it had neither top nor bottom."""
    found = simulate(pressed(voxel_size=3 * mm))
    (contact,) = found.contacts
    # With voxels of 4, 2.4 and 2 mm it is 2.249, 2.249 and 2.247 N.
    assert contact.force[2] == pytest.approx(-2.248, abs=0.005)
    surface = surface_of(found.design.objects[0], found.design, "objects[0]")
    ends = np.sort(surface.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(ends, axis=0, return_counts=True)[1] == 2).all()  # closed


@pytest.mark.slow
def test_a_path_that_ends_early_proposes_a_control_with_contact():
    # The plate ends 0.3 mm below the ground that the block stands on.
    result = simulate(pressed(way=-SIDE - 0.8 * mm))
    assert result.status == "not-at-rest"
    assert 'control = "arc-length"' in result.message
    assert "xpbd" not in result.message
    assert 'method = "dynamics"' in result.message


@pytest.mark.parametrize("what", ["floor", "plate"])
def test_a_clamped_end_may_lie_on_a_touched_object(what):
    # Clamped vertices that touch to the last bit are not the clearance apart, and never will be.
    side = 10 * mm
    below = {"floor": {"z": 0.0}}
    if what == "plate":
        plate = vs.Box(size=(60 * mm, 30 * mm, 5 * mm), corner=(-10 * mm, -10 * mm, -5 * mm))
        below = {"objects": [{"name": "plate", "shape": plate, "motion": "fixed"}]}
    design = vs.Design(
        name="lying",
        voxel_size=side / 2,
        parts=[
            vs.Part(
                shape=vs.Box(size=(20 * mm, side, side)),
                material=vs.NeoHookean(young=60 * kPa, poisson=0.45, density=1070.0),
            )
        ],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        loads=[vs.Gravity()],
        contact={"friction": 0.3},
        **below,
    )
    result = vs.simulate(design)
    assert result.status == "ok", result.message
    lowest = result.positions[:, 2].min()
    assert -1e-4 * design.voxel_size < lowest
    [contact] = result.contacts
    assert 0 < contact.force[2] < result.mass * 9.81
