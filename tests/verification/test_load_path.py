"""Load paths: the branch that is found, and the rest of a path that is lost."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.simulation import simulate
from voxsoft.units import kPa, mm

RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.49)
SIDE, HEIGHT = 10 * mm, 80 * mm


def column(lean):
    """A column under its weight, a part `lean` of it along x. Upright it buckles at 3/4 of it."""
    return vs.Design(
        name="column",
        voxel_size=5 * mm,
        parts=[vs.Part(shape=vs.Box(size=(SIDE, SIDE, HEIGHT)), material=RUBBER)],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Gravity(direction=(lean, 0.0, -1.0))],
        probes={"top": vs.Probe(point=(SIDE / 2, SIDE / 2, HEIGHT))},
    )


@pytest.mark.parametrize("lean", [0.002, 0.02])
def test_a_long_step_to_an_unstable_branch_is_cut(lean):
    """In one step it leans against its load, by 7 mm for 0.02, in a state that is not stable."""
    result = simulate(column(lean), method="statics")
    assert result.status == "ok", result.message
    assert result.stable is True
    assert result.back_offs > 0
    sideways = result.recording.probes["top"][:, 0]
    # A path from rest leans one way only, and ever farther.
    assert np.all(np.diff(sideways) > 0.0)
    assert sideways[-1] > HEIGHT / 2


def test_a_bifurcation_is_passed_and_reported_to_be_one():
    result = simulate(column(0.0), method="statics")
    assert result.status == "ok", result.message
    assert result.stable is False
    assert "where the body can buckle" in result.message
    # Nothing pushes the upright one sideways but rounding.
    assert abs(result.probes["top"][0]) < 1e-6 * HEIGHT


def test_a_path_that_is_cut_short_keeps_its_states():
    """A chamber cannot grow sixfold in a block of 4.6 times its volume whose outside is held."""
    size, wall = 25 * mm, 5 * mm
    inside = vs.Box(size=(size - 2 * wall,) * 3, corner=(wall,) * 3)
    faces = [vs.Region(**{axis: (at, at)}) for axis in "xyz" for at in (0, size)]
    design = vs.Design(
        name="boxed chamber",
        voxel_size=wall,
        parts=[vs.Part(shape=vs.Box(size=(size,) * 3) - inside, material=RUBBER)],
        clamps=[vs.Clamp(region=face) for face in faces],
        loads=[vs.Pressure(value=15 * kPa)],
    )
    result = simulate(design, method="statics", control="volume", volume_ratio=6.0, steps=10)
    assert result.status == "not-at-rest"
    (cavity,) = result.mesh.cavities
    growth = result.metric("cavity_volume_change") / cavity.volume
    # The block is full at (125 - 27)/27; its walls of ten percent that count as sound leave less.
    assert 1.0 < growth < 3.6
    assert f"followed for {100 * growth / 5.0:.4g} % of the growth in volume" in result.message
    assert "kept are the path so far" in result.message
    # The path goes to the state that is kept, which is an equilibrium.
    assert len(result.recording.times) > 2
    assert result.recording.times[-1] == result.load_factor
    assert result.residual < 1e-8


def test_a_body_that_bends_far_begins_with_a_part_of_the_load():
    """The linear answer turns its end by 2.5 rad: trying all at once took 35 iterations."""
    side, rubber = 10 * mm, vs.NeoHookean(young=60 * kPa, poisson=0.49, density=1070)
    beam = vs.Design(
        name="beam",
        voxel_size=side,
        parts=[vs.Part(shape=vs.Box(size=(10 * side, side, side)), material=rubber)],
        clamps=[vs.Clamp(region=vs.Region(x=(0, side)))],
        loads=[vs.Gravity()],
    )
    found = vs.simulate(beam, method="statics")
    assert found.status == "ok"
    assert found.steps < 25
    small_steps = vs.simulate(beam, method="statics", first_step=0.1)
    # Far above what a residual of 1e-8 leaves of displacements of 0.1 m.
    assert abs(found.positions - small_steps.positions).max() < 1e-9
