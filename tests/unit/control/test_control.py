"""Responses, controllers and loops against closed forms, and a simulator against itself."""

import math

import numpy as np
import pytest

import voxsoft as vs
from voxsoft import control
from voxsoft.design import families
from voxsoft.errors import DesignError, SimulationError


def lagging(gain=2.0, constant=0.5, delay=0.2, step=1e-3, duration=5.0):
    """Return the step response of a first-order lag with a delay."""
    times = np.arange(0.0, duration, step)
    values = gain * (1.0 - np.exp(-np.clip(times - delay, 0.0, None) / constant))
    return control.StepResponse("u", "y", "number", 0.0, 1.0, times, values)


def swinging(damping=0.3, frequency=10.0):
    """Return the step response of a damped mass on a spring."""
    times = np.arange(0.0, 6.0, 1e-3)
    turned = frequency * math.sqrt(1.0 - damping**2)
    fade = np.exp(-damping * frequency * times)
    ratio = damping * frequency / turned
    values = 1.0 - fade * (np.cos(turned * times) + ratio * np.sin(turned * times))
    return control.StepResponse("u", "y", "number", 0.0, 2.0, times, values)


@pytest.fixture(scope="module")
def cup():
    """Return a simulator of a small cylinder at rest."""
    return vs.Simulator(families.cylinder(radius="20 mm", height="30 mm"))


def test_first_order_response_gives_its_constants_back():
    gain, constant, delay = lagging().first_order
    # The formulas are rounded: 0.67 (1.917 - 0.435) = 0.993, 1.3 0.435 - 0.29 1.917 = 0.01,
    # 1.3 - 0.29 = 1.01.
    assert gain == pytest.approx(2.0, rel=1e-3)  # e^-9.6 is left
    assert constant == pytest.approx(0.5, rel=0.01)
    assert delay == pytest.approx(0.2, abs=0.0102 * (0.5 + 0.2))


def test_figures_of_a_response_are_those_of_closed_forms():
    lag = lagging(delay=0.0)
    assert lag.rise_time == pytest.approx(0.5 * math.log(9.0), rel=1e-3)
    assert lag.settling_time == pytest.approx(0.5 * math.log(50.0), abs=2e-3)
    assert lag.overshoot == 0.0
    swing = swinging()
    assert swing.gain == pytest.approx(0.5, rel=1e-6)
    assert swing.overshoot == pytest.approx(math.exp(-math.pi * 0.3 / math.sqrt(0.91)), rel=1e-4)


def test_tuned_controller_follows_the_simc_rules():
    response = lagging()
    gain, constant, delay = response.first_order
    delay += 0.5e-3
    pid = control.PIDController.tuned(response)
    assert pid.gain == pytest.approx(constant / (gain * 2.0 * delay))
    assert pid.integral_time == pytest.approx(min(constant, 8.0 * delay))
    slow = control.PIDController.tuned(response, closed_loop_time=5.0)
    assert slow.gain == pytest.approx(constant / (gain * (5.0 + delay)))


def run(controller, targets, step=0.05, gain=2.0, constant=0.5, push=0.0):
    """Return values and commands of a first-order lag under a controller."""
    value, values, commands = 0.0, [], []
    controller.start(step, 0.0)
    padded = np.append(targets, np.full(controller.preview, targets[-1]))
    for index in range(len(targets)):
        ahead = padded[index : index + controller.preview]
        given = controller.command(ahead, value)
        value += (gain * given + push - value) * (1.0 - math.exp(-step / constant))
        values.append(value)
        commands.append(given)
    return np.array(values), np.array(commands)


def test_integral_removes_the_offset_of_a_disturbance():
    values, _ = run(control.PIDController(1.0, 0.5), np.ones(400), push=0.3)
    assert values[-1] == pytest.approx(1.0, abs=1e-6)
    only_gain, _ = run(control.PIDController(1.0), np.ones(400), push=0.3)
    # At rest y = (K g r + d)/(1 + K g).
    assert only_gain[-1] == pytest.approx(2.3 / 3.0, abs=1e-6)


def test_bound_command_does_not_wind_up():
    # 2 u cannot reach 3 with u <= 1; then the target drops within reach.
    targets = np.r_[np.full(200, 3.0), np.full(100, 1.0)]
    values, commands = run(control.PIDController(2.0, 0.2, high=1.0, low=0.0), targets)
    assert commands[:200].max() == 1.0
    # Without back-calculation the integral of 10 s of errors above 1 holds the bound for seconds.
    assert commands[200:204].min() < 1.0
    assert values[-1] == pytest.approx(1.0, abs=1e-3)


def test_derivative_acts_on_the_value_and_not_on_the_target():
    pid = control.PIDController(1.0, derivative_time=1.0)
    pid.start(0.1, 0.0)
    assert pid.command([5.0], 0.0) == pytest.approx(5.0)
    assert pid.command([5.0], 0.1) == pytest.approx(4.9 - 1.0)


def test_feed_forward_starts_without_a_bump():
    pid = control.PIDController(1.0, 1.0, feedforward=lambda target: 10.0 * target)
    pid.start(0.1, 0.2, 2.5)
    assert pid.command([0.2], 0.2) == pytest.approx(2.5)


def test_predictive_controller_follows_targets_within_reach():
    lag = lagging(delay=0.0, step=0.05, duration=8.0)
    controller = control.PredictiveController(
        lag, horizon=20, moves=20, effort=1e-12, low=-9.0, high=9.0
    )
    targets = 1.0 - np.cos(np.linspace(0.0, 6.0, 120))
    values, _ = run(controller, targets)
    assert np.abs(values - targets).max() < 1e-5


def test_predictive_controller_keeps_bounds_and_leaves_no_offset():
    lag = lagging(delay=0.0, step=0.05, duration=8.0)
    controller = control.PredictiveController(lag, low=0.0, high=0.6)
    values, commands = run(controller, np.ones(200), push=0.2)
    assert commands.min() >= 0.0
    assert commands.max() == pytest.approx(0.6)
    assert values[-1] == pytest.approx(1.0, abs=1e-6)


def test_predictive_controller_refuses_other_steps_and_long_horizons():
    lag = lagging(step=0.05)
    with pytest.raises(DesignError, match=r"steps of 0\.05 s"):
        control.PredictiveController(lag).start(0.02)
    with pytest.raises(DesignError, match="watch it longer"):
        control.PredictiveController(lag, horizon=1000)


def stiff_chamber():
    """Return a simulator of a box that hardly gives: air flows in by a valve and out by a leak."""
    wall = vs.Box(size=("30 mm", "30 mm", "30 mm"))
    inside = vs.Box(size=("20 mm", "20 mm", "20 mm"), corner=("5 mm", "5 mm", "5 mm"))
    rubber = vs.NeoHookean(young="50 MPa", poisson=0.3, density=1070.0)
    design = vs.Design(
        name="box",
        voxel_size="5 mm",
        parts=[vs.Part(shape=wall - inside, material=rubber)],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        chambers={"air": {"point": ("15 mm", "15 mm", "15 mm")}},
        supplies=[
            {
                "kind": "flow",
                "chamber": "air",
                "source": "20 kPa",
                "valve": {"conductance": "0.02 L/s/bar"},
                "leak": {"conductance": "0.02 L/s/bar"},
            }
        ],
    )
    simulator = vs.Simulator(design)
    for _ in range(150):
        simulator.step({"air.valve": 1.0, "air.source": "20 kPa", "air.leak": 1.0})
    return simulator


@pytest.mark.long
def test_frequency_response_is_the_transform_of_the_step_response():
    """A small change of the source fills the chamber linearly: H is the sum of its increments."""
    box = stiff_chamber()
    asked = {"output": "chambers.air.pressure"}
    found = control.frequency_response(
        box, "air.source", around=20e3, amplitude=10.0, frequencies=[0.5, 1.5, 2.6], **asked
    )
    # 2.6 Hz goes to an odd multiple of 0.5 Hz.
    assert found.frequencies == pytest.approx([0.5, 1.5, 2.5])
    step = control.step_response(box, "air.source", to=20.01e3, duration=3.0, **asked)
    _, constant, _ = step.first_order
    increments = np.diff(step.values) / 10.0
    for frequency, response in zip(found.frequencies, found.response, strict=True):
        expected = np.sum(increments * np.exp(-2j * np.pi * frequency * step.times[1:]))
        # The step begins by another formula than steps of waves: both are of second order.
        assert abs(response - expected) < (box.time_step / constant) ** 2
    assert found.distortion < 1e-3


def test_figures_of_a_frequency_response_are_those_of_a_lag():
    frequencies = np.geomspace(1e-3, 100.0, 200)
    lag = 5.0 / (1.0 + 1j * frequencies / 2.0)
    found = control.FrequencyResponse("u", "y", "number", 0.0, 1.0, frequencies, lag, 0.0)
    # Half of the power is 3.0103 dB.
    assert found.bandwidth == pytest.approx(2.0 * math.sqrt(10.0**0.3 - 1.0), rel=1e-3)
    assert found.phase == pytest.approx(-np.arctan(frequencies / 2.0))
    assert found.decibels[0] == 0.0


@pytest.mark.long
def test_loop_holds_its_target_under_a_disturbance(cup):
    response = control.step_response(
        cup, "pressure", to=500.0, output="probes.top[2]", duration=0.4
    )
    own = cup.copy()
    tracked = control.track(
        own,
        control.PIDController.tuned(response, high=5e3),
        lambda time: 40e-6,
        "pressure",
        "probes.top[2]",
        duration=1.0,
    )
    assert abs(tracked.errors[-1]) < 1e-3 * 40e-6
    assert tracked.error(after=0.9) < 1e-3 * 40e-6
    assert own.state.time == pytest.approx(1.0)
    assert tracked.commands.min() >= 0.0
    assert cup.state.time == 0.0


def test_unknown_quantities_and_commands_are_named(cup):
    asked = {"to": 1.0, "duration": 0.1}
    with pytest.raises(DesignError, match="has 3 components"):
        control.step_response(cup, "pressure", output="probes.top", **asked)
    with pytest.raises(DesignError, match="none of the probes"):
        control.step_response(cup, "pressure", output="probes.tip[2]", **asked)
    with pytest.raises(DesignError, match="pressur"):
        control.step_response(cup, "pressur", output="probes.top[2]", **asked)
    with pytest.raises(SimulationError, match="does not change"):
        control.step_response(cup, "pressure", output=lambda seen: 0.0, **asked)
    with pytest.raises(DesignError, match="shorter time_step"):
        control.frequency_response(
            cup,
            "pressure",
            around=0.0,
            amplitude=1.0,
            output="probes.top[2]",
            frequencies=[1.0, 20.0],
        )
