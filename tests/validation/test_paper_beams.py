"""The paper's three beams: errors of the shipped cards, and that the calibration finds them.

Mean length of the error vectors over nine stations of the lower edge. The paper's own calibration
ended at 9.9, 5.7 and 3.7 mm for EcoFlex 00-20, 00-30 and 00-50; a geometrically exact beam of one
modulus reaches 4.6, 4.4 and 2.1 mm, and 1.3, 1.0 and 0.7 mm with the scale of the photograph freed.
"""

import sys
from pathlib import Path

import lattice_families as families
import numpy as np
import pytest

from voxsoft.calibration import Experiment, Measurement, calibrate
from voxsoft.calibration.misfit import best_scale
from voxsoft.materials import load_card
from voxsoft.simulation import simulate

ROOT = Path(__file__).parents[2]
NAMES = ("00-20", "00-30", "00-50")
FIXED_SCALE = dict(zip(NAMES, (4.8e-3, 4.6e-3, 2.3e-3), strict=True))
FREE_SCALE = dict(zip(NAMES, (1.5e-3, 1.2e-3, 0.9e-3), strict=True))


def experiment(name):
    data = ROOT / "examples" / "data" / "paper_beams" / f"ecoflex-{name}.csv"
    beam = families.beam().with_values(f"parts.0.material=ecoflex-{name}-lattice")
    return Experiment(beam, Measurement.read(data))


@pytest.mark.parametrize("name", NAMES)
def test_shipped_card_reproduces_its_beam(name):
    """The card's moduli and scale, simulated afresh, give the error that the card states."""
    tested, card = experiment(name), load_card(f"ecoflex-{name}-lattice")
    simulated = tested.seen_at(simulate(tested.setup, tolerance=1e-6).positions)
    measured = tested.measurement.values
    scale = best_scale(simulated, measured)
    error = np.linalg.norm(scale * simulated - measured, axis=1).mean()
    assert error < FREE_SCALE[name]
    assert scale == pytest.approx(card.calibration["scale"][0], abs=2e-3)
    stated = float(card.calibration["mean_error"].removesuffix(" mm"))
    assert 1e3 * error == pytest.approx(stated, rel=0.01)


def test_cards_say_that_bulk_is_not_identified():
    for name in NAMES:
        card = load_card(f"ecoflex-{name}-lattice")
        assert "only bounded from above" in card.calibration["bulk_interval"]
        assert "bulk is not identified" in card.caution


def test_one_card_predicts_other_beams():
    """Beams of twice the width and half the length, against finite elements; and its limit.

    Seen: -1.3, -0.2, -0.5 and +2.1 % of the tip sag for beams a, b, d, e at 5 mm voxels. Beams c
    and f are twice as high: four voxels through the thickness lock less than the two of the
    specimen, so that they sag 11 and 19 % too far.
    """
    sys.path.insert(0, str(ROOT / "examples"))
    try:
        from predict_beams import predictions
    finally:
        sys.path.pop(0)
    ratio = {p.beam: p.tip[0] / p.tip[1] for p in predictions()}
    assert sorted(ratio) == list("abcdef")
    for beam in "abde":
        assert ratio[beam] == pytest.approx(1.0, abs=0.03), beam
    assert ratio["c"] == pytest.approx(1.0, abs=0.15)
    assert ratio["f"] == pytest.approx(1.0, abs=0.22)


@pytest.mark.slow
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("free_scale", [False, True])
@pytest.mark.parametrize("name", NAMES)
def test_two_seeds_agree(name, free_scale):
    """The paper's genetic algorithm with refinement, twice: identified moduli agree to 2 %."""
    tested = experiment(name)
    runs = [calibrate(tested, free_scale=free_scale, seed=seed) for seed in (1, 2)]
    limit = FREE_SCALE[name] if free_scale else FIXED_SCALE[name]
    for run in runs:
        assert run.mean_error < limit
        assert run.identifiable == {"edge": True, "bulk": False}
    first, second = (run.parameters["edge"] for run in runs)
    assert first == pytest.approx(second, rel=0.02)
