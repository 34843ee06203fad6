"""Units: meaning of text, refusals, and that writing and reading agree."""

import contextlib
import math
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, ValidationError

from voxsoft.errors import UnitError, VoxSoftError
from voxsoft.units import (
    KINDS,
    Angle,
    Dimension,
    ExtendedLength,
    Length,
    Modulus,
    Point,
    Quantity,
    Vector,
    format_quantity,
    kPa,
    mm,
    parse,
    parse_any,
    round_significant,
)


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("5 mm", "length", 0.005),
        ("35mm", "length", 0.035),
        ("-1.5e1 cm", "length", -0.15),
        ("2 inch", "length", 0.0508),
        ("3 µm", "length", 3e-6),
        ("1 mile", "length", 1609.344),
        ("0", "length", 0.0),
        ("4 kPa", "pressure", 4000.0),
        ("1 N/mm^2", "pressure", 1e6),
        ("1 N/mm²", "pressure", 1e6),
        ("1070 kg/m^3", "density", 1070.0),
        ("1070 kg m^-3", "density", 1070.0),
        ("9.81 m/s**2", "acceleration", 9.81),
        ("9.81 m/s/s", "acceleration", 9.81),
        ("5 1/s", "rate", 5.0),
        ("5 /s", "rate", 5.0),
        ("5 Hz", "rate", 5.0),
        ("90 deg", "angle", math.pi / 2),
        ("90°", "angle", math.pi / 2),
        ("1 rad", "angle", 1.0),
        ("10 %", "number", 0.1),
        ("2.5", "number", 2.5),
        ("3 mL", "volume", 3e-6),
        ("2 N*m", "energy", 2.0),
    ],
)
def test_text_with_a_unit_is_read_in_si(text, kind, value):
    assert parse(text, kind) == pytest.approx(value, rel=1e-15, abs=0.0)


@pytest.mark.parametrize(
    ("text", "kind", "words"),
    [
        ("5", "length", ['"5" has no unit', 'write "5 mm"']),
        ("5 kPa", "length", ["is a pressure", "expected a length"]),
        ("5 mm^2", "length", ["an area"]),
        ("5 furlongz", "length", ['no unit "furlongz"']),
        ("5 degC", "temperature", ["does not count from zero", "353.15 K"]),
        ("5 kelvin", "length", ["a temperature", "expected a length"]),
        ("5 mol", "length", ["not a unit of mechanics"]),
        ("5,3 mm", "length", ["decimal point"]),
        ("wide", "length", ["does not start with a number"]),
        ("= 2*radius", "length", ["formula"]),
        ("5 mm^99", "length", ["not a unit"]),
        ("5 m/", "length", ["not a unit"]),
        ("1e9999 mm", "length", ["too large"]),
        ("1", "angle", ['write "1 deg"']),
        ("nan", "length", ["does not start with a number"]),
        ("9" * 500, "length", ["does not start with a number"]),
    ],
)
def test_wrong_text_is_refused_in_plain_words(text, kind, words):
    with pytest.raises(UnitError) as caught:
        parse(text, kind)
    for word in words:
        assert word in str(caught.value)


def test_an_error_names_the_place_it_is_reported():
    with pytest.raises(UnitError, match=r"^parts\[0\]\.wall: "):
        parse("5", "length", where="parts[0].wall")


def test_parse_any_finds_the_dimension():
    assert parse_any("2 kPa") == Quantity(2000.0, KINDS["pressure"].dimension)
    assert parse_any("2") == Quantity(2.0, Dimension())


@given(
    st.floats(allow_nan=False, allow_infinity=False, min_value=-1e15, max_value=1e15),
    st.sampled_from(sorted(set(KINDS) - {"angle"})),
)
def test_writing_and_reading_agree_to_twelve_digits_exactly(value, kind):
    assert parse(format_quantity(value, kind), kind) == round_significant(value)


@given(st.floats(min_value=-10.0, max_value=10.0))
def test_angles_agree_to_twelve_digits(angle):
    read = parse(format_quantity(angle, "angle"), "angle")
    assert round_significant(read) == round_significant(angle)


@given(st.text(max_size=30))
def test_any_text_is_read_or_refused_with_our_error(text):
    with contextlib.suppress(VoxSoftError):
        assert math.isfinite(parse_any(text).value)


@pytest.mark.parametrize(
    ("value", "kind", "text"),
    [
        (0.005, "length", "5 mm"),
        (0.0, "length", "0"),
        (2.5, "length", "2.5 m"),
        (1.2e6, "pressure", "1.2 MPa"),
        (math.pi / 2, "angle", "90 deg"),
        (9.81, "acceleration", "9.81 m/s^2"),
        (1 / 3, "number", "0.333333333333"),
    ],
)
def test_quantities_are_written_with_a_fitting_unit(value, kind, text):
    assert format_quantity(value, kind) == text


class Sample(BaseModel):
    length: Length = 0.0
    span: ExtendedLength = 0.0
    stiffness: Modulus = 1.0
    tilt: Angle = 0.0
    at: Point = (0.0, 0.0, 0.0)
    along: Vector = (0.0, 0.0, 1.0)


FROM_FILE = {"source": "file"}


def test_python_takes_si_floats_and_text():
    sample = Sample(length=5 * mm, stiffness="60 kPa", at=("1 mm", 0, 2 * mm), along=(1, 0, 0))
    assert sample.length == 0.005
    assert sample.stiffness == 60 * kPa
    assert sample.at == (0.001, 0.0, 0.002)


def test_a_file_needs_units_except_for_zero_and_infinity():
    document = {"length": 0, "span": math.inf, "at": [0, "1 mm", 0.0], "along": [0, 0, 1]}
    sample = Sample.model_validate(document, context=FROM_FILE)
    assert sample.at == (0.0, 0.001, 0.0)
    with pytest.raises(ValidationError, match=r"0.005 has no unit"):
        Sample.model_validate({"length": 0.005}, context=FROM_FILE)


@pytest.mark.parametrize(
    "document",
    [
        {"stiffness": "-1 kPa"},
        {"stiffness": 0},
        {"length": math.nan},
        {"length": math.inf},
        {"length": 10**400},
        {"length": True},
        {"length": [1]},
        {"length": None},
        {"at": ["1 mm", "1 mm"]},
        {"along": ["1 mm", 0, 0]},
        {"length": Quantity(1.0, KINDS["area"].dimension)},
    ],
)
def test_values_out_of_bounds_are_refused(document):
    with pytest.raises(ValidationError):
        Sample.model_validate(document)


def test_a_dumped_sample_reads_back():
    sample = Sample(length=12.5 * mm, tilt=0.25, stiffness=61 * kPa)
    document = sample.model_dump(mode="json")
    assert document["length"] == "12.5 mm"
    assert Sample.model_validate(document, context=FROM_FILE) == sample


def test_the_schema_names_the_kind():
    schema = Sample.model_json_schema()["properties"]["stiffness"]
    assert schema["x-kind"] == "modulus"
    assert '"5 kPa"' in schema["description"]


def test_common_units_do_not_load_pint():
    code = (
        "import sys; from voxsoft.units import parse; parse('5 kg/m^3', 'density');"
        "sys.exit('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
