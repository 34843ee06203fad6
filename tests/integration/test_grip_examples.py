"""The examples that grip: the held objects are held with their weight."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.geometry import rotation_matrix
from voxsoft.units import mm

GRAVITY = 9.81
NAMES = ("first", "second", "third")


def gripped(result, name):
    """The contact of the body with an object."""
    (found,) = [each for each in result.contacts if each.of == ("body", name)]
    return found


@pytest.mark.slow
def test_a_pinched_plate_hangs_on_friction():
    result = vs.simulate(vs.load("examples/pinch.toml"))
    assert result.status == "ok"
    contact = gripped(result, "plate")
    # Forces are in balance to 1e-7 of those that act, of which the pads' are 60 times the weight.
    assert contact.force[2] == pytest.approx(-0.045 * GRAVITY, rel=1e-5)
    heights = result.recording.objects["plate"][0][:, 2]
    # It hangs on pads that give way, and stays where it hangs to the last recorded swing.
    assert -0.2 * mm < heights[-1] < 0.0
    assert abs(heights[-1] - heights[-10]) < 1e-3 * mm


@pytest.mark.slow
def test_without_enough_friction_it_falls_and_is_named():
    result = vs.simulate(vs.load("examples/pinch.toml").with_parameters(friction=0.02))
    assert result.status == "diverged"
    assert '"plate" falls' in result.message


@pytest.mark.long
def test_three_fingers_of_one_file_close_alike():
    """Without a can between them, under a third of the pressure: each in its place as one alone."""
    whole = vs.load("examples/gripper_three.toml").with_parameters(pressure="8 kPa")
    still = {"solver": {"method": "statics"}, "loads": [], "floor": None}
    apart = [body.replace(motion=None) for body in whole.bodies]
    none = {"pairs": [{"of": [a, b], "kind": "none"} for a in NAMES for b in NAMES]}
    fingers = vs.simulate(
        whole.replace(**still, bodies=apart, objects=[], objectives={}, contact=none)
    )
    finger = vs.load("examples/gripper_finger.toml").with_parameters(pressure="8 kPa")
    alone = vs.simulate(finger.replace(solver=still["solver"]))
    assert fingers.status == alone.status == "ok"
    size = np.abs(alone.displacements).max()
    assert size > 0.3 * mm
    for body, angle in zip(fingers.mesh.bodies, (0, 120, 240), strict=True):
        turn = rotation_matrix((0, 0, 1), np.radians(angle))
        own = fingers.displacements[body.vertices] @ turn
        # Both are in balance to the tolerance of statics, 1e-4 of the load, to which displacements
        # are in proportion; Newton's last step leaves far less.
        assert np.abs(own - alone.displacements).max() < 1e-4 * size


@pytest.mark.slow
def test_three_fingers_lift_a_can_and_hold_it():
    result = vs.simulate(vs.load("examples/gripper_three.toml"))
    assert result.status == "ok"
    held = [each for each in result.contacts if each.of[1] == "can"]
    assert [each.of[0] for each in held] == list(NAMES)
    # In balance to 1e-7 of the forces that act; it swings by less than a hundredth of its weight.
    assert sum(each.force[2] for each in held) == pytest.approx(-0.01 * GRAVITY, rel=0.01)
    positions = result.recording.objects["can"][0]
    # The flange goes up by 10 mm; the fingers sag by the weight of the object.
    assert positions[-1, 2] - positions[0, 2] == pytest.approx(10 * mm, abs=0.5 * mm)
    assert not result.penetration.overlaps


@pytest.mark.slow
@pytest.mark.parametrize("time_step", ["20 ms", "10 ms"])
def test_fingers_lift_a_cube_and_hold_it(time_step):
    result = vs.simulate(vs.load("examples/gripper.toml"), time_step=time_step)
    assert result.status == "ok"
    assert gripped(result, "cube").force[2] == pytest.approx(-0.05 * GRAVITY, rel=0.01)
    positions = result.recording.objects["cube"][0]
    # The flange goes up by 50 mm; the fingers sag by the weight of the object.
    assert positions[-1, 2] - positions[0, 2] == pytest.approx(50 * mm, abs=3 * mm)
    assert not result.penetration.overlaps
