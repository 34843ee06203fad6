"""A body that is driven step by step: commands, observations, bits."""

import runpy
from dataclasses import FrozenInstanceError
from pathlib import Path

import lattice_families
import numpy as np
import pint
import pytest

import voxsoft as vs
from voxsoft.design import families
from voxsoft.errors import DesignError, SimulationError

EXAMPLE = Path(__file__).parents[3] / "examples" / "pulse.py"
#: Implicit steps of rubber, and explicit ones of springs.
RUBBER = families.cylinder(radius="20 mm", height="30 mm")
SPRINGS = lattice_families.cylinder(radius="20 mm", height="30 mm")
#: Two states at rest whose residuals are below 1e-4 differ by about as much, the slowest mode last.
SAME = 2e-3


def drive(simulator, steps=25):
    """Pulses of pressure of three sizes."""
    return [simulator.step({"pressure": 500.0 * (step % 3)}) for step in range(steps)]


def assert_same_bits(first, second):
    for one, other in zip(first, second, strict=True):
        assert (one.time, one.steps, one.status) == (other.time, other.steps, other.status)
        np.testing.assert_array_equal(one.positions, other.positions)
        np.testing.assert_array_equal(one.velocities, other.velocities)
        assert one.chambers == other.chambers


@pytest.mark.parametrize("design", [RUBBER, SPRINGS], ids=["rubber", "springs"])
def test_the_same_commands_give_the_same_bits(design):
    simulator = vs.Simulator(design)
    first = [simulator.state, *drive(simulator)]
    other = vs.Simulator(design)
    assert_same_bits(first, [other.state, *drive(other)])
    # And so they do after a reset, from the unloaded shape.
    fresh = simulator.reset()
    np.testing.assert_array_equal(fresh.positions, fresh.result.mesh.vertices)
    assert np.isfinite(fresh.result.residual)
    assert_same_bits(first, [fresh, *drive(simulator)])


@pytest.mark.parametrize("design", [RUBBER, SPRINGS], ids=["rubber", "springs"])
def test_at_rest_it_is_where_simulate_ends(design):
    simulator = vs.Simulator(design)
    seen = simulator.step({"pressure": "1 kPa"})
    assert seen.status == "moving"
    for _ in range(200):
        seen = simulator.step()
    assert seen.status == "at-rest"
    assert seen.residual < 1e-4
    assert seen.time == pytest.approx(201 * 0.02)
    expected = vs.simulate(design.with_values("loads.0.value=1 kPa"))
    moved = np.abs(expected.displacements).max()
    assert np.abs(seen.positions - expected.positions).max() < SAME * moved
    assert seen.probes["top"] == pytest.approx(expected.probes["top"], abs=SAME * moved)
    [chamber] = seen.chambers
    assert chamber.volume == pytest.approx(expected.cavity_volumes[0], rel=1e-4)
    assert chamber.pressure == 1000.0
    # The rise is small beside the largest displacement.
    rise = expected.metrics["rise"]
    assert seen.metrics["rise"] == pytest.approx(rise, abs=SAME * moved)
    assert seen.metric("displacement", probe="top", axis="z") == seen.metrics["rise"]
    assert seen.result.status == "ok"
    assert seen.warnings == expected.warnings


def test_it_follows_time_however_long_the_steps_inside_are():
    """A clamp that rises by 1 mm in 0.1 s and stays: springs pull it along, step by step."""
    bar = vs.Design(
        name="bar",
        voxel_size="5 mm",
        parts=[vs.Part(shape=vs.Box(size=("10 mm", "10 mm", "20 mm")), material=MATERIAL)],
        clamps=[
            vs.Clamp(
                region=vs.Region(z=(0, 0)),
                motion=vs.Motion(
                    displacement=("0 mm", "0 mm", "1 mm"),
                    history=vs.History(time=("0 s", "0.1 s"), factor=(0.0, 1.0)),
                ),
            )
        ],
        probes={"foot": vs.Probe(z=(0, 0))},
    )
    for step in (0.007, 0.02):
        simulator = vs.Simulator(bar, time_step=step)
        assert simulator.loads == ()
        while simulator.state.time < 0.15:
            seen = simulator.step()
            due = 1e-3 * min(seen.time / 0.1, 1.0)
            # The steps inside end within half of one of the time; none is longer than 1 ms here.
            assert seen.probes["foot"][2] == pytest.approx(due, abs=0.6e-3 * 1e-3 / 0.1)


MATERIAL = vs.Lattice(edge=60e3, bulk=400e3, density=1070.0)


def test_without_a_load_it_stays_as_it_is():
    simulator = vs.Simulator(SPRINGS)
    seen = simulator.step()
    assert seen.status == "at-rest"
    assert seen.loads == {"pressure": 0.0}
    # Rounding of a body of 40 mm.
    assert np.abs(seen.positions - simulator.reset().positions).max() < 1e-12


def test_forces_have_three_components_and_gravity_acts_from_the_start():
    beam = families.beam()
    end = vs.Region(x=("100 mm", "100 mm"))
    loads = [*beam.loads, vs.Force(region=end, value=(0.0, 0.0, "1 mN"))]
    simulator = vs.Simulator(beam.replace(loads=loads))
    assert simulator.loads == ("gravity", "force")
    assert simulator.state.loads == {"gravity": 9.81, "force": (0.0, 0.0, 0.0)}
    for _ in range(200):
        seen = simulator.step({"gravity": "2 m/s^2", 1: (0.0, "2 mN", "-1 mN")})
    loads = [vs.Gravity(value=2.0), vs.Force(region=end, value=(0.0, 0.002, -0.001))]
    expected = vs.simulate(beam.replace(loads=loads))
    moved = np.abs(expected.displacements).max()
    assert seen.status == "at-rest"
    assert np.abs(seen.positions - expected.positions).max() < SAME * moved


def test_loads_are_called_by_chamber_kind_or_place():
    fingers = families.cylinder(radius="20 mm", height="30 mm")
    named = fingers.replace(
        chambers={"inside": {"point": (0, 0, "15 mm")}},
        loads=[vs.Pressure(value=0.0, cavity="inside"), vs.Pressure(value=1.0), vs.Gravity()],
    )
    simulator = vs.Simulator(named)
    assert simulator.loads == ("inside", "pressure", "gravity")
    units = pint.UnitRegistry()
    seen = simulator.step({"inside": 1 * units.kPa, "loads[1]": np.float64(500.0), 2: "0 m/s^2"})
    assert seen.loads == {"inside": 1000.0, "pressure": 500.0, "gravity": 0.0}
    assert [(each.name, each.pressure) for each in seen.chambers] == [("inside", 1500.0)]
    twice = fingers.replace(loads=[vs.Pressure(value=1.0), vs.Pressure(value=1.0)])
    assert vs.Simulator(twice).loads == ("loads[0]", "loads[1]")


@pytest.mark.parametrize(
    ("loads", "words"),
    [
        ({"presure": 1.0}, 'commands: "presure" is no command. Try: did you mean "pressure"'),
        (
            {"pressure": "1 mm"},
            r"commands\['pressure'\]: \"1 mm\" is a length; expected a pressure",
        ),
        ({"pressure": float("nan")}, "nan is not a finite number"),
        ({"pressure": float("inf")}, "inf is not a finite number"),
        ({"pressure": (1.0, 2.0, 3.0)}, "is not a quantity"),
        ({"pressure": None}, "is not a quantity"),
        ({7: 1.0}, "7 is no load; there are 1, from 0"),
        ({True: 1.0}, '"True" is no command'),
        ({"pressure": 1.0, 0: 2.0}, "commanded twice"),
        (5.0, "no mapping"),
    ],
)
def test_a_wrong_command_moves_nothing(loads, words):
    simulator = vs.Simulator(RUBBER)
    before = simulator.state
    with pytest.raises(DesignError, match=words):
        simulator.step(loads)
    assert simulator.state is before
    assert simulator.step().loads == {"pressure": 0.0}


def test_too_much_is_reported_and_only_a_reset_leads_on():
    # Springs, which turn inside out: rubber diverges before that.
    simulator = vs.Simulator(SPRINGS)
    statuses = []
    while "diverged" not in statuses:
        assert len(statuses) < 100
        seen = simulator.step({"pressure": -5e3 * len(statuses)})
        statuses.append(seen.status)
        if seen.status == "inverted":
            count = int((seen.result.fields.volume_ratio <= 0.0).sum())
            whole = len(seen.result.fields.volume_ratio)
            assert seen.message == f"{count:,} of {whole:,} voxels are inside out"
            assert any(each.severity == "error" for each in seen.warnings)
    assert "inverted" in statuses
    assert "diverged at (" in seen.message
    assert np.isfinite(seen.positions).all()
    with pytest.raises(SimulationError, match=r"cannot go on from .*: diverged at .*reset\(\)"):
        simulator.step()
    assert simulator.reset().status == "moving"
    assert simulator.step({"pressure": "1 kPa"}).probes["top"][2] > 0


def test_an_observation_stays_as_it_is():
    simulator = vs.Simulator(RUBBER)
    seen = simulator.step({"pressure": 1000.0})
    kept = seen.positions.copy()
    simulator.step({"pressure": 0.0})
    np.testing.assert_array_equal(seen.positions, kept)
    assert seen.metrics["max_displacement"] > 0
    assert seen.loads == {"pressure": 1000.0}
    with pytest.raises(FrozenInstanceError):
        seen.time = 0.0
    with pytest.raises(ValueError, match="read-only"):
        seen.positions[0] = 0.0


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"time_step": 0.0}, "time_step"),
        ({"time_step": "1 mm"}, "time_step: .*is a length"),
        ({"damping": "strong"}, "damping"),
        ({"tolerance": 2.0}, "tolerance"),
    ],
)
def test_settings_that_cannot_be(settings, words):
    with pytest.raises(DesignError, match=words):
        vs.Simulator(RUBBER, **settings)


def test_a_load_with_a_history_follows_it_until_it_is_commanded():
    history = vs.History(time=("0 s", "40 ms"), factor=(0.0, 1.0))
    loads = [vs.Pressure(value="1 kPa", history=history)]
    simulator = vs.Simulator(RUBBER.replace(loads=loads))
    assert simulator.state.loads == {"pressure": 0.0}
    followed = [simulator.step(given).loads["pressure"] for given in (None, None, None)]
    assert followed == pytest.approx([500.0, 1000.0, 1000.0])
    assert simulator.step({"pressure": 200.0}).loads == {"pressure": 200.0}
    assert simulator.step().loads == {"pressure": 200.0}
    simulator.reset()
    assert simulator.step({"pressure": 200.0}).loads == {"pressure": 200.0}
    assert simulator.step().loads == {"pressure": 200.0}


def test_less_damping_lets_it_swing():
    """A beam let go: critically damped it creeps to its rest, hardly damped it swings past."""

    def lowest(damping):
        simulator = vs.Simulator(families.beam(), damping=damping)
        return min(simulator.step().probes["station-9"][2] for _ in range(30))

    # Undamped and linear it would be twice; large bending and 0.6 s of damping leave a fifth.
    assert lowest("1 1/s") < 1.15 * lowest("critical") < 0


def pulses_of_the_example(capsys, monkeypatch):
    monkeypatch.setattr("sys.argv", ["pulse.py"])
    runpy.run_path(str(EXAMPLE))
    _, *lines = capsys.readouterr().out.splitlines()
    rows = [line.split() for line in lines]
    assert [row[0] for row in rows] == ["0", "1", "2", "3", "4"]
    return rows


@pytest.mark.slow
def test_the_example_tells_of_five_pulses(capsys, monkeypatch):
    bends = [float(row[1]) for row in pulses_of_the_example(capsys, monkeypatch)]
    # All pulses after the first begin alike, up to the rest of the one before.
    assert bends[1:] == pytest.approx([bends[1]] * 4, rel=0.02)
    assert bends[1] > 4.0


@pytest.mark.long
def test_the_example_runs_on_a_smaller_body(capsys, monkeypatch):
    cup = RUBBER.replace(probes={"tip": RUBBER.probes["top"]}, objectives={}, constraints={})
    monkeypatch.setattr(families, "pneunet", lambda chambers: cup)
    air = [float(row[5]) for row in pulses_of_the_example(capsys, monkeypatch)]
    expected = vs.simulate(cup.with_values("loads.0.value=2 kPa")).metrics["cavity_volume_change"]
    # Printed in ml, to a thousandth; it hardly moves any more when the valve closes.
    assert air == pytest.approx([1e6 * expected] * 5, abs=2e-3)
    assert len(EXAMPLE.read_text().splitlines()) <= 25
