"""Chambers as volumes of gas and liquid: laws of gases, limit points, flow beside an ODE solver."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import voxsoft as vs
from voxsoft import _core
from voxsoft.design import Connection, FlowSupply, Liquid, MassSupply, PressureSupply, VolumeSupply
from voxsoft.design.fluid import ATMOSPHERE, FLUIDS, ROOM
from voxsoft.errors import DesignError, SimulationError
from voxsoft.simulation import Setup, simulate
from voxsoft.units import kPa, mm

AIR, WATER = FLUIDS["air"], FLUIDS["water"]
#: p/ρ of air at 20 °C, J/kg.
RT = AIR.gas_constant * ROOM
RUBBER = vs.NeoHookean(young=200 * kPa, poisson=0.48, density=1070)
WALL, INSIDE = 4 * mm, 12 * mm
TUBE = {"length": "0.5 m", "diameter": "0.5 mm"}


def pair(*supplies, **changes):
    """Two cubic chambers side by side in a block of rubber on a plate."""
    width, height = 2 * INSIDE + 3 * WALL, INSIDE + 2 * WALL
    left = vs.Box(size=(INSIDE,) * 3, corner=(WALL,) * 3)
    right = vs.Box(size=(INSIDE,) * 3, corner=(2 * WALL + INSIDE, WALL, WALL))
    middle = WALL + INSIDE / 2
    entries = {
        "name": "pair",
        "voxel_size": WALL,
        "parts": [
            vs.Part(shape=vs.Box(size=(width, height, height)) - left - right, material=RUBBER)
        ],
        "clamps": [vs.Clamp(region=vs.Region(z=(0, 0)))],
        "chambers": {
            "left": vs.Chamber(point=(middle, middle, middle)),
            "right": vs.Chamber(point=(middle + WALL + INSIDE, middle, middle)),
        },
        "supplies": supplies,
    }
    return vs.Design(**(entries | changes))


def loaded(**pressures):
    """The pair under pressure loads."""
    loads = [vs.Pressure(value=value, cavity=name) for name, value in pressures.items()]
    return simulate(pair(loads=loads))


def off(one, other):
    """The largest distance of two states, over the largest displacement."""
    return np.abs(one.positions - other.positions).max() / np.abs(other.displacements).max()


#: Both ways to a state leave 1e-8 of the load; a soft one magnifies that.
ALIKE = 1e-6


@pytest.mark.long
@pytest.mark.parametrize(
    "supply",
    [
        PressureSupply(chamber="left", value=15 * kPa),
        PressureSupply(chamber="left", value=-15 * kPa),
        VolumeSupply(chamber="left", value="1 mL"),
        VolumeSupply(chamber="left", value="-0.5 mL"),
        VolumeSupply(chamber="left", value="0.4 mL", fluid="water"),
        VolumeSupply(chamber="left", value="-0.3 mL", fluid="water", line_volume="1 mL"),
        MassSupply(chamber="left", value="3 mg"),
        MassSupply(chamber="left", temperature="80 degC"),
        FlowSupply(chamber="left", source=12 * kPa, tube=TUBE),
        FlowSupply(chamber="left", pump={"flow": ("1 L/min", 0), "pressure": (0, 9 * kPa)}),
    ],
    ids=lambda supply: f"{supply.kind} {getattr(supply, 'value', '')} {supply.fluid}",
)
def test_at_rest_a_supply_is_the_pressure_that_it_comes_to(supply):
    found = simulate(pair(supply))
    assert found.status == "ok", found.message
    (chamber,) = found.supplies
    assert chamber.volume == pytest.approx(found.cavity_volumes[0], rel=1e-12)
    assert off(found, loaded(left=chamber.pressure)) < ALIKE
    # The work on the walls is the stored energy. It is added up by the trapezoidal rule over
    # eight steps, whose error is some of (1/8)² / 12 by how far the curve of the pressure bends.
    assert chamber.work == pytest.approx(found.elastic_energy, rel=5e-3)


def test_gas_keeps_its_law():
    """Pressure, volume and mass of sealed, drawn in and warmed gas."""
    rest = INSIDE**3
    outside, stroke, hot = 0.8e-6, 1e-6, 353.15
    (pushed,) = simulate(
        pair(VolumeSupply(chamber="left", value=stroke, line_volume=outside))
    ).supplies
    amount = ATMOSPHERE * (rest + outside + stroke)
    assert (pushed.pressure + ATMOSPHERE) * (pushed.volume + outside) == pytest.approx(amount)
    assert pushed.mass == pytest.approx(amount / RT)
    (drawn,) = simulate(
        pair(VolumeSupply(chamber="left", value=-stroke, line_volume=outside))
    ).supplies
    amount = ATMOSPHERE * (rest + outside)
    within = drawn.volume + outside + stroke
    assert (drawn.pressure + ATMOSPHERE) * within == pytest.approx(amount)
    (warm,) = simulate(pair(MassSupply(chamber="left", temperature=hot))).supplies
    amount = ATMOSPHERE * rest * hot / ROOM
    assert (warm.pressure + ATMOSPHERE) * warm.volume == pytest.approx(amount)
    assert warm.mass == pytest.approx(ATMOSPHERE * rest / RT)


def test_water_hardly_gives_way():
    pushed = simulate(pair(VolumeSupply(chamber="left", value="0.4 mL", fluid="water")))
    (chamber,) = pushed.supplies
    content = INSIDE**3 + 0.4e-6
    assert chamber.volume == pytest.approx(
        content * np.exp(-chamber.pressure / WATER.bulk_modulus), rel=1e-10
    )
    soft = Liquid(bulk_modulus="1 MPa")
    (spongy,) = simulate(pair(VolumeSupply(chamber="left", value="0.4 mL", fluid=soft))).supplies
    assert spongy.pressure < 0.99 * chamber.pressure
    assert spongy.volume == pytest.approx(content * np.exp(-spongy.pressure / 1e6), rel=1e-9)


def test_chambers_on_a_manifold_share_a_pressure():
    together = simulate(pair(VolumeSupply(chambers=("left", "right"), value="2 mL")))
    (both,) = together.supplies
    assert both.name == "left + right"
    assert both.volume == pytest.approx(sum(together.cavity_volumes))
    same = loaded(left=both.pressure, right=both.pressure)
    assert off(together, same) < ALIKE
    amount = ATMOSPHERE * (2 * INSIDE**3 + 2e-6)
    assert (both.pressure + ATMOSPHERE) * both.volume == pytest.approx(amount)


def ball(*supplies, **changes):
    """A hollow ball, which grows by itself past a limit pressure."""
    shape = vs.Sphere(radius=15 * mm) - vs.Sphere(radius=10 * mm)
    entries = {
        "name": "ball",
        "voxel_size": 5 * mm,
        "parts": [
            vs.Part(shape=shape, material=vs.NeoHookean(young=60 * kPa, poisson=0.45, density=1070))
        ],
        "clamps": [vs.Clamp(region=vs.Region(z=("-inf", -14.9 * mm)))],
        "supplies": supplies,
    }
    return vs.Design(**(entries | changes))


@pytest.mark.parametrize("fluid", ["air", "water"])
def test_a_balloon_is_filled_through_its_limit_point(fluid):
    """Comparison with volume control, which prescribes the effect of the fluid."""
    ratio = {"control": "volume", "volume_ratio": 8.0, "steps": 20, "method": "statics"}
    expected = simulate(ball(loads=[vs.Pressure(value=15 * kPa)], solver=ratio))
    pressure = 15 * kPa * expected.load_factor
    (volume,) = expected.cavity_volumes
    assert pressure < 0.97 * 15 * kPa * expected.limit_factor
    if fluid == "air":
        supply = MassSupply(chamber=0, value=(pressure + ATMOSPHERE) * volume / RT)
    else:
        mass = WATER.density * np.exp(pressure / WATER.bulk_modulus) * volume
        supply = MassSupply(chamber=0, value=mass, fluid="water")
    filled = simulate(ball(supply), first_step=0.05)
    assert filled.status == "ok", filled.message
    assert filled.stable
    (chamber,) = filled.supplies
    assert chamber.pressure == pytest.approx(pressure, rel=1e-6)
    assert off(filled, expected) < 1e-5
    # It went through the limit: the highest pressure on the way is that of the path, up to the
    # square of its steps.
    highest = filled.recording.chambers["cavity 0"].pressure.max()
    assert highest == pytest.approx(15 * kPa * expected.limit_factor, rel=0.01)


@pytest.mark.long
@pytest.mark.parametrize("fluid", [pytest.param("air", marks=pytest.mark.slow), "water"])
def test_a_balloon_that_is_filled_presses_against_a_wall(fluid):
    """State under its final pressure: contact settles in rounds, and pressures with it."""
    wall = vs.Box(size=(80 * mm, 80 * mm, 5 * mm), center=(0, 0, 19.5 * mm))
    held = [vs.Clamp(region=vs.Region(**{axis: (0, 0)}), axes=axis) for axis in "xy"]
    touching = {
        "clamps": [vs.Clamp(region=vs.Region(z=("-inf", -14.9 * mm))), *held],
        "objects": [{"name": "wall", "shape": wall}],
        "contact": {"friction": 0.0},
    }
    if fluid == "air":
        supply = MassSupply(chamber=0, value="15 mg")
    else:
        supply = VolumeSupply(chamber=0, value="6 mL", fluid="water")
    filled = simulate(ball(supply, **touching))
    assert filled.status == "ok", filled.message
    (touch,) = filled.contacts
    assert touch.force[2] < -0.1
    load = vs.Pressure(value=filled.supplies[0].pressure)
    # Forces of contact are known to a part in a thousand of the clearance.
    assert off(filled, simulate(ball(loads=[load], **touching))) < 1e-4


def test_gas_that_gives_way_lets_a_balloon_snap():
    """Behind a large tank the pressure hardly falls as the balloon grows: nothing holds it."""
    behind = VolumeSupply(chamber=0, value="10 mL", line_volume="2 L")
    lost = simulate(ball(behind.replace(value="900 mL")))
    assert lost.status == "not-at-rest"
    assert simulate(ball(behind)).status == "ok"


VESSEL = 32 * mm
#: m³
FILLED = 50e-6


def vessel(supply, **settings):
    """A cubic vessel with walls of 4 mm that hardly give way: 0.06 % of its volume at 50 kPa."""
    outside = VESSEL + 2 * WALL
    shape = vs.Box(size=(outside,) * 3) - vs.Box(size=(VESSEL,) * 3, corner=(WALL,) * 3)
    stiff = vs.NeoHookean(young="2 GPa", poisson=0.3, density=1200)
    solver = {"method": "dynamics", "damping": "critical", "time_step": 0.01, "end_time": 2.0}
    return vs.Design(
        name="vessel",
        voxel_size=WALL,
        parts=[vs.Part(shape=shape, material=stiff)],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        supplies=[supply],
        solver=solver | settings,
    )


def through_orifice(high, low, conductance=1e-9, ratio=0.3):
    """ISO 6358-1, kg/s; pressures are absolute."""
    if high < low:
        return -through_orifice(low, high, conductance, ratio)
    share = max(0.0, (low / high - ratio) / (1 - ratio))
    return conductance * 1.185 * high * np.sqrt(1 - share**2)


def through_tube(high, low, length=2.0, diameter=1e-3):
    """Hagen and Poiseuille for an ideal gas at one temperature, kg/s; pressures are absolute."""
    unit = np.pi * diameter**4 / (256 * AIR.viscosity * length * RT)
    return unit * (high**2 - low**2)


HELD = 2.0 * np.pi / 4 * 1e-3**2
LINES = {
    "orifice": ({"valve": {"conductance": 1e-9, "critical_ratio": 0.3}}, through_orifice, 0.0),
    "tube": ({"tube": {"length": 2.0, "diameter": 1e-3}}, through_tube, HELD),
}


def filling(flow, source, times):
    """Absolute pressures in a rigid vessel; it is full where only a thousandth is missing."""

    def slope(_, pressure):
        return [flow(pressure[0]) * RT / FILLED]

    def is_full(_, pressure):
        return abs(source + ATMOSPHERE - pressure[0]) - 1e-3 * abs(source)

    is_full.terminal = True
    span = (0.0, times[-1])
    exact = {"rtol": 1e-9, "atol": 1e-3, "events": is_full}
    found = solve_ivp(slope, span, [ATMOSPHERE], t_eval=times, method="LSODA", **exact).y[0]
    full = np.full(len(times) - len(found), source + ATMOSPHERE)
    return np.concatenate([found, full])


@pytest.mark.parametrize(
    ("line", "source"),
    [
        # One line, emptied; the others are slow.
        pytest.param("tube", 50 * kPa, marks=pytest.mark.slow),
        ("orifice", -60 * kPa),
        pytest.param("orifice", 300 * kPa, marks=pytest.mark.slow),
        pytest.param("tube", 300 * kPa, marks=pytest.mark.slow),
        pytest.param("tube", -60 * kPa, marks=pytest.mark.slow),
        pytest.param("orifice", 50 * kPa, marks=pytest.mark.slow),
    ],
)
def test_a_vessel_fills_as_the_differential_equation_says(line, source):
    keys, flow, held = LINES[line]
    outside = FILLED - VESSEL**3 - held
    supply = FlowSupply(chamber=0, source=source, line_volume=outside, **keys)
    found = simulate(vessel(supply))
    assert found.status == "ok", found.message
    history = found.recording.chambers["cavity 0"]
    times = found.recording.times
    expected = filling(lambda pressure: flow(source + ATMOSPHERE, pressure), source, times)
    # Steps of 10 ms leave 0.3 % where 300 kPa come in within 0.3 s, and walls give way by less.
    error = np.abs(history.pressure + ATMOSPHERE - expected).max()
    assert error < 0.01 * abs(source)
    # Mass came through the line, and nothing else: the law of the gas has it.
    within = history.volume + FILLED - VESSEL**3
    assert history.mass == pytest.approx((history.pressure + ATMOSPHERE) * within / RT, rel=1e-9)


@pytest.mark.long
def test_valves_fill_hold_and_empty_a_vessel():
    """One lets in until it closes; then nothing moves; then another one lets out."""
    inlet = {"time": (0.3, 0.301), "factor": (1, 0)}
    vent = {"time": (0.6, 0.601), "factor": (0, 1)}
    valve = {"conductance": 1e-9, "critical_ratio": 0.3}
    supply = FlowSupply(
        chamber=0,
        source=50 * kPa,
        line_volume=FILLED - VESSEL**3,
        valve=valve | {"history": inlet},
        leak=valve | {"history": vent},
    )
    found = simulate(vessel(supply, end_time=1.0))
    pressure, times = found.recording.chambers["cavity 0"].pressure, found.recording.times
    flow = found.recording.chambers["cavity 0"].flow
    filled = times < 0.295
    expected = filling(lambda p: through_orifice(50 * kPa + ATMOSPHERE, p), 50 * kPa, times[filled])
    # Tolerance as without histories: steps of 10 ms, and walls that give way by a little.
    assert np.abs(pressure[filled] + ATMOSPHERE - expected).max() < 0.01 * 50 * kPa
    # Walls that settle after the step in which it closed move the pressure, and no mass does.
    held = (times > 0.315) & (times < 0.595)
    assert np.all(flow[held] == 0.0)
    assert np.ptp(pressure[held]) < 1e-3 * pressure[held].max()
    out = times > 0.605
    assert np.all(np.diff(pressure[out]) < 0)


def test_stiff_lines_need_no_short_steps():
    """A line that fills in 0.2 ms, at steps of 50 ms."""
    wide = FlowSupply(chamber=0, source=50 * kPa, valve={"conductance": 1e-6})
    found = simulate(vessel(wide, time_step=0.05, end_time=0.5))
    pressure = found.recording.chambers["cavity 0"].pressure
    assert pressure[1:] == pytest.approx(50 * kPa, rel=1e-3)


@pytest.mark.slow
def test_chambers_that_exchange_gas_keep_it():
    """Nothing is lost to the last digits, and in the end it is as if they had one manifold."""
    rest = ATMOSPHERE / RT * INSIDE**3
    # Half of the tube is either chamber's.
    half = 0.5 * 0.5 * np.pi / 4 * 0.5e-3**2
    first = MassSupply(
        chamber="left", value=1.5 * rest, history={"time": (0.0, 0.1), "factor": (0, 1)}
    )
    joined = pair(
        first,
        MassSupply(chamber="right"),
        connections=[Connection(chambers=("left", "right"), tube=TUBE)],
        solver={"method": "dynamics", "end_time": 2.0, "time_step": 0.01, "damping": "20 1/s"},
    )
    found = simulate(joined)
    assert found.status == "ok", found.message
    left, right = (found.recording.chambers[name] for name in ("left", "right"))
    total, later = left.mass + right.mass, found.recording.times > 0.1 + 1e-9
    assert np.ptp(total[later]) < 1e-14 * total[-1]
    assert right.flow == pytest.approx(-left.flow, abs=1e-18 + 1e-9 * right.flow.max())
    assert left.pressure[6] > 2 * right.pressure[6] > 0.0
    still = simulate(
        joined, **{"method": "statics", "end_time": None, "time_step": None, "damping": None}
    )
    one, other = still.supplies
    assert one.pressure == pytest.approx(other.pressure, rel=1e-12)
    assert one.mass + other.mass == pytest.approx(total[-1], rel=1e-12)
    # The difference has fallen to a thousandth by then.
    assert left.pressure[-1] == pytest.approx(one.pressure, rel=2e-3)
    mass = 2.5 * rest + ATMOSPHERE / RT * half
    manifold = MassSupply(chambers=("left", "right"), value=mass, line_volume=2 * half)
    assert off(still, simulate(pair(manifold))) < ALIKE


def test_a_leak_takes_the_flow_of_the_valve():
    """Like valves in series: the pressure between them, by the flow that both carry."""
    valve = {"conductance": "0.01 L/s/bar", "critical_ratio": 0.3}
    (chamber,) = simulate(
        pair(FlowSupply(chamber="left", source=20 * kPa, valve=valve, leak=valve))
    ).supplies
    absolute = chamber.pressure + ATMOSPHERE
    entering = through_orifice(20 * kPa + ATMOSPHERE, absolute)
    leaving = through_orifice(absolute, ATMOSPHERE)
    assert entering == pytest.approx(leaving, rel=1e-9)


@pytest.mark.slow
def test_a_syringe_with_a_leak_is_empty_in_the_end():
    leak = {"conductance": "0.001 L/s/bar"}
    leaky = VolumeSupply(
        chamber="left", value="1 mL", leak=leak, history={"time": (0, 0.1), "factor": (0, 1)}
    )
    solver = {"method": "dynamics", "time_step": 0.01, "max_time": 30.0}
    found = simulate(pair(leaky, solver=solver))
    assert found.status == "ok", found.message
    history = found.recording.chambers["left"].pressure
    assert history.max() > 5 * kPa
    assert abs(history[-1]) < 1e-3 * history.max()
    (at_rest,) = simulate(pair(leaky)).supplies
    assert at_rest.pressure == pytest.approx(0.0, abs=1e-6)


@pytest.mark.slow
def test_water_flows_through_a_tube_into_rubber():
    """The inflow is the integral of the flow, and the pressure ends at that of the source."""
    feed = FlowSupply(
        chamber="left",
        source=10 * kPa,
        fluid="water",
        tube={"length": "1 m", "diameter": "2 mm"},
    )
    solver = {"method": "dynamics", "end_time": 1.5, "time_step": 0.005, "damping": "50 1/s"}
    found = simulate(pair(feed, solver=solver), record_interval=0.005)
    assert found.status == "ok", found.message
    history, times = found.recording.chambers["left"], found.recording.times
    gained = np.trapezoid(history.flow, times)
    # Steps of 5 ms, over some tenths of a second.
    assert history.mass[-1] - history.mass[0] == pytest.approx(gained, rel=0.02)
    assert history.pressure[-1] == pytest.approx(10 * kPa, rel=0.02)
    assert off(found, loaded(left=10 * kPa)) < 0.02


def test_over_time_a_slow_syringe_goes_along_the_states_at_rest():
    slow = VolumeSupply(chamber="left", value="1 mL", history={"time": (0, 2.0), "factor": (0, 1)})
    solver = {"method": "dynamics", "end_time": 2.0, "time_step": 0.02, "damping": "50 1/s"}
    found = simulate(pair(slow, solver=solver))
    still = simulate(pair(slow))
    # Inertia and damping hold the walls back by 0.1 % of the way.
    assert off(found, still) < 2e-3
    (moved,), (rested,) = found.supplies, still.supplies
    assert moved.pressure == pytest.approx(rested.pressure, rel=2e-3)
    # Trapezoidal rule over 100 steps.
    assert moved.work == pytest.approx(found.elastic_energy, rel=5e-3)
    assert moved.energy > moved.work


def test_the_pressures_of_a_path_are_those_of_its_states():
    """Records of statics come at load factors, and end at the result."""
    design = pair(MassSupply(chamber="left", value="3 mg"))
    found = simulate(design, first_step=0.1, frames=True)
    recorded = found.recording.chambers["left"]
    assert recorded.pressure[-1] == found.supplies[0].pressure
    (cavity, _) = Setup.of(design).mesh.cavities
    volumes = [cavity.volume_at(frame) for frame in found.recording.frames]
    assert recorded.volume == pytest.approx(volumes, rel=1e-12)


def test_a_liquid_weighs_on_its_walls():
    """The supports carry it, about its own center, and its pressure is that of a column."""
    gravity = vs.Gravity()
    water = PressureSupply(chamber="left", value=0.0, fluid="water")
    found = simulate(pair(water, loads=[gravity]))
    (chamber,) = found.supplies
    assert chamber.mass == pytest.approx(WATER.density * chamber.volume, rel=1e-12)
    weight = gravity.value * (found.mass + WATER.density * chamber.volume)
    assert found.load == pytest.approx((0.0, 0.0, -weight), abs=1e-9 * weight)
    assert found.reaction[2] == pytest.approx(weight, rel=1e-9)
    middle = WALL + INSIDE / 2
    # Without the body's own moment: rubber weighs on both sides of the middle alike, within what
    # the walls give way.
    own = found.mass * gravity.value * (3 * WALL + 2 * INSIDE) / 2
    moment = WATER.density * chamber.volume * gravity.value * middle + own
    assert found.load_moment[1] == pytest.approx(moment, rel=1e-3)
    # Above its middle its pressure is below zero and draws the roof down; below, the plate holds.
    dry = simulate(pair(water.replace(fluid="air"), loads=[gravity]))
    assert chamber.volume < dry.supplies[0].volume


@pytest.mark.long
@pytest.mark.parametrize("fluid", ["air", "water"])
def test_derivatives_go_through_sealed_gas(fluid):
    """Beside differences over two parts in ten thousand, which are good to the square of that."""
    value, young = 1e-7, 200 * kPa
    tip = {"probes": {"top": vs.Probe(z=(INSIDE + 2 * WALL,) * 2)}}
    rise = vs.Objective(maximize="displacement", probe="top", axis="z")
    design = pair(
        VolumeSupply(chamber="left", value=value, fluid=fluid), **tip, objectives={"rise": rise}
    )
    slopes = vs.gradient(simulate(design), "rise", ["supplies.0.value", "parts.0.material.young"])

    def difference(change):
        high, low = (simulate(design.with_values(change(1 + s))) for s in (1e-4, -1e-4))
        return (high.metrics["rise"] - low.metrics["rise"]) / 2e-4

    by_value = difference(lambda f: f"supplies.0.value={value * f!r} m^3") / value
    by_young = difference(lambda f: f"parts.0.material.young={young * f!r} Pa") / young
    assert slopes["rise"]["supplies.0.value"] == pytest.approx(by_value, rel=1e-6)
    # Water keeps the volume whatever the stiffness: next to nothing is left of that slope.
    small = 1e-4 * abs(by_value) * value / young
    assert slopes["rise"]["parts.0.material.young"] == pytest.approx(by_young, rel=1e-6, abs=small)


@pytest.mark.parametrize("fluid", ["air", "water"])
def test_multigrid_and_a_direct_factor_find_the_same(fluid):
    """Also past the limit of a balloon, where only its content holds the body."""
    ratio = 4.0 if fluid == "air" else 2.0
    mass = ratio * 4.2e-6 * (WATER.density if fluid == "water" else 1.1 * ATMOSPHERE / RT)
    setup = Setup.of(ball(MassSupply(chamber=0, value=mass, fluid=fluid)))
    found = {
        linear: _core.equilibrium(setup.problem, tolerance=1e-8, linear=linear)
        for linear in ("direct", "iterative")
    }
    one, other = found.values()
    assert one.status == other.status == _core.Status.AT_REST
    size = np.abs(one.positions - setup.mesh.vertices).max()
    assert np.abs(one.positions - other.positions).max() < 1e-5 * size
    assert one.path.stable
    assert other.path.stable
    assert one.chambers[0, 0] == pytest.approx(other.chambers[0, 0], rel=1e-5)


@pytest.mark.long
@pytest.mark.parametrize(
    ("varied", "still", "key", "values"),
    [
        (
            VolumeSupply(chamber="left", value="0.3 mL"),
            PressureSupply(chamber="right", value="5 kPa"),
            "value",
            "-0.2..0.4 mL/4",
        ),
        pytest.param(
            PressureSupply(chamber="left", value="5 kPa"),
            VolumeSupply(chamber="right", value="0.1 mL", fluid="water"),
            "value",
            "8..-4 kPa/4",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            MassSupply(chamber="left", temperature="300 K"),
            MassSupply(chamber="right"),
            "temperature",
            "280..340 K/4",
            marks=pytest.mark.slow,
        ),
        (
            FlowSupply(chamber="left", source="5 kPa", valve={"conductance": "0.1 L/s/bar"}),
            MassSupply(chamber="right"),
            "source",
            "0..6 kPa/4",
        ),
    ],
    ids=["syringe", "regulator", "heat", "source"],
)
def test_along_a_path_of_supplies_each_state_is_that_of_a_single_run(varied, still, key, values):
    design = pair(varied, still)
    path = vs.follow(design, f"supplies[0].{key}={values}")
    assert path.status == "ok"
    for found in path.results:
        alone = simulate(found.design)
        for here, there in zip(found.supplies, alone.supplies, strict=True):
            assert here.pressure == pytest.approx(there.pressure, rel=1e-5, abs=1e-2)
            assert here.volume == pytest.approx(there.volume, rel=1e-6)
            assert here.mass == pytest.approx(there.mass, rel=1e-6)
        assert found.positions == pytest.approx(alone.positions, abs=1e-8)


@pytest.mark.slow
def test_work_goes_on_along_a_path_of_supplies_and_comes_back():
    design = pair(VolumeSupply(chamber="left", value="0.4 mL", fluid="water"))
    path = vs.follow(design, "supplies[0].value=0..0.4..0 mL/9")
    work = [each.supplies[0].work for each in path.results]
    (alone,) = simulate(design).supplies
    # Steps of a path are added up by the trapezoidal rule, the longest ones being a quarter of it.
    assert work[4] == pytest.approx(alone.work, rel=5e-3)
    assert work[4] == max(work)
    assert abs(work[-1]) < 5e-3 * work[4]


def test_a_path_that_changes_more_of_supplies_is_refused():
    leaky = FlowSupply(chamber="left", source="5 kPa", valve={"conductance": "0.1 L/s/bar"})
    with pytest.raises(DesignError, match="changes more of supplies"):
        vs.follow(pair(leaky), "supplies[0].valve.conductance=0.1..0.2 L/s/bar/2")


@pytest.mark.slow
def test_supplies_follow_their_histories_along_time():
    ramp = {"time": ("0 s", "2 s"), "factor": (0, 1)}
    pushed = VolumeSupply(chamber="left", value="0.4 mL", fluid="water")
    held = PressureSupply(chamber="right", value="6 kPa")
    moving = pair(*(each.replace(history=ramp) for each in (pushed, held)))
    path = vs.follow(moving, "time=0..2 s/3")
    for found, part in zip(path.results, (0.0, 0.5, 1.0), strict=True):
        now = simulate(pair(*(each.replace(value=part * each.value) for each in (pushed, held))))
        assert found.positions == pytest.approx(now.positions, abs=1e-8)
        assert found.supplies[1].pressure == pytest.approx(part * 6 * kPa)
        # What a state says of its design is that instant alone: run again it is the same state.
        assert simulate(found.design).positions == pytest.approx(now.positions, abs=1e-8)


def test_a_valve_that_opens_over_time_is_refused_along_time():
    valve = {"conductance": "0.1 L/s/bar", "history": {"time": ("0 s", "1 s"), "factor": (0, 1)}}
    filled = pair(FlowSupply(chamber="left", source="5 kPa", valve=valve))
    with pytest.raises(SimulationError, match=r"supplies\[0\].valve.history: is not followed"):
        vs.follow(filled, "time=0..1 s/3")
