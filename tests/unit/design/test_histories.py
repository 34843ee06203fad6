"""Histories: instants, sines, repeats, tables, and names that loads and motions share."""

import numpy as np
import pytest
from tiny_design import TINY

import voxsoft as vs
from voxsoft.design import families
from voxsoft.errors import DesignError


def test_a_sine_is_one():
    sine = vs.History(sine={"period": "2 s", "low": -0.5, "high": 1.5, "cycles": 3})
    times = np.linspace(0.0, 6.0, 301)
    found = np.array([sine.at(float(t)) for t in times])
    exact = 0.5 - np.cos(np.pi * times)
    # Chords of 64 pieces: half the height times 1 - cos(pi/64), 1.2e-3.
    assert np.abs(found - exact).max() < 1.3e-3
    assert sine.at(100.0) == pytest.approx(-0.5)


def test_an_expression_is_followed_closely():
    charge = vs.History(expression="1 - exp(-t / 0.05)", duration="3 s")
    times = np.linspace(0.0, 3.0, 1001)
    found = np.array([charge.at(float(t)) for t in times])
    # Bound by construction: an eight-hundredth of the range.
    assert np.abs(found - (1.0 - np.exp(-times / 0.05))).max() < 1.0 / 800.0
    assert 64 < len(charge.times) < 4097
    assert charge.at(100.0) == pytest.approx(1.0)
    swing = vs.History(expression="sin(2*pi*t)^2 * min(1, t)", duration="1 s")
    assert swing.at(0.25) == pytest.approx(0.25, abs=2e-3)
    # Shorter than the first pieces, and on none of their ends and middles.
    click = vs.History(expression="max(0, 1 - abs(t - 0.3035)/0.001)", duration="1 s")
    assert click.at(0.3035) > 0.8
    flat = vs.History(expression="0.5", duration="1 s", repeat=2)
    assert set(flat.factors) == {0.5}


def test_a_cycle_repeats_without_a_seam():
    puff = vs.History(time=("0.5 s", "1 s", "2 s"), factor=(0, 1, 0), repeat=3)
    assert puff.times == pytest.approx((0.5, 1.0, 2.0, 2.5, 3.5, 4.0, 5.0))
    assert [puff.at(t) for t in (1.0, 2.5, 4.0, 9.0)] == pytest.approx([1, 1, 1, 0])


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({}, "has no instants"),
        ({"time": (0.0,), "factor": (1.0,), "sine": {"period": 1.0}}, "instants and a sine"),
        ({"time": (0.0, 1.0), "factor": (0.0, 1.0), "repeat": 2}, "end where it begins"),
        ({"time": (0.0, 0.0), "factor": (0.0, 1.0)}, "does not rise"),
        ({"sine": {"period": 1.0, "cycles": 1000}, "repeat": 1000}, "stay below"),
        ({"sine": {"period": 0.0}}, "period"),
        ({"expression": "t", "duration": 1.0, "sine": {"period": 1.0}}, "a sine and an expression"),
        ({"expression": "t"}, "duration: is missing"),
        ({"time": (0.0,), "factor": (1.0,), "duration": 1.0}, "expression: is missing"),
        ({"expression": "t + tt", "duration": 1.0}, 'character 5: "tt" is not known; known are t'),
        ({"expression": "x", "duration": 1.0}, "function of t in seconds"),
        ({"expression": "1/t", "duration": 1.0}, "no value at 0 s"),
        ({"expression": "t", "duration": 1.0, "repeat": 2}, "end where it begins"),
    ],
)
def test_bad_histories_are_refused(given, words):
    with pytest.raises(DesignError, match=words):
        vs.History(**given)


def named(history, table="", more=""):
    text = f'schema = "voxsoft/1"\nname = "tiny"\n{TINY}'
    load = f'kind = "gravity"\nhistory = "{history}"'
    return text.replace('kind = "gravity"', load) + f"\n[histories]\n{table}\n{more}"


def test_loads_share_a_history_by_its_name(tmp_path):
    file = tmp_path / "tiny.toml"
    file.write_text(named("breath", 'breath = { sine = { period = "1 s" } }'))
    design = vs.load(file)
    assert design.loads[0].history.at(0.5) == pytest.approx(1.0)
    path = vs.follow(design, "time=0..1 s/3")
    rise = np.array(path.columns["rise"][1])
    assert rise[1] < 100 * min(rise[0], -1e-12)
    # The document keeps the name, and a change of its history changes all that use it.
    assert 'history = "breath"' in design.to_toml()
    quick = design.with_values('histories.breath.sine.period="0.5 s"')
    assert quick.loads[0].history.at(0.25) == pytest.approx(1.0)


def test_a_name_that_is_none_is_refused_with_its_line(tmp_path):
    file = tmp_path / "tiny.toml"
    file.write_text(named("breth", 'breath = { sine = { period = "1 s" } }'))
    with pytest.raises(
        DesignError, match=r'loads\[0\].history: there is no history "breth".*"breath"'
    ):
        vs.load(file)


def test_a_table_is_read_beside_the_design(tmp_path):
    file = tmp_path / "tiny.toml"
    (tmp_path / "t.csv").write_text("# pressures\ntime_s,left,right\n0,0,1\n1,1,0\n")
    file.write_text(named("t", 't = { table = "t.csv", column = "right" }'))
    assert vs.load(file).loads[0].history.factors == (1.0, 0.0)
    file.write_text(named("t", 't = { table = "t.csv" }'))
    assert vs.load(file).loads[0].history.factors == (0.0, 1.0)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("time,left\n0,1\n", "no column time_s"),
        ("time_s,left\n0,1\n2,1\n1,0\n", "line 4: 1 s comes after 2 s"),
        ("time_s,left\n0,1\n1,\n", "line 3, left: is empty"),
        ("time_s,left\n0,1\n1,x\n", 'line 3, left: "x" is no number'),
        ("time_s,left\n", "has no lines"),
        (None, "cannot be read"),
    ],
)
def test_bad_tables_are_refused_with_their_line(tmp_path, text, words):
    file = tmp_path / "t.csv"
    if text is not None:
        file.write_text(text)
    with pytest.raises(DesignError, match=words):
        vs.History.from_table(file)


def test_a_column_that_is_none_is_refused(tmp_path):
    (tmp_path / "t.csv").write_text("time_s,left\n0,1\n")
    with pytest.raises(DesignError, match=r'no column "lift".*"left"'):
        vs.History.from_table(tmp_path / "t.csv", "lift")


def test_a_parameter_may_be_called_history():
    beam = families.beam().document
    known = {**beam, "parameters": {**beam["parameters"], "history": "5 mm"}}
    assert vs.Design.from_document(known).parameters["history"].value == 0.005
