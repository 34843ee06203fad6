"""Commands of a simulator: every drive by name, sensors, and what is remembered."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import (
    Dielectric,
    Drag,
    ForceField,
    Immersion,
    MassSupply,
    Object,
    ShapeMemory,
    Strain,
    VolumeSupply,
)
from voxsoft.design.supply import FlowSupply, PressureSupply
from voxsoft.errors import DesignError, SimulationError
from voxsoft.simulation import Sensor

RUBBER = vs.NeoHookean(young="60 kPa", poisson=0.45, density=1070.0)
SIDE = 10e-3
#: A cantilever of four voxels along x.
BEAM = vs.Design(
    name="beam",
    voxel_size="5 mm",
    parts=[vs.Part(name="soft", shape=vs.Box(size=("40 mm", SIDE, SIDE)), material=RUBBER)],
    clamps=[vs.Clamp(name="wall", region=vs.Region(x=(0, 0)))],
    probes={"tip": vs.Probe(x=("40 mm", "40 mm"))},
)
#: A block with a cubic chamber.
BLOCK = vs.Design(
    name="block",
    voxel_size="5 mm",
    parts=[
        vs.Part(
            shape=vs.Box(size=("20 mm", "20 mm", "20 mm"))
            - vs.Box(size=(SIDE, SIDE, SIDE), corner=("5 mm", "5 mm", "5 mm")),
            material=RUBBER,
        )
    ],
    clamps=[vs.Clamp(name="foot", region=vs.Region(z=(0, 0)))],
    chambers={"c": vs.Chamber(point=("10 mm", "10 mm", "10 mm"))},
    probes={"top": vs.Probe(z=("20 mm", "20 mm"))},
)
LINE = {"through": [[0, "5 mm", "8 mm"], ["40 mm", "5 mm", "8 mm"]], "name": "flexor"}
PLATE = Object(
    name="plate",
    shape=vs.Box(size=("15 mm", "14 mm", "5 mm"), corner=("30 mm", "-2 mm", "11 mm")),
    motion=vs.Motion(),
)
WIRE = ShapeMemory(
    part="soft",
    value="350 K",
    strain="-4 %",
    heating=("340 K", "350 K"),
    cooling=("330 K", "320 K"),
)
VALVE = {"conductance": "1e-3 L/s/bar"}
#: Each way to drive: a design, and commands that are not those of the first state.
DRIVES = {
    "pressure": (BLOCK.replace(supplies=[PressureSupply(chamber="c", value="2 kPa")]), {"c": 1500}),
    "volume": (BLOCK.replace(supplies=[VolumeSupply(chamber="c", value="0.3 mL")]), {"c": 2e-7}),
    "mass": (BLOCK.replace(supplies=[MassSupply(chamber="c")]), {"c.temperature": 310.0}),
    "flow": (
        BLOCK.replace(supplies=[FlowSupply(chamber="c", source="10 kPa", valve=VALVE)]),
        {"c.valve": 0.5, "c.source": "8 kPa"},
    ),
    "tension": (BEAM.replace(tendons=[{**LINE, "tension": "0.1 N"}]), {"flexor": "0.05 N"}),
    "shortening": (
        BEAM.replace(tendons=[{**LINE, "shortening": "1 mm", "friction": 0.1}]),
        {"flexor": "0.5 mm"},
    ),
    "length": (BEAM.replace(tendons=[{**LINE, "length": "39 mm"}]), {"flexor": "39.5 mm"}),
    "strain": (
        BEAM.replace(activations=[Strain(part="soft", value=0.02)]),
        {"soft": 0.01},
    ),
    "memory": (BEAM.replace(activations=[WIRE]), {"soft": "345 K"}),
    "dielectric": (
        BEAM.replace(
            activations=[
                Dielectric(part="soft", value="10 MV/m", permittivity=2.8, normal=(0, 0, 1))
            ]
        ),
        {"soft": "8 MV/m"},
    ),
    "clamp": (
        BEAM.replace(
            clamps=[
                BEAM.clamps[0].replace(
                    motion=vs.Motion(rotation={"axis": (0, 1, 0), "angle": "10 deg"})
                )
            ]
        ),
        {"wall.displacement": (0, 0, "1 mm"), "wall.angle": "5 deg"},
    ),
    "object": (BEAM.replace(objects=[PLATE]), {"plate": (0, 0, "-2 mm")}),
}


def bits(seen):
    return (
        seen.time,
        seen.status,
        seen.positions.tobytes(),
        seen.velocities.tobytes(),
        seen.chambers,
        dict(seen.commands),
        seen.power,
        {name: sample.tobytes() for name, sample in seen.sensors.items()},
    )


def run(simulator, commands, steps):
    return [simulator.step(commands if step == 0 else None) for step in range(steps)]


@pytest.mark.parametrize("name", DRIVES)
def test_a_drive_is_off_until_it_is_commanded_and_repeats_to_the_bit(name):
    design, commands = DRIVES[name]
    simulator = vs.Simulator(design)
    still = simulator.step()
    assert np.abs(still.positions - still.result.mesh.vertices).max() < 1e-9
    first = simulator.step(commands)
    mid = run(simulator, None, 2)[-1]
    assert np.abs(first.positions - still.positions).max() > 1e-6
    other = simulator.targets
    later = [*run(simulator, None, 2), *run(simulator, other, 3), *run(simulator, None, 2)]
    assert simulator.restore(mid) is mid is simulator.state is simulator.observation
    copied = simulator.copy()
    # Forces of the last step too, by which the energy of the next one is judged.
    assert copied._live.memory() == mid._moment.memory
    again = [*run(simulator, None, 2), *run(simulator, other, 3), *run(simulator, None, 2)]
    assert [bits(each) for each in again] == [bits(each) for each in later]
    also = [*run(copied, None, 2), *run(copied, other, 3), *run(copied, None, 2)]
    assert [bits(each) for each in also] == [bits(each) for each in later]


@pytest.mark.long
@pytest.mark.parametrize("name", [name for name in DRIVES if name != "mass"])
def test_all_drives_at_their_targets_rest_where_the_design_does(name):
    design, _ = DRIVES[name]
    simulator = vs.Simulator(design)
    # On the way, so that a path that matters is that of the design.
    share = 0.0
    for _ in range(10):
        share += 0.1
        way = {
            key: tuple(np.asarray(each.first) + share * (np.asarray(each.design) - each.first))
            if each.shape
            else each.first + share * (each.design - each.first)
            for key, each in simulator.commands.items()
        }
        seen = simulator.step(way)
    seen = simulator.step(simulator.targets)
    while seen.status == "moving" and seen.time < 20.0:
        seen = simulator.step()
    assert seen.status == "at-rest"
    expected = vs.simulate(design, method="statics")
    assert expected.status == "ok"
    moved = np.abs(expected.displacements).max()
    # Residuals below 1e-4 of the load, of which a slender body makes ten times as much motion.
    allowed = 5e-3 * moved + 1e-9
    if any(tendon.friction for tendon in design.tendons):
        # A line that settles slides back at its bends, which then hold it from the other side:
        # rest is between that of statics and its mirror image at the place without friction.
        free = [tendon.replace(friction=0.0) for tendon in design.tendons]
        middle = vs.simulate(design.replace(tendons=free), method="statics")
        allowed += 2.0 * np.abs(middle.positions - expected.positions).max()
    assert np.abs(seen.positions - expected.positions).max() < allowed
    assert seen.result.status == "ok"


def test_motion_by_commands_is_that_by_a_history():
    """A clamp that rises evenly, by its history and by commands: the same steps, to the bit."""
    history = vs.History(time=("0 s", "0.1 s"), factor=(0.0, 1.0))
    way = vs.Motion(displacement=(0, 0, "2 mm"), history=history)
    [clamp] = BEAM.clamps
    timed = vs.Simulator(BEAM.replace(clamps=[clamp.replace(motion=way)]))
    driven = vs.Simulator(BEAM.replace(clamps=[clamp.replace(motion=vs.Motion())]))
    for step in range(1, 6):
        one, other = timed.step(), driven.step({"wall": (0, 0, step * 0.4e-3)})
        # Factors times lengths round otherwise.
        assert one.positions == pytest.approx(other.positions, abs=1e-12)
        assert one.commands["wall"] == pytest.approx(other.commands["wall"], abs=1e-15)


def test_shape_memory_remembers_how_warm_it_was():
    design, _ = DRIVES["memory"]
    simulator = vs.Simulator(design)

    def length(temperature):
        seen = simulator.step({"soft": temperature})
        for _ in range(400):
            if seen.status != "moving":
                break
            seen = simulator.step()
        assert seen.status == "at-rest"
        return seen.probes["tip"][0]

    cold, warm, between = length(300.0), length(355.0), length(335.0)
    assert abs(cold) < 1e-6
    assert warm == pytest.approx(-0.04 * 0.04, rel=0.1)
    # Above the temperatures of cooling it stays transformed.
    assert between == pytest.approx(warm, rel=1e-3)
    assert abs(length(310.0)) < 1e-2 * abs(warm)


def test_names_units_bounds_and_places():
    design = BLOCK.replace(
        supplies=[FlowSupply(chamber="c", source="10 kPa", valve=VALVE, leak=VALVE)],
        clamps=[BLOCK.clamps[0].replace(motion=vs.Motion())],
        loads=[vs.Gravity()],
    )
    commands = vs.Simulator(design).commands
    seen = {name: (each.place, each.unit, each.low, each.high) for name, each in commands.items()}
    assert seen["gravity"] == ("loads[0].acceleration", "m/s^2", -np.inf, np.inf)
    assert seen["c.valve"] == ("supplies[0].valve", "1", 0.0, 1.0)
    assert seen["c.leak"] == ("supplies[0].leak", "1", 0.0, 1.0)
    assert seen["foot"] == ("clamps[0].displacement", "m", -np.inf, np.inf)
    assert commands["foot"].shape == (3,)
    assert (commands["c.source"].first, commands["c.valve"].first) == (10e3, 0.0)
    simulator = vs.Simulator(design)
    given = {"supplies[0].valve": 0.25, "foot.displacement": (0, 0, "1 mm")}
    assert simulator.step(given).commands["c.valve"] == 0.25


@pytest.mark.parametrize(
    ("name", "commands", "words"),
    [
        ("flow", {"c.valve": 1.5}, r"commands\['c.valve'\]: 1.5 is above 1"),
        ("flow", {"c": 1.0}, r'"c" is no command'),
        ("pressure", {"c": "-2 bar"}, "is below -101.324 kPa"),
        ("volume", {"c": "0.4 mL"}, r"0.4 mL is above 0.3 mL"),
        ("tension", {"flexor": "-1 N"}, "is below 0"),
        ("tension", {"flexor": "1 mm"}, r"is a length; expected a force"),
        ("shortening", {"flexor": "50 mm"}, "is above"),
        ("strain", {"soft": -1.0}, "is below"),
        ("object", {"plate": "1 mm"}, "is not three components"),
        ("object", {"plate": (0, 0)}, "has 2 components"),
        ("object", {"plate": (0, 0, float("nan"))}, "is not a finite number"),
        ("clamp", {"wall.angle": "1 mm"}, "expected an angle"),
    ],
)
def test_a_bad_command_is_named_and_the_state_is_kept(name, commands, words):
    simulator = vs.Simulator(DRIVES[name][0])
    simulator.step()
    before = simulator.state
    with pytest.raises(DesignError, match=words):
        simulator.step(commands)
    assert simulator.state is before
    after = simulator.step()
    simulator.restore(before)
    assert bits(simulator.step()) == bits(after)


def syringe(**changes):
    supply = VolumeSupply(chamber="c", value="0.3 mL", fluid="water", **changes)
    return BLOCK.replace(supplies=[supply])


def test_a_syringe_pump_fills_at_its_flow_and_is_sealed_without():
    """Beside the volume of the water: V + s = M/ρ(p), with what is left in the syringe."""
    design = syringe()
    simulator = vs.Simulator(design)
    assert simulator.commands["c.flow"].unit == "m^3/s"
    bulk = design.supplies[0].medium.bulk_modulus
    first, whole = simulator.state.chambers[0].volume, 0.3e-6
    flow, volumes = 1e-6, []
    for step in range(8):
        seen = simulator.step({"c.flow": "1 mL/s"} if step == 0 else None)
        [chamber] = seen.chambers
        pushed = flow * seen.time
        assert seen.commands == {"c": pytest.approx(pushed, rel=1e-14), "c.flow": flow}
        inside = (first + whole) * np.exp(-chamber.pressure / bulk)
        # A step is found to 1e-7 of its load, which is 1e-6 of the bulk modulus.
        assert chamber.volume + whole - pushed == pytest.approx(inside, rel=1e-13)
        volumes.append(chamber.volume)
    assert np.diff(volumes) == pytest.approx(flow * 0.02, rel=1e-4)
    seen = simulator.step({"c.flow": 0})
    kept = seen.commands["c"]
    while seen.status == "moving":
        seen = simulator.step()
        assert seen.commands == {"c": kept, "c.flow": 0.0}
    assert seen.chambers[0].volume - first == pytest.approx(0.16e-6, rel=1e-4)


def test_a_syringe_pump_stops_at_its_end_and_by_a_volume():
    simulator = vs.Simulator(syringe())
    seen = simulator.step({"supplies[0].flow": "9 mL/s"})
    assert seen.commands == {"c": pytest.approx(0.18e-6), "c.flow": 9e-6}
    middle = [bits(each) for each in run(simulator, None, 3)]
    assert simulator.state.commands == {"c": 0.3e-6, "c.flow": 0.0}
    simulator.restore(seen)
    assert [bits(each) for each in run(simulator, None, 3)] == middle
    simulator.restore(seen)
    with pytest.raises(DesignError, match=r"commands\['c.flow'\]: is not 0, and 'c' says where"):
        simulator.step({"c": 0.0, "c.flow": 1e-6})
    assert simulator.state is seen
    assert simulator.step({"c": 0.1e-6}).commands == {"c": 0.1e-6, "c.flow": 0.0}
    assert simulator.step().commands["c"] == 0.1e-6
    assert simulator.step(simulator.targets).commands["c"] == 0.3e-6


def test_a_flow_takes_over_from_a_history_and_has_no_derivative():
    history = vs.History(time=("0 s", "0.1 s"), factor=(0.0, 1.0))
    simulator = vs.Simulator(syringe(history=history))
    assert simulator.step().commands["c"] == pytest.approx(0.06e-6)
    seen = simulator.step({"c.flow": "-1 mL/s"})
    assert seen.commands["c"] == pytest.approx(0.04e-6)
    with pytest.raises(DesignError, match="is the rate of 'c'"):
        vs.rollout(simulator, {"c.flow": [0.0, 1e-6]}, steps=2)


@pytest.mark.parametrize("load", [Drag(), Immersion(level="50 mm")])
def test_a_fluid_may_go_but_not_drive(load):
    simulator = vs.Simulator(BEAM.replace(loads=[load]))
    before = simulator.state
    with pytest.raises(DesignError, match=rf"commands\['{load.kind}'\]: -1 kg/m\^3 is below 0"):
        simulator.step({load.kind: -1.0})
    assert simulator.state is before
    assert simulator.step({load.kind: 0.0}).result.displacements == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("acceleration", "axis", "when"),
    [
        (("0", "0", "-9.81 + 0*sqrt(z + 0.05)"), 2, np.sqrt(2 * 0.05 / 9.81)),
        (("0", "0", "-9.81 + 0*sqrt(0.5 + vz)"), 2, 0.5 / 9.81),
        (("0", "0*sqrt(0.105 - t)", "-9.81"), 1, 0.105),
    ],
    ids=["place", "velocity", "time"],
)
def test_a_field_without_a_value_is_named_with_its_place_and_time(acceleration, axis, when):
    """A beam that falls freely, with its lowest vertices at the height 0."""
    field = ForceField(acceleration=acceleration)
    nothing = vs.Force(region=vs.Region(x=(0, 0)), value=(0, 0, 0))
    design = BEAM.replace(clamps=[], loads=[nothing, field])
    simulator = vs.Simulator(design, damping=0.0)
    while simulator.state.status != "diverged" and simulator.state.time < 1.0:
        seen = simulator.step()
    words = rf"loads\[1\].acceleration\[{axis}\] has no finite value at \(.*\) mm, .* at (.*) s"
    found = re.fullmatch(words, seen.message)
    assert found
    # Steps of 20 ms are halved ten times.
    assert float(found[1]) == pytest.approx(when, abs=0.1e-3)
    with pytest.raises(SimulationError, match=words):
        simulator.step()
    over_time = {"method": "dynamics", "end_time": 1.0, "time_step": 0.02, "damping": 0}
    moved = vs.simulate(design.replace(solver=over_time, contact={}))
    assert moved.status == "diverged"
    assert re.match(words, moved.message)


def test_a_field_without_a_value_ends_a_load_path_with_its_place():
    """A beam that is pulled until its end is 0.5 mm farther."""
    design = BEAM.replace(loads=[ForceField(acceleration=("60 + 0*sqrt(0.0405 - x)", "0", "0"))])
    found = vs.simulate(design, method="statics")
    assert found.status == "not-at-rest"
    words = r"loads\[0\].acceleration\[0\] has no finite value at \((.*), .*, .*\) .* past (.*) %"
    match = re.match(words, found.message)
    assert match
    # Load steps are a thousandth at least, and so is the search past the last one.
    assert float(match[1]) == pytest.approx(40.5, abs=4e-3 * 0.5 / 0.6)
    assert float(match[2]) == pytest.approx(100.0 * found.load_factor, rel=1e-3)
    more = vs.simulate(design.replace(loads=[ForceField(acceleration=("60", "0", "0"))]))
    assert more.status == "ok"


SCRIPT = """
import sys
sys.path.insert(0, {folder!r})
import hashlib
from test_simulator_commands import DRIVES
import voxsoft as vs
for name in ("object", "shortening", "flow"):
    design, commands = DRIVES[name]
    simulator = vs.Simulator(design)
    for given in (None, commands, None, None):
        seen = simulator.step(given)
    print(hashlib.sha256(seen.positions.tobytes() + seen.velocities.tobytes()).hexdigest())
"""


@pytest.mark.long
def test_other_numbers_of_threads_give_the_same_bits():
    def hashes(threads):
        script = SCRIPT.format(folder=str(Path(__file__).parent))
        environment = {**os.environ, "RAYON_NUM_THREADS": str(threads)}
        done = subprocess.run(
            [sys.executable, "-c", script],
            capture_output=True,
            text=True,
            check=True,
            env=environment,
        )
        return done.stdout.split()

    one = hashes(1)
    assert len(set(one)) == 3
    assert hashes(3) == one


def test_sensors_are_late_noisy_and_repeat():
    design, commands = DRIVES["flow"]
    sensors = [
        "chambers.c.pressure",
        Sensor(of="chambers.c.pressure", noise=50.0, name="noisy"),
        Sensor(of="chambers.c.pressure", delay="40 ms", name="late"),
        Sensor(of="probes.top", resolution="10 um", drift="1 mm", name="top"),
    ]
    simulator = vs.Simulator(design, sensors=sensors, seed=3)
    seen = run(simulator, commands, 6)
    exact = [float(each.sensors["chambers.c.pressure"]) for each in seen]
    assert exact == [each.chambers[0].pressure for each in seen]
    late = [float(each.sensors["late"]) for each in seen]
    assert late[2:] == exact[:-2]
    assert late[:2] == [vs.Simulator(design).state.chambers[0].pressure] * 2
    off = np.array([float(each.sensors["noisy"]) for each in seen]) - exact
    assert 5.0 < np.abs(off).max() < 250.0
    assert len(set(off.round(3))) == len(off)
    top = seen[-1].sensors["top"]
    assert top / 10e-6 == pytest.approx(np.round(top / 10e-6), abs=1e-6)
    simulator.restore(seen[2])
    assert [bits(each) for each in run(simulator, None, 3)] == [bits(each) for each in seen[3:]]
    simulator.reset(seed=4)
    other = run(simulator, commands, 6)
    assert other[-1].positions.tobytes() == seen[-1].positions.tobytes()
    assert other[-1].sensors["noisy"] != seen[-1].sensors["noisy"]
    simulator.reset(seed=3)
    assert [bits(each) for each in run(simulator, commands, 6)] == [bits(each) for each in seen]


@pytest.mark.parametrize(
    ("sensor", "words"),
    [
        ("probes.tp", r'sensors\[0\].of: "tp" is none of the probes.*did you mean "tip"'),
        ("probe.tip", r'"probe.tip" is no quantity'),
        ("probes.tip.speed", r'"speed" is none of probes'),
        (Sensor(of="probes.tip", noise="1 kPa"), r"sensors\[0\].noise"),
        (Sensor(of="probes.tip", noise=-1.0), "is not a size"),
    ],
)
def test_sensors_of_nothing_are_refused(sensor, words):
    with pytest.raises(DesignError, match=words):
        vs.Simulator(BEAM, sensors=[sensor])
    with pytest.raises(SimulationError, match="sensors"):
        vs.Simulator(BEAM, sensors=["probes.tip"]).restore(vs.Simulator(BEAM).state)


def test_rates_at_a_probe_are_those_of_a_rigid_body():
    """A beam carried by its clamp, quickly enough to keep its shape where it is held."""
    [clamp] = BEAM.clamps
    design = BEAM.replace(
        clamps=[
            clamp.replace(
                region=vs.Region(x=(0, "40 mm")),
                motion=vs.Motion(rotation={"axis": (0, 0, 2), "angle": "1 rad"}),
            )
        ],
        loads=[vs.Gravity()],
    )
    simulator = vs.Simulator(design, damping=0.0)
    for step in range(1, 6):
        seen = simulator.step({"wall.angle": 0.1 * step, "wall.displacement": (0, 0, 0)})
    felt = seen.motion("tip")
    turn = np.array([[np.cos(0.5), -np.sin(0.5), 0], [np.sin(0.5), np.cos(0.5), 0], [0, 0, 1]])
    assert felt.rotation == pytest.approx(turn, abs=1e-12)
    assert felt.strain == pytest.approx(np.zeros(6), abs=1e-12)
    # 5 rad/s; the second-order formula is off by (0.1)²/3 of it.
    assert felt.rate == pytest.approx([0, 0, 5.0], abs=5.0 * 0.1**2)
    middle = turn @ [0.0375, 0.005, 0.005]
    inward = -25.0 * middle * [1, 1, 0]
    expected = turn.T @ np.add(inward, [0, 0, 9.81])
    # Backward differences are late by half a step.
    assert felt.acceleration == pytest.approx(expected, abs=0.06 * 25.0 * 0.04)


def test_work_of_a_tendon_and_a_pressure_is_stored_in_the_body():
    for name in ("tension", "pressure"):
        simulator = vs.Simulator(DRIVES[name][0])
        target = simulator.targets
        for step in range(1, 11):
            seen = simulator.step({key: 0.1 * step * value for key, value in target.items()})
        while seen.status == "moving":
            seen = simulator.step()
        [work] = seen.work.values()
        # Slow enough that little is lost to damping.
        assert seen.energy == work
        assert (
            0.9 * seen.elastic_energy
            < (work if name == "tension" else seen.result.supplies[0].work)
            < 1.3 * seen.elastic_energy
        )


#: Designs that are driven without losses, each with the sizes of its commands.
ACCOUNTS = {
    "clamp": (
        BEAM.replace(
            clamps=[
                BEAM.clamps[0].replace(
                    motion=vs.Motion(rotation={"axis": (0, 1, 0), "angle": "10 deg"})
                )
            ]
        ),
        {"wall.displacement": (0.0, 0.0, 3e-3), "wall.angle": 0.2},
    ),
    "field": (
        BEAM.replace(
            loads=[ForceField(acceleration=("-100*(x - 0.02)", "0", "6*cos(20*t) - 2*vz"))]
        ),
        {"force_field": 1.0},
    ),
    "force": (
        BEAM.replace(
            loads=[vs.Force(region=vs.Region(x=("40 mm", "40 mm")), value=(0, 0, "2 mN"))]
        ),
        {"force": (0.0, 0.0, 2e-3)},
    ),
    "pressure": (BLOCK.replace(loads=[vs.Pressure(value="2 kPa")]), {"pressure": 2e3}),
    "tension": (DRIVES["tension"][0], {"flexor": 0.05}),
    "dielectric": (DRIVES["dielectric"][0], {"soft": 8e6}),
}


@pytest.mark.long
@pytest.mark.parametrize("name", ACCOUNTS)
def test_work_is_the_energy_of_a_body_without_losses(name):
    design, size = ACCOUNTS[name]

    def off(steps):
        """Energy that the body has and nobody gave, over the energy that went to and fro."""
        simulator = vs.Simulator(design, damping=0.0, time_step=0.2 / steps)
        turned = 0.0
        for step in range(1, steps + 1):
            share = np.sin(np.pi * step / steps) ** 2
            seen = simulator.step({key: share * np.array(each) for key, each in size.items()})
            turned += abs(seen.power) * simulator.time_step
        assert seen.energy == pytest.approx(sum(seen.work.values()))
        return (seen.elastic_energy + seen.kinetic_energy - seen.energy) / turned

    coarse, fine = off(50), off(100)
    assert abs(coarse) < 0.02
    # Steps and their account are of second order, and each is found to 1e-7 of its forces.
    assert abs(fine) < max(abs(coarse) / 3.0, 1e-6)


def test_work_of_an_object_is_that_of_its_contact():
    simulator = vs.Simulator(DRIVES["object"][0])
    for step in range(1, 21):
        seen = simulator.step({"plate": (0, 0, -0.2e-3 * step)})
    while seen.status == "moving":
        seen = simulator.step()
    assert seen.work.keys() == {"plate"}
    # Damping takes a part of it.
    assert seen.elastic_energy < seen.energy < 1.5 * seen.elastic_energy


def test_shorter_steps_bring_a_vibration_nearer_to_the_true_one():
    load = vs.Force(region=vs.Region(x=("40 mm", "40 mm")), value=(0, 0, "2 mN"))
    design = BEAM.replace(loads=[load])

    def swing(step, count, accuracy=None):
        simulator = vs.Simulator(design, time_step=step, damping=0.0, accuracy=accuracy)
        seen = [simulator.step({"force": (0, 0, 2e-3)}) for _ in range(count)]
        return np.array([each.probes["tip"][2] for each in seen])

    true = swing(0.5e-3, 320)[39::40]
    coarse, fine = swing(0.02, 8), swing(0.02, 8, accuracy=1e-4)
    assert np.abs(fine - true).max() < 0.3 * np.abs(coarse - true).max()


@pytest.mark.parametrize("name", ["tension", "pressure"])
def test_a_body_at_rest_rests_after_it_is_restored(name):
    design, commands = DRIVES[name]
    simulator = vs.Simulator(design)
    seen = simulator.step(commands)
    while seen.status == "moving":
        seen = simulator.step()
    plain = [bits(each) for each in run(simulator, None, 2)]
    assert plain[-1][2] == seen.positions.tobytes()
    simulator.restore(seen)
    assert [bits(each) for each in run(simulator, None, 2)] == plain
    moved = [bits(each) for each in run(simulator, simulator.targets, 2)]
    simulator.restore(seen)
    run(simulator, None, 2)
    assert [bits(each) for each in run(simulator, simulator.targets, 2)] == moved
