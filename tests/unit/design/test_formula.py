"""Formulas: arithmetic with dimensions, and every way to get them wrong."""

import contextlib
import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from voxsoft.design.document.formula import DEEPEST_NESTING, LONGEST_FORMULA, evaluate, is_formula
from voxsoft.errors import DesignError, FormulaError
from voxsoft.units import COMMON_UNITS, KINDS, Quantity

CASES = json.loads(Path(__file__).with_name("formulas.json").read_text(encoding="utf-8"))
VALUES = {
    name: Quantity(each["value"], KINDS[each["kind"]].dimension)
    for name, each in CASES["parameters"].items()
}


def known(name):
    if name not in VALUES:
        raise FormulaError("", f'"{name}" is not a parameter')
    return VALUES[name]


def value_of(text):
    return evaluate(text, known)


@pytest.mark.parametrize("case", CASES["values"], ids=lambda case: case["formula"])
def test_arithmetic_carries_dimensions(case):
    result = value_of(case["formula"])
    assert result.value == pytest.approx(case["value"], rel=1e-14)
    assert result.dimension == KINDS[case["kind"]].dimension


@pytest.mark.parametrize(
    ("text", "words"),
    [
        *((case["formula"], case["words"]) for case in CASES["refused"]),
        ("= " + "(" * 60 + "1" + ")" * 60, [f"deeper than {DEEPEST_NESTING}"]),
        ("= " + "-" * 60 + "1", [f"deeper than {DEEPEST_NESTING}"]),
        ("= 1" + "+1" * LONGEST_FORMULA, [f"longer than {LONGEST_FORMULA}"]),
    ],
)
def test_wrong_formulas_name_the_fault(text, words):
    with pytest.raises(FormulaError) as caught:
        value_of(text)
    for word in words:
        assert word in str(caught.value)


def test_the_page_gets_the_units_and_the_dimensions_of_kinds():
    assert sorted(COMMON_UNITS) == CASES["common_units"]
    assert {name: list(kind.dimension) for name, kind in KINDS.items()} == CASES["dimensions"]


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


@given(st.text(alphabet="=+-*/(),.^ 0123456789eEminaxrdus_µ°%²⁻", max_size=60))
def test_any_text_is_evaluated_or_refused_with_our_error(text):
    def nothing(name):
        raise FormulaError("", f'"{name}" is not a parameter')

    with contextlib.suppress(FormulaError):
        evaluate(f"={text}", nothing)
