"""Softening fitted to cyclic coupons: known constants come back, and unknown ones are reported."""

from itertools import pairwise

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.errors import MeasurementError
from voxsoft.files.coupons import load_cycles, write_coupon_fit
from voxsoft.materials import Mullins, cycled_stress, load_card
from voxsoft.materials.coupon import Cycles, fit_coupons, fit_softening

TRUE = Mullins(r=1.6, m="1.5 kPa", beta=0.12)
RUBBER = vs.Yeoh(c=[10e3, 300.0, -2.0], mullins=TRUE)


def measured(*turns, noise=0.0, seed=0, material=RUBBER, points=40):
    """Pull to each turn in turn; noise as a part of the largest stress."""
    ways = [np.linspace(a, b, points + 1)[1:] for a, b in pairwise((0.0, *turns))]
    strain = np.concatenate([[0.0], *ways])
    clean = cycled_stress(material, 1.0 + strain)
    scatter = np.random.default_rng(seed).standard_normal(len(strain))
    return Cycles(strain, clean + noise * clean.max() * scatter, name="cycles.csv")


def test_known_constants_come_back():
    found = fit_softening(RUBBER, [measured(0.6, 0.0, 1.2, 0.0, 1.2)])
    assert found.mullins.r == pytest.approx(TRUE.r, rel=1e-4)
    assert found.mullins.m == pytest.approx(TRUE.m, rel=1e-3)
    assert found.mullins.beta == pytest.approx(TRUE.beta, rel=1e-3)
    assert found.warnings == ()


@pytest.mark.slow
def test_intervals_hold_the_truth_about_as_often_as_they_say():
    """95 of 100 with independent noise; of 40, at least 33 have a chance of 99.9 % (binomial)."""
    held = dict.fromkeys(("r", "m", "beta"), 0)
    for seed in range(40):
        cycles = measured(0.6, 0.0, 1.2, 0.0, noise=0.01, seed=seed, points=25)
        for name, interval in fit_softening(RUBBER, [cycles]).constants.items():
            held[name] += interval.low <= getattr(TRUE, name) <= interval.high
    assert min(held.values()) >= 33, held


def test_one_peak_tells_one_constant_less():
    found = fit_softening(RUBBER, [measured(1.0, 0.0, 1.0)])
    assert found.mullins.m == 0.0
    assert set(found.constants) == {"r", "beta"}
    assert "larger peak" in found.warnings[0]
    # At that peak m + beta P is the same.
    stretch = np.array([2.0, 2.0**-0.5, 2.0**-0.5])
    peak = float(RUBBER.energy(stretch))
    assert found.mullins.beta == pytest.approx(TRUE.m / peak + TRUE.beta, rel=1e-5)


def test_cycles_give_the_curve_and_the_card(tmp_path):
    cycles = measured(0.6, 0.0, 1.2, 0.0, 1.5, noise=0.003)
    file = tmp_path / "cycles.csv"
    table = zip(cycles.strain.tolist(), cycles.stress.tolist(), strict=True)
    rows = "".join(f"{strain},{stress}\n" for strain, stress in table)
    file.write_text("strain,stress_Pa\n" + rows)
    fit = fit_coupons([], cycles=[load_cycles(file)], toe="off", models=["yeoh-3", "neo-hookean"])
    assert [curve.mode for curve in fit.curves] == ["uniaxial"]
    assert fit.curves[0].strain.max() == pytest.approx(1.5)
    card = fit.card("soft")
    soft = card.material.mullins
    # The virgin constants are fitted too: those of softening move by some of their intervals.
    assert soft.r == pytest.approx(TRUE.r, rel=0.05)
    written = write_coupon_fit(fit, card, tmp_path / "out")
    assert load_card(written[0]).material.mullins == soft
    assert card.calibration["cycles"] == ["cycles.csv"]
    summary = fit.summary()["softening"]
    assert summary["constants"]["r"]["value"] == pytest.approx(soft.r)


def test_tables_without_a_cycle_are_refused():
    up = np.linspace(0.0, 1.0, 30)
    with pytest.raises(MeasurementError, match="the strain never falls"):
        Cycles(up, 40e3 * up)
    elastic = RUBBER.model_copy(update={"mullins": None})
    with pytest.raises(MeasurementError, match="shows no softening"):
        fit_softening(RUBBER, [measured(1.0, 0.0, noise=0.003, material=elastic)])
    with pytest.raises(MeasurementError, match="expected at least 10"):
        Cycles(up[:5], up[:5])


def test_the_toe_and_the_largest_strain_are_those_of_the_curves():
    cycles = measured(0.5, 0.0, 1.0, 0.0)
    slack = Cycles(cycles.strain + 0.02, cycles.stress)
    toe = slack.first_loading().toe()
    # The line through the start of another model misses the slack by a tenth of it.
    assert toe.strain == pytest.approx(0.02, abs=2e-3)
    found = slack.corrected(toe, "strain", 0.9)
    assert found.strain.max() <= 0.9
    assert found.strain[0] == pytest.approx(0.0, abs=2e-3)
    assert len(found.strain) < len(slack.strain)
