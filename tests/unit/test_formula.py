"""Formulas: arithmetic with dimensions, and every way to get them wrong."""

import contextlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from voxsoft.design.formula import DEEPEST_NESTING, LONGEST_FORMULA, evaluate, is_formula
from voxsoft.errors import DesignError, FormulaError
from voxsoft.units import KINDS, Dimension, Quantity

LENGTH = KINDS["length"].dimension
VALUES = {
    "radius": Quantity(0.02, LENGTH),
    "wall": Quantity(0.005, LENGTH),
    "zero_length": Quantity(0.0, LENGTH),
    "count": Quantity(3.0, Dimension()),
}


def value_of(text):
    return evaluate(text, VALUES.__getitem__)


@pytest.mark.parametrize(
    ("text", "value", "kind"),
    [
        ("= radius", 0.02, "length"),
        ("=radius-wall", 0.015, "length"),
        ("= radius - 2*wall + wall", 0.015, "length"),
        ("= 2*(radius - wall)", 0.03, "length"),
        ("= -wall", -0.005, "length"),
        ("= --wall", 0.005, "length"),
        ("= 8 - 4 - 2", 2.0, "number"),
        ("= 8 / 4 / 2", 1.0, "number"),
        ("= 2 + 3*4", 14.0, "number"),
        ("= -2*-3", 6.0, "number"),
        ("= 1e-3*2.5E2", 0.25, "number"),
        ("= .5", 0.5, "number"),
        ("= radius/wall", 4.0, "number"),
        ("= radius*wall", 1e-4, "area"),
        ("= 1/(radius*radius*radius) * radius*radius*radius * radius", 0.02, "length"),
        ("= min(radius, 2*wall, 7*wall)", 0.01, "length"),
        ("= max(radius - 5*wall, 0)", 0.0, "length"),
        ("= radius + 0", 0.02, "length"),
        ("= count * wall", 0.015, "length"),
    ],
)
def test_arithmetic_carries_dimensions(text, value, kind):
    result = value_of(text)
    assert result.value == pytest.approx(value, rel=1e-14)
    assert result.dimension == KINDS[kind].dimension


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("= radius + 4", ["a length and a plain number cannot be added", "parameter with a unit"]),
        ("= radius - radius*radius", ["a length and an area"]),
        ("= min(radius, 1)", ["compared"]),
        ("= zero_length + 1", ["cannot be added"]),
        ("= 1/0", ["divides by zero"]),
        ("= wall/(radius - 4*wall)", ["divides by zero"]),
        ("=", ["is not complete"]),
        ("= radius +", ["is not complete"]),
        ("= (radius", ['")" is due where the end stands']),
        ("= radius)", ['")" is not expected']),
        ("= radius wall", ['"wall" is not expected']),
        ("= radius * * wall", ['where "*" stands']),
        ("= radius ** 2", ['where "*" stands']),
        ("= min()", ['where ")" stands']),
        ("= sqrt(radius)", ["sqrt"]),
        ("= radius.real", ["not part of a formula"]),
        ("= radius[0]", ["not part of a formula"]),
        ("= 5 mm", ["mm"]),
        ("= 1e300*1e300", ["too large"]),
        ("= 1e999", ["too large"]),
        ("= " + "(" * 60 + "1" + ")" * 60, [f"deeper than {DEEPEST_NESTING}"]),
        ("= " + "-" * 60 + "1", [f"deeper than {DEEPEST_NESTING}"]),
        ("= 1" + "+1" * LONGEST_FORMULA, [f"longer than {LONGEST_FORMULA}"]),
    ],
)
def test_wrong_formulas_say_what_is_wrong(text, words):
    def known(name):
        if name not in VALUES:
            raise FormulaError("", f'"{name}" is not a parameter')
        return VALUES[name]

    with pytest.raises(FormulaError) as caught:
        evaluate(text, known)
    for word in words:
        assert word in str(caught.value)


def test_only_text_with_an_equals_sign_is_a_formula():
    assert is_formula("  = a")
    assert not any(map(is_formula, ["a = b", "5 mm", 5, None, ["= a"]]))


def test_a_formula_error_is_a_design_error():
    assert issubclass(FormulaError, DesignError)


EXPRESSIONS = st.recursive(
    st.sampled_from(["1", "2.5", "count", "0.5"]),
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from("+-*"), inner).map(lambda t: f"({t[0]} {t[1]} {t[2]})"),
        inner.map(lambda e: f"-{e}"),
        st.lists(inner, min_size=1, max_size=3).map(lambda es: f"max({', '.join(es)})"),
    ),
    max_leaves=12,
)


@given(EXPRESSIONS)
def test_values_agree_with_python(expression):
    with contextlib.suppress(FormulaError):  # nested too deep
        expected = eval(expression, {"count": 3.0, "max": lambda *a: max(a)})
        assert value_of(f"= {expression}").value == expected


@given(st.text(alphabet="=+-*/(),. 0123456789eEminaxrdus_", max_size=60))
def test_any_text_is_evaluated_or_refused_with_our_error(text):
    def nothing(name):
        raise FormulaError("", f'"{name}" is not a parameter')

    with contextlib.suppress(FormulaError):
        evaluate(f"={text}", nothing)
