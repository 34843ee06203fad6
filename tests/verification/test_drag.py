"""Drag of a fluid: the fall to a terminal speed, flows, balls, turned bodies, and energy."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft import _core
from voxsoft.design import Drag, Gravity, Region
from voxsoft.errors import DesignError, SimulationError
from voxsoft.geometry import rotation_matrix
from voxsoft.materials import NeoHookean
from voxsoft.shapes import Box, Sphere
from voxsoft.simulation import Setup
from voxsoft.units import mm

#: Stiff, so that no part moves against another.
STIFF = NeoHookean(young=10e6, poisson=0.45, density=1100.0)
EDGE = 20 * mm
CUBE = Box(size=(EDGE, EDGE, EDGE), corner=(-EDGE / 2, -EDGE / 2, -EDGE / 2))
RADIUS = 9 * mm
BALL = Sphere(radius=RADIUS)


def falling(shape, drag, end, step, **changes):
    """Speed along z of a free body that falls through a fluid, and its mass."""
    design = vs.Design(
        name="falling",
        voxel_size=changes.pop("voxel_size", 10 * mm),
        parts=[vs.Part(shape=shape, material=STIFF)],
        loads=[Gravity(), drag],
        solver={"method": "dynamics", "end_time": end, "time_step": step, "damping": 0},
    ).replace(**changes)
    result = vs.simulate(design)
    masses = Setup.of(design).problem.masses
    return (masses @ result.velocities)[2] / masses.sum(), masses.sum()


def test_a_cube_falls_as_the_hyperbolic_tangent_says():
    coefficient, end = 1.3, 0.1
    drag = Drag(normal=coefficient)
    errors = []
    for step in (10e-3, 5e-3, 2.5e-3):
        speed, mass = falling(CUBE, drag, end, step)
        # m v' = m g − ρ c A v²/2
        terminal = np.sqrt(2.0 * mass * 9.81 / (1000.0 * coefficient * EDGE**2))
        errors.append(speed / (-terminal * np.tanh(9.81 * end / terminal)) - 1.0)
    # The error falls with the square of the step.
    orders = np.log2(np.abs(errors[:-1]) / np.abs(errors[1:]))
    assert orders == pytest.approx([2.0, 2.0], abs=0.35)
    assert abs(errors[-1]) < 1e-3


def test_a_cube_comes_to_its_terminal_speed():
    speed, mass = falling(CUBE, Drag(value=1000.0), 0.6, 10e-3)
    terminal = np.sqrt(2.0 * mass * 9.81 / (1000.0 * EDGE**2))
    # The step leaves no error in what stays; the pressure squeezes the cube by part of a modulus.
    assert speed == pytest.approx(-terminal, rel=0.5 * 1000.0 * terminal**2 / 10e6)


@pytest.mark.parametrize("fill", ["fraction", "binary"])
def test_a_ball_has_half_the_coefficient(fill):
    changes = {"voxel_size": 3 * mm, "fill": fill}
    speed, mass = falling(BALL, Drag(normal=0.9), 0.6, 10e-3, **changes)
    terminal = np.sqrt(2.0 * mass * 9.81 / (1000.0 * 0.45 * np.pi * RADIUS**2))
    # Chords of half a voxel lie inside of the ball, by an eighth of their squared angle.
    assert speed == pytest.approx(-terminal, rel=(1.5 * mm / RADIUS) ** 2 / 8.0)


def test_a_ball_sinks_slowly_as_stokes_says():
    viscosity, density = 1.0, 1000.0
    drag = Drag(normal=0.0, linear=1.5 * viscosity / density / RADIUS, value=density)
    end = 0.02
    speed, mass = falling(BALL, drag, end, 5e-4, voxel_size=3 * mm)
    rate = 6.0 * np.pi * viscosity * RADIUS / mass
    # As above.
    exact = -9.81 / rate * (1.0 - np.exp(-rate * end))
    assert speed == pytest.approx(exact, rel=(1.5 * mm / RADIUS) ** 2 / 8.0)


def in_flow(flow, **changes):
    """A block on a wall in a flow."""
    size = (30 * mm, 10 * mm, 20 * mm)
    return vs.Design(
        name="block",
        voxel_size=5 * mm,
        parts=[
            vs.Part(
                shape=Box(size=size, corner=(0, 0, 0)),
                material=NeoHookean(young=100e3, poisson=0.45, density=1100.0),
            )
        ],
        clamps=[vs.Clamp(region=Region(x=(0, 0)))],
        loads=[Drag(normal=1.0, tangential=0.1, linear="1 cm/s", flow=flow)],
        probes={"tip": vs.Probe(point=(30 * mm, 5 * mm, 10 * mm))},
    ).replace(**changes)


def test_a_block_at_rest_in_a_flow_is_the_end_of_its_motion():
    design = in_flow(("0.1 m/s", "0.2 m/s", "0.3 m/s"))
    rest = vs.simulate(design, method="statics")
    moved = vs.simulate(design, method="dynamics", tolerance=1e-7, max_time=20.0)
    assert moved.status == rest.status == "ok"
    assert moved.probes["tip"] == pytest.approx(rest.probes["tip"], rel=1e-4)
    assert moved.reaction == pytest.approx(rest.reaction, rel=1e-3)
    assert np.abs(rest.probes["tip"]).min() > 1e-6


def test_a_flow_pushes_a_stiff_block_as_its_sides_say():
    speed = np.array([0.1, 0.2, 0.3])
    design = in_flow(tuple(speed))
    part = design.parts[0].replace(material=STIFF)
    found = vs.simulate(design.replace(parts=[part]), method="statics")
    edges = np.array([30 * mm, 10 * mm, 20 * mm])
    sides = edges.prod() / edges
    # The side at −x meets the flow too, though a wall holds it.
    force = 1000.0 * (0.5 * sides * speed**2 + 0.01 * 2.0 * sides.sum() * speed)
    for axis in range(3):
        along = np.where(np.arange(3) == axis, 0.0, speed)
        force += 1000.0 * 0.1 / 2.0 * 2.0 * sides[axis] * np.linalg.norm(along) * along
    assert found.reaction == pytest.approx(-force, rel=2e-3)


def test_a_turned_block_in_a_turned_flow_answers_the_same_turned():
    turn = rotation_matrix((1.0, 2.0, -1.0), 0.7)
    flow = np.array([0.05, 0.2, -0.3])
    design = in_flow(tuple(flow))
    whole = vs.simulate(design, method="statics", tolerance=1e-9)
    body = {"rotation": {"axis": (1.0, 2.0, -1.0), "angle": 0.7}}
    turned = in_flow(
        tuple(turn @ flow),
        bodies=[{"name": "block", **body}],
        parts=[design.parts[0].replace(body="block")],
        clamps=[vs.Clamp(region=Region(x=(0, 0), body="block"))],
        probes={},
    )
    found = vs.simulate(turned, method="statics", tolerance=1e-9)
    assert found.reaction == pytest.approx(turn @ np.array(whole.reaction), rel=1e-6)


def test_walls_of_a_closed_cavity_feel_no_fluid():
    full, hollow = (
        sum(len(each.triangles) for each in Setup.of(ball).outer_surfaces)
        for ball in (
            in_flow(
                (0, 0, "1 m/s"),
                parts=[vs.Part(shape=shape, material=STIFF)],
                clamps=[],
                probes={},
                solver={"end_time": 1.0},
                voxel_size=3 * mm,
            )
            for shape in (BALL, BALL - Sphere(radius=4 * mm))
        )
    )
    assert full == hollow > 0


def test_drag_takes_the_energy_of_a_body_that_swings():
    design = in_flow((0, 0, 0), clamps=[vs.Clamp(region=Region(x=(0, 0)))]).replace(
        loads=[
            Drag(normal=5.0),
            vs.Force(
                region=Region(x=(30 * mm, 30 * mm)),
                value=(0, 0, "0.3 N"),
                history={"time": (0, "1 ms"), "factor": (1, 0)},
            ),
        ],
        contact={},
    )
    found = vs.simulate(
        design, method="dynamics", end_time=0.3, time_step=1e-3, damping=0, record_interval=0.01
    )
    energy = found.recording.elastic_energy + found.recording.kinetic_energy
    assert energy[1] > 0.0
    assert (np.diff(energy[1:]) < 1e-9 * energy[1]).all()


def test_refusals_name_the_place_and_a_remedy():
    with pytest.raises(DesignError, match=r"drag below zero would drive the body.*from 0 on"):
        Drag(history={"time": (0, "1 s"), "factor": (1, -1)})
    design = in_flow((0, 0, 0), solver={"method": "xpbd", "end_time": 0.1})
    with pytest.raises(SimulationError, match=r'loads\[0\]: is known .* method = "dynamics"'):
        vs.simulate(design)


@pytest.mark.parametrize("material", [STIFF, vs.Lattice(edge=1e6, bulk=3e6, density=1100.0)])
def test_live_bodies_come_to_the_terminal_speed_too(material):
    design = vs.Design(
        name="falling",
        voxel_size=10 * mm,
        parts=[vs.Part(shape=CUBE, material=material)],
        loads=[Gravity(), Drag(normal=5.0)],
        solver={"end_time": 1.0},
    )
    setup = Setup.of(design)
    triangles = setup.mesh.triangles.astype(np.uint32)
    tags = np.zeros(len(triangles), np.uint8)
    live = _core.Live(setup.problem, triangles, tags, design.voxel_size, damping=0.0)
    start, before = live.advance(24).time, live.positions().mean(axis=0)
    took = live.advance(10).time - start
    speed = (live.positions().mean(axis=0) - before)[2] / took
    terminal = np.sqrt(2.0 * setup.problem.mass * 9.81 / (5.0 * 1000.0 * EDGE**2))
    # Twice exp(−2 g t / v) of it is missing after 0.4 s, and a squeeze as above.
    assert speed == pytest.approx(-terminal, rel=1e-4)


def test_a_simulator_begins_in_the_fluid_of_the_design_and_goes_on_to_the_bit():
    flow = in_flow(("0.1 m/s", 0, "0.3 m/s"))
    simulator, still = vs.Simulator(flow), vs.Simulator(flow)
    assert simulator.step().positions.any()
    state = simulator.state
    ends = []
    for _ in range(2):
        simulator.restore(state)
        for _ in range(3):
            found = simulator.step().positions
        ends.append(found)
    assert (ends[0] == ends[1]).all()
    for _ in range(4):
        unmoved = still.step({"drag": 0.0}).positions
    rest = Setup.of(flow).mesh.vertices
    assert np.abs(ends[0] - rest).max() > 1e-5
    assert np.abs(unmoved - rest).max() < 1e-12


def test_gradients_in_a_flow_are_those_of_differences():
    """The tangent of a body at rest in a flow is not symmetric."""
    flow = {"kind": "drag", "tangential": 0.1, "linear": 0.01, "flow": (0.1, 0.2, 0.6)}
    goal = {"reach": {"maximize": "displacement", "probe": "tip", "axis": "z"}}

    def at(density):
        return in_flow((0, 0, 0), loads=[{**flow, "value": density}], objectives=goal)

    def reach(density):
        return vs.simulate(at(density), method="statics", tolerance=1e-11).probes["tip"][2]

    rest = vs.simulate(at(1000.0), method="statics", tolerance=1e-10)
    found = vs.gradient(rest, ["reach"], ["loads.0.value"])["reach"]["loads.0.value"]
    # Positions of 3 cm are known to 1e-16 m or so, over a change of 1e-7 m.
    assert found == pytest.approx((reach(1000.1) - reach(999.9)) / 0.2, rel=1e-6)
