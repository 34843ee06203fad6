"""Hyperelastic models: constants, values for the core, refusals, ranges of stability."""

from functools import partial

import numpy as np
import pytest

import voxsoft as vs
from voxsoft._core import Fiber
from voxsoft._core import Material as Core
from voxsoft.errors import DesignError, MaterialError
from voxsoft.files.cards import load_card_file, save_card
from voxsoft.materials import Card, nominal_stress, stable_range, stable_ranges

EVERY_MODEL = [
    vs.NeoHookean(young="60 kPa", poisson=0.49),
    vs.MooneyRivlin(c10="10 kPa", c01="4 kPa"),
    vs.Yeoh(c=["13 kPa", "-0.14 kPa", "0.02 kPa"]),
    vs.Ogden(mu=["24 kPa", "67 Pa", "450 Pa"], alpha=[1.7, 7.1, -3.4]),
    vs.Gent(shear="20 kPa", jm=40, prony=[{"g": 0.1, "tau": "1 s"}]),
]


@pytest.mark.parametrize("material", EVERY_MODEL, ids=lambda m: m.model)
def test_moduli_belong_together(material):
    young, shear, bulk, nu = material.young(), material.shear, material.bulk, material.poisson
    # Isotropic elasticity, to rounding.
    assert young == pytest.approx(9 * bulk * shear / (3 * bulk + shear), rel=1e-12)
    assert nu == pytest.approx((3 * bulk - 2 * shear) / (2 * (3 * bulk + shear)), rel=1e-12)


@pytest.mark.parametrize("material", EVERY_MODEL, ids=lambda m: m.model)
def test_a_card_keeps_every_constant(material, tmp_path):
    card = Card(name="soft", material=material, source="made up")
    save_card(card, tmp_path / "soft.toml")
    assert load_card_file(tmp_path / "soft.toml") == card
    text = (tmp_path / "soft.toml").read_text(encoding="utf-8")
    assert ("prony" in text) == bool(material.prony)


@pytest.mark.parametrize("material", EVERY_MODEL, ids=lambda m: m.model)
def test_a_design_holds_the_model(material, tmp_path):
    part = vs.Part(shape=vs.Box(size=(0.1, 0.01, 0.01)), material=material)
    design = vs.Design(name="strip", voxel_size=5e-3, parts=[part])
    file = tmp_path / "strip.toml"
    design.save(file)
    again = vs.load(file)
    assert again.material_of(again.parts[0]) == material
    assert again.hash == design.hash


@pytest.mark.parametrize(
    ("material", "core"),
    [
        (vs.NeoHookean(young=60e3, poisson=0.2), partial(Core.neo_hookean, c10=12.5e3)),
        (vs.MooneyRivlin(c10=1e3, c01=2e3), partial(Core.mooney_rivlin, c10=1e3, c01=2e3)),
        (vs.Yeoh(c=[1e3, -5.0]), partial(Core.yeoh, c=[1e3, -5.0, 0.0])),
        (
            vs.Ogden(mu=[1e3, 2e3], alpha=[2, -3]),
            partial(Core.ogden, terms=[(1e3, 2.0), (2e3, -3.0)]),
        ),
        (vs.Gent(shear=1e3, jm=30), partial(Core.gent, shear=1e3, limit=30.0)),
    ],
    ids=lambda value: value.model if hasattr(value, "model") else "",
)
def test_constants_for_the_core(material, core):
    expected = core(bulk=material.bulk, density=1070.0)
    assert material.core == expected
    viscous = material.replace(prony=[{"g": 0.25, "tau": "2 s"}])
    assert viscous.core == expected.with_prony([(0.25, 2.0)]) != expected


def test_fibers_and_branches_belong_to_hyperelastic_materials():
    """Neither takes the other's place, and a lattice has none."""
    fiber = Fiber((0.0, 0.6, 0.8), modulus=2e6, compression=False, free=1.0)
    soft = Core.neo_hookean(c10=1e4, bulk=1e6, density=1e3)
    both = soft.with_prony([(0.25, 2.0)]).with_fibers([fiber])
    assert both == soft.with_fibers([fiber]).with_prony([(0.25, 2.0)])
    assert both.with_fibers([]).with_prony([]) == soft != both
    lattice = Core.lattice(edge=1e4, bulk=1e5, density=1e3)
    with pytest.raises(MaterialError, match="fibers: are for hyperelastic materials"):
        lattice.with_fibers([fiber])
    with pytest.raises(MaterialError, match="prony: are for hyperelastic materials"):
        lattice.with_prony([(0.25, 2.0)])
    with pytest.raises(DesignError, match="4 entries, expected 3"):
        Core.ogden(terms=[(1e3, 2.0)] * 4, bulk=1e6, density=1e3)


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"model": "neo-hookean", "young": "60 kPa", "poisson": 0.5}, "use 0.499"),
        ({"model": "neo-hookean", "young": "60 kPa", "poisson": -0.1}, "negative"),
        ({"model": "neo-hookean", "young": "-60 kPa"}, "not positive"),
        ({"model": "neo-hookean", "young": "60 mm"}, "expected a modulus"),
        ({"model": "neo-hookean", "young": "1e307 kPa"}, "too large"),
        ({"model": "neo-hookean", "young": 60.0}, "has no unit"),
        ({"model": "mooney-rivlin", "c10": "1 kPa", "c01": "-1 kPa"}, "initial shear modulus"),
        ({"model": "mooney-rivlin", "c10": "1 kPa", "c01": "2"}, "c01"),
        ({"model": "yeoh", "c": ["-1 kPa"]}, "initial shear modulus is -2 kPa"),
        ({"model": "yeoh", "c": ["1 kPa"] * 4}, "more than 3"),
        ({"model": "yeoh", "c": "1 kPa"}, "expected a list"),
        ({"model": "ogden", "mu": ["1 kPa"], "alpha": []}, "alpha"),
        ({"model": "ogden", "mu": ["1 kPa"], "alpha": [1, 2]}, "one exponent for each"),
        ({"model": "ogden", "mu": ["1 kPa"], "alpha": [0]}, "is zero"),
        ({"model": "ogden", "mu": ["1 kPa", "-2 kPa"], "alpha": [1, 2]}, "above zero"),
        ({"model": "gent", "shear": "1 kPa", "jm": 0}, "not positive"),
        ({"model": "gent", "shear": "1 kPa", "jm": "nan"}, "jm"),
        ({"model": "gent", "shear": "1 kPa", "jm": 9, "prony": [{"g": 1.2, "tau": "1 s"}]}, "1.2"),
        ({"model": "gent", "shear": "1 kPa", "jm": 9, "prony": [{"g": 0.1, "tau": 1}]}, "unit"),
        ({"model": "neohooke", "young": "1 kPa"}, 'did you mean "neo-hookean"'),
    ],
)
def test_impossible_constants_are_reported_in_words(table, words):
    document = {"schema": "voxsoft-material/1", "name": "x", "material": table}
    with pytest.raises(vs.VoxSoftError, match=words) as caught:
        Card.from_document(document)
    assert str(caught.value).startswith(("material", "2 problems"))


def test_the_two_ogden_conventions():
    """Ogden's own: W = Σ m/α (...), one term with α = 2 being neo-Hookean of μ = m."""
    classic = vs.Ogden.from_classic([20e3], [2.0])
    neo = vs.NeoHookean(young=2 * 20e3 * 1.499)
    stretch = np.linspace(0.5, 4.0, 30)
    np.testing.assert_allclose(
        nominal_stress(classic, stretch), nominal_stress(neo, stretch), rtol=1e-12, atol=1e-8
    )


def test_gent_locks_and_tends_to_neo_hookean():
    neo = vs.NeoHookean(young=2 * 20e3 * 1.499)
    stretch = np.linspace(0.5, 3.0, 20)
    # ln(1 - x) = -x - x²/2 ...: the difference is of relative order (I₁ - 3)/Jm = 6.7e-8.
    nearly = nominal_stress(vs.Gent(shear=20e3, jm=1e8), stretch)
    np.testing.assert_allclose(nearly, nominal_stress(neo, stretch), rtol=1e-6)
    locked = nominal_stress(vs.Gent(shear=20e3, jm=5), [2.0, 3.0])
    assert np.isfinite(locked[0])
    assert np.isnan(locked[1])


def test_stable_models_are_found_stable():
    for material in (EVERY_MODEL[0], EVERY_MODEL[1], EVERY_MODEL[3], EVERY_MODEL[4]):
        for found in stable_ranges(material):
            assert not found.sentence
            assert found.stable == pytest.approx((0.3, 5.0))


def test_the_end_of_a_monotone_range():
    """P' = 0 of a two-term Yeoh model, solved by hand: see the bisection below."""
    material = vs.Yeoh(c=[10e3, -500.0])

    def slope(stretch):
        step = 1e-6
        ahead, behind = (nominal_stress(material, stretch + s) for s in (step, -step))
        return float(ahead - behind)

    low, high = 1.0, 5.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if slope(middle) > 0 else (low, middle)
    found = stable_range(material, "uniaxial")
    # The grid of the scan: 2001 stretches over a ratio of 5/0.3, 0.14 % apart.
    assert found.monotone[1] == pytest.approx(low, rel=2e-3)
    assert found.holds(0.9, 1.5)
    assert not found.holds(0.9, low * 1.01)
    assert "above stretch" in found.sentence


def test_unknown_modes_and_impossible_stretches():
    with pytest.raises(vs.VoxSoftError, match="did you mean"):
        nominal_stress(EVERY_MODEL[0], 2.0, "uniaxail")
    with pytest.raises(vs.VoxSoftError, match="above zero"):
        nominal_stress(EVERY_MODEL[0], [1.0, 0.0])
