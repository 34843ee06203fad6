"""Contact over time: objects that fall, are pinched, slip, and refusals."""

import numpy as np
import pytest
from gripped import BALL, GRAVITY, bar, dropped, pinched

import voxsoft as vs
from voxsoft.design import Floor, Object, Solver
from voxsoft.errors import DesignError, SimulationError
from voxsoft.simulation import simulate
from voxsoft.units import mm


@pytest.fixture(scope="module")
def landed():
    return simulate(dropped(), end_time=0.3, time_step=0.01)


def test_a_ball_falls_freely_until_it_meets_the_pad(landed):
    times = landed.recording.times
    heights = landed.recording.objects["ball"][0][:, 2]
    falling = times <= 0.025
    # Backward Euler takes the first step, which falls by h²/2 g too far.
    expected = heights[0] - GRAVITY * times**2 / 2.0
    assert falling.sum() >= 2
    assert heights[falling] == pytest.approx(expected[falling], abs=GRAVITY * 0.01**2)
    contacts = landed.recording.contacts
    assert all(not contacts[index] for index in np.flatnonzero(falling))


def test_the_pad_carries_the_weight_of_the_ball_in_the_end(landed):
    assert landed.status == "ok"
    (contact,) = landed.contacts
    assert contact.of == ("body", "ball")
    # It still swings a little.
    assert contact.force[2] == pytest.approx(-0.01 * GRAVITY, rel=0.02)
    assert contact.gap > 0.0
    position = landed.objects["ball"].position
    assert position[:2] == pytest.approx((10 * mm, 10 * mm), abs=0.01 * mm)
    assert landed.recording.objects["ball"][1].shape == (len(landed.recording.times), 3, 3)


def test_a_run_to_rest_ends_where_statics_would():
    rest = simulate(dropped(), method="dynamics", time_step=0.01)
    assert rest.status == "ok"
    assert rest.solver["method"] == "implicit"
    (contact,) = rest.contacts
    assert contact.force[2] == pytest.approx(-0.01 * GRAVITY, rel=1e-3)
    assert rest.residual < 1e-4


def test_free_objects_ask_for_motion_over_time():
    assert simulate(dropped(solver=Solver(time_step="20 ms"))).solver["method"] == "implicit"


@pytest.mark.long
@pytest.mark.parametrize("step", [pytest.param(5e-3, marks=pytest.mark.slow), 20e-3])
def test_a_pinched_object_does_not_creep(step):
    result = simulate(pinched(0.7), end_time=0.6, time_step=step)
    times, heights = result.recording.times, result.recording.objects["capsule"][0][:, 2]
    assert result.status == "ok"
    (contact,) = result.contacts
    assert contact.force[2] == pytest.approx(-0.045 * GRAVITY, rel=1e-3)
    later = heights[times >= 0.4]
    # A tenth of a micrometer a minute, of which this is a third of a hundredth.
    assert np.ptp(later) < 0.1e-6 / 300.0


@pytest.mark.slow
def test_a_pinched_object_slips_at_its_bound():
    # Faces wider than the pads: as it slides nothing changes but the friction.
    block = bar(40 * mm)
    weight = 0.045 * GRAVITY
    friction = 0.05
    for _ in range(2):  # the pads press by a little more or less, as they may bulge
        slipping = simulate(pinched(friction, objects=[block]), end_time=0.05, time_step=5e-3)
        (contact,) = slipping.contacts
        friction = weight / contact.pressed
    held = simulate(pinched(1.04 * friction, objects=[block]), end_time=0.3, time_step=5e-3)
    slid = simulate(pinched(0.96 * friction, objects=[block]), end_time=0.3, time_step=5e-3)
    heights, fallen = (run.recording.objects["block"][0][:, 2] for run in (held, slid))
    # Nothing damps what is left of its start but the step: it swings by some nanometers, where what
    # slips has gone millimeters.
    assert np.ptp(heights[-5:]) < 1e-8
    contact = {contact.of: contact for contact in slid.contacts}[("body", "block")]
    # A slipping object is held by the coefficient times the pressure; bounds are right to 0.3 %.
    pressure = np.sqrt(contact.pressed**2 - contact.force[2] ** 2)
    assert -contact.force[2] == pytest.approx(0.96 * friction * pressure, rel=5e-3)
    steady = slid.recording.times >= 0.15
    fit = np.polyfit(slid.recording.times[steady], fallen[steady], 2)
    expected = -contact.force[2] / 0.045 - GRAVITY
    assert 2.0 * fit[0] == pytest.approx(expected, abs=5e-3 * GRAVITY)
    assert fallen[-1] < -1 * mm


@pytest.mark.slow
def test_an_object_that_slides_out_of_a_grip_falls_freely():
    block = bar(16 * mm)
    # Its upper edge passes the faces of the pads, which bulge out over it.
    result = simulate(pinched(0.01, objects=[block]), end_time=0.24, time_step=5e-3)
    assert result.status == "ok"
    assert result.contacts == ()
    heights = result.recording.objects["block"][0][:, 2]
    rate, before = ((heights[-k] - heights[-k - 1]) / 0.02 for k in (1, 2))
    # Steps of other lengths, which the edges took until 0.17 s, fade from the formula at a third a
    # step.
    assert (rate - before) / 0.02 == pytest.approx(-GRAVITY, rel=1e-4)


def test_an_endless_fall_is_reported_as_such():
    away = Object(name="stone", shape=BALL, motion="free", mass="1 g", voxel_size=3 * mm)
    aside = {"shape": vs.Sphere(radius=6 * mm, center=(60 * mm, 10 * mm, 20 * mm))}
    result = simulate(dropped(objects=[away.replace(**aside)]), end_time=2.0, time_step=0.02)
    assert result.status == "diverged"
    assert 'the object "stone" falls or flies away' in result.message


def test_the_floor_is_one_of_the_objects():
    block = dropped(
        clamps=[],
        objects=[],
        floor=Floor(z=-1 * mm),
        solver=Solver(method="dynamics", time_step="10 ms", damping="critical"),
    )
    result = simulate(block)
    (contact,) = result.contacts
    assert contact.of == ("body", "floor")
    assert contact.force[2] == pytest.approx(result.mass * GRAVITY, rel=1e-3)
    assert result.probes["top"][2] == pytest.approx(-1 * mm, abs=0.05 * mm)
    force = result.metric("contact_force", object="floor", axis="z")
    assert force == pytest.approx(contact.force[2])
    assert result.metric("contact_gap", object="floor") == contact.gap


def test_the_mass_of_an_object_is_that_of_its_density():
    by_density = Object(name="ball", shape=BALL, motion="free", density=2000, voxel_size=2 * mm)
    result = simulate(dropped(objects=[by_density]), method="dynamics", time_step=0.01)
    volume = 4.0 / 3.0 * np.pi * (6 * mm) ** 3
    (contact,) = result.contacts
    # The traced sphere is inscribed: 2 % at three voxels in its radius.
    assert contact.force[2] == pytest.approx(-2000 * volume * GRAVITY, rel=0.03)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"motion": "free"}, "mass: an object that moves freely needs a mass"),
        ({"mass": "1 g"}, "mass: is that of an object that moves freely"),
        ({"motion": "free", "mass": "1 g", "density": 1000}, "mass: is given twice"),
        ({"motion": "free", "mass": "0 g"}, "mass"),
        ({"motion": "free", "mass": "1 g", "name": "floor"}, 'the name "floor" is taken'),
    ],
)
def test_invalid_entries_are_refused_with_their_place(changes, message):
    with pytest.raises(DesignError, match=message):
        dropped(objects=[{"name": "ball", "shape": BALL} | changes])


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"method": "dynamics", "substeps": 4}, "substeps: is a setting of explicit dynamics"),
        ({"method": "xpbd", "end_time": 1}, "the settings mean dynamics by xpbd"),
    ],
)
def test_settings_that_know_no_free_objects_are_refused(settings, message):
    with pytest.raises(SimulationError, match=message):
        simulate(dropped(solver=Solver(**settings)))


def test_two_objects_touch_where_one_of_them_is_free():
    table = Object(
        name="table",
        shape=vs.Box(size=(20 * mm, 20 * mm, 4 * mm), center=(10 * mm, 10 * mm, 30 * mm)),
    )
    ball = vs.Sphere(radius=6 * mm, center=(10 * mm, 10 * mm, 40 * mm))
    both = [table, Object(name="ball", shape=ball, motion="free", mass="10 g", voxel_size=3 * mm)]
    result = simulate(dropped(objects=both), method="dynamics", time_step=0.01)
    found = {contact.of: contact for contact in result.contacts}
    assert found[("table", "ball")].force[2] == pytest.approx(-0.01 * GRAVITY, rel=1e-3)
    assert ("body", "ball") not in found


def test_a_pose_has_the_middle_of_the_box_also_where_mass_is_off_it():
    # A slab with a post on one end, so that its center of mass is off the middle of its box.
    shape = vs.Box(size=(20 * mm, 8 * mm, 4 * mm), center=(10 * mm, 10 * mm, 30 * mm)) | vs.Box(
        size=(4 * mm, 8 * mm, 12 * mm), center=(2 * mm, 10 * mm, 34 * mm)
    )
    odd = Object(name="odd", shape=shape, motion="free", mass="5 g", voxel_size=2 * mm)
    start = (10 * mm, 10 * mm, 34 * mm)
    result = simulate(dropped(objects=[odd]), end_time=0.02, time_step=1e-3)
    assert result.contacts == ()
    fallen = start[2] - result.objects["odd"].position[2]
    assert result.objects["odd"].position[:2] == pytest.approx(start[:2], abs=1e-6)
    assert fallen == pytest.approx(GRAVITY * 0.02**2 / 2.0, rel=0.06)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"floor": Floor(z=1 * mm)}, "floor: is above the lowest point of the body by 1 mm"),
        (
            {"floor": Floor(z=-10 * mm), "objects": ["low"]},
            r"objects\[0\]: is in the floor by",
        ),
        ({"objects": ["ball", "same"]}, r'objects\[1\]: is .* mm deep in "ball" at'),
    ],
)
def test_overlap_at_rest_is_refused(changes, message):
    ball = Object(name="ball", shape=BALL, motion="free", mass="1 g", voxel_size=3 * mm)
    low = vs.Sphere(radius=6 * mm, center=(60 * mm, 10 * mm, -8 * mm))
    named = {
        "ball": ball,
        "same": ball.replace(name="same"),
        "low": ball.replace(name="low", shape=low),
    }
    if "objects" in changes:
        changes = changes | {"objects": [named[name] for name in changes["objects"]]}
    with pytest.raises(DesignError, match=message):
        simulate(dropped(**changes), end_time=0.02)


def test_a_tangent_without_room_says_so(monkeypatch):
    monkeypatch.setattr("voxsoft.simulation.solving.dynamics.memory_limit", lambda: 1000)
    with pytest.raises(SimulationError, match="the tangent of 108 vertices"):
        simulate(dropped(), end_time=0.02)
