"""One setup that several threads solve: each has the bits that it has alone."""

import threading
from pathlib import Path

import numpy as np
import pytest

import voxsoft as vs
from voxsoft import _core
from voxsoft.design.contact import Contact
from voxsoft.simulation import Setup

EXAMPLES = sorted((Path(__file__).parents[3] / "examples").glob("*.toml"))
#: Design of the quick test: tendons, and a body of a lattice.
QUICK = ("beam", "tendon_finger")
TOP = vs.Region(z=("10 mm", "10 mm"))
#: A block that is pressed on a floor and pushed along it.
RUBBED = vs.Design(
    name="block",
    voxel_size="5 mm",
    parts=[
        vs.Part(
            shape=vs.Box(size=("10 mm", "10 mm", "10 mm")),
            material=vs.NeoHookean(young="60 kPa", poisson=0.45, density=1070.0),
        )
    ],
    clamps=[
        vs.Clamp(region=TOP, axes="xy", motion=vs.Motion(displacement=("2 mm", 0, 0))),
        vs.Clamp(region=TOP, axes="z", motion=vs.Motion(displacement=(0, 0, "-0.5 mm"))),
    ],
    floor=vs.Floor(z=0.0),
    contact=Contact(friction=0.5),
    probes={"foot": vs.Probe(z=(0, 0))},
    solver={"method": "statics", "error": "off"},
)


def named(name):
    return EXAMPLES[0].with_name(f"{name}.toml")


def coarsened(path, times):
    design = vs.load(path)
    return design.replace(voxel_size=times * design.voxel_size)


def in_threads(work, count=2):
    """Results of some threads that begin at the same time."""
    found, ready = [None] * count, threading.Barrier(count)

    def run(number):
        ready.wait()
        try:
            found[number] = work()
        except BaseException as error:  # reported by who asserts
            found[number] = error

    threads = [threading.Thread(target=run, args=(number,)) for number in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return found


def check_shared(design):
    solver = {"end_time": 0.02} if design.solver.is_timed else {}
    alone = vs.simulate(Setup.of(design), **solver)
    shared = Setup.of(design)
    for found in in_threads(lambda: vs.simulate(shared, **solver)):
        assert isinstance(found, vs.Result), found
        assert (found.status, found.steps) == (alone.status, alone.steps)
        assert found.positions.tobytes() == alone.positions.tobytes()
        assert found.reactions.tobytes() == alone.reactions.tobytes()


@pytest.mark.parametrize("name", QUICK)
def test_two_threads_have_the_bits_that_they_have_alone(name):
    check_shared(coarsened(named(name), 2.0))


def test_two_threads_have_the_bits_of_contact_that_they_have_alone():
    check_shared(RUBBED)


@pytest.mark.slow
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_two_threads_have_the_bits_that_they_have_alone_in_every_example(path):
    check_shared(vs.load(path))


def test_candidates_of_one_setup_are_found_in_threads_too():
    setup = Setup.of(coarsened(named("beam"), 2.0))
    alone = [found.positions.tobytes() for found in vs.simulate_many(setup, load_factors=[1, 2])]
    for found in in_threads(lambda: vs.simulate_many(setup, load_factors=[1, 2])):
        assert [each.positions.tobytes() for each in found] == alone


def test_derivatives_and_modes_of_a_result_are_found_in_threads_too():
    design = coarsened(named("beam"), 2.0)
    design = design.with_values("parts.0.material=ecoflex-00-30")
    result = vs.simulate(design, tolerance=1e-10)
    alone = vs.modes(result, 2).frequencies
    for found in in_threads(lambda: vs.modes(result, 2).frequencies):
        assert np.array_equal(found, alone)
    slope = vs.gradient(result, next(iter(design.objectives)), "loads.0.value")
    for found in in_threads(
        lambda: vs.gradient(result, next(iter(design.objectives)), "loads.0.value")
    ):
        assert found == slope


def test_a_progress_may_solve_the_watched_design():
    setup = Setup.of(RUBBED)
    alone, within = vs.simulate(setup), []

    def again(*_):
        if not within:
            within.append(vs.simulate(setup))

    watched = vs.simulate(setup, progress=again)
    assert within
    assert watched.positions.tobytes() == within[0].positions.tobytes() == alone.positions.tobytes()


def test_a_solution_leaves_its_problem_as_it_was():
    setup = Setup.of(RUBBED)
    before = setup.problem.net_forces(setup.mesh.vertices)
    answer = _core.equilibrium(setup.problem, tolerance=1e-8)
    assert np.array_equal(setup.problem.net_forces(setup.mesh.vertices), before)
    # Multipliers that the answer remembers hold the pressed body.
    there = answer.problem.net_forces(answer.positions)
    free = ~np.any(answer.reactions != 0.0, axis=1)
    assert np.abs(there[free]).max() < 1e-6 * np.abs(answer.reactions).max()
    forgotten = setup.problem.net_forces(answer.positions)
    assert np.abs(forgotten[free]).max() > 1e-3 * np.abs(answer.reactions).max()


@pytest.mark.parametrize("work", ["contacts", "net_forces"])
def test_threads_ask_one_answer_at_once(work):
    setup = Setup.of(RUBBED)
    answer = _core.equilibrium(setup.problem, tolerance=1e-8)

    def ask():
        if work == "net_forces":
            return answer.problem.net_forces(answer.positions).tobytes()
        found = _core.contacts_at(answer.problem, answer.positions)
        return [(each.pressed, each.bound, each.slipping) for each in found]

    first, second = in_threads(ask)
    assert first == second == ask()
