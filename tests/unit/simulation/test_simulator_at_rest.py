"""A simulator's body at rest is the equilibrium of statics, however soft it bends."""

import numpy as np
import pytest

import voxsoft as vs

WALL = vs.Box(size=("72 mm", "15 mm", "18 mm"))
HOLLOW = vs.Box(size=("63 mm", "9 mm", "6 mm"), corner=("3 mm", "3 mm", "9 mm"))
FINGER = vs.Design(
    name="finger",
    voxel_size="3 mm",
    parts=[
        vs.Part(
            shape=WALL - HOLLOW,
            material=vs.NeoHookean(young="100 kPa", poisson=0.45, density=1070.0),
        )
    ],
    clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
    loads=[vs.Pressure(value="6 kPa")],
    probes={"tip": {"x": ("72 mm", "72 mm")}},
)


@pytest.mark.long
@pytest.mark.parametrize("damping", ["critical", 5.0, 400.0])
def test_finger_rests_where_statics_ends(damping):
    """Critically damped, swinging, creeping: pressures that balance hide the force that bends."""
    simulator = vs.Simulator(FINGER, damping=damping)
    seen = simulator.step(simulator.targets)
    while seen.status == "moving" and seen.steps < 1000:
        seen = simulator.step()
    assert seen.status == "at-rest"
    tip = vs.simulate(FINGER).probes["tip"][2]
    # Ten times the tolerance of 1e-4 is allowed along the last step, whose direction changes.
    assert seen.probes["tip"][2] == pytest.approx(tip, rel=5e-3)


@pytest.mark.long
def test_finger_follows_a_slow_wave():
    """A wave of a fifth of a hertz is nearly static: damping that creeps would lag by its size."""
    simulator = vs.Simulator(FINGER)
    seen = simulator.step(simulator.targets)
    while seen.status == "moving":
        seen = simulator.step()
    rest = seen.probes["tip"][2]
    pressures = 6e3 + 100.0 * np.sin(0.4 * np.pi * simulator.time_step * np.arange(1, 126))
    tips = np.array([simulator.step({"pressure": each}).probes["tip"][2] for each in pressures])
    # The slope at rest, and a lag of about 2/ω of the slowest mode, 35 ms of 5 s.
    slope = np.ptp(tips) / np.ptp(pressures)
    static = vs.gradient(vs.simulate(FINGER), {"tip": TIP}, "loads.0.value")["tip"]["loads.0.value"]
    assert slope == pytest.approx(abs(static), rel=0.05)
    lag = np.argmax(np.abs(tips - rest)) - np.argmax(pressures)
    assert 0 <= lag <= 5
    assert seen.status == "at-rest"


TIP = vs.design.Objective(minimize="displacement", probe="tip", axis="z")
