"""CalculiX and the code with scikit-fem share no line past the nodes; both must agree."""

import os
import shutil
from contextlib import suppress

import numpy as np
import pytest
from scipy.optimize import brentq
from waiting import until

import voxsoft as vs
from voxsoft.comparison.bricks import BrickModel
from voxsoft.comparison.scikit_fem import run_scikit_fem
from voxsoft.errors import MissingPackageError, OutsideCodeError, SimulationError
from voxsoft.files.calculix import run_calculix
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

needs_calculix = pytest.mark.skipif(
    shutil.which("ccx") is None, reason="CalculiX is not installed (apt install calculix-ccx)"
)

NODES = {"CalculiX": 20, "scikit-fem": 27}
BOTH = [
    pytest.param(lambda s: run_calculix(BrickModel.of(s)), marks=needs_calculix, id="calculix"),
    pytest.param(lambda s: run_scikit_fem(BrickModel.of(s, nodes=27)), id="scikit-fem"),
]

MATERIALS = {
    "neo-hookean": vs.NeoHookean(young=60 * kPa, poisson=0.49),
    "mooney-rivlin": vs.MooneyRivlin(c10=8 * kPa, c01=2 * kPa, poisson=0.48),
    "yeoh": vs.Yeoh(c=(8 * kPa, -0.2 * kPa, 0.3 * kPa), poisson=0.48),
    "ogden": vs.Ogden(mu=(24 * kPa, 67.0, 454.0), alpha=(1.7, 7.1, -3.4), poisson=0.48),
}


def bar(material):
    """A bar that is drawn to one and a half times its length and sideways."""
    return Setup.of(
        vs.Design(
            name="bar",
            voxel_size=5 * mm,
            parts=[vs.Part(shape=vs.Box(size=(20 * mm, 5 * mm, 5 * mm)), material=material)],
            clamps=[
                vs.Clamp(region=vs.Region(x=(0, 0))),
                vs.Clamp(
                    region=vs.Region(x=(20 * mm, 20 * mm)),
                    motion=vs.Motion(displacement=(10 * mm, 2 * mm, 0)),
                ),
            ],
            loads=[vs.Gravity()],
        )
    )


def block(pressure=3 * kPa):
    """A cube with a cubic hole, held below and under pressure.

    Poisson's ratio is far from 0.5, so that the height depends on the hole and not on rounding.
    """
    material = vs.NeoHookean(young=60 * kPa, poisson=0.4)
    outer = vs.Box(size=(15 * mm, 15 * mm, 15 * mm))
    hole = vs.Box(size=(5 * mm, 5 * mm, 5 * mm), corner=(5 * mm, 5 * mm, 5 * mm))
    return Setup.of(
        vs.Design(
            name="block",
            voxel_size=5 * mm,
            parts=[vs.Part(shape=outer - hole, material=material)],
            clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
            loads=[vs.Pressure(value=pressure), vs.Gravity()],
        )
    )


@needs_calculix
@pytest.mark.parametrize("name", MATERIALS)
def test_both_codes_agree_on_a_drawn_bar(name):
    setup = bar(MATERIALS[name])
    quadratic = run_calculix(BrickModel.of(setup, split=2))
    mixed = run_scikit_fem(BrickModel.of(setup, split=1, nodes=27))
    assert quadratic.status == mixed.status == "ok"
    # Middle vertices, away from the corners of the clamps where stresses are singular. Four bricks
    # and 32: measured 0.3 % of the displacement apart.
    middle = np.flatnonzero(np.isclose(setup.mesh.vertices[:, 0], 10 * mm))
    apart = quadratic.displacements[middle] - mixed.displacements[middle]
    size = np.linalg.norm(mixed.displacements[middle], axis=1).max()
    assert np.abs(apart).max() < 0.01 * size


@needs_calculix
def test_both_codes_agree_on_a_post_that_pressure_bends():
    """The pressure follows the side of the post, which leans by 25 degrees."""
    side = vs.Region(x=(10 * mm, 10 * mm))
    post = vs.Box(size=(10 * mm, 10 * mm, 15 * mm))
    setup = Setup.of(
        vs.Design(
            name="post",
            voxel_size=5 * mm,
            parts=[vs.Part(shape=post, material=MATERIALS["neo-hookean"])],
            clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
            loads=[vs.Traction(region=side, value=3 * kPa)],
        )
    )
    quadratic = run_calculix(BrickModel.of(setup, split=2))
    mixed = run_scikit_fem(BrickModel.of(setup, split=1, nodes=27))
    top = np.isclose(setup.mesh.vertices[:, 2], 15 * mm)
    one, other = (each.displacements[top].mean(axis=0) for each in (quadratic, mixed))
    # The edge of the clamp is singular: CalculiX comes from below, 12 % short with whole voxels
    # and 4.4 % here; the mixed bricks are 0.5 % from their own next split.
    assert np.linalg.norm(one - other) < 0.06 * np.linalg.norm(other)
    np.testing.assert_allclose(quadratic.reaction[0], mixed.reaction[0], rtol=0.03)


@pytest.mark.parametrize("solve", BOTH)
def test_supports_carry_the_weight_and_nothing_else(solve):
    """A pressure in a closed cavity adds no force, however the body deforms."""
    setup = block()
    answer = solve(setup)
    weight = 26 * (5 * mm) ** 3 * 1070 * 9.81
    # CalculiX prints seven digits of forces that are 50 times the weight.
    np.testing.assert_allclose(answer.reaction, [0, 0, weight], atol=1e-5 * weight)


def free_bar(material, motion=None, loads=()):
    """One voxel between plates without friction: the strain is even."""
    far = vs.Region(x=(5 * mm, 5 * mm))
    clamps = [vs.Clamp(region=vs.Region(**{axis: (0, 0)}), axes=axis) for axis in "xyz"]
    if motion is not None:
        moved = vs.Motion(displacement=(motion, 0, 0))
        clamps.append(vs.Clamp(region=far, axes="x", motion=moved))
    return Setup.of(
        vs.Design(
            name="bar",
            voxel_size=5 * mm,
            parts=[vs.Part(shape=vs.Box(size=(5 * mm, 5 * mm, 5 * mm)), material=material)],
            clamps=clamps,
            loads=loads,
        )
    )


@pytest.mark.parametrize("solve", BOTH)
def test_simple_tension_is_that_of_the_closed_form(solve):
    setup = free_bar(vs.NeoHookean(young=60 * kPa, poisson=0.49), motion=5 * mm)
    answer = solve(setup)
    shear, bulk = 60 * kPa / 2.98, 60 * kPa / 0.06

    def stress(stretch, side, along):
        """Nominal stress of the compressible neo-Hookean body, written out by hand."""
        volume, square = stretch * side**2, stretch**2 + 2 * side**2
        pulled = stretch if along else side
        even = shear * volume ** (-2 / 3) * (pulled - square / (3 * pulled))
        return even + bulk * (volume - 1) * volume / pulled

    side = brentq(lambda side: stress(2.0, side, along=False), 0.5, 1.0)
    # The plates pull with opposite forces. Virtual work: each node by its place between them.
    nodes = BrickModel.of(setup, nodes=NODES[answer.code]).nodes
    force = answer.reactions[:, 0] @ nodes[answer.held, 0] / (5 * mm)
    # Newton's residual: CalculiX stops at 5e-5 of the mean force.
    assert force == pytest.approx(stress(2.0, side, along=True) * (5 * mm) ** 2, rel=1e-4)


@needs_calculix
@pytest.mark.parametrize("scale", [1.0, 0.01])
def test_small_and_soft_bodies_are_the_large_ones_scaled(scale):
    """A beam whose deflection is half its length: its shape depends on ρ g L/E alone.

    In N and mm CalculiX's absolute stop made the small one 3 % wrong, and said nothing.
    """
    size = 10 * mm * scale
    beam = vs.Box(size=(10 * size, 2 * size, 2 * size))
    setup = Setup.of(
        vs.Design(
            name="beam",
            voxel_size=size,
            parts=[
                vs.Part(shape=beam, material=vs.NeoHookean(young=60 * kPa * scale, poisson=0.45))
            ],
            clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
            loads=[vs.Gravity()],
        )
    )
    answer = run_calculix(BrickModel.of(setup))
    end = np.isclose(setup.mesh.vertices[:, 0], 10 * size)
    tip = answer.displacements[end].mean(axis=0) / size
    # Seven digits are printed of 6.2 mm at the largest; the units make both decks the same.
    np.testing.assert_allclose(tip, [-1.5821195, 0.0, -5.2041511], atol=3e-6)
    weight = 40 * size**3 * 1070 * 9.81
    assert answer.reaction[2] == pytest.approx(weight, rel=1e-4)


@pytest.mark.parametrize("solve", BOTH)
def test_past_the_largest_load_the_last_equilibrium_is_kept(solve):
    """Rubber that softens for good bears a largest force; twice as much is asked for."""
    rubber = vs.Yeoh(c=(10 * kPa, -1 * kPa), poisson=0.49)
    stretches = np.linspace(1.0, 2.5, 151)
    largest = float(vs.materials.nominal_stress(rubber, stretches).max())
    pull = vs.Traction(region=vs.Region(x=(5 * mm, 5 * mm)), value=(2 * largest, 0, 0))
    answer = solve(free_bar(rubber, loads=[pull]))
    assert answer.status == "not-converged"
    # Half of the load is the largest; both codes stop a step short of it.
    assert 0.4 < answer.load_factor < 0.51
    assert f"{answer.load_factor:.1%}" in answer.message
    assert answer.displacements[:, 0].max() > 1 * mm


def test_scikit_fem_keeps_its_time_limit():
    with pytest.raises(OutsideCodeError, match="did not end within 0 s"):
        run_scikit_fem(BrickModel.of(block(), nodes=27), time_limit=0.0)


def test_a_lattice_is_refused():
    setup = bar(vs.Lattice(edge=20 * kPa, bulk=100 * kPa))
    with pytest.raises(SimulationError, match='no "lattice" material'):
        run_scikit_fem(BrickModel.of(setup, nodes=27))


def program(folder, text):
    """Put a program of our own in the place of CalculiX."""
    path = folder / "ccx"
    path.write_text("#!/bin/sh\n" + text)
    path.chmod(0o755)


@pytest.fixture
def alone(tmp_path, monkeypatch):
    """A search path that holds one empty folder and the shell's own programs."""
    folder = tmp_path / "bin"
    folder.mkdir()
    monkeypatch.setenv("PATH", str(folder))
    return folder


def model():
    return BrickModel.of(bar(MATERIALS["neo-hookean"]))


def test_without_calculix_the_package_is_named(alone):
    with pytest.raises(MissingPackageError, match="apt install calculix-ccx"):
        run_calculix(model())


def test_a_crash_shows_the_last_lines(alone):
    program(alone, 'echo reading; echo "*ERROR: out of memory"; exit 7')
    with pytest.raises(OutsideCodeError, match=r"code 7.*\*ERROR: out of memory"):
        run_calculix(model())


def test_silence_is_a_crash_too(alone):
    program(alone, "exit 0")
    with pytest.raises(OutsideCodeError, match="its last lines: none"):
        run_calculix(model())


def test_a_program_that_hangs_is_stopped_with_its_children(alone, tmp_path):
    line = tmp_path / "line"
    os.mkfifo(line)
    listening = os.open(line, os.O_RDONLY | os.O_NONBLOCK)
    # Program and child hold the line open as long as they live.
    program(alone, f"exec 3>{line}; /bin/sleep 30 & /bin/sleep 60")
    with pytest.raises(OutsideCodeError, match="did not end within 1 s"):
        run_calculix(model(), time_limit=1.0)

    def nobody_writes():
        with suppress(BlockingIOError):
            return os.read(listening, 1) == b""

    until(nobody_writes, "the end of program and child")
    os.close(listening)
