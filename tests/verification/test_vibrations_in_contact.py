"""Natural frequencies of bodies that touch or hold gas, against closed forms."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft import _core
from voxsoft.simulation.results.vibration import _loaded
from voxsoft.simulation.setup.setup import Setup

#: Speed of waves along a bar: Young's modulus of 100 kPa, 1000 kg/m³, Poisson's ratio 0.
SPEED = 10.0
RUBBER = '{ model = "neo-hookean", young = "100 kPa", poisson = 0.0, density = "1000 kg/m^3" }'
HEAD = f"""
schema = "voxsoft/1"
name = "bar"
voxel_size = "5 mm"
[shapes]
bar = {{ kind = "box", size = ["40 mm", "20 mm", "20 mm"] }}
[[parts]]
shape = "bar"
material = {RUBBER}
[[clamps]]
region = {{ x = [0, 0] }}
"""
#: Pressed by half a thousandth of its length, so that stress changes no frequency by as much.
PLATE = """
[[objects]]
name = "plate"
shape = { kind = "box", size = ["10 mm", "60 mm", "60 mm"], corner = ["40 mm", "-20 mm", "-20 mm"] }
motion = { displacement = ["-0.02 mm", 0, 0] }
[contact]
friction = 0
"""
HALVES = f"""
schema = "voxsoft/1"
name = "halves"
voxel_size = "5 mm"
[[bodies]]
name = "left"
parts = [{{ shape = {{ kind = "box", size = ["20 mm", "20 mm", "20 mm"] }}, material = {RUBBER} }}]
[[bodies]]
name = "right"
parts = [{{ shape = {{ kind = "box", size = ["20 mm", "20 mm", "20 mm"] }}, material = {RUBBER} }}]
position = ["20 mm", 0, 0]
[[clamps]]
region = {{ x = [0, 0], body = "left" }}
[[clamps]]
region = {{ x = ["20 mm", "20 mm"], body = "right" }}
motion = {{ displacement = ["-0.02 mm", 0, 0] }}
[contact]
friction = 10
"""
SEALED = """
schema = "voxsoft/1"
name = "sealed"
voxel_size = "2.5 mm"
[shapes]
outer = { kind = "box", size = ["20 mm", "20 mm", "20 mm"] }
room = { kind = "box", size = ["10 mm", "10 mm", "10 mm"], corner = ["5 mm", "5 mm", "5 mm"] }
body = { kind = "difference", of = ["outer", "room"] }
[[parts]]
shape = "body"
material = { model = "neo-hookean", young = "20 kPa", poisson = 0.45, density = "1000 kg/m^3" }
[[clamps]]
region = { x = [0, 0] }
"""
SYRINGE = '[[supplies]]\nchamber = 0\nkind = "volume"\nvalue = "0.1 mL"\n'


def solved(tmp_path, text):
    file = tmp_path / "design.toml"
    file.write_text(text)
    return vs.simulate(vs.load(file), method="statics")


def has(frequencies, expected, tolerance):
    return (np.abs(frequencies / expected - 1.0) < tolerance).any()


def test_a_bar_pressed_on_a_smooth_plate_swings_between_two_ends(tmp_path):
    """Eight elements with lumped masses are 0.64 % low; contact gives way by h/1000 of a voxel."""
    free = vs.modes(solved(tmp_path, HEAD), 6).frequencies
    held = vs.modes(solved(tmp_path, HEAD + PLATE), 8).frequencies
    both, one = SPEED / (2 * 0.04), SPEED / (4 * 0.04)
    assert has(free, one, 0.01)
    assert not has(free, both, 0.01)
    assert has(held, both, 0.01)
    assert not has(held, one, 0.01)
    # The plate is smooth: its end slides as a free one in bending, but does not turn.
    assert free[0] < held[0]


@pytest.mark.long
def test_halves_that_stick_together_swing_as_one_bar(tmp_path):
    """Faces of the seam warp as free ones, 0.2 % in bending and torsion; contact is 1e-4."""
    clamped = HEAD + '[[clamps]]\nregion = { x = ["40 mm", "40 mm"] }\n'
    whole = vs.modes(solved(tmp_path, clamped), 4).frequencies
    halves = vs.modes(solved(tmp_path, HALVES), 4).frequencies
    assert halves == pytest.approx(whole, rel=0.005)


def test_a_sealed_chamber_pushes_back_as_its_gas_is_squeezed(tmp_path):
    """The square of a frequency is the stiffness along its shape, by differences of all forces."""
    result = solved(tmp_path, SEALED + SYRINGE)
    problem, positions = _loaded(Setup(result.design, result.mesh), result)
    squares, shapes = _core.modes(problem, positions, 12)
    # Shapes are 1 kg^-1/2 m or so: a thousandth of a voxel moves by 2.5e-6 m.
    step = 2.5e-6 / np.abs(shapes).max()
    for square, shape in zip(squares, shapes, strict=True):
        high, low = (problem.net_forces(positions + s * step * shape) for s in (1, -1))
        along = -np.vdot(shape, high - low) / (2 * step)
        assert along == pytest.approx(square, rel=1e-4)
    pressure = f"{result.supplies[0].pressure:.9g} Pa"
    given = solved(tmp_path, SEALED + f'[[loads]]\nkind = "pressure"\nvalue = "{pressure}"\n')
    assert given.positions == pytest.approx(result.positions, abs=2.5e-8)
    sealed, open_ = vs.modes(result, 12).frequencies, vs.modes(given, 12).frequencies
    # Of the first modes the swing along the axis alone changes the volume.
    rise = sealed / open_ - 1.0
    assert np.argmax(rise) == 3
    assert rise[3] > 0.005
    assert np.abs(np.delete(rise, 3)).max() < 1e-5


def test_a_weight_on_a_block_swings_as_a_mass_on_a_spring(tmp_path):
    text = f"""
schema = "voxsoft/1"
name = "weight"
voxel_size = "5 mm"
[shapes]
block = {{ kind = "box", size = ["20 mm", "20 mm", "20 mm"] }}
[[parts]]
shape = "block"
material = {RUBBER}
[[clamps]]
region = {{ z = [0, 0] }}
[[loads]]
kind = "gravity"
[[objects]]
name = "weight"
shape = {{ kind = "box", size = ["20 mm", "20 mm", "5 mm"], corner = [0, 0, "20 mm"] }}
motion = "free"
mass = "50 g"
[contact]
friction = 1
"""
    swings = vs.modes(solved(tmp_path, text), 6)
    assert np.linalg.norm(swings.shapes, axis=2).max(axis=1) == pytest.approx(1.0)
    found = swings.frequencies
    stiffness, mass = 100e3 * 4e-4 / 0.02, 0.05 + 0.008 / 3  # a third of the spring's own mass
    # The block is shorter by 1.2 % under the weight, and stiffer by as much and more.
    assert has(found, np.sqrt(stiffness / mass) / (2 * np.pi), 0.03)
