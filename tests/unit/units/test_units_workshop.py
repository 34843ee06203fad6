"""Units with a trap: each is read to its right value, or its refusal holds that value."""

import re

import pytest

from voxsoft.errors import UnitError
from voxsoft.units import KINDS, parse, parse_any

#: Text, kind, and the value in SI by the definition of the unit.
READ = [
    ("5 Nm", "energy", 5.0),
    ("5 N·m", "energy", 5.0),
    ("5 mNm", "energy", 5e-3),
    ("5 N·mm", "energy", 5e-3),
    ("5 Nmm", "energy", 5e-3),
    ("5 Ncm", "energy", 5e-2),
    ("20 mil", "length", 20 * 25.4e-6),
    ("20 thou", "length", 20 * 25.4e-6),
    ("20 rpm", "rate", 20 / 60),
    ("30 kPag", "pressure", 30e3),
    ("0.3 barg", "pressure", 30e3),
    ("10 psig", "pressure", 10 * 6894.757293168361),
    ("3 cmH2O", "pressure", 3 * 98.0665),
    ("3 mmH2O", "pressure", 3 * 9.80665),
    ("1 inH2O", "pressure", 249.08891),
    ("1 mmHg", "pressure", 133.322387415),
]
#: Text, kind, and the value that is meant in SI.
REFUSED = [
    ("2 bara", "pressure", 200e3 - 101325.0),
    ("14.7 psia", "pressure", 14.7 * 6894.757293168361 - 101325.0),
    ("101 kPa abs", "pressure", 101e3 - 101325.0),
    ("10 slpm", "volume flow", 10e-3 / 60),
    ("500 sccm", "volume flow", 0.5e-3 / 60),
    ("2 kg", "force", 2 * 9.80665),
    ("5 lbs", "force", 5 * 0.45359237 * 9.80665),
]


@pytest.mark.parametrize(("text", "kind", "value"), READ)
def test_units_of_workshops_are_read(text, kind, value):
    assert parse(text, kind) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(("text", "kind", "value"), REFUSED)
def test_a_refusal_holds_the_value_that_is_meant(text, kind, value):
    with pytest.raises(UnitError) as caught:
        parse(text, kind)
    meant = re.search(r'"([^"]+)"', caught.value.hint)
    # Twelve digits are shown; a difference from the atmosphere loses some of them.
    assert parse(meant[1], kind) == pytest.approx(value, rel=1e-9)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    "unit", ["mm", "J", "kPa", "kg", "deg", "N/m", "1/s", "mNm", "mil", "rpm", "%"]
)
def test_no_hint_has_the_number_in_a_unit_of_another_kind(kind, unit):
    text = f"5.25 {unit}"
    try:
        parse(text, kind)
    except UnitError as error:
        for shown in re.findall(r'"(-?[\d.e-]+ [^"]+)"', error.hint):
            assert "5.25" not in shown
            assert kind == "force"  # of a mass, its weight
            assert parse(shown, "force") == pytest.approx(parse_any(text).value * 9.80665)
