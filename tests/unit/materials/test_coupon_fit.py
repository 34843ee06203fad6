"""Fits of coupons: known constants come back, and unknown ones are reported."""

from pathlib import Path

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.errors import MaterialError
from voxsoft.materials import StretchRange, nominal_stress
from voxsoft.materials.coupon import (
    BendingTest,
    Curve,
    FrequencyTest,
    MeasuredModulus,
    fit_coupons,
    read_curve,
    read_modulus_tests,
)
from voxsoft.units import format_quantity

DATA = Path(__file__).parents[3] / "examples" / "data" / "tensile"


@pytest.fixture(scope="module")
def rtv615():
    return read_curve((DATA / "rtv615.csv").read_text(encoding="utf-8"), name="rtv615")


# Constants in kPa that SciPy-independent fits of the same rows gave, to all digits published with
# them; Ogden's in his own convention W = Σ m/α (...).
@pytest.mark.parametrize(
    ("toe", "model", "constants"),
    [
        ("off", "neo-hookean", [402.725 / 2]),
        ("off", "mooney-rivlin", [319.284, -199.785]),
        ("off", "yeoh-3", [165.768, 12.84, 0.944176]),
        ("strain", "neo-hookean", [407.795 / 2]),
        ("strain", "mooney-rivlin", [313.625, -185.192]),
        ("strain", "yeoh-3", [172.802, 9.40677, 1.7959]),
    ],
)
def test_constants_agree_with_other_fits_of_the_same_rows(rtv615, toe, model, constants):
    fit = fit_coupons([rtv615], toe=toe, max_strain=1.0, models=[model])
    found = [interval.value / 1e3 for interval in fit.of(model).constants.values()]
    # Six digits are given; C30 loses some in the shift of the strain.
    assert found == pytest.approx(constants, rel=2e-5)


def test_ogden_s_constants_in_the_other_convention(rtv615):
    fit = fit_coupons([rtv615], max_strain=1.0, models=["ogden-3"]).of("ogden-3").material
    other = vs.Ogden.from_classic(
        [-23.7845e3, 2.05018e3, 234.216e3], [-6.09272, 7.2614, 2.37526], poisson=0.499
    )
    ours = sorted(zip(fit.alpha, fit.mu, strict=True))
    theirs = sorted(zip(other.alpha, other.mu, strict=True))
    # A flat minimum: exponents are known to some digits only, the stress to all.
    np.testing.assert_allclose(ours, theirs, rtol=1e-3)
    stretch = np.linspace(1.0, 2.0, 11)
    np.testing.assert_allclose(
        nominal_stress(fit, stretch), nominal_stress(other, stretch), rtol=1e-5, atol=1.0
    )


def made(material, modes=("uniaxial",), noise=0.0, points=40, seed=0):
    random = np.random.default_rng(seed)
    strain = np.linspace(0.0, 2.0, points)
    return [
        Curve(
            strain,
            nominal_stress(material, 1.0 + strain, mode) + noise * random.standard_normal(points),
            mode,
            mode,
        )
        for mode in modes
    ]


MADE = [
    ("neo-hookean", vs.NeoHookean(young=60e3)),
    ("mooney-rivlin", vs.MooneyRivlin(c10=10e3, c01=4e3)),
    ("yeoh-3", vs.Yeoh(c=[10e3, 300.0, -2.0])),
    ("gent", vs.Gent(shear=20e3, jm=25.0)),
    ("ogden-1", vs.Ogden(mu=[20e3], alpha=[3.1])),
    ("ogden-2", vs.Ogden(mu=[20e3, 2e3], alpha=[1.7, -3.4])),
]


@pytest.mark.parametrize(("name", "material"), MADE, ids=[name for name, _ in MADE])
def test_constants_come_back_from_their_own_curves(name, material):
    curves = made(material, ("uniaxial", "planar", "equibiaxial"))
    fit = fit_coupons(curves, toe="off", models=[name])
    found = fit.of(name)
    # Six digits are kept on the card; the two-term Ogden search stops at a flat minimum.
    tolerance = 1e-3 if name == "ogden-2" else 1e-5
    assert sorted(found.material.constants) == pytest.approx(
        sorted(material.constants), rel=tolerance
    )
    assert found.rmse < 1e-4 * max(np.abs(curve.stress).max() for curve in fit.curves)


@pytest.mark.slow
def test_intervals_hold_the_truth_about_as_often_as_they_say():
    """95 of 100 with independent noise; at least 88 of 100 has a chance of 99.8 % (binomial)."""
    material = vs.Yeoh(c=[10e3, 300.0])
    held = 0
    for seed in range(100):
        curve = made(material, noise=500.0, seed=seed)[0]
        interval = _only("yeoh-2", curve).constants["c10"]
        held += interval.low <= 10e3 <= interval.high
    assert held >= 88


def _only(name, curve):
    return fit_coupons([curve], toe="off", models=[name]).of(name)


def test_residuals_that_follow_one_another_widen_the_interval():
    material, points = vs.Yeoh(c=[10e3, 300.0]), 200
    random = np.random.default_rng(3)
    strain = np.linspace(0.0, 2.0, points)
    clean = nominal_stress(material, 1.0 + strain)
    white = 300.0 * random.standard_normal(points)
    slow = np.convolve(300.0 * random.standard_normal(points + 19), np.full(20, 20**-0.5), "valid")
    widths = [
        _only("yeoh-2", Curve(strain, clean + noise)).constants["c10"].half_width
        for noise in (white, slow)
    ]
    # A running mean of 20 points has 20 times fewer that count: √20 = 4.5 times as wide; the
    # lag-1 correlation of one sample is known to some tenths.
    assert widths[1] > 2.5 * widths[0]


def test_uniaxial_curves_alone_recommend_a_first_invariant_model(rtv615):
    fit = fit_coupons([rtv615])
    assert fit.models[0].name.startswith("ogden")
    assert fit.recommended.material.model in ("yeoh", "gent", "neo-hookean")
    assert any("guess" in warning for warning in fit.warnings)
    material = vs.Ogden(mu=[20e3], alpha=[3.1])
    three = fit_coupons(made(material, ("uniaxial", "planar")), models=["ogden-1", "yeoh-2"])
    assert three.recommended.name == "ogden-1"
    assert not any("guess" in warning for warning in three.warnings)


def test_unstable_ranges_are_warned_of():
    material = vs.Yeoh(c=[10e3, 300.0, -8.0])
    strain = np.linspace(0.0, 1.5, 30)
    curve = Curve(strain, nominal_stress(material, 1.0 + strain))
    fit = fit_coupons([curve], toe="off", models=["yeoh-3", "mooney-rivlin"])
    found = fit.of("yeoh-3")
    assert found.stable_in_fit
    assert any("uniaxial: unstable above stretch" in warning for warning in found.warnings)
    rubber = fit.of("mooney-rivlin")
    assert not rubber.stable_in_fit
    assert "mooney-rivlin is unstable inside the fitted range" in rubber.warnings
    with pytest.raises(MaterialError, match=r"mooney-rivlin: is unstable between.*: yeoh-3$"):
        fit.card("no", "mooney-rivlin")
    card = fit.card("yes", "yeoh-3")
    assert card.material.constants == found.material.constants
    assert card.material.tested_stretch == StretchRange(largest=2.5)


def test_a_measured_modulus_pulls_the_fit():
    """A precise one moves the initial modulus to it, a vague one does nothing."""
    curve = made(vs.Yeoh(c=[10e3, 300.0, -2.0]), noise=100.0)[0]
    alone = _only("yeoh-3", curve).young.value

    def joined(uncertainty):
        beam = MeasuredModulus("beam", 1.2 * alone, uncertainty)
        return fit_coupons([curve], [beam], toe="off", models=["yeoh-3"])

    precise, vague = joined(1.0), joined(1e6)
    # The curve is known to 100 Pa at 40 points: it moves a modulus known to 1 Pa by less than a
    # thousandth, and one known to 1 MPa alone by less than that.
    assert precise.of("yeoh-3").young.value == pytest.approx(1.2 * alone, rel=1e-3)
    assert vague.of("yeoh-3").young.value == pytest.approx(alone, rel=1e-3)
    assert precise.of("yeoh-3").young.half_width < alone * 0.01


def test_a_contradiction_between_tests_is_reported():
    curve = made(vs.NeoHookean(young=60e3), noise=50.0)[0]
    beam = MeasuredModulus("beam", 90e3, 3e3)
    fit = fit_coupons([curve], [beam], toe="off", models=["neo-hookean"])
    assert any("beam (90 kPa)" in warning for warning in fit.warnings)


def test_several_specimens_of_one_kind():
    curves = [made(vs.NeoHookean(young=young))[0] for young in (57e3, 63e3)]
    fit = fit_coupons(curves, toe="off", models=["neo-hookean"])
    assert fit.of("neo-hookean").young.value == pytest.approx(60e3, rel=1e-4)


def test_a_softening_heap_of_numbers_has_no_model():
    strain = np.linspace(0.0, 1.0, 20)
    with pytest.raises(vs.VoxSoftError, match="no model could be fitted"):
        fit_coupons([Curve(strain, 1e3 * strain - 1e4)], toe="off")
    with pytest.raises(vs.VoxSoftError, match="none came"):
        fit_coupons([])
    with pytest.raises(vs.VoxSoftError, match="expected at least 5"):
        fit_coupons([Curve(strain, 1e4 * strain)], max_strain=0.1)
    with pytest.raises(vs.VoxSoftError, match="did you mean"):
        fit_coupons([Curve(strain, 1e4 * strain)], toe="strian")
    with pytest.raises(vs.VoxSoftError, match='did you mean "yeoh-3"'):
        fit_coupons([Curve(strain, 1e4 * strain)], models=["yeoh3"])


def test_models_that_were_not_fitted_say_why():
    curves = made(vs.NeoHookean(young=60e3))
    fit = fit_coupons(curves, toe="off", models=["neo-hookean", "gent"])
    assert "gent" in fit.rejected
    with pytest.raises(vs.VoxSoftError, match="no limit shows"):
        fit.of("gent")
    with pytest.raises(vs.VoxSoftError, match="did you mean"):
        fit.of("neo-hooke")


def test_a_card_states_its_quality(rtv615):
    card = fit_coupons([rtv615], models=["yeoh-3"]).card("rtv615", source="a test")
    assert card.source == "a test"
    assert "between" in card.calibration["young_interval"]
    assert "Only uniaxial curves" in card.caution
    assert card.calibration["strain_range"][1] == pytest.approx(0.99, abs=0.01)


def test_beam_formulas_against_the_slender_limit():
    """At L/h = 100 shear is 1e-4 of bending: E = 3 ρ g L⁴/(2 h² δ), f = β² h/(2π L²) √(E/12ρ)."""
    length, height, young, density = 1.0, 0.01, 60e3, 1000.0
    sag = 3 * density * 1e-4 * 9.80665 * length**4 / (2 * height**2 * young)
    seen = BendingTest(
        length=length,
        width=0.02,
        height=height,
        deflection=0.05,
        uncertainty="5 %",
        density=density * 1e-4 * 0.05 / sag,
    ).modulus()
    assert seen.young == pytest.approx(young, rel=5e-4)
    assert seen.uncertainty == pytest.approx(0.05 * seen.young)
    frequency = 1.8751041**2 * height / (2 * np.pi * length**2) * np.sqrt(young / (12 * density))
    swung = FrequencyTest(
        length=length, height=height, frequency=frequency, density=density, uncertainty=0.1
    ).modulus()
    assert swung.young == pytest.approx(young, rel=5e-4)


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"kind": "bending", "length": "50 mm"}, "is missing"),
        ({"kind": "torsion"}, "is not known"),
        ({"kind": "modulus", "young": "60 mm", "uncertainty": "1 kPa"}, "expected a modulus"),
        (
            {
                "kind": "bending",
                "length": "90 mm",
                "width": "10 mm",
                "height": "10 mm",
                "deflection": "60 mm",
                "uncertainty": "5 %",
            },
            "voxsoft calibrate",
        ),
        (
            {
                "kind": "frequency",
                "length": "30 mm",
                "height": "10 mm",
                "frequency": "4 Hz",
                "uncertainty": "5 %",
            },
            "at least 4",
        ),
    ],
)
def test_modulus_tests_that_cannot_be_used(table, words):
    with pytest.raises(vs.VoxSoftError, match=words):
        read_modulus_tests({"observation": [table]})


def test_a_card_that_fits_worse_than_others_says_its_own_stress_and_so():
    # Mooney-Rivlin of 20 and 10 kPa: at an equibiaxial stretch of 1.5 it has 116.3 kPa.
    random = np.random.default_rng(0)
    stretch = np.linspace(1.02, 2.0, 60)
    stress = 2.0 * (stretch - stretch**-2) * (20e3 + 10e3 / stretch)
    noisy = stress + 150.0 * random.standard_normal(60)
    curve = Curve(stretch - 1.0, noisy, name="coupon")
    fit = fit_coupons([curve], toe="off")
    (mode,) = (each for each in fit.untested if each.mode == "equibiaxial")
    assert mode.low < 116.3e3 < mode.high
    (sentence,) = (each for each in fit.warnings if each.startswith("equibiaxial"))
    own = float(nominal_stress(fit.recommended.material, [mode.stretch], "equibiaxial")[0])
    assert f"The card says {format_quantity(float(f'{own:.3g}'), 'modulus')}" in sentence
    # The case this is about: a recommended model that the others fit better than.
    assert fit.recommended.name not in mode.models
    assert mode.low <= own <= mode.high
    assert f"by {fit.recommended.name} and models that fit better" in sentence
    assert not any("safer" in each for each in fit.warnings)


def test_the_warning_on_a_card_of_another_model_is_about_that_model():
    random = np.random.default_rng(0)
    stretch = np.linspace(1.02, 2.0, 60)
    stress = 2.0 * (stretch - stretch**-2) * (20e3 + 10e3 / stretch)
    curve = Curve(stretch - 1.0, stress + 150.0 * random.standard_normal(60), name="coupon")
    fit = fit_coupons([curve], toe="off")
    chosen = fit.of("mooney-rivlin")
    assert chosen is not fit.recommended
    own = float(nominal_stress(chosen.material, [1.5], "equibiaxial")[0])
    shown = format_quantity(float(f"{own:.3g}"), "modulus")
    assert f"The card says {shown}" in fit.card("other", "mooney-rivlin").caution
    assert f"The card says {shown}" in " ".join(fit.summary("mooney-rivlin")["warnings"])


@pytest.mark.long
@pytest.mark.parametrize("name", ["ecoflex-00-30", "dragon-skin-10", "rtv615"])
@pytest.mark.parametrize("farthest", [0.5, 1.0])
def test_a_recommended_card_lies_inside_the_range_of_its_own_warning(name, farthest):
    curve = read_curve((DATA / f"{name}.csv").read_text(encoding="utf-8"), name=name)
    fit = fit_coupons([curve], max_strain=farthest)
    for mode in fit.untested:
        own = nominal_stress(fit.recommended.material, [mode.stretch], mode.mode)[0]
        assert mode.low <= own <= mode.high
