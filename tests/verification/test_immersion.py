"""Immersion in a liquid: buoyancy, pressure at a depth, sinking, and bodies that come out of it."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Gravity, Immersion, Region
from voxsoft.errors import DesignError
from voxsoft.geometry import tet_volumes
from voxsoft.materials import NeoHookean
from voxsoft.shapes import Sphere
from voxsoft.simulation import Setup
from voxsoft.simulation.loads import LoadReceiver
from voxsoft.units import kPa, mm

RUBBER = NeoHookean(young=100 * kPa, poisson=0.45, density=1100.0)
CENTER, RADIUS = (0.0, 0.0, -50 * mm), 9 * mm


def ball(shape, **changes):
    """A ball 5 cm under water, held in its middle."""
    return vs.Design(
        name="ball",
        voxel_size=2 * mm,
        parts=[vs.Part(name="ball", shape=shape, material=RUBBER)],
        clamps=[vs.Clamp(region=Region(x=(-1 * mm, 1 * mm), y=(-1 * mm, 1 * mm)))],
        loads=[Gravity(), Immersion()],
    ).replace(**changes)


FULL = Sphere(radius=RADIUS, center=CENTER)
HOLLOW = FULL - Sphere(radius=4 * mm, center=CENTER)


@pytest.mark.parametrize("shape", [FULL, HOLLOW], ids=["full", "hollow"])
def test_the_clamp_carries_weight_less_buoyancy(shape):
    result = vs.simulate(ball(shape))
    mesh, now = result.mesh, result.positions
    displaced = mesh.volume + sum(cavity.volume for cavity in mesh.cavities)
    # The ball of the shapes, but for its flat voxels: the closed cavity displaces water too.
    assert displaced == pytest.approx(4 / 3 * np.pi * RADIUS**3, rel=2e-3)
    filled = mesh.fractions[mesh.tet_voxel]
    squeezed = filled @ tet_volumes(now, mesh.tets) + sum(result.cavity_volumes)
    assert 0.99 * displaced < squeezed < 0.9999 * displaced
    carried = 9.81 * (1000.0 * squeezed - 1100.0 * mesh.volume)
    # Tets of one split and of both differ in volume by the square of the strain.
    assert result.reaction[2] == pytest.approx(-carried, abs=1e-4 * 9810.0 * displaced)
    assert np.abs(result.reaction[:2]).max() < 1e-6 * 9810.0 * displaced


def test_the_forces_are_those_of_the_core_wherever_the_body_is():
    design = ball(HOLLOW, loads=[Immersion()])
    setup, twice = Setup.of(design), Setup.of(design.replace(loads=[Immersion(value=2000.0)]))
    moved = setup.mesh.vertices + np.random.default_rng(1).normal(0.0, 3e-4, (1, 3))
    moved = moved + np.random.default_rng(2).normal(0.0, 3e-4, moved.shape)
    # The difference of two densities is free of the body's own forces.
    core = twice.problem.net_forces(moved) - setup.problem.net_forces(moved)
    forces = sum(action.forces(moved) for action in setup.loads[0].actions)
    assert forces == pytest.approx(core, abs=1e-12 * np.abs(core).max())


class Total(LoadReceiver):
    """The resultant of a load, for a receiver that knows no depth."""

    def __init__(self, mesh):
        super().__init__(mesh)
        self.total = np.zeros(3)

    def acceleration(self, acceleration):
        raise AssertionError

    def pressure(self, triangles, value, cavity):
        raise AssertionError

    def forces(self, vertices, forces):
        self.total += forces.sum(axis=0)


def test_a_receiver_without_depth_takes_the_buoyancy_of_the_unloaded_body():
    setup = Setup.of(ball(HOLLOW))
    receiver = Total(setup.mesh)
    for action in setup.loads[1].actions:
        action.give_to(receiver)
    displaced = setup.mesh.volume + setup.mesh.cavities[0].volume
    assert receiver.total == pytest.approx([0.0, 0.0, 9810.0 * displaced], abs=1e-12)


def test_a_cube_at_a_depth_is_squeezed_from_all_sides():
    depth, edge, bulk = 1.0, 10 * mm, 100e3 / (3 * (1 - 2 * 0.45))
    floating = NeoHookean(young=100 * kPa, poisson=0.45, density=1000.0)
    cube = vs.Design(
        name="cube",
        voxel_size=5 * mm,
        parts=[vs.Part(shape=vs.Box(size=(edge, edge, edge), corner=(0, 0, 0)), material=floating)],
        clamps=[
            vs.Clamp(region=Region(x=(0, 0)), axes="x"),
            vs.Clamp(region=Region(y=(0, 0)), axes="y"),
            vs.Clamp(region=Region(z=(0, 0)), axes="z"),
        ],
        loads=[Gravity(), Immersion(level=depth)],
        probes={"corner": vs.Probe(point=(edge, edge, edge))},
    )
    # The pressure is K (1 - J), and nothing else acts on a body as heavy as its water.
    pressure = 9810.0 * (depth - edge / 2)
    exact = edge * ((1.0 - pressure / bulk) ** (1 / 3) - 1.0)
    # From the middle to the corner the depth differs by half an edge.
    assert vs.simulate(cube).probes["corner"] == pytest.approx([exact] * 3, rel=edge / depth)


@pytest.mark.long
def test_a_ball_sinks_as_its_weight_in_water_says():
    rate, end = 8.0, 0.1
    stiff = NeoHookean(young=10e6, poisson=0.49, density=1100.0)  # which water does not squeeze
    falling = ball(
        FULL,
        parts=[vs.Part(shape=FULL, material=stiff)],
        clamps=[],
        contact={},  # so that steps are implicit
        solver={"method": "dynamics", "end_time": end, "time_step": 2e-3, "damping": rate},
    )
    result = vs.simulate(falling)
    masses = Setup.of(falling).problem_alone.masses
    speed = (masses @ result.velocities)[2] / masses.sum()
    # m v' = (m − ρ V) g − m c v
    drive = 9.81 * (1.0 - 1000.0 * result.mesh.volume / masses.sum())
    exact = -drive / rate * (1.0 - np.exp(-rate * end))
    # Steps are of second order, and rate times step is a sixtieth.
    assert speed == pytest.approx(exact, rel=1e-3)


def test_a_body_above_the_surface_is_reported():
    with pytest.raises(DesignError, match=r"loads\[1\].level: is .* below the highest voxels"):
        Setup.of(ball(FULL, loads=[Gravity(), Immersion(level="-45 mm")])).loads  # noqa: B018
    low = ball(
        FULL,
        loads=[Immersion(level="-39 mm")],
        clamps=[
            {
                "region": {"x": ("-1 mm", "1 mm")},
                "motion": {"displacement": (0, 0, "5 mm")},
            }
        ],
    )
    found = {each.where for each in vs.simulate(low).warnings}
    assert "loads[0].level" in found
    assert "loads[1].level" not in {each.where for each in vs.simulate(ball(FULL)).warnings}
