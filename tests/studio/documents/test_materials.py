"""Event of the materials for the page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from own_loop import run

from voxsoft.design import families
from voxsoft.files.cards import save_card
from voxsoft.files.toml_edits import with_value
from voxsoft.materials import card_names, load_card
from voxsoft.studio.documents.document import DesignDocument
from voxsoft.studio.documents.materials import materials_of
from voxsoft.studio.protocol import events

BEAM = families.family_text("beam")


def facts(document: DesignDocument) -> dict[str, events.MaterialFacts]:
    return {one.name: one for one in materials_of(document).materials}


def test_every_card_is_there_once() -> None:
    found = [
        one for one in facts(DesignDocument(BEAM, "beam.toml")).values() if one.origin == "card"
    ]
    shown = {one.name for one in found} | {one.same_as for one in found}
    assert shown - {""} == set(card_names())
    assert len(found) == len({one.name for one in found})
    assert not {one.name for one in found} & {one.same_as for one in found}


def test_unstated_values_of_cards_are_left_open() -> None:
    found = facts(DesignDocument(BEAM, "beam.toml"))
    bending = found["dragon-skin-10"]
    assert (bending.tested_to, bending.elongation_at_break, bending.shore) == (None, None, "10A")
    assert found["rtv615"].shore == ""
    tested = found["dragon-skin-30"]
    assert tested.tested_to == 4.0
    assert tested.stretches[-1] > 4.0


def test_no_curve_goes_beyond_the_break() -> None:
    for one in facts(DesignDocument(BEAM, "beam.toml")).values():
        if one.elongation_at_break is not None:
            assert one.stretches[-1] <= 1.0 + one.elongation_at_break + 1e-9


def test_own_materials_and_files_stand_before_the_cards(tmp_path: Path) -> None:
    card = load_card("ecoflex-00-30").replace(name="mine", shore="00-30")
    save_card(card, tmp_path / "mine.toml")
    text = BEAM.replace('material = "ecoflex-00-30"', 'material = "mine.toml"')
    text += '\n[materials]\nown = { model = "lattice", edge = "20 kPa", bulk = "100 kPa" }\n'
    document = DesignDocument(text, "beam.toml", folder=tmp_path)
    assert document.valid, document.diagnostics
    first, second, *_ = materials_of(document).materials
    assert (first.name, first.origin, first.live) == ("own", "design", "explicit")
    assert (second.name, second.origin) == (str(tmp_path / "mine.toml"), "file")


def test_a_mixture_of_lattice_and_rubber_has_a_sentence() -> None:
    assert materials_of(DesignDocument(BEAM, "beam.toml")).mixed == ""
    second = '\n[[parts]]\nshape = "body"\nname = "other"\nmaterial = "ecoflex-00-30-lattice"\n'
    document = DesignDocument(BEAM + second, "beam.toml")
    assert document.valid, document.diagnostics
    assert "mixes a spring lattice with rubber" in materials_of(document).mixed


def test_a_card_that_is_copied_is_the_same_material() -> None:
    one = facts(DesignDocument(BEAM, "beam.toml"))["ecoflex-00-30-epfl"]
    text = with_value(BEAM, ["materials", "copy"], one.table)
    design = DesignDocument(text, "beam.toml").design
    assert design is not None
    assert design.materials["copy"] == load_card("ecoflex-00-30-epfl").material


def test_a_tab_asks_for_the_materials(fresh_studio: Any) -> None:
    async def scenario() -> None:
        async with fresh_studio.page() as page:
            await page.send("materials")
            found = await page.until("materials")
            assert found.rev == page.rev
            assert {"ecoflex-00-30", "dragon-skin-10"} <= {one["name"] for one in found.materials}

    run(scenario())
