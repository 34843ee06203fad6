"""Branches from tests over time: those of a known material come back, and else a true reason."""

import numpy as np
import pytest

from voxsoft.errors import MaterialError, MeasurementError
from voxsoft.materials import NeoHookean, Yeoh, nominal_stress, relaxing_stress
from voxsoft.materials.card import Card
from voxsoft.materials.coupon import (
    Curve,
    TimedTest,
    fit_branches,
    read_timed_test,
)

#: Standard linear solid, and one with two branches whose stress bends with the strain.
SOLID = NeoHookean(young="60 kPa", prony=[{"g": 0.3, "tau": "20 s"}])
TWO = Yeoh(c=["12 kPa", "1 kPa"], prony=[{"g": 0.2, "tau": "2 s"}, {"g": 0.15, "tau": "60 s"}])
#: Noise of the load cell, Pa: half a percent of the stress.
NOISE = 100.0
#: Intervals hold 95 % of the time, ± 2 standard deviations; twice that fails once in 10,000.
ROOM = 2.0


def held(material, strain=0.5, *, ramp=0.5, end=200.0, noise=NOISE, name="held"):
    time = np.concatenate([np.linspace(0.0, ramp, 20), ramp + np.geomspace(ramp / 10, end, 150)])
    return measured(
        material, time, np.minimum(time / ramp, 1.0) * strain, noise, "relaxation", name
    )


def pulled(material, rate, *, strain=1.0, noise=NOISE, name=None):
    time = np.linspace(0.0, strain / rate, 150)
    return measured(material, time, rate * time, noise, "rate", name or f"rate {rate:g}")


def measured(material, time, strain, noise, kind, name):
    white = np.random.default_rng(1).standard_normal(len(time))
    stress = relaxing_stress(material, time, 1.0 + strain) + noise * white
    return TimedTest(time, strain, stress, kind, name)


def quasi_static(material, noise=NOISE):
    strain = np.linspace(0.0, 1.0, 60)
    white = np.random.default_rng(2).standard_normal(60)
    return Curve(strain, nominal_stress(material, 1.0 + strain) + noise * white)


def assert_known(fit, prony, young):
    assert len(fit.branches) == len(prony)
    for branch, term in zip(fit.branches, prony, strict=True):
        assert abs(branch.g.value - term.g) <= ROOM * branch.g.half_width
        assert abs(np.log(branch.tau.value / term.tau)) <= ROOM * np.log(
            branch.tau.high / branch.tau.value
        )
    assert abs(fit.young.value - young) <= ROOM * fit.young.half_width
    # The noise is what is left; its own scatter is 1/√(2 n) of it, 5 % for 170 rows.
    assert fit.rmse == pytest.approx(NOISE, rel=0.15)


@pytest.fixture(scope="module")
def solid():
    return fit_branches([held(SOLID)], model="neo-hookean")


def test_a_standard_linear_solid_comes_back_from_one_relaxation(solid):
    fit = solid
    assert_known(fit, SOLID.prony, SOLID.young())
    # Known to a percent: intervals that hold everything would hold the truth too.
    assert fit.branches[0].g.half_width < 0.01
    assert fit.branches[0].tau.half_width < 0.05 * 20.0


@pytest.mark.long
def test_two_branches_come_back_from_relaxations_at_two_strains():
    tests = [held(TWO, 0.5, end=600.0, name="small"), held(TWO, 1.0, end=600.0, name="large")]
    fit = fit_branches(tests)
    assert fit.model == "yeoh-2"
    assert_known(fit, TWO.prony, TWO.young())


@pytest.mark.long
def test_two_branches_come_back_from_four_rates():
    fit = fit_branches([pulled(TWO, rate) for rate in (1.0, 0.1, 0.01, 0.001)])
    assert fit.model == "yeoh-2"
    assert_known(fit, TWO.prony, TWO.young())


@pytest.mark.long
def test_a_quasi_static_curve_gives_the_long_term_of_a_short_relaxation():
    short = held(SOLID, end=10.0)
    fit = fit_branches([short], [quasi_static(SOLID)], toe="off")
    assert_known(fit, SOLID.prony, SOLID.young())
    with pytest.raises(MeasurementError, match=r"branch 1: .*no plateau.*quasi-static curve"):
        fit_branches([short])


def test_one_rate_is_refused_and_a_curve_beside_it_is_enough():
    one = pulled(SOLID, 0.05)
    with pytest.raises(MeasurementError, match=r"one rate only \(0.05 /s\)"):
        fit_branches([one])
    fit = fit_branches([one], [quasi_static(SOLID)], model="neo-hookean", toe="off")
    assert_known(fit, SOLID.prony, SOLID.young())


@pytest.mark.long
def test_a_branch_beyond_the_test_is_named():
    slow = NeoHookean(young="60 kPa", prony=[{"g": 0.2, "tau": "2 s"}, {"g": 0.2, "tau": "1000 s"}])
    test = held(slow, end=100.0)
    with pytest.raises(MeasurementError, match=r"branch 2: .*longer than the longest test, 100 s"):
        fit_branches([test])
    asked = fit_branches([test], branches=1)
    assert any("no plateau" in warning for warning in asked.warnings)


def test_a_branch_that_is_not_there_is_not_identified():
    with pytest.raises(
        MeasurementError, match=r"branch 2: not identified: 2 .* no better than one"
    ):
        fit_branches([held(SOLID)], branches=2, model="neo-hookean")


def test_an_elastic_material_shows_no_relaxation():
    with pytest.raises(MeasurementError, match="show no relaxation"):
        fit_branches([held(NeoHookean(young="60 kPa"))], model="neo-hookean")
    with pytest.raises(MeasurementError, match="show no relaxation"):
        fit_branches([held(NeoHookean(young="60 kPa"))], branches=1, model="neo-hookean")


def test_a_test_of_many_rows_gives_the_branches_of_its_means():
    time = np.linspace(0.01, 400.0, 40_000)
    test = measured(SOLID, time, np.full(len(time), 0.5), 10 * NOISE, "relaxation", "long")
    fit = fit_branches([test])
    # Ten times the noise in two hundred times the rows is no more than in the test above.
    assert fit.branches[0].g.value == pytest.approx(0.3, abs=ROOM * fit.branches[0].g.half_width)
    assert fit.branches[0].g.half_width < 0.02
    assert fit.rmse == pytest.approx(10 * NOISE, rel=0.02)


def test_the_card_says_which_stiffness_it_has(solid):
    fit = solid
    card = fit.card("soft")
    assert "long-term (E 59.99 kPa)" in card.caution
    assert fit.instantaneous_young == pytest.approx(
        fit.young.value / (1.0 - fit.branches[0].g.value)
    )
    assert (
        Card.from_document(
            {"name": "again", "material": card.material.model_dump(mode="json", exclude_none=True)}
        ).material.prony
        == card.material.prony
    )


@pytest.mark.parametrize(
    ("rows", "kind", "words"),
    [
        ("0,0,0\n1,0.1,5\n2,0.2,9\n3,0.3,12\n4,0.4,15", "relaxation", "is no relaxation test"),
        ("0,0,0\n1,0.1,5\n2,0.4,9\n3,0.4,9\n4,0.4,9", "rate", "is not of one rate"),
        ("1,0.5,9\n1,0.5,8\n2,0.5,7\n3,0.5,6\n4,0.5,6", "relaxation", "time does not rise"),
        ("-1,0.5,9\n1,0.5,8\n2,0.5,7\n3,0.5,6\n4,0.5,6", "relaxation", "before time zero"),
        ("0,0.5,-9\n1,0.5,-8\n2,0.5,-7\n3,0.5,-6\n4,0.5,-6", "relaxation", "different signs"),
        ("0,0,0\n1,0,0\n2,0,0\n3,0,0\n4,0,0", "relaxation", "is never strained"),
        ("0,0.5,9\n1,0.5,8", "relaxation", "has 2 points"),
    ],
)
def test_tables_unlike_their_test_are_refused(rows, kind, words):
    with pytest.raises(MeasurementError, match=words):
        read_timed_test(f"time_s,strain,stress_kPa\n{rows}\n", kind=kind)


def test_the_time_has_a_unit_and_a_column():
    rows = "".join(f"\n{i},0.5,{9 - i}" for i in range(5))
    assert read_timed_test(f"Time (min),strain,stress_kPa{rows}", kind="relaxation").time[1] == 60.0
    with pytest.raises(MeasurementError, match="has no unit"):
        read_timed_test(f"time,strain,stress_kPa{rows}", kind="relaxation")
    with pytest.raises(MeasurementError, match="no column of the time among"):
        read_timed_test(f"turn,strain,stress_kPa{rows}", kind="relaxation")


def test_unknown_requests_are_refused():
    with pytest.raises(MaterialError, match="did you mean"):
        fit_branches([held(SOLID)], model="yeoh2")
    with pytest.raises(MeasurementError, match="expected 1 to 4"):
        fit_branches([held(SOLID)], branches=0)
    with pytest.raises(MeasurementError, match="give a relaxation test"):
        fit_branches([])
    sudden = measured(SOLID, np.arange(9.0), np.full(9, 0.5), 0.0, "relaxation", "one")
    with pytest.raises(MeasurementError, match="has one strain alone, and yeoh-3 has 3 constants"):
        fit_branches([sudden], model="yeoh-3")


def test_steps_of_a_response_do_not_change_it():
    """A ramp in one row or in many is one test, and decays far beyond the time of a branch."""
    ends, fine = np.array([10.0, 2e4]), np.concatenate([np.linspace(0.0, 10.0, 500)[1:], [2e4]])
    coarse = relaxing_stress(SOLID, ends, [2.0, 2.0])
    # Between instants 0.01 of stretch apart stresses are taken for linear, 1e-5 of them.
    found = relaxing_stress(SOLID, fine, np.minimum(1.0 + fine / 10.0, 2.0))
    assert found[-2:] == pytest.approx(coarse, rel=2e-5)
    assert coarse[-1] == pytest.approx(float(nominal_stress(SOLID, 2.0)), rel=1e-9)
