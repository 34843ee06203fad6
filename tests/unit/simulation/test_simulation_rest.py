"""The choice between relaxation and statics on the way to rest."""

from types import SimpleNamespace

import lattice_families as families
import numpy as np
import pytest

import voxsoft as vs
from voxsoft._core import Status
from voxsoft.errors import SimulationError
from voxsoft.simulation import Setup
from voxsoft.simulation.solving import rest
from voxsoft.simulation.solving.method import Report
from voxsoft.units import kPa, mm

LATTICE = vs.Lattice(edge=60 * kPa, bulk=400 * kPa, density=1070.0)
#: Two states whose residuals are below 1e-4 of the load differ by about as much of the largest
#: displacement, as the slowest mode converges last; 0.1 % is the bar for every answer.
SAME = 1e-3


def beam(**changes):
    """A beam of 20 x 2 x 2 voxels, for which relaxation takes 4,425 steps."""
    clamp = vs.Clamp(region=vs.Region(x=(0, 0)), **changes)
    return vs.Design(
        name="beam",
        voxel_size=5 * mm,
        parts=[vs.Part(shape=vs.Box(size=(100 * mm, 10 * mm, 10 * mm)), material=LATTICE)],
        clamps=[clamp],
        loads=[vs.Gravity()],
    )


def plain(setup):
    return vs.simulate(setup, method="xpbd")


def assert_same_state(first, second):
    moved = np.abs(second.positions - second.mesh.vertices).max()
    assert np.abs(first.positions - second.positions).max() < SAME * moved


def test_a_slender_body_is_left_to_statics_and_keeps_its_answer():
    setup = Setup.of(beam())
    result = vs.simulate(setup)
    assert (result.solver["method"], result.solver["trial_steps"]) == ("statics", 200)
    assert_same_state(result, plain(setup))


def test_a_squat_body_relaxes_to_the_same_bits():
    setup = Setup.of(families.cylinder())
    result, expected = vs.simulate(setup), plain(setup)
    assert result.solver["way"] == "relaxation"
    assert result.steps == expected.steps
    assert np.array_equal(result.positions, expected.positions)


def test_a_body_between_the_two_goes_on_relaxing():
    setup = Setup.of(families.beam())
    seen = []
    result = vs.simulate(setup, progress=lambda steps, *_: seen.append(steps))
    assert (result.status, result.solver["way"]) == ("ok", "relaxation")
    assert result.steps > rest.TRIAL_STEPS
    assert seen == sorted(seen)
    # It goes on as if nobody had looked, and does not start again.
    expected = plain(setup)
    assert result.steps == expected.steps
    assert np.array_equal(result.positions, expected.positions)


@pytest.mark.parametrize("settings", [{"method": "xpbd"}, {"damping": "auto"}])
def test_who_asks_for_relaxation_gets_it(settings):
    assert vs.simulate(beam(), **settings).solver["way"] == "relaxation"


def test_prescribed_motions_stay_with_relaxation():
    moved = beam(motion=vs.Motion(displacement=(0, 0, 1 * mm)))
    assert vs.simulate(moved).solver["way"] == "relaxation"


def unstable(setup, solver, progress):
    answer = SimpleNamespace(path=SimpleNamespace(stable=False))
    return {}, Report(answer, Status.AT_REST, 0)


def no_memory(setup, solver, progress):
    raise SimulationError("solver.method", "does not fit in memory")


@pytest.mark.parametrize("failing", [unstable, no_memory])
def test_relaxation_goes_on_where_statics_fails(monkeypatch, failing):
    setup = Setup.of(beam())
    monkeypatch.setattr(rest, "find_equilibrium", failing)
    result = vs.simulate(setup)
    assert (result.status, result.solver["way"]) == ("ok", "relaxation")
    assert_same_state(result, plain(setup))
