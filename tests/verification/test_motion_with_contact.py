"""Balls that roll, bounce and meet, beside closed forms and conservation laws.

The designs are those of `evidence/contact_over_time.py`, which has the figures.
"""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

import voxsoft as vs

EVIDENCE = Path(__file__).parents[2] / "evidence"
GRAVITY = 9.81


@pytest.fixture
def designs(monkeypatch):
    monkeypatch.syspath_prepend(str(EVIDENCE))
    import contact_over_time

    monkeypatch.setattr(sys, "argv", ["benchmark"])
    return contact_over_time


def accelerations(designs, friction, degrees=20.0, step=5e-3):
    """Errors of the way of a ball and of its surface as it turns, and its slip over its way."""
    design = designs.rolling(degrees, friction)
    result = vs.simulate(design, end_time=0.1, time_step=step, record_interval=step)
    places, turns = result.recording.objects["ball"]
    later = result.recording.times >= 0.03 - 1e-9
    way = places[later, 0]
    turned = np.unwrap(np.arctan2(turns[:, 0, 2], turns[:, 0, 0]))[later] * designs.RADIUS
    times = result.recording.times[later]
    along, around = (2.0 * np.polyfit(times, each, 2)[0] for each in (way, turned))
    return along, around, float(np.ptp(way - turned) / np.ptp(way))


@pytest.mark.slow
def test_a_ball_rolls_where_friction_is_enough(designs):
    # When a facet lands within a step is chance, which may cost a run some percent: the median.
    runs = [accelerations(designs, 0.5, step=step) for step in (5e-3, 4e-3, 2.5e-3)]
    along, around, slip = (float(each) for each in np.median(runs, axis=0))
    expected = 5.0 / 7.0 * GRAVITY * math.sin(math.radians(20.0))
    # Facets of h = 0.67 mm land on the plane, each of which takes m (v h/R)²/2: after a way L that
    # is 5/7 L h/R² of the acceleration, up to 6 % after the 12 mm here and less before.
    assert along == pytest.approx(expected, rel=0.04)
    # Surface and place go on together, but for the hops from facet to facet.
    assert around == pytest.approx(along, rel=0.04)
    assert slip < 0.02


@pytest.mark.slow
def test_a_ball_slips_where_friction_is_not(designs):
    angle, friction = math.radians(20.0), 0.08
    assert friction < 2.0 / 7.0 * math.tan(angle)
    along, around, slip = accelerations(designs, friction)
    bound = friction * GRAVITY * math.cos(angle)
    # It always slips, so that friction is at its bound whatever facet bears.
    assert along == pytest.approx(GRAVITY * math.sin(angle) - bound, rel=5e-3)
    # The force is up to half a facet off the middle, which is h/2Rμ = 0.4 of the moment; that
    # fades as facets pass, of which it meets some ten.
    assert around == pytest.approx(2.5 * bound, rel=0.1)
    assert slip > 0.3


@pytest.mark.parametrize("step", [5e-3, pytest.param(2e-3, marks=pytest.mark.slow)])
def test_a_ball_that_bounces_only_loses_energy(designs, step):
    result = vs.simulate(designs.bouncing(), end_time=0.2, time_step=step, record_interval=step)
    total, grown = designs.energies(result.recording)
    fall = result.mass * GRAVITY * 2.0 * designs.RADIUS
    # A step may end with a thousandth of the energy of motion more: formulas of the second order
    # keep it to the square of the step.
    assert grown < 1e-3 * fall
    touching = [bool(found) for found in result.recording.contacts]
    up = touching.index(False, touching.index(True))
    kept = 1.0 + (total[up] - total[0]) / fall
    # It leaves the floor again, with less.
    assert 0.02 < kept < 0.9


@pytest.mark.slow
def test_two_balls_that_meet_keep_their_momentum(designs):
    result = vs.simulate(designs.meeting(), end_time=0.05, time_step=5e-3, record_interval=5e-3)
    recording = result.recording
    flying = recording.times >= designs.PUSHED - 1e-9
    momentum = recording.momentum[flying]
    assert momentum[0, 0] > 0.0
    off = np.linalg.norm(momentum - momentum[0], axis=1)
    # All forces are in pairs: 800 vertices and ten steps, to rounding.
    assert off.max() < 1e-12 * np.linalg.norm(momentum[0])
    total = (recording.kinetic_energy + recording.elastic_energy)[flying]
    assert np.max(total - np.minimum.accumulate(total)) < 1e-3 * total[0]
    assert any(recording.contacts)
