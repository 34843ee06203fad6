"""Posteriors of cards: what they read, and what they draw."""

import numpy as np
import pytest

from voxsoft.errors import MaterialError
from voxsoft.materials import NeoHookean, Ogden, Posterior, Rigid, Yeoh, load_card
from voxsoft.materials.card import Card


def card(material, **notes):
    return Card(name="mine", material=material, calibration=notes)


RUBBER = NeoHookean(young="60 kPa", poisson=0.45, density=1070.0)


def test_the_interval_of_a_calibrated_card_is_read():
    posterior = Posterior.of(load_card("ecoflex-00-50-lattice"))
    # bulk is only bounded from above there.
    assert posterior.intervals == {"edge": (39.1e3, 47.2e3)}


def test_a_card_without_intervals_has_none():
    assert Posterior.of(load_card("ecoflex-00-30")) is None


def test_half_of_the_draws_lie_below_the_value_and_most_in_the_interval():
    posterior = Posterior.of(card(RUBBER, young_interval="between 50 kPa and 90 kPa (95 %)"))
    generator = np.random.default_rng(0)
    drawn = np.array([posterior.draw(generator).young_modulus for _ in range(4000)])
    # Four standard deviations of a binomial of 4000.
    assert np.mean(drawn < 60e3) == pytest.approx(0.5, abs=4 * np.sqrt(0.25 / 4000))
    inside = np.mean((drawn > 50e3) & (drawn < 90e3))
    assert inside == pytest.approx(0.95, abs=4 * np.sqrt(0.95 * 0.05 / 4000))


def test_young_alone_is_drawn_where_the_card_has_it_and_scales_all_moduli():
    soft = Ogden(mu=["20 kPa", "5 kPa"], alpha=[1.7, -3.4], poisson=0.45)
    young = soft.young()
    notes = {
        "young_interval": f"between {0.8 * young} Pa and {1.3 * young} Pa (95 %)",
        "poisson_interval": "between 0.4 and 0.49 (95 %)",
    }
    drawn = Posterior.of(card(soft, **notes)).draw(np.random.default_rng(3))
    factor = drawn.young() / young
    assert factor != 1.0
    assert drawn.mu == pytest.approx([20e3 * factor, 5e3 * factor])
    assert (drawn.alpha, drawn.poisson) == (soft.alpha, soft.poisson)


def test_a_seed_repeats_a_draw():
    posterior = Posterior.around(RUBBER, 0.3)
    first, second, other = (posterior.draw(np.random.default_rng(s)) for s in (1, 1, 2))
    assert first == second != other


def test_a_spread_is_as_many_times_less_as_more():
    posterior = Posterior.around(Yeoh(c=["10 kPa", "1 kPa"], poisson=0.45), 0.25)
    [(low, high)] = posterior.intervals.values()
    young = posterior.material.young()
    assert (low, high) == pytest.approx((young / 1.25, young * 1.25))


@pytest.mark.parametrize(
    ("notes", "what"),
    [
        ({"young_interval": "between 70 kPa and 90 kPa (95 %)"}, "does not lie around"),
        ({"young_interval": "between -5 kPa and 90 kPa (95 %)"}, "does not lie around"),
        ({"young_interval": "between soft and 90 kPa (95 %)"}, "young_interval"),
    ],
)
def test_an_impossible_interval_is_an_error_of_the_card(notes, what):
    with pytest.raises(MaterialError, match=what):
        Posterior.of(card(RUBBER, **notes))


@pytest.mark.parametrize("share", [0.0, -0.1, float("nan")])
def test_a_spread_is_above_zero(share):
    with pytest.raises(MaterialError, match="is no share"):
        Posterior.around(RUBBER, share)


def test_a_rigid_material_has_no_spread():
    with pytest.raises(MaterialError, match="has no moduli"):
        Posterior.around(Rigid(density=1000.0), 0.3)
