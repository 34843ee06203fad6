"""A body that is driven step by step while it touches, holds gas or softens."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Object, VolumeSupply
from voxsoft.materials import Mullins

SIDE = 10e-3
CUBE = vs.Part(
    shape=vs.Box(size=(SIDE, SIDE, SIDE)),
    material=vs.NeoHookean(young="60 kPa", poisson=0.45, density=1070.0),
)
#: A cantilever of four voxels, for designs that change it.
BEAM = vs.Design(
    name="beam",
    voxel_size="5 mm",
    parts=[
        vs.Part(
            name="soft",
            shape=vs.Box(size=("40 mm", SIDE, SIDE)),
            material=vs.NeoHookean(young="60 kPa", poisson=0.45, density=1070.0),
        )
    ],
    clamps=[vs.Clamp(name="wall", region=vs.Region(x=(0, 0)))],
    loads=[
        vs.Force(region=vs.Region(x=("40 mm", "40 mm")), value=(0, 0, "20 mN")),
    ],
    probes={"tip": vs.Probe(x=("40 mm", "40 mm"))},
)
#: A plate 1 mm above the free end of the beam.
PLATE = Object(
    name="plate", shape=vs.Box(size=("15 mm", "14 mm", "5 mm"), corner=("30 mm", "-2 mm", "11 mm"))
)
#: An object far away, which makes every step converge and touches nothing.
AWAY = Object(name="away", shape=vs.Box(size=("10 mm",) * 3, corner=("0 mm", "0 mm", "90 mm")))
#: A free block on a floor.
FREE = vs.Design(
    name="table",
    voxel_size="5 mm",
    parts=[CUBE],
    clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
    objects=[
        Object(
            name="block",
            shape=vs.Box(size=("6 mm", "6 mm", "4 mm"), corner=("2 mm", "2 mm", "10.5 mm")),
            motion="free",
            mass="2 g",
        )
    ],
    loads=[vs.Gravity()],
)
SOFT = vs.NeoHookean(
    young="60 kPa", poisson=0.45, density=1070.0, mullins=Mullins(r=1.5, m="100 Pa", beta=0.1)
)
DESIGNS = {
    "contact": BEAM.replace(objects=[PLATE]),
    "softening": BEAM.replace(parts=[BEAM.parts[0].replace(material=SOFT)]),
}


#: The force of BEAM, commanded.
PULL = {"force": (0.0, 0.0, 0.02)}


def run_to_rest(simulator, commands, most=300):
    seen = simulator.step(commands)
    for _ in range(most):
        if seen.status != "moving":
            break
        seen = simulator.step()
    assert seen.status == "at-rest", seen.message
    return seen


@pytest.mark.parametrize("name", DESIGNS)
def test_identical_commands_give_identical_bits(name):
    def drive(simulator):
        seen = [simulator.step({"force": (0.0, 0.0, 0.02 * (step % 3))}) for step in range(6)]
        return [(each.positions.tobytes(), each.velocities.tobytes()) for each in seen]

    simulator = vs.Simulator(DESIGNS[name])
    first = drive(simulator)
    simulator.reset()
    assert drive(simulator) == first
    assert drive(vs.Simulator(DESIGNS[name])) == first


@pytest.mark.parametrize("name", DESIGNS)
def test_the_rest_under_commands_is_the_equilibrium_of_statics(name):
    design = DESIGNS[name]
    seen = run_to_rest(vs.Simulator(design), PULL)
    expected = vs.simulate(design, method="statics")
    assert expected.status == "ok"
    # Both residuals are below 1e-4 of the load; a slender body turns one into ten times the motion.
    moved = np.abs(expected.displacements).max()
    off = np.abs(seen.positions - expected.positions).max()
    assert off < 2e-3 * moved
    if name == "contact":
        [contact], [there] = seen.contacts, expected.contacts
        assert contact.force == pytest.approx(there.force, abs=5e-3 * abs(there.force[2]))
        assert contact.force[2] < -1e-3


def test_a_free_object_lies_as_in_statics_and_presses_with_its_weight():
    seen = run_to_rest(vs.Simulator(FREE), {})
    [contact] = seen.contacts
    assert abs(contact.force[2]) == pytest.approx(2e-3 * 9.81, rel=1e-3)
    expected = vs.simulate(FREE).objects["block"].position
    # A clearance of contact of 1e-4 voxels, twice.
    assert seen.objects["block"].position == pytest.approx(expected, abs=1e-6)
    assert len(seen.positions) == len(seen.result.positions)


def test_a_syringe_in_motion_reaches_the_pressure_of_its_equilibrium():
    design = vs.Design(
        name="syringe",
        voxel_size="5 mm",
        parts=[
            vs.Part(
                shape=vs.Box(size=("20 mm", "20 mm", "20 mm"))
                - vs.Box(size=(SIDE, SIDE, SIDE), corner=("5 mm", "5 mm", "5 mm")),
                material=vs.NeoHookean(young="60 kPa", poisson=0.45, density=1070.0),
            )
        ],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        chambers={"c": vs.Chamber(point=("10 mm", "10 mm", "10 mm"))},
        supplies=[VolumeSupply(chamber="c", value="0.3 mL")],
    )
    seen = run_to_rest(vs.Simulator(design), {"c": "0.3 mL"})
    expected = vs.simulate(design)
    [chamber], [supply] = seen.chambers, expected.supplies
    assert supply.pressure > 1e3
    assert chamber.pressure == pytest.approx(supply.pressure, rel=1e-3)
    assert chamber.volume == pytest.approx(supply.volume, rel=1e-3)
    assert seen.result.supplies[0].pressure == chamber.pressure


def test_softened_rubber_rests_at_the_end_of_its_path():
    # Damped so much that nothing overshoots: softening remembers the farthest point.
    simulator = vs.Simulator(DESIGNS["softening"], damping=400.0)
    first = run_to_rest(simulator, {"force": (0.0, 0.0, 0.01)}).probes["tip"][2]
    run_to_rest(simulator, {"force": (0.0, 0.0, 0.04)})
    again = run_to_rest(simulator, {"force": (0.0, 0.0, 0.01)})
    assert again.probes["tip"][2] > 1.02 * first
    path = vs.follow(DESIGNS["softening"], "loads[0].value.2", [0.01, 0.04, 0.01])
    back = path.results[-1]
    assert again.probes["tip"][2] == pytest.approx(back.probes["tip"][2], rel=5e-3)
    assert again.result.peaks == pytest.approx(back.peaks, rel=2e-2, abs=1e-2 * back.peaks.max())


def prony(design):
    """The design with rubber that relaxes by a third, over a tenth of a second."""
    relaxing = vs.NeoHookean(
        young="60 kPa", poisson=0.45, density=1070.0, prony=[{"g": 0.3, "tau": "0.1 s"}]
    )
    return design.replace(parts=[part.replace(material=relaxing) for part in design.parts])


def test_relaxing_rubber_rests_as_elastic_rubber_but_later():
    def heights(design):
        simulator = vs.Simulator(design, damping=0.0)
        loads = {"force": (0.0, 0.0, 0.005)}
        return np.array([simulator.step(loads).probes["tip"][2] for _ in range(15)])

    far = BEAM.replace(objects=[AWAY])
    elastic, relaxing = heights(far), heights(prony(far))
    # The branch adds to the stiffness at first, and takes energy out of the vibration.
    assert relaxing.max() < 0.99 * elastic.max()
    assert np.ptp(relaxing[-5:]) < 0.8 * np.ptp(elastic[-5:])
    seen = run_to_rest(vs.Simulator(prony(DESIGNS["contact"])), PULL)
    expected = vs.simulate(DESIGNS["contact"], method="statics").probes["tip"][2]
    assert seen.probes["tip"][2] == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize("kind", ["relaxing", pytest.param("retarded", marks=pytest.mark.slow)])
def test_viscous_vibrations_with_contact_are_those_of_explicit_steps(kind):
    force = BEAM.loads[0].replace(value=(0, 0, "2 mN"))
    elastic = BEAM.replace(loads=[force])
    design = prony(elastic) if kind == "relaxing" else elastic
    settings = {"end_time": 0.15, "damping": 0.0, "record_interval": "4 ms"}
    viscous = settings | ({} if kind == "relaxing" else {"retardation": "5 ms"})

    def swing(design, **settings):
        return vs.simulate(design, **settings).recording.probes["tip"][:, 2]

    explicit = swing(design, method="xpbd", **viscous)
    implicit = {"method": "dynamics", "time_step": "2 ms"}
    found = swing(design.replace(objects=[AWAY]), **implicit, **viscous)
    # Steps of 2 ms of a period of 40 ms are off by this much without any viscosity.
    plain = swing(elastic, method="xpbd", **settings)
    error = np.abs(swing(elastic.replace(objects=[AWAY]), **implicit, **settings) - plain).max()
    assert found == pytest.approx(explicit, abs=error)
    assert np.ptp(found[-12:]) < 0.9 * np.ptp(plain[-12:])


def test_slow_motion_of_softening_rubber_follows_the_path_of_equilibria():
    times, factors = ("0 s", "1 s", "2 s"), (0, 1, 0.25)
    history = {"time": times, "factor": factors}
    force = BEAM.loads[0].replace(value=(0, 0, "40 mN"), history=history)
    design = DESIGNS["softening"].replace(loads=[force])
    path = vs.follow(design, "time", ["0.5 s", "1 s", "1.5 s", "2 s"])
    moved = vs.simulate(design, method="dynamics", end_time="2 s", damping="20 1/s")
    expected = [found.probes["tip"][2] for found in path.results]
    record = moved.recording
    seen = np.interp([0.5, 1.0, 1.5, 2.0], record.times, record.probes["tip"][:, 2])
    # Viscous drag of 20/s lags behind by 20/ω² = 0.02 s of a way that takes 1 s.
    assert seen == pytest.approx(expected, abs=0.03 * max(expected))
    assert moved.positions == pytest.approx(path.results[-1].positions, abs=0.03 * max(expected))


#: Designs whose states depend on the way to them.
WITH_MEMORY = {
    "relaxing": prony(BEAM),
    "relaxing in contact": prony(DESIGNS["contact"]),
    "softening": DESIGNS["softening"],
}


@pytest.mark.long
@pytest.mark.parametrize("damping", ["critical", 0.0])
@pytest.mark.parametrize("name", WITH_MEMORY)
def test_motion_from_a_restored_observation_repeats_bit_for_bit(name, damping):
    design = WITH_MEMORY[name]

    def go_on(simulator, steps=6):
        return [simulator.step() for _ in range(steps)]

    def bits(seen):
        return [(each.time, each.positions.tobytes(), each.velocities.tobytes()) for each in seen]

    simulator = vs.Simulator(design, damping=damping, retardation="1 ms")
    for _ in range(4):
        seen = simulator.step({"force": (0.0, 0.0, 0.005)})
    plain = go_on(simulator)
    assert simulator.restore(seen) is seen is simulator.state
    first = go_on(simulator)
    simulator.restore(seen)
    assert bits(go_on(simulator)) == bits(first)
    other = vs.Simulator(design, damping=damping, retardation="1 ms")
    other.restore(seen)
    assert bits(go_on(other)) == bits(first)
    assert bits(plain) == bits(first)


def test_observations_of_another_design_are_refused():
    with pytest.raises(vs.errors.SimulationError, match="same design"):
        vs.Simulator(DESIGNS["softening"]).restore(vs.Simulator(BEAM).state)


def test_an_object_falls_as_far_as_it_may():
    # Beside the cube, by 40 times its size; what is held may move by 10 times.
    shape = vs.Box(size=("6 mm", "6 mm", "4 mm"), corner=("32 mm", "2 mm", "10.5 mm"))
    design = FREE.replace(objects=[FREE.objects[0].replace(shape=shape)])
    simulator = vs.Simulator(design, damping=0.0)
    start = simulator.state.objects["block"].position
    for _ in range(20):
        seen = simulator.step()
    assert seen.status == "moving"
    moved = np.subtract(seen.objects["block"].position, start)
    # The time integration is exact for a constant acceleration; forces are balanced to 1e-4.
    assert moved == pytest.approx([0.0, 0.0, -9.81 * 0.4**2 / 2.0], rel=1e-4, abs=1e-6)
