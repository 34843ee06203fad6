"""Chambers that have names: found by their place, and the same ones whatever their volumes."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design import Design
from voxsoft.errors import DesignError, NoCavityError
from voxsoft.simulation import Setup
from voxsoft.simulation.setup.chambers import center_of

#: An upright bar with two chambers side by side; the right one is as wide as `w` says.
TWO = {
    "name": "two",
    "voxel_size": "2 mm",
    "parameters": {"w": {"value": "6 mm", "min": "2 mm", "max": "8 mm", "step": "2 mm"}},
    "shapes": {
        "bar": {"kind": "box", "size": ["24 mm", "10 mm", "20 mm"], "corner": ["-12 mm", 0, 0]},
        "left": {
            "kind": "box",
            "size": ["6 mm", "6 mm", "16 mm"],
            "corner": ["-8 mm", "2 mm", "2 mm"],
        },
        "right": {
            "kind": "box",
            "size": ["= w", "6 mm", "16 mm"],
            "corner": ["2 mm", "2 mm", "2 mm"],
        },
        "body": {"kind": "difference", "of": ["bar", "left", "right"]},
    },
    "materials": {"soft": {"model": "neo-hookean", "young": "60 kPa", "poisson": 0.4}},
    "parts": [{"shape": "body", "material": "soft"}],
    "clamps": [{"region": {"z": [0, 0]}}],
    "loads": [{"kind": "pressure", "value": "2 kPa", "cavity": "left"}],
    "chambers": {
        "left": {"point": ["-5 mm", "5 mm", "10 mm"]},
        "right": {"point": ["= 2 mm + w/2", "5 mm", "10 mm"]},
    },
    "probes": {"tip": {"z": ["20 mm", "20 mm"]}},
    "objectives": {"bend": {"maximize": "displacement", "probe": "tip", "axis": "x"}},
}


def two(**changes):
    return Design.from_document({**TWO, **changes})


def by_index(index=0):
    return two(loads=[{"kind": "pressure", "value": "2 kPa", "cavity": index}], chambers={})


def indices(**given):
    names = [cavity.name for cavity in Setup.of(two(**given)).mesh.cavities]
    return {name: names.index(name) for name in names if name}


def test_a_named_chamber_stays_the_same_while_another_outgrows_it():
    """An index sent the tip the other way: "the largest now" is the right one from 8 mm on."""
    named = [vs.simulate(two().with_parameters(w=w)) for w in ("4 mm", "6 mm", "8 mm")]
    tips = [result.probes["tip"][0] for result in named]
    assert min(tips) > 0.0
    wide = vs.simulate(by_index().with_parameters(w="8 mm"))
    assert wide.probes["tip"][0] < 0.0
    grown = [result.metric("cavity_volume_change", cavity="left") for result in named]
    assert min(grown) > 10 * max(
        abs(result.metric("cavity_volume_change", cavity="right")) for result in named
    )


def test_names_stand_wherever_cavities_are_reported():
    result = vs.simulate(two(parameters={"w": "8 mm"}))
    right, left = result.summary()["cavities"]  # the largest first
    assert (right["name"], right["pressure"]) == ("right", 0.0)
    assert (left["name"], left["pressure"]) == ("left", 2000.0)
    assert result.chamber_volumes == {"left": left["volume"], "right": right["volume"]}
    report = vs.check(two(parameters={"w": "8 mm"}))
    assert [each["name"] for each in report.summary()["cavities"]] == ["right", "left"]


def test_by_region_and_by_formula():
    beside = {"x": ["-inf", 0]}
    assert indices(chambers={"left": beside}, parameters={"w": "8 mm"}) == {"left": 1}
    assert indices(parameters={"w": "8 mm"}) == {"right": 0, "left": 1}
    assert indices(parameters={"w": "4 mm"}) == {"left": 0, "right": 1}
    shape = {"left": {"shape": "left"}}
    assert indices(chambers=shape, parameters={"w": "8 mm"}) == {"left": 1}


LEFT = {"point": ["-5 mm", "5 mm", "10 mm"]}
FAR = r"in no cavity; the nearest is 12 mm away, around \(5 mm, 5 mm, 10 mm\)\. Try: move"
#: Chambers, the error, and its words.
NO_CHAMBERS = [
    ({"left": {"point": ["9 mm", "5 mm", "30 mm"]}}, NoCavityError, FAR),
    ({"left": {"point": [0, "5 mm", "10 mm"]}}, NoCavityError, "the nearest is 2 mm away"),
    ({"left": {"x": ["10 mm", "12 mm"]}}, NoCavityError, "no cavity; there are 2, around"),
    ({"left": {"z": [0, "20 mm"]}}, DesignError, "the region holds 2 cavities"),
    ({"left": LEFT, "again": LEFT}, DesignError, 'again: is the same cavity as "left"'),
]


@pytest.mark.parametrize(("chambers", "error", "words"), NO_CHAMBERS)
def test_a_place_that_is_no_chamber_of_its_own_is_refused(chambers, error, words):
    design = two(chambers=chambers)
    with pytest.raises(error, match=words):
        vs.simulate(design)
    assert not vs.check(design).valid


MISSPELLED = {"kind": "pressure", "value": "2 kPa", "cavity": "lefft"}
LOST = {"v": {"maximize": "cavity_volume", "cavity": "up"}}
#: Changes of the design, and the words that refuse them.
LOST_NAMES = [
    (
        {"loads": [MISSPELLED]},
        r'loads\[0\].cavity: there is no chamber "lefft".*did you mean "left"',
    ),
    ({"chambers": {}}, r"name it under \[chambers\] by its place"),
    ({"objectives": LOST}, "objectives.v.cavity: there is no chamber"),
    ({"chambers": {"all": {"point": [0, 0, 0]}}}, 'cannot be called "all"'),
    ({"chambers": {"left": {}}}, "chambers.left.*says nowhere"),
]


@pytest.mark.parametrize(("changes", "words"), LOST_NAMES)
def test_names_that_lead_nowhere_are_refused_as_they_are_read(changes, words):
    with pytest.raises(DesignError, match=words):
        two(**changes)


def test_an_index_of_chambers_that_are_alike_is_doubtful():
    twins = by_index()
    found = [each for each in vs.check(twins).findings if each.where == "loads[0].cavity"]
    assert [each.severity for each in found] == ["warning"]
    assert 'point = ["-5 mm", "5 mm", "10 mm"]' in found[0].hint
    assert found[0].at == pytest.approx((-5e-3, 5e-3, 10e-3))
    assert any("may mean another one" in each.what for each in vs.simulate(twins).warnings)
    for sure in (two(), by_index("all"), by_index().with_parameters(w="4 mm")):
        assert not any(each.where == "loads[0].cavity" for each in vs.check(sure).findings)


def test_twins_are_counted_by_place():
    """The first of equal volumes is that whose first voxel is first: lower x, then y, then z."""
    mesh = Setup.of(by_index()).mesh
    centers = [center_of(cavity, mesh) for cavity in mesh.cavities]
    assert mesh.cavities[0].volume == mesh.cavities[1].volume
    assert np.allclose(centers, [(-5e-3, 5e-3, 10e-3), (5e-3, 5e-3, 10e-3)])


def test_chambers_are_saved_and_written(tmp_path):
    design = two()
    design.save(tmp_path / "two.toml")
    assert vs.load(tmp_path / "two.toml") == design
    assert "[chambers.left]" in design.to_toml() or "[chambers]" in design.to_toml()
    outcome = CliRunner().invoke(
        app, ["run", str(tmp_path / "two.toml"), "--json", "--out", str(tmp_path / "run")]
    )
    assert outcome.exit_code == 0, outcome.stderr
    assert {each["name"] for each in json.loads(outcome.stdout)["cavities"]} == {"left", "right"}


def test_python_names_them_too():
    inner = vs.Box(size=(0.01, 0.01, 0.01), center=(0, 0, 0))
    body = vs.Box(size=(0.02, 0.02, 0.02), center=(0, 0, 0)) - inner
    design = vs.Design(
        name="cube",
        voxel_size=5e-3,
        parts=[vs.Part(shape=body, material=vs.NeoHookean(young=6e4))],
        clamps=[vs.Clamp(region=vs.Region(z=(-0.01, -0.01)))],
        chambers={"core": vs.Chamber(point=(0, 0, 0))},
        loads=[vs.Pressure(value=100.0, cavity="core")],
    )
    assert vs.simulate(design).chamber_volumes["core"] > 1e-6


@pytest.mark.slow
def test_a_study_says_that_an_index_has_switched(tmp_path):
    """The tip goes the other way from w = 8 mm on, because 0 means the other chamber there."""
    file = tmp_path / "two.toml"
    by_index().save(file)
    folder = ["--out", str(tmp_path / "sweep")]
    outcome = CliRunner().invoke(app, ["sweep", str(file), "--json", *folder])
    assert outcome.exit_code == 0, outcome.stderr
    (warning,) = json.loads(outcome.stdout)["warnings"]
    assert warning["where"] == "loads[0].cavity"
    assert "another cavity in 1 of 4 trials (3) than in trial 0" in warning["what"]
    shown = CliRunner().invoke(app, ["sweep", str(file), *folder])
    assert "another cavity in 1 of 4 trials" in " ".join(shown.stderr.split())


@pytest.mark.slow
def test_a_study_by_name_or_of_one_order_is_quiet(tmp_path):
    named = vs.Study(two(), folder=tmp_path / "named").grid(workers=1)
    assert (named.counts["ok"], named.warnings) == (4, ())
    tips = [trial.objectives["bend"] for trial in named.trials]
    assert min(tips) > 0.0
    narrow = {"w": ("2 mm", "4 mm", "2 mm")}
    assert vs.Study(by_index(), narrow, folder=tmp_path / "narrow").grid(workers=1).warnings == ()
