"""The examples that grip: what they hold, they hold with its weight."""

import pytest

import voxsoft as vs
from voxsoft.units import mm

GRAVITY = 9.81


def gripped(result, name):
    """The contact of the body with an object."""
    (found,) = [each for each in result.contacts if each.of == ("body", name)]
    return found


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


def test_without_enough_friction_it_falls_and_is_named():
    result = vs.simulate(vs.load("examples/pinch.toml").with_parameters(friction=0.02))
    assert result.status == "diverged"
    assert '"plate" falls' in result.message


@pytest.mark.slow
@pytest.mark.parametrize("time_step", ["20 ms", "10 ms"])
def test_fingers_lift_a_cube_and_hold_it(time_step):
    result = vs.simulate(vs.load("examples/gripper.toml"), time_step=time_step)
    assert result.status == "ok"
    assert gripped(result, "cube").force[2] == pytest.approx(-0.05 * GRAVITY, rel=0.01)
    positions = result.recording.objects["cube"][0]
    # The flange goes up by 50 mm; the fingers sag by the weight of what they hold.
    assert positions[-1, 2] - positions[0, 2] == pytest.approx(50 * mm, abs=3 * mm)
    assert not result.penetration.overlaps
