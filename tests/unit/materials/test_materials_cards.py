"""The cards that come with VoxSoft: each states its title, its source, and its quality."""

from pathlib import Path

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.materials import Hyperelastic, card_names, nominal_stress, stable_range
from voxsoft.materials.coupon import read_curve

ROOT = Path(__file__).parents[3]
FOLDER = ROOT / "python" / "voxsoft" / "materials" / "cards"
EVERY = [vs.load_card(name) for name in card_names()]
CARDS = [card for card in EVERY if not card.same_as]
PLAIN = [card for card in EVERY if card.same_as]
HYPERELASTIC = [card for card in CARDS if isinstance(card.material, Hyperelastic)]


def test_every_file_is_a_card_of_that_name():
    files = {file.stem for file in FOLDER.rglob("*.toml")} - {"plain-names"}
    assert files == {card.name for card in CARDS}
    assert len(HYPERELASTIC) > 20


@pytest.mark.parametrize("card", PLAIN, ids=lambda card: card.name)
def test_a_plain_name_is_rubber_and_says_which_and_why(card):
    stood_for = vs.load_card(card.same_as)
    assert isinstance(card.material, Hyperelastic)
    assert card.material == stood_for.material
    assert (card.source, card.caution) == (stood_for.source, stood_for.caution)
    assert stood_for.name.startswith(f"{card.name}-")
    alternatives = [other for other in CARDS if other.name.startswith(f"{card.name}-")]
    rubbers = [other for other in alternatives if isinstance(other.material, Hyperelastic)]
    assert len(card.choice) > 100 or len(rubbers) == 1 or card.name == "dragon-skin-fx-pro"


def test_only_names_that_say_so_are_lattices():
    for card in EVERY:
        assert (card.material.model == "lattice") == card.name.endswith("-lattice")


@pytest.mark.parametrize("card", CARDS, ids=lambda card: card.name)
def test_a_card_states_its_source_and_quality(card):
    assert len(card.source) > 40
    assert len(card.caution) > 40
    assert card.title


@pytest.mark.parametrize("card", HYPERELASTIC, ids=lambda card: card.name)
def test_a_hyperelastic_card_is_sound(card):
    assert card.license
    # Silicones for soft robots; the softest here is a slacker gel, the stiffest a casting rubber.
    assert 5e3 < card.material.young() < 2e6
    assert 1000 <= card.material.density <= 1200
    strains = card.calibration.get("strain_range", [0.0, 0.5])
    assert stable_range(card.material, "uniaxial").holds(0.7, 1.0 + strains[1])
    if card.elongation_at_break is not None:
        assert strains[1] <= card.elongation_at_break < 20


@pytest.mark.parametrize("card", HYPERELASTIC, ids=lambda card: card.name)
def test_an_unstable_range_stands_in_the_caution(card):
    for mode in ("uniaxial", "equibiaxial", "planar"):
        sentence = stable_range(card.material, mode).sentence
        assert not sentence or sentence[1:] in card.caution


@pytest.mark.parametrize(
    ("name", "noise"), [("ecoflex-00-30", 0.276e3), ("dragon-skin-10", 3.204e3)]
)
def test_a_tensile_card_follows_the_measured_curve(name, noise):
    """Root mean square over a third of the rows that the constants were fitted to.

    `noise` is that of all rows; of a third it may be half as large again, because errors follow one
    another.
    """
    card = vs.load_card(f"{name}-tensile")
    file = ROOT / "examples" / "data" / "tensile" / f"{name}.csv"
    curve = read_curve(file.read_text(encoding="utf-8"))
    strain = curve.strain - card.calibration["toe_strain"]
    kept = (strain >= 0.0) & (strain <= 3.0)
    error = nominal_stress(card.material, 1.0 + strain[kept]) - curve.stress[kept]
    assert np.sqrt(np.mean(error**2)) < 1.5 * noise


def test_derived_cards_keep_their_license_beside_them():
    text = (FOLDER / "srmd" / "LICENSE.md").read_text(encoding="utf-8")
    assert "Open Database License" in text
    for file in (FOLDER / "srmd").glob("*.toml"):
        assert "Open Database License" in vs.load_card(file.stem).license


def test_the_older_spelling_of_a_card_is_read():
    material = {"model": "neo-hookean", "young": "70 kPa"}
    document = {"schema": "voxsoft-material/1", "name": "soft", "material": material}
    found = vs.materials.Card.from_document({**document, "licence": "MIT"})  # older
    assert found == vs.materials.Card.from_document({**document, "license": "MIT"})
    assert found.license == "MIT"
