"""Hashes of a family: those of each design alone, though most entries are written once."""

import hashlib
import json
import tomllib

import pytest
from tiny_design import TINY

import voxsoft as vs
from voxsoft.design import Design, families
from voxsoft.design.document.identity import Hashes
from voxsoft.errors import DesignError
from voxsoft.files.cards import save_card
from voxsoft.units import round_significant


def canonical(value):
    """Round numbers, and leave out what is empty."""
    if isinstance(value, dict):
        return {key: canonical(each) for key, each in value.items() if each is not None}
    if isinstance(value, list):
        return [canonical(each) for each in value]
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return round_significant(float(value)) + 0.0 if is_number else value


def test_a_hash_is_that_of_canonical_json():
    design = Design.from_document({"name": "tiny", **tomllib.loads(TINY)})
    left_out = {"schema_", "name", "description", "parameters", "objectives", "constraints"}
    plain = design.model_dump(mode="json", by_alias=True, exclude_none=True, exclude=left_out)
    plain = {key: value for key, value in plain.items() if value not in ("", {}, [])}
    text = json.dumps(
        canonical(plain | {"fill": "fraction"}), sort_keys=True, separators=(",", ":")
    )
    assert design.hash == hashlib.sha256(text.encode()).hexdigest()


@pytest.mark.parametrize("family", [families.cylinder, families.pneunet, families.sphere])
def test_designs_of_a_family_have_the_hashes_of_each_alone(family):
    base, hashes = family(), Hashes()
    designs = [base]
    for name, parameter in base.parameters.items():
        for factor in (0.9, 1.0, 1.1):
            value = type(parameter.value)(factor * parameter.value)
            try:
                designs.append(base.with_parameters(**{name: value}))
            except DesignError:
                continue
    loads = [each.replace(value=2.0 * each.value) for each in base.loads]
    designs += [base.replace(loads=loads), base.replace(fill="binary"), base]
    assert [hashes.of(each) for each in designs] == [each.hash for each in designs]
    assert len({each.hash for each in designs}) > 3


def test_a_card_that_changes_changes_the_hash_of_the_next_design(tmp_path):
    def card(young):
        material = vs.NeoHookean(young=young, density="1100 kg/m^3")
        save_card(vs.materials.Card(name="mine", material=material), tmp_path / "mine.toml")

    card("55 kPa")
    hashes = Hashes()
    base = families.beam()
    part = base.parts[0].replace(material=str(tmp_path / "mine.toml"))
    base = base.replace(parts=[part])
    first = hashes.of(base)
    card("65 kPa")
    longer = base.with_parameters(length="110 mm")
    assert longer.parts[0] is base.parts[0]
    assert hashes.of(longer) == longer.hash
    assert hashes.of(base) == base.hash != first
