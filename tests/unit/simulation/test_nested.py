"""Equilibria on fine voxels that begin from those on voxels twice as large."""

from pathlib import Path

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Contact, Symmetry
from voxsoft.simulation import Setup
from voxsoft.simulation.runs.nested import nested
from voxsoft.simulation.runs.symmetric_body import SectorSetup
from voxsoft.units import kPa, mm

PNEUNET = vs.load(Path(__file__).parents[3] / "examples/pneunet.toml", chambers=2)
BALL = vs.Design(
    name="ball",
    voxel_size=5 * mm,
    fill="fraction",
    parts=[
        vs.Part(
            shape=vs.Sphere(radius=20 * mm) - vs.Sphere(radius=10 * mm),
            material=vs.NeoHookean(young=60 * kPa, poisson=0.49),
        )
    ],
    clamps=[vs.Clamp(region=vs.Region(z=("-inf", -15 * mm)))],
    loads=[vs.Pressure(value=5 * kPa)],
)


@pytest.fixture(scope="module")
def coarse():
    return vs.simulate(PNEUNET)


def test_the_fine_equilibrium_is_the_same_and_takes_fewer_iterations(coarse):
    """3 or 4 for 9 were seen: quadratic from the error of the large voxels on."""
    cold = vs.simulate(PNEUNET, refine=2)
    warm = vs.simulate(PNEUNET, refine=2, coarser=coarse)
    assert warm.steps <= 5 < cold.steps
    # Both are solved to 1e-8 of the load, which Newton's last step squares.
    moved = np.abs(cold.displacements).max()
    assert np.abs(warm.positions - cold.positions).max() < 1e-7 * moved


def test_pressures_are_those_around(coarse):
    setup = Setup.of(PNEUNET, refine=2)
    start = nested(coarse, setup)
    own = Setup(coarse.design, coarse.mesh).problem.pressures(coarse.positions)
    assert np.count_nonzero(start.pressures) >= len(setup.mesh.tets) // 5
    assert np.isclose(start.pressures.min(), np.nanmin(own))
    assert np.isclose(start.pressures.max(), np.nanmax(own))
    # Vertices of the large voxels go where they went.
    keys = map(tuple, np.rint(coarse.mesh.vertices * 1e7))
    where = dict(zip(keys, coarse.positions, strict=True))
    pairs = [
        (x, where[key])
        for at, x in zip(setup.mesh.vertices, start.positions, strict=True)
        if (key := tuple(np.rint(at * 1e7))) in where
    ]
    assert len(pairs) == len(coarse.mesh.vertices)
    assert np.allclose(*map(np.array, zip(*pairs, strict=True)), rtol=0.0, atol=1e-15)


def test_a_sector_begins_there_too(coarse):
    half = PNEUNET.replace(symmetry=[Symmetry(plane="y", at="10 mm")])
    part = SectorSetup.part_of(Setup.of(half, refine=2))
    whole, kept = nested(coarse, Setup.of(PNEUNET, refine=2)), nested(coarse, part)
    vertices = part.sector.vertices
    assert np.array_equal(kept.positions + part.origin, whole.positions[vertices])
    assert np.array_equal(kept.pressures, whole.pressures[vertices])
    warm = vs.simulate(half, refine=2, coarser=coarse)
    assert warm.status == "ok"
    assert warm.steps <= 5


@pytest.mark.slow
def test_a_small_voxel_outside_large_ones_has_no_first_pressure():
    """All its corners are those of other large voxels: a sheet that is thin for both sizes."""
    sheet = vs.Box(size=(20 * mm, 17.5 * mm, 20 * mm)) & vs.Gyroid(
        period=17.963 * mm, thickness=5.623 * mm
    )
    block = vs.Design(
        name="gyroid",
        voxel_size=2.5 * mm,
        fill="fraction",
        parts=[vs.Part(shape=sheet, material=vs.NeoHookean(young=160 * kPa, poisson=0.49))],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Gravity(value=47.0)],
    )
    large = vs.simulate(block)
    small = block.replace(voxel_size=1.25 * mm)
    assert nested(large, Setup.of(small)) is not None
    warm = vs.simulate(small, coarser=large)
    assert warm.status == "ok"
    assert np.allclose(
        warm.positions,
        vs.simulate(small).positions,
        rtol=0.0,
        atol=1e-6 * warm.metrics["max_displacement"],
    )


@pytest.mark.slow
def test_others_begin_at_rest(coarse):
    """Cut voxels that do not fill the large ones, and their contacts."""
    ball = vs.simulate(BALL)
    assert nested(ball, Setup.of(BALL, refine=2)) is None
    again = vs.simulate(BALL, refine=2, coarser=ball)
    assert np.array_equal(again.positions, vs.simulate(BALL, refine=2).positions)
    touching = PNEUNET.replace(contact=Contact())
    assert nested(coarse, Setup.of(touching, refine=2)) is None
    assert nested(coarse, Setup.of(PNEUNET)) is None
