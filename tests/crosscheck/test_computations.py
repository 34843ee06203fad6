"""Exported computations run in CalculiX as written, and are those of a comparison."""

import shutil
import subprocess

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.comparison.bricks import BrickModel
from voxsoft.comparison.deck import Deck
from voxsoft.design import Contact, History, Object, Solver
from voxsoft.files.calculix import run_calculix
from voxsoft.units import kPa, mm

pytestmark = pytest.mark.skipif(
    shutil.which("ccx") is None, reason="CalculiX is not installed (apt install calculix-ccx)"
)

SOFT = vs.NeoHookean(young=60 * kPa, poisson=0.45, density=1000.0)
STIFF = vs.Ogden(mu=(90 * kPa, 2 * kPa), alpha=(2.0, 5.0), poisson=0.48, density=1200.0)
END = vs.Region(x=(40 * mm, 40 * mm))


def bar(**changes):
    """A bar of 40 x 10 x 10 mm, stiffer in its half by the clamp."""
    half = vs.Box(size=(20 * mm, 10 * mm, 10 * mm))
    whole = vs.Box(size=(40 * mm, 10 * mm, 10 * mm))
    entries = {
        "name": "bar",
        "voxel_size": 5 * mm,
        "parts": [
            vs.Part(name="stiff", shape=half, material=STIFF),
            vs.Part(name="soft", shape=whole, material=SOFT),
        ],
        "clamps": [vs.Clamp(region=vs.Region(x=(0, 0)))],
        "loads": [vs.Gravity(), vs.Traction(region=END, value=(0, 1 * kPa, 0))],
        "probes": {
            "tip": vs.Probe(x=(40 * mm, 40 * mm)),
            "side": vs.Probe(point=(31 * mm, 2 * mm, 10 * mm)),
        },
    }
    return vs.Design(**(entries | changes))


def run(deck, folder):
    """Run CalculiX on a file as a user does; return what it printed."""
    (folder / "it.inp").write_text(deck.text, encoding="ascii")
    ended = subprocess.run(
        ["ccx", "it"], cwd=folder, capture_output=True, text=True, timeout=300, check=False
    )
    assert ended.returncode == 0, ended.stdout[-2000:]
    assert "*ERROR" not in ended.stdout
    assert "*WARNING" not in ended.stdout
    return (folder / "it.dat").read_text()


def compared(deck):
    """The probes in m as a comparison finds them on the same bricks."""
    setup = deck.setup
    answer = run_calculix(BrickModel.of(setup, split=deck.model.split))
    assert answer.status == "ok"
    return {
        name: place.weights @ answer.displacements[place.vertices]
        for name, place in setup.places.items()
    }


@pytest.mark.parametrize("unit", ["mm", "um"])
def test_a_file_is_the_computation_of_a_comparison(unit, tmp_path):
    deck = Deck.of(bar(), unit=unit)
    found, expected = deck.displacements(run(deck, tmp_path)), compared(deck)
    assert found.keys() == expected.keys() == {"tip", "side"}
    for name in found:
        # Seven digits are printed of each node; in N a residual of 1e-8 counts as zero, that of a
        # strain of 1e-8 on a face of 1.5 N.
        size = np.linalg.norm(expected[name])
        assert size > 1 * mm
        np.testing.assert_allclose(found[name], expected[name], atol=1e-6 * size)


@pytest.mark.long
def test_a_finer_file_lies_within_the_error_bar_of_a_run(tmp_path):
    design = bar()
    deck = Deck.of(design, unit="um", split=2)
    found = deck.displacements(run(deck, tmp_path))["tip"]
    bars = vs.error_bars(vs.simulate(design, error="off")).probes["tip"]
    for axis in (1, 2):
        assert abs(found[axis] - bars[axis].estimate) <= bars[axis].error


def test_objects_touch_in_a_file_as_in_a_comparison(tmp_path):
    plate = Object(
        name="plate",
        shape=vs.Box(size=(30 * mm, 30 * mm, 4 * mm), center=(5 * mm, 5 * mm, 13 * mm)),
        motion=vs.Motion(displacement=(0, 0, -3 * mm)),
        voxel_size=4 * mm,
    )
    block = vs.Box(size=(10 * mm, 10 * mm, 10 * mm))
    design = bar(
        parts=[vs.Part(shape=block, material=SOFT)],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[],
        objects=[plate],
        contact=Contact(friction=0.2),
        probes={"top": vs.Probe(z=(10 * mm, 10 * mm))},
    )
    deck = Deck.of(design, unit="mm")
    found, expected = deck.displacements(run(deck, tmp_path)), compared(deck)
    assert found["top"][2] == pytest.approx(-2 * mm, rel=0.01)  # it stands 1 mm above the block
    np.testing.assert_allclose(found["top"], expected["top"], atol=1e-6 * 2 * mm)


@pytest.mark.long
def test_a_floor_carries_the_end_of_a_bar_in_a_file_as_in_ours(tmp_path):
    parts = [vs.Part(shape=vs.Box(size=(40 * mm, 10 * mm, 10 * mm)), material=SOFT)]
    design = bar(parts=parts, loads=[vs.Gravity()], floor=vs.Floor(z=-2 * mm))
    deck = Deck.of(design, unit="um")
    found, expected = deck.displacements(run(deck, tmp_path)), compared(deck)
    np.testing.assert_allclose(found["tip"], expected["tip"], atol=1e-6 * 2 * mm)
    ours = vs.simulate(design, error="off").probes["tip"][2]
    free = vs.simulate(design.replace(floor=None), error="off").probes["tip"][2]
    assert free < 2 * ours
    # The lower edge of the end lies on the floor; its middle goes as far but for the strain there.
    assert found["tip"][2] == pytest.approx(ours, rel=0.01)


@pytest.mark.long
def test_a_layer_bends_a_bar_in_a_file_as_in_ours(tmp_path):
    """A film of 40 times the stiffness of the bar below it, on a bar that is drawn."""
    film = vs.Layer(region=vs.Region(z=(0, 0)), young=20e6, thickness=0.2 * mm, name="film")
    pull = vs.Traction(region=END, value=(5 * kPa, 0, 0))
    parts = [vs.Part(shape=vs.Box(size=(40 * mm, 10 * mm, 10 * mm)), material=SOFT)]
    design = bar(parts=parts, layers=[film], loads=[pull], voxel_size=2.5 * mm)
    deck = Deck.of(design, unit="um")
    assert [each.where for each in deck.lost] == ["layers[0]"]
    found, expected = deck.displacements(run(deck, tmp_path)), compared(deck)
    size = np.linalg.norm(expected["tip"])
    np.testing.assert_allclose(found["tip"], expected["tip"], atol=1e-6 * size)
    bar_of = vs.error_bars(vs.simulate(design, error="off")).probes["tip"][2]
    free = vs.simulate(design.replace(layers=[]), error="off").probes["tip"]
    assert found["tip"][2] < -1 * mm < -100 * abs(free[2])  # the film alone bends it
    assert abs(found["tip"][2] - bar_of.estimate) <= bar_of.error


@pytest.mark.long
def test_a_motion_over_time_is_that_of_our_steps(tmp_path):
    """Two accelerations and a force, each with a history of its own."""
    rise = History(time=(0, 0.05, 0.1), factor=(0, 1, 0.3))
    loads = [
        vs.Gravity(value=2.0),
        vs.Gravity(value=6.0, history=rise),
        vs.Force(region=END, value=(0, 0, -0.01), history=rise),
    ]
    solver = Solver(method="dynamics", end_time=0.1, time_step=2e-3, damping=10.0)
    parts = [vs.Part(shape=vs.Box(size=(40 * mm, 10 * mm, 10 * mm)), material=SOFT)]
    design = bar(parts=parts, loads=loads, solver=solver)
    deck = Deck.of(design, unit="mm")
    assert deck.lost == ()
    course = deck.courses(run(deck, tmp_path))["tip"]
    times = np.array([0.0, *sorted(course)])
    moved = np.array([0.0, *(course[time][2] for time in sorted(course))])
    own = vs.simulate(design, record_interval=0.01, error="off").recording
    ours = own.probes["tip"][:, 2]
    apart = np.abs(np.interp(own.times, times, moved) - ours).max()
    # Two voxels across: the bricks are some 4 % stiffer than ours at rest, so that the body
    # swings 2 % faster there, which is up to 2 π · 0.02 of its swing after one period.
    assert apart < 2 * np.pi * 0.02 * np.abs(ours).max()


@pytest.mark.long
def test_a_falling_block_lands_on_a_floor_in_a_file_as_in_ours(tmp_path):
    block = vs.Box(size=(10 * mm, 10 * mm, 10 * mm))
    design = bar(
        parts=[vs.Part(shape=block, material=SOFT)],
        clamps=[],
        loads=[vs.Gravity()],
        floor=vs.Floor(z=-1 * mm),
        probes={"low": vs.Probe(z=(0, 0))},
        solver=Solver(method="dynamics", end_time=0.03, time_step=1e-3),
    )
    course = Deck.of(design, unit="mm").courses(run(Deck.of(design, unit="mm"), tmp_path))["low"]
    times = np.array(sorted(course))
    moved = np.array([course[time][2] for time in times])
    # It falls freely, from rest; the first step of 1 ms is the error of its time.
    before = times < 0.013
    freely = -9.81 / 2 * times[before] ** 2
    np.testing.assert_allclose(moved[before], freely, atol=9.81 * 0.013 * 1e-3)
    # It lands after sqrt(2 · 1 mm/g) = 14.3 ms, on the floor and not in it.
    assert moved.min() == pytest.approx(-1 * mm, rel=0.01)
    assert times[moved < -0.99 * mm].min() == pytest.approx(14.3e-3, abs=1e-3)
