"""Derivatives of motions: closed forms, differences of whole motions, contact, and other drives."""

from pathlib import Path

import lattice_families as families
import numpy as np
import pytest

import voxsoft as vs
from voxsoft.environments.robots import robot
from voxsoft.errors import DesignError
from voxsoft.simulation.runs.rollout import rollout

EXAMPLES = Path(__file__).parents[2] / "examples"
#: Derivatives of smooth motions against central differences: steps end at residuals of 1e-7.
SMOOTH = 1e-4
#: Derivatives with contact, whose gaps and bounds end within a thousandth.
TOUCHING = 5e-3


def cup():
    return families.cylinder(radius="20 mm", height="30 mm")


def falling():
    """A cube that nothing holds."""
    rubber = vs.NeoHookean(young=1e5, poisson=0.3, density=1000)
    part = vs.Part(shape=vs.Box(size=(0.02, 0.02, 0.02)), material=rubber)
    return vs.Design(
        name="falling",
        voxel_size=0.01,
        parts=[part],
        loads=[vs.Gravity()],
        floor={"z": -10.0},
        contact={"friction": 0.5},
        probes={"middle": {"point": (0.01, 0.01, 0.01)}},
    )


def differences(simulator, knots, name, knot, h, steps, **options):
    """Central differences of all probes by a knot, with steps of the size h."""
    ends = []
    for sign in (1.0, -1.0):
        moved = {each: np.array(values, dtype=float) for each, values in knots.items()}
        moved[name][knot] += sign * h
        simulator.reset()
        found = rollout(simulator, moved, steps=steps, slopes=False, **options)
        ends.append(found.observations)
    return {
        probe: np.array(
            [(a.probes[probe] - b.probes[probe]) / (2 * h) for a, b in zip(*ends, strict=True)]
        )
        for probe in simulator.state.probes
    }


def worst_error(simulator, knots, h, steps, **options):
    """Largest error of any slope, relative to the largest slope by its command."""
    simulator.reset()
    found, worst = rollout(simulator, knots, steps=steps, **options), 0.0
    for name, values in knots.items():
        of = found.slopes[name]
        size = max(np.abs(rows).max() for rows in of.values())
        for knot in range(len(values)):
            expected = differences(simulator, knots, name, knot, h, steps, **options)
            for probe, rows in expected.items():
                worst = max(worst, np.abs(of[probe][:, knot] - rows).max() / size)
    return worst


def test_the_way_of_a_fall_changes_with_gravity_as_galilei_says():
    simulator = vs.Simulator(falling(), damping=0, time_step=0.01)
    found = rollout(simulator, {"gravity": [9.81]}, steps=10, between="held")
    times = np.array([seen.time for seen in found.observations])
    # The first step has two stages of second order, the formula of the others is of second order.
    fall = -0.5 * times**2
    assert found.slopes["gravity"]["middle"][:, 0, 2] == pytest.approx(fall, rel=1e-6)
    assert np.abs(found.end["gravity"][0, :, :2]).max() < 1e-9


def arm():
    """A bar that stands on a plate and is pulled aside."""
    rubber = vs.NeoHookean(young=1e5, poisson=0.3, density=1000)
    return vs.Design(
        name="arm",
        voxel_size=0.01,
        parts=[vs.Part(shape=vs.Box(size=(0.01, 0.01, 0.04)), material=rubber)],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Force(value=(0.01, 0, 0), region=vs.Region(z=(0.04, 0.04)))],
        probes={"tip": {"z": (0.04, 0.04)}},
    )


def test_slopes_by_a_vector_are_those_of_its_components():
    simulator = vs.Simulator(arm())
    knots = {"force": [[0.0, 0.0, 0.0], [0.01, 0.005, 0.0]]}
    found = rollout(simulator, knots, steps=5)
    assert found.slopes["force"]["tip"].shape == (5, 2, 3, 3)
    assert found.end["force"].shape[:2] == (2, 3)
    for axis in range(3):
        expected = differences(simulator, knots, "force", (1, axis), 1e-5, 5)["tip"]
        error = np.abs(found.slopes["force"]["tip"][:, 1, axis] - expected).max()
        assert error < SMOOTH * np.abs(expected).max()
    aside = found.gradient({"tip": [1.0, 0.0, 0.0]})["force"]
    assert aside.shape == (2, 3)
    assert aside[1, 0] > 10.0 * abs(aside[1, 1])


@pytest.mark.long
def test_slopes_know_moved_clamps_and_free_objects():
    simulator = vs.Simulator(vs.load(EXAMPLES / "pinch.toml"), damping=20)
    knots = {
        "gravity": [0.0, 9.81],
        "clamps[0]": [[-2e-4, 0, 0], [-5e-4, 0, 1e-4]],
        "clamps[1]": [[2e-4, 0, 0], [5e-4, 0, 0]],
    }
    found = rollout(simulator, knots, steps=8)
    for name, knot, h in (("gravity", (1,), 1e-2), ("clamps[0]", (1, 2), 1e-7)):
        ends = []
        for sign in (1.0, -1.0):
            moved = {each: np.array(values, dtype=float) for each, values in knots.items()}
            moved[name][knot] += sign * h
            simulator.reset()
            ends.append(rollout(simulator, moved, steps=8, slopes=False).observations[-1].positions)
        expected = (ends[0] - ends[1]) / (2 * h)
        error = np.abs(found.end[name][knot] - expected).max()
        assert error < TOUCHING * np.abs(expected).max()


def test_slopes_are_those_of_differences_without_contact():
    assert worst_error(vs.Simulator(cup()), {"pressure": [500.0, 2000.0, 0.0]}, 1.0, 8) < SMOOTH


def test_held_commands_act_until_the_next_knot():
    simulator = vs.Simulator(cup())
    found = rollout(simulator, {"pressure": [500.0, 2000.0]}, steps=4, between="held")
    assert found.values["pressure"].tolist() == [500.0, 500.0, 2000.0, 2000.0]
    late = found.slopes["pressure"]["top"][:, 1, 2]
    assert (late[:2] == 0.0).all()
    assert (late[2:] > 0.0).all()


def test_the_gradient_is_the_chain_rule():
    found = rollout(vs.Simulator(cup()), {"pressure": [500.0, 2000.0, 0.0]}, steps=5)
    rows = found.slopes["pressure"]["top"]
    last = found.gradient({"top": [0.0, 0.0, 2.0]})["pressure"]
    assert last == pytest.approx(2.0 * rows[-1, :, 2])
    weights = np.random.default_rng(0).normal(size=(5, 3))
    every = found.gradient({"top": weights})["pressure"]
    assert every == pytest.approx(np.einsum("ski,si->k", rows, weights))


def test_derivatives_leave_the_motion_as_it_is():
    knots = {"rear": [0.1, 0.5], "front": [0.3, 0.0]}
    ends = []
    for slopes in (True, False):
        simulator = vs.Simulator(robot("crawl"), damping=10)
        rollout(simulator, knots, steps=4, slopes=slopes)
        ends.append(simulator.step({"rear": 0.2}))
    assert (ends[0].positions == ends[1].positions).all()
    assert (ends[0].velocities == ends[1].velocities).all()


@pytest.mark.long
@pytest.mark.parametrize("friction", [0.0, 0.5, 1.0])
def test_slopes_are_those_of_differences_with_contact(friction):
    design = robot("crawl")
    design = design.replace(contact=design.contact.replace(friction=friction))
    simulator = vs.Simulator(design, damping=10)
    knots = {"rear": [0.15, 0.4], "front": [0.1, 0.3]}
    assert worst_error(simulator, knots, 3e-6, 6) < TOUCHING


@pytest.mark.long
def test_slopes_know_valves_and_sources():
    simulator = vs.Simulator(vs.load(EXAMPLES / "pulsed_finger.toml"), damping=10)
    knots = {"left.source": [2e3, 9e3], "left.valve": [0.6, 0.8]}
    simulator.reset()
    found = rollout(simulator, knots, steps=4)
    for name, h in (("left.source", 1.0), ("left.valve", 1e-4)):
        probe = next(iter(found.slopes[name]))
        rows = found.slopes[name][probe][:, 0]
        expected = differences(simulator, knots, name, 0, h, 4)[probe]
        assert np.abs(rows - expected).max() < SMOOTH * np.abs(expected).max()


@pytest.mark.long
def test_slopes_know_the_friction_of_tendons():
    simulator = vs.Simulator(vs.load(EXAMPLES / "tendon_finger.toml"), damping=10)
    knots = {"flexor": [0.05, 0.2]}
    found = rollout(simulator, knots, steps=4)
    probe = next(iter(found.slopes["flexor"]))
    rows = found.slopes["flexor"][probe][:, 1]
    expected = differences(simulator, knots, "flexor", 1, 1e-5, 4)[probe]
    assert np.abs(rows - expected).max() < SMOOTH * np.abs(expected).max()


def test_damping_that_follows_the_motion_has_no_derivative():
    with pytest.raises(DesignError, match="damping=10"):
        rollout(vs.Simulator(robot("crawl")), {"rear": [0.1]}, steps=1)


@pytest.mark.parametrize(
    ("knots", "words"),
    [
        ({"pull": [1.0]}, "no command"),
        ({"pressure": []}, "shape"),
        ({"pressure": [[1.0, 2.0]]}, "pressure"),
        ({"pressure": [[[1.0]]]}, "shape"),
        ({"pressure": [float("nan")]}, "pressure"),
    ],
)
def test_bad_knots_are_named(knots, words):
    with pytest.raises(DesignError, match=words):
        rollout(vs.Simulator(cup()), knots, steps=2)


def test_bad_weights_are_named():
    found = rollout(vs.Simulator(cup()), {"pressure": [500.0]}, steps=2)
    with pytest.raises(DesignError, match="no probe"):
        found.gradient({"tip": [0, 0, 1]})
    with pytest.raises(DesignError, match=r"give \(3,\) or \(2, 3\)"):
        found.gradient({"top": [0, 1]})


def test_slopes_know_the_drag_of_a_fluid():
    rubber = vs.NeoHookean(young=1e5, poisson=0.3, density=2000)
    sinking = vs.Design(
        name="sinking",
        voxel_size=0.01,
        parts=[vs.Part(shape=vs.Box(size=(0.02, 0.02, 0.02)), material=rubber)],
        loads=[vs.Gravity(), vs.design.Drag(normal=1.0, tangential=0.1)],
        probes={"middle": {"point": (0.01, 0.01, 0.01)}},
    )
    simulator = vs.Simulator(sinking, damping=0, time_step=0.05)
    assert worst_error(simulator, {"gravity": [9.81, 5.0]}, 1e-2, 8) < SMOOTH


@pytest.mark.long
def test_bonds_have_no_derivative_along_a_motion():
    simulator = vs.Simulator(vs.load(EXAMPLES / "squeeze.toml"), damping=10)
    name, command = next(iter(simulator.commands.items()))
    with pytest.raises(DesignError, match="bond"):
        rollout(simulator, {name: [command.design]}, steps=1)


@pytest.mark.parametrize(
    "changes",
    [
        {"floor": {"z": -0.002}},
        {"loads": [vs.Gravity(), vs.design.ForceField(acceleration=("-8*(vx+2*y)", "0", "-3*vz"))]},
    ],
    ids=["floor", "field"],
)
def test_slopes_know_a_floor_and_fields_of_formulas(changes):
    rubber = vs.NeoHookean(young=1e5, poisson=0.3, density=1000)
    sagging = vs.Design(
        name="sagging",
        voxel_size=0.01,
        parts=[vs.Part(shape=vs.Box(size=(0.06, 0.01, 0.01)), material=rubber)],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        probes={"tip": {"x": (0.06, 0.06)}},
        **{"loads": [vs.Gravity()]} | changes,
    )
    simulator = vs.Simulator(sagging, damping=5)
    assert worst_error(simulator, {"gravity": [3.0, 9.81]}, 1e-3, 10) < SMOOTH
