"""Uncertainty left by coupons in untested modes: true there, gone once these are tested."""

from functools import cache

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.materials import nominal_stress
from voxsoft.materials.coupon import Curve, fit_coupons

#: Ogden's constants of Treloar's rubber, in Ogden's own convention (doi 10.1098/rspa.1972.0026).
TRELOAR = vs.Ogden.from_classic([0.63e6, 1.2e3, -10e3], [1.3, 5.0, -2.0], poisson=0.499)
LAWS = {
    "neo-hookean": vs.NeoHookean(young=60e3),
    "mooney-rivlin": vs.MooneyRivlin(c10=10e3, c01=4e3),
    "yeoh": vs.Yeoh(c=[10e3, 300.0, -2.0]),
    "gent": vs.Gent(shear=20e3, jm=25.0),
    "treloar": TRELOAR,
}


#: The law of fewest constants, and rubber itself.
QUICK = {("neo-hookean", 0.01), ("treloar", 0.01)}


def measured(law, mode, reach, noise):
    """Return a curve of 40 points with noise of a part of the largest stress."""
    strain = np.linspace(0.0, reach, 40)
    clean = nominal_stress(law, 1.0 + strain, mode)
    random = np.random.default_rng(0)
    return Curve(strain, clean + noise * clean.max() * random.standard_normal(40), mode, mode)


@cache
def fitted(name, *modes, noise=0.01, reach=2.0):
    curves = [measured(LAWS[name], mode, noise=noise, reach=reach) for mode in modes]
    return fit_coupons(curves, toe="off")


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "noise"),
    [
        pytest.param(name, noise, marks=[pytest.mark.slow] * ((name, noise) not in QUICK))
        for name in LAWS
        for noise in (0.003, 0.01)
    ],
)
def test_the_true_stress_lies_in_the_spread(name, noise):
    law = LAWS[name]
    found = fitted(name, "uniaxial", noise=noise).untested
    assert [each.mode for each in found] == ["equibiaxial", "planar"]
    for each in found:
        assert each.stretch == 1.5
        assert each.low <= nominal_stress(law, 1.5, each.mode) <= each.high


@pytest.mark.slow
def test_the_warning_vanishes_once_the_other_modes_are_tested():
    alone = fitted("treloar", "uniaxial")
    equibiaxial = alone.untested[0]
    warning = next(w for w in alone.warnings if w.startswith("equibiaxial stress at stretch 1.5"))
    assert "test a membrane" in warning
    assert warning in alone.card("rubber").caution
    assert alone.summary()["untested"][0]["high"] == equibiaxial.high
    both = fitted("treloar", "uniaxial", "equibiaxial")
    assert [each.mode for each in both.untested] == ["planar"]
    # Planar tension lies between the two: the range left open there is less than a tenth.
    assert not any("stress at stretch" in warning for warning in both.warnings)
    assert fitted("treloar", "uniaxial", "equibiaxial", "planar").untested == ()


@pytest.mark.slow
def test_less_noise_leaves_less_open():
    noisy, clean = (
        fit_coupons(
            [measured(TRELOAR, "uniaxial", noise=noise, reach=2.0)],
            toe="off",
            models=["ogden-3"],
        ).untested[0]
        for noise in (0.01, 1e-4)
    )
    assert clean.spread < 0.2 * noisy.spread
    assert not clean.sentence


@pytest.mark.slow
def test_a_card_far_from_determined_stress_has_a_warning():
    """Clean data of Treloar's rubber determine 602 kPa; a law of one invariant has 483 kPa."""
    fit = fitted("treloar", "uniaxial", noise=1e-4)
    own = float(nominal_stress(fit.recommended.material, 1.5, "equibiaxial"))
    truth = float(nominal_stress(TRELOAR, 1.5, "equibiaxial"))
    assert own < 0.9 * truth
    found = fit.untested[0]
    assert (found.low, found.low_model) == (own, fit.recommended.name)
    assert any("equibiaxial stress at stretch 1.5" in warning for warning in fit.warnings)


def test_compression_is_equibiaxial_tension():
    """Pressing to λ⁻² stretches both other axes by λ: the membrane is measured, if not named."""
    strain = np.linspace(-0.6, 1.0, 40)
    random = np.random.default_rng(5)
    clean = nominal_stress(LAWS["mooney-rivlin"], 1.0 + strain)
    curve = Curve(strain, clean * (1.0 + 0.003 * random.standard_normal(40)))
    pressed = fit_coupons([curve], toe="off").untested[0]
    pulled = fitted("mooney-rivlin", "uniaxial", reach=1.0, noise=0.003).untested[0]
    assert pressed.spread < 0.1 < pulled.spread


def test_the_stretch_is_no_larger_than_the_specimens_went():
    found = fitted("treloar", "uniaxial", reach=0.2).untested
    assert [each.stretch for each in found] == pytest.approx([1.2, 1.2])
    assert fitted("treloar", "uniaxial", reach=0.04).untested == ()
