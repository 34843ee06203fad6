"""Fields of force by formulas of place, velocity and time, beside closed forms and other loads."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft import _core
from voxsoft.design import Drag, ForceField, Gravity, Region
from voxsoft.errors import DesignError, SimulationError
from voxsoft.materials import NeoHookean
from voxsoft.shapes import Box
from voxsoft.simulation import Setup
from voxsoft.units import mm

#: Stiff, so that no part moves against another.
STIFF = NeoHookean(young=10e6, poisson=0.45, density=1100.0)
EDGE = 20 * mm


def cube(*loads, center=(0.0, 0.0, 0.0), **changes):
    """A free cube under some loads, in motion by implicit steps."""
    corner = tuple(each - EDGE / 2 for each in center)
    return vs.Design(
        name="cube",
        voxel_size=10 * mm,
        parts=[vs.Part(shape=Box(size=(EDGE, EDGE, EDGE), corner=corner), material=STIFF)],
        loads=loads,
        contact={},
        solver={"method": "dynamics", "end_time": 0.2, "time_step": 0.01, "damping": 0},
    ).replace(**changes)


def field(x, y=0, z=0, **more):
    return ForceField(acceleration=(x, y, z), **more)


def moved(design, **settings):
    """Mean place and velocity at the end, (3,) each."""
    result = vs.simulate(design, **settings)
    masses = Setup.of(design).problem_alone.masses
    return (masses @ result.positions) / masses.sum(), (masses @ result.velocities) / masses.sum()


def orders(design, exact):
    """Orders in the step of the error of the mean velocity at the end."""
    errors = [
        np.linalg.norm(moved(design, time_step=step)[1] - exact) for step in (0.01, 0.005, 0.0025)
    ]
    return np.log2(np.array(errors[:-1]) / errors[1:]), errors[-1]


@pytest.mark.parametrize("factor", [1.0, 0.5])
def test_a_constant_field_is_gravity_to_the_bit(factor):
    weights = Gravity(value=9.81 * factor), field(0, z="-9.81", value=factor)
    first, second = (vs.simulate(cube(each)) for each in weights)
    assert (first.positions == second.positions).all()
    assert (first.velocities == second.velocities).all()
    held = [
        cube(each, clamps=[vs.Clamp(region=Region(x=(-EDGE / 2, -EDGE / 2)))], contact=None)
        for each in weights
    ]
    first, second = (
        vs.simulate(each, method="statics", end_time=None, time_step=None, damping=None)
        for each in held
    )
    assert (first.positions == second.positions).all()
    assert np.abs(first.displacements).max() > 1e-7


def test_a_cube_on_a_spring_of_formulas_swings():
    rate, start = 20.0, (10 * mm, 0.0, -4 * mm)
    design = cube(field("-400*x", 0, "-20^2*z"), center=start)
    place, _ = moved(design, time_step=0.0025)
    exact = np.array(start) * np.cos(rate * 0.2)
    # The phase is off by a third of the square of an angle of a twentieth, over 0.64 of a period.
    assert place == pytest.approx(exact, abs=3e-3 * np.linalg.norm(start))
    found, left = orders(design, -rate * np.array(start) * np.sin(rate * 0.2))
    assert found == pytest.approx([2.0, 2.0], abs=0.3)
    assert left < 1e-2 * rate * np.linalg.norm(start)


def test_a_brake_by_velocity_lets_speed_come_to_an_end():
    design = cube(field("2", 0, "-9.81 - 8*vz"))
    exact = np.array([0.4, 0.0, -9.81 / 8.0 * (1.0 - np.exp(-8.0 * 0.2))])
    found, left = orders(design, exact)
    assert found == pytest.approx([2.0, 2.0], abs=0.3)
    assert left < 1e-3 * np.linalg.norm(exact)


def test_a_charge_in_crossed_fields_goes_round():
    # v' = (E + w vy, -w vx): a skew tangent, which a search by a potential would not find.
    pull, rate = 3.0, 20.0
    angle = rate * 0.2
    exact = pull / rate * np.array([np.sin(angle), np.cos(angle) - 1.0, 0.0])
    found, left = orders(cube(field("3 + 20*vy", "-20*vx")), exact)
    assert found == pytest.approx([2.0, 2.0], abs=0.3)
    assert left < 1e-2 * pull / rate


def test_a_field_over_time_gives_its_integral():
    exact = np.array([0.0, 2.0 / 30.0 * (1.0 - np.cos(30.0 * 0.2)), 0.0])
    found, left = orders(cube(field(0, "2*sin(30*t)")), exact)
    assert found == pytest.approx([2.0, 2.0], abs=0.3)
    assert left < 1e-2 * 2.0 / 30.0


def test_a_bar_in_a_field_that_grows_along_it_stretches():
    length, young, density, pull = 40 * mm, 100e3, 1000.0, 5.0
    bar = vs.Design(
        name="bar",
        voxel_size=4 * mm,
        parts=[
            vs.Part(
                shape=Box(size=(length, 8 * mm, 8 * mm), corner=(0, 0, 0)),
                material=NeoHookean(young=young, poisson=0.0, density=density),
            )
        ],
        clamps=[vs.Clamp(region=Region(x=(0, 0)))],
        loads=[field("5*x/0.04")],
        probes={"tip": vs.Probe(x=(length, length))},
    )
    # E u'' = -ρ a x/L with u'(L) = 0; masses at the ends of voxels have a larger moment of x.
    exact = density * pull * length**2 / (3.0 * young) * (1.0 + 0.5 * (4 * mm / length) ** 2)
    # The strain is a thousandth.
    assert vs.simulate(bar).probes["tip"][0] == pytest.approx(exact, rel=2e-3)


def test_live_bodies_take_fields_beside_drag():
    """The search under hands holds forces without a potential for a step, and drag within it."""
    design = cube(field("0", 0, "-9.81 - 8*vz"), Drag(normal=5.0), contact=None)
    setup = Setup.of(design)
    triangles = setup.mesh.triangles.astype(np.uint32)
    tags = np.zeros(len(triangles), np.uint8)
    live = _core.Live(setup.problem, triangles, tags, design.voxel_size, damping=0.0)
    start, before = live.advance(24).time, live.positions().mean(axis=0)
    took = live.advance(10).time - start
    speed = (live.positions().mean(axis=0) - before)[2] / took
    # m g = m c v + ρ cₙ A v²/2
    mass, half = setup.problem.mass, 0.5 * 5.0 * 1000.0 * EDGE**2
    exact = (np.sqrt((8.0 * mass) ** 2 + 4.0 * half * 9.81 * mass) - 8.0 * mass) / (2.0 * half)
    assert speed == pytest.approx(-exact, rel=1e-4)


def test_a_command_scales_a_field():
    simulator = vs.Simulator(cube(field(0, z="-9.81 - 8*vz"), contact=None))
    here = simulator.step().positions.mean(axis=0)
    for _ in range(3):
        there = simulator.step({"force_field": 0.0}).positions.mean(axis=0)
    assert here[2] < -1e-6
    # Nothing brakes any more.
    last = simulator.step().positions.mean(axis=0)
    assert last - there == pytest.approx(there - here, abs=np.abs(there - here).max())
    assert last[2] < there[2] < here[2]


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("-9.81*hight", r'at character 7: "hight" is not known; known are x y z vx vy vz t pi'),
        ("9.81 m/s^2", r"at character 6: 'm' came; expected an operator or the end"),
        ("2 + log(0)", r"a constant part has no finite value"),
        ("2*(x", r"at character 5: expected '\)'"),
        ("", r"at character 1: the text ends"),
    ],
)
def test_text_that_is_no_formula_is_refused_at_its_place(text, what):
    with pytest.raises(DesignError, match=rf"loads\[1\]\.acceleration\[2\]: {what}.*m/s and t"):
        cube(Gravity(), {"kind": "force_field", "acceleration": [0, 0, text]})


def test_a_formula_of_the_design_has_the_unit_of_an_acceleration():
    document = {
        **cube().document,
        "parameters": {"g": "1.62 m/s^2", "wide": "5 mm"},
        "loads": [{"kind": "force_field", "acceleration": [0, 0, "= -2*g"]}],
    }
    assert vs.Design.from_document(document).loads[0].acceleration[2] == "-3.24"
    document["loads"][0]["acceleration"][2] = "= 2*wide"
    with pytest.raises(DesignError, match=r"acceleration\[2\].*a length.*, not an acceleration"):
        vs.Design.from_document(document)


def test_a_field_without_a_value_names_the_place():
    with pytest.raises(DesignError, match=r"loads\[0\]\.acceleration\[1\].*at \(.*\) mm.*t = 0"):
        vs.simulate(cube(field(0, "1/x")))


def test_a_field_over_time_needs_a_motion():
    with pytest.raises(SimulationError, match=r"loads\[0\]\.acceleration: changes with t, and"):
        vs.simulate(cube(field(0, "t"), contact=None, solver={"method": "statics"}))
    with pytest.raises(SimulationError, match=r"loads\[0\]: is known .* method = \"dynamics\""):
        vs.simulate(cube(field(0, "x"), contact=None), method="xpbd")


def test_gradients_in_a_skew_field_are_those_of_differences():
    goal = {"reach": {"maximize": "displacement", "probe": "tip", "axis": "z"}}

    def at(young):
        soft = NeoHookean(young=young, poisson=0.45, density=1100.0)
        return vs.Design(
            name="bar",
            voxel_size=5 * mm,
            parts=[
                vs.Part(
                    shape=Box(size=(30 * mm, 10 * mm, 10 * mm), corner=(0, 0, 0)), material=soft
                )
            ],
            clamps=[vs.Clamp(region=Region(x=(0, 0)))],
            loads=[field("20*y", "-60*x", "-9.81 + 30*x")],
            probes={"tip": vs.Probe(x=(30 * mm, 30 * mm))},
            objectives=goal,
        )

    def reach(young):
        return vs.simulate(at(young), method="statics", tolerance=1e-11).probes["tip"][2]

    rest = vs.simulate(at(100e3), method="statics", tolerance=1e-10)
    name = "parts.0.material.young"
    found = vs.gradient(rest, ["reach"], [name])["reach"][name]
    # The slope changes by a millionth of it over a thousandth of the modulus.
    assert found == pytest.approx((reach(100.1e3) - reach(99.9e3)) / 200.0, rel=1e-5)
