"""Bending angles, curvature, softness and frequencies beside closed forms."""

from dataclasses import replace

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design.contact import Contact
from voxsoft.errors import DesignError, SimulationError
from voxsoft.units import kPa, mm

LONG, SIDE, YOUNG, DENSITY = 100 * mm, 10 * mm, 100 * kPa, 1000.0


def bar(**changes):
    design = vs.Design(
        name="bar",
        voxel_size=2.5 * mm,
        parts=[
            vs.Part(
                shape=vs.Box(size=(LONG, SIDE, SIDE)),
                material=vs.NeoHookean(young=YOUNG, poisson=0.3, density=DENSITY),
            )
        ],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        loads=[vs.Gravity(value=1e-6)],
        probes={"base": vs.Probe(x=(0, 0)), "tip": vs.Probe(x=(LONG, LONG))},
    )
    return design.replace(**changes)


@pytest.fixture(scope="module")
def still():
    return vs.simulate(bar())


@pytest.mark.parametrize(("turn", "axis", "sign"), [("y", "y", 1), ("z", "z", 1), ("z", "z", -1)])
def test_a_bar_bent_to_an_arc(turn, axis, sign):
    """Both ends are turned about an axis, so that the bar is an arc but for its ends."""
    angle = sign * np.radians(40.0)
    direction = np.eye(3)["xyz".index(turn)]
    # The middle of the far end, and where an arc of that angle and length takes it.
    middle = np.array([LONG, SIDE / 2, SIDE / 2])
    radius = LONG / angle
    side = np.cross(direction, [1.0, 0, 0])
    arc = np.array([radius * np.sin(angle), 0, 0]) + radius * (1 - np.cos(angle)) * side
    motion = vs.Motion(
        rotation=vs.Rotation(axis=tuple(direction), angle=angle, center=tuple(middle)),
        displacement=tuple(arc - [LONG, 0, 0]),
    )
    clamps = (*bar().clamps, vs.Clamp(region=vs.Region(x=(LONG, LONG)), motion=motion))
    result = vs.simulate(bar(clamps=clamps, loads=()))
    assert result.metric("rotation", probe="tip", axis=axis) == pytest.approx(angle, rel=1e-9)
    assert result.metric("rotation", probe="tip") == pytest.approx(abs(angle), rel=1e-9)
    half = result.metric("chord_angle", probe="tip", base="base", axis=axis)
    assert half == pytest.approx(angle / 2, rel=1e-9)
    assert result.metric("curvature", probe="tip", axis=axis) == pytest.approx(
        angle / LONG, rel=1e-9
    )
    assert result.metric("curvature", probe="tip") == pytest.approx(abs(angle) / LONG, rel=1e-9)


def test_twist_has_its_sign():
    motion = vs.Motion(
        rotation=vs.Rotation(axis=(1, 0, 0), angle="-30 deg", center=(0, SIDE / 2, SIDE / 2))
    )
    clamps = (*bar().clamps, vs.Clamp(region=vs.Region(x=(LONG, LONG)), motion=motion))
    result = vs.simulate(bar(clamps=clamps, loads=()))
    assert result.metric("rotation", probe="tip", axis="x") == pytest.approx(np.radians(-30))


def test_compliance_is_that_of_a_beam(still):
    inertia, area = SIDE**4 / 12, SIDE**2
    shear = YOUNG / 2.6
    bending = LONG**3 / (3 * YOUNG * inertia) + LONG / (5 / 6 * shear * area)
    # The tip in bending, with four voxels across: -0.4 % was measured; along, the clamp holds the
    # section, which stiffens a length of its side by some percent.
    assert still.metric("compliance", probe="tip", axis="z") == pytest.approx(bending, rel=0.01)
    along = LONG / (YOUNG * area)
    assert still.metric("compliance", probe="tip", axis="x") == pytest.approx(along, rel=0.03)
    softest = still.metric("compliance", probe="tip")
    assert softest == pytest.approx(still.metric("compliance", probe="tip", axis="y"), rel=1e-6)
    assert still.metric("stiffness", probe="tip") == pytest.approx(1 / softest)


def test_compliance_is_how_far_a_small_force_moves_a_loaded_bar():
    force = 1e-6
    pushed = vs.Force(region=vs.Region(x=(LONG, LONG)), value=(0, 0, force))
    loaded = bar(loads=[vs.Gravity(value=3.0)])
    before = vs.simulate(loaded, tolerance=1e-12)
    after = vs.simulate(loaded.replace(loads=(*loaded.loads, pushed)), tolerance=1e-12)
    moved = (after.probes["tip"] - before.probes["tip"])[2] / force
    # The force is 1e-5 of the weight: its second order, and rounding, stay below.
    assert before.metric("compliance", probe="tip", axis="z") == pytest.approx(moved, rel=1e-4)


def test_frequencies_are_those_of_a_beam(still):
    inertia, area = SIDE**4 / 12, SIDE**2
    found = vs.modes(still, 6).frequencies
    first = 1.8751**2 / (2 * np.pi) * np.sqrt(YOUNG * inertia / (DENSITY * area)) / LONG**2
    # Shear and the turning of sections lower it by about 0.4 %.
    assert found[0] == pytest.approx(first, rel=0.01)
    assert found[1] == pytest.approx(found[0], rel=1e-6)
    second = first * (4.6941 / 1.8751) ** 2
    assert 0.93 * second < found[2] < 0.97 * second
    assert np.all(np.diff(found) > -1e-9 * found[1:])
    assert still.metric("natural_frequency") == pytest.approx(found[0], rel=1e-6)


def test_a_bar_swings_at_its_frequency():
    """Let go from a small bend, over time: half periods between the turns of the tip."""
    bent = bar(loads=[vs.Gravity(value=0.02)], voxel_size=5 * mm)
    slowest = vs.modes(vs.simulate(bent), 1).frequencies[0]
    timed = vs.simulate(
        bent, method="dynamics", end_time=1.0, time_step=2e-3, damping=0.0, record_interval=2e-3
    )
    sag = timed.recording.probes["tip"][:, 2]
    middle = vs.simulate(bent).probes["tip"][2]
    crossings = np.flatnonzero(np.diff(np.sign(sag - middle)) != 0)
    times = timed.recording.times[crossings]
    # One instant of record either way in half a period of 0.31 s.
    assert np.diff(times).mean() == pytest.approx(0.5 / slowest, rel=0.01)


def test_shapes_are_orthogonal_and_held(still):
    found = vs.modes(still, 4)
    assert np.linalg.norm(found.shapes, axis=2).max(axis=1) == pytest.approx(np.ones(4))
    root = still.mesh.vertices[:, 0] < 1e-9
    assert not found.shapes[:, root].any()


def test_pulling_raises_a_frequency_and_pressing_lowers_it(still):
    slowest = still.metric("natural_frequency")
    for force, raised in ((0.02, True), (-0.005, False)):
        load = vs.Force(region=vs.Region(x=(LONG, LONG)), value=(force, 0, 0))
        result = vs.simulate(bar(loads=[load]))
        assert (result.metric("natural_frequency") > 1.02 * slowest) is raised


def test_a_body_without_modes_is_refused(still):
    with pytest.raises(SimulationError, match="ask for one mode"):
        vs.modes(still, 0)
    # What may touch and does not changes nothing.
    touching = vs.modes(vs.simulate(bar(contact=Contact())), 2).frequencies
    assert touching == pytest.approx(vs.modes(still, 2).frequencies, rel=1e-6)
    moving = {"method": "dynamics", "end_time": 0.01, "time_step": 5e-3}
    with pytest.raises(SimulationError, match="motion over time"):
        vs.modes(vs.simulate(bar(solver=moving)))
    # A design brought to rest by other settings is in equilibrium.
    rested = replace(vs.simulate(bar()), design=bar(solver=moving))
    assert vs.modes(rested, 1).frequencies[0] == pytest.approx(
        still.metric("natural_frequency"), rel=1e-3
    )
    # Buckled: Euler's load is 0.2 N.
    load = vs.Force(region=vs.Region(x=(LONG, LONG)), value=(-0.03, 0, 0))
    with pytest.raises(SimulationError, match="not stable"):
        vs.modes(vs.simulate(bar(loads=[load])))


def test_the_base_of_a_line(still):
    assert still.metric("chord_angle", probe="tip") == pytest.approx(0.0, abs=1e-4)
    for base, words in (("tip", "itself"), ("nowhere", "is not a probe")):
        with pytest.raises(DesignError, match=words):
            still.metric("chord_angle", probe="tip", base=base)
    with pytest.raises(DesignError, match="is not measured along a line"):
        still.metric("displacement", probe="tip", base="base")
