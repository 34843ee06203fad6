"""Cost of a run as `check` estimates it: the iterations are held against runs, not the clock."""

import pytest

import voxsoft as vs
from voxsoft.cli.check import _show_body
from voxsoft.design import Contact, Object
from voxsoft.simulation import Setup, simulate
from voxsoft.simulation.solving.cost import Cost, cost_of, newton_iterations
from voxsoft.units import kPa, mm

RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.49)
WALL = 4 * mm
HOLLOW = vs.Box(size=(24 * mm,) * 3) - vs.Box(size=(16 * mm,) * 3, corner=(WALL,) * 3)
BEAM = vs.Box(size=(100 * mm, 10 * mm, 10 * mm))
BLOCK = vs.Box(size=(20 * mm,) * 3)
LIFT = vs.Force(region=vs.Region(x=(100 * mm, 100 * mm)), value=(0, 0, 1e-3))
PULL = vs.Force(region=vs.Region(x=(100 * mm, 100 * mm)), value=(0.5, 0, 0))
PRESS = vs.Clamp(
    region=vs.Region(x=(20 * mm, 20 * mm)), motion=vs.Motion(displacement=(-4 * mm, 0, 0))
)
#: Name: shape, voxel size in mm, loads, further clamps, settings.
CASES = {
    "a block under its weight": (BLOCK, 4, [vs.Gravity()], [], {}),
    "a block pressed by a fifth": (BLOCK, 4, [], [PRESS], {}),
    "a beam under its weight": (BEAM, 5, [vs.Gravity()], [], {}),
    "a beam hardly lifted": (BEAM, 5, [LIFT], [], {}),
    "a beam pulled": (BEAM, 5, [PULL], [], {}),
    "a chamber": (HOLLOW, 4, [vs.Pressure(value=1 * kPa)], [], {}),
    "a chamber by volume": (
        HOLLOW,
        4,
        [vs.Pressure(value=1 * kPa)],
        [],
        {"control": "volume", "volume_ratio": 1.2, "steps": 4},
    ),
    "a chamber by arc length": (
        HOLLOW,
        4,
        [vs.Pressure(value=2 * kPa)],
        [],
        {"control": "arc-length"},
    ),
}


def made(name):
    shape, size, loads, clamps, settings = CASES[name]
    return vs.Design(
        name="body",
        voxel_size=size * mm,
        parts=[vs.Part(shape=shape, material=RUBBER)],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0))), *clamps],
        loads=loads,
        solver=vs.Solver(**settings),
    )


@pytest.mark.parametrize("name", CASES)
def test_newton_iterations_lie_in_the_range_that_was_reported(name):
    design = made(name)
    setup = Setup.of(design)
    reported = newton_iterations(design, setup.mesh, WALL, setup.problem.mass)
    taken = simulate(setup).steps
    assert reported.low <= taken <= (reported.high or 3 * reported.seconds), reported


def test_friction_is_counted():
    shape = vs.Box(size=(30 * mm, 30 * mm, 4 * mm), center=(10 * mm, 10 * mm, 22 * mm))
    motion = vs.Motion(displacement=(0, 0, -1 * mm))
    plate = Object(name="plate", shape=shape, motion=motion)
    foot = vs.Clamp(region=vs.Region(z=(0, 0)))
    design = made("a block under its weight").replace(
        clamps=[foot], loads=[], objects=[plate], contact=Contact(friction=0.5)
    )
    setup = Setup.of(design)
    reported = newton_iterations(design, setup.mesh, None, setup.problem.mass)
    assert reported.low <= simulate(setup).steps <= 3 * reported.seconds
    assert reported.high is None  # twenty steps, if it may rub itself


def test_a_run_costs_more_the_farther_it_goes_and_the_finer_it_is():
    coarse = made("a beam under its weight")
    setup = Setup.of(coarse)
    cost = {
        factor: cost_of(
            coarse.replace(loads=[vs.Gravity(value=factor)]), setup.mesh, None, setup.problem.mass
        )
        for factor in (0.01, 9.81)
    }
    assert cost[9.81].seconds > 3 * cost[0.01].seconds
    assert cost[0.01].high is not None
    assert cost[9.81].high is None  # the path is not known beforehand
    fine = coarse.replace(solver=vs.Solver(refine=2))
    finer = cost_of(fine, setup.mesh, None, setup.problem.mass)
    assert finer.seconds > 8 * cost[9.81].seconds


def test_the_range_is_reported(capsys):
    report = vs.check(made("a chamber by volume"))
    low, high = report.summary()["seconds_range"]
    assert 0 < low < report.summary()["seconds"]
    assert high is None
    _show_body(report)
    assert "one run: at least" in capsys.readouterr().err
    known = vs.check(made("a block under its weight"))
    assert known.cost.low < known.cost.seconds < known.cost.high
    assert "about" in known.cost.sentence
    assert vs.check(vs.voxels_of(made("a chamber"))).cost is None


def test_runs_over_time_cost_by_their_time():
    short, long = (
        vs.check(made("a block under its weight").replace(solver=vs.Solver(end_time=end))).cost
        for end in (0.1, 1.0)
    )
    assert long.seconds == pytest.approx(10 * short.seconds)
    assert isinstance(long, Cost)
