"""A bending actuator with a film of silk: correct and wrong predictions of published constants."""

import importlib
import sys
from pathlib import Path

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.units import kPa, mm

ROOT = Path(__file__).parents[2]


def script(folder, name):
    """A module of a folder of scripts, those beside which it may import."""
    sys.path.insert(0, str(ROOT / folder))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(str(ROOT / folder))


@pytest.fixture(scope="module")
def bender():
    return script("examples/validation", "epfl_bender")


def test_the_film_closes_one_chamber(bender):
    design = vs.load(bender.DESIGN)
    chamber, slit, wall = 8 * mm, 2 * mm, 10 * mm
    (cavity,) = vs.simulation.Setup.of(design).mesh.cavities
    # The tunnel is 2 mm wide and comes out 4 mm wide: its sides are in the middle of voxels.
    volume = 5 * chamber * chamber * slit + 4 * wall * (2 * slit) * slit
    assert cavity.volume == pytest.approx(volume, rel=1e-9)


def test_angles_are_compared_where_both_are_known(bender):
    """A straight line against measured angles, by hand."""
    real = bender.measured()
    line = bender.Curve(np.array([0.0, 40 * kPa]), np.array([0.0, 0.4]))
    at, apart = bender.errors(line, real)
    assert at[-1] == pytest.approx(40 * kPa)
    # The data say 11.07 degrees at 40 kPa, where the line says 0.4 rad less 0.1 at 10 kPa.
    assert apart[-1] == pytest.approx(0.3 - np.radians(11.07))
    assert bender.reached(line, 0.1) == pytest.approx(10 * kPa)
    assert np.isnan(bender.reached(line, 1.0))


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_the_first_bending_is_predicted_and_the_transition_comes_late(bender):
    """Up to 30 kPa 0.08 degrees off on average were seen; 3 degrees come 0.3 kPa late.

    The whole path to 62 kPa, 11 degrees off, takes a minute; `docs/validation.md` has it.
    """
    simulated, real = bender.predicted(ratio=4.5), bender.measured()
    at, apart = bender.errors(simulated, real)
    assert at[-1] >= 30 * kPa
    early = np.degrees(apart[at <= 30 * kPa])
    assert np.abs(early).mean() < 0.15
    assert early[-1] < 0.0  # stiffer than the silicone was
    curves = bender.from_start(simulated), real
    here, there = (bender.reached(curve, np.radians(3)) for curve in curves)
    assert 0.0 < here - there < 2.5 * kPa


@pytest.mark.slow
def test_the_tip_that_is_held_pushes_as_hard_as_measured():
    """0.679 N at 50 kPa, measured 0.724 N: 0.938 of it were seen."""
    blocked = script("evidence", "blocked_force")
    force = blocked.predicted(50 * kPa, blocked.VARIANTS[0])
    assert force / blocked.measured()[50 * kPa] == pytest.approx(0.938, abs=0.01)
