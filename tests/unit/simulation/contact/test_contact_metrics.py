"""Metrics of contact: pairs and forces, in results, studies and files."""

import json

import numpy as np
import pytest
from pressed import BLOCK, PLATE, POST, RUBBER, SIDE, pressed, slit
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design import Contact, Object
from voxsoft.errors import DesignError
from voxsoft.files import load, save
from voxsoft.metrics import METRICS
from voxsoft.simulation import check, simulate
from voxsoft.units import mm

ASKED = {
    "push": {"maximize": "contact_force", "object": "plate", "axis": "z"},
    "grip": {"maximize": "sticking", "object": "plate"},
}


@pytest.fixture(scope="module")
def result():
    limits = {"touch": {"metric": "contact_area", "object": "plate", "min": "100 mm^2"}}
    design = pressed(
        objects=[PLATE, POST], objectives=ASKED, constraints=limits, contact=Contact(friction=5.0)
    )
    return simulate(design)


def test_a_result_measures_contacts(result):
    (contact,) = result.contacts
    assert result.metric("contact_force", object="plate", axis="z") == contact.force[2] < 0.0
    assert result.metric("contact_force", object="plate") == pytest.approx(
        np.linalg.norm(contact.force)
    )
    assert result.metric("contact_area", object="plate") == pytest.approx(SIDE**2, rel=1e-9)
    assert result.metric("contact_gap", object="plate") == contact.gap
    assert result.metric("sticking", object="plate") == 1.0 - contact.slipping > 0.95
    summary = result.summary()["metrics"]
    assert summary["push"] == contact.force[2]
    assert summary["touch"] == contact.area
    # Metrics that need an object are in no list that nobody asked for.
    assert not {"contact_force", "contact_area", "contact_gap", "sticking"} & summary.keys()


def test_separate_surfaces_have_no_force_but_a_distance(result):
    for name in ("contact_force", "contact_area", "sticking"):
        assert result.metric(name, object="post") == 0.0
    # Its face is at x = -5 mm, traced to a thousandth of a voxel, and the block bulges toward it.
    bulge = -result.positions[:, 0].min()
    assert bulge > 0.1 * mm
    gap = result.metric("contact_gap", object="post")
    assert gap == pytest.approx(5 * mm - bulge, abs=4e-3 * 1 * mm)


def test_a_distance_follows_an_object_that_turns():
    """A bar beside the block that turns by a quarter, so that its end comes near."""
    bar = vs.Box(size=(2 * mm, 12 * mm, 4 * mm), center=(22 * mm, 6 * mm, 6 * mm))
    turn = vs.design.Rotation(axis=(0, 0, 1), angle="90 deg", center=(22 * mm, 6 * mm, 6 * mm))
    free = {"friction": 0.0, "pairs": [{"of": ["body", "bar"], "kind": "none"}]}
    bar = Object(name="bar", shape=bar, motion=vs.Motion(rotation=turn), voxel_size=1 * mm)
    found = simulate(pressed(objects=[bar], contact=free))
    assert found.metric("contact_gap") == pytest.approx(4 * mm, abs=0.02 * mm)


def test_a_body_presses_itself():
    found = simulate(slit(contact=Contact()))
    (contact,) = found.contacts
    assert found.metric("contact_force") == contact.pressed > 0.0
    assert found.metric("contact_force", object="body") == contact.pressed
    assert found.metric("contact_area", object="body") == contact.area > 0.0
    with pytest.raises(DesignError, match="axis: the forces of a body on itself cancel"):
        found.metric("contact_force", object="body", axis="z")
    with pytest.raises(DesignError, match="object: a body has no gap to itself"):
        found.metric("contact_gap")


@pytest.mark.parametrize(
    ("objects", "objective", "message"),
    [
        ([PLATE, POST], {"minimize": "contact_area"}, "object: is missing.*name plate, post, body"),
        ([PLATE], {"minimize": "contact_gap", "object": "body"}, "object: a body has no gap"),
        ([], {"minimize": "contact_area"}, r"object: nothing touches.*\[\[objects\]\]"),
        ([PLATE], {"minimize": "mass", "object": "plate"}, "object: mass is not measured between"),
        ([PLATE], {"minimize": "sticking", "axis": "z"}, "axis: sticking has no direction"),
    ],
)
def test_check_refuses_problems_without_an_answer_with_their_place(objects, objective, message):
    found = check(pressed(objects=objects, objectives={"aim": objective}))
    assert not found.valid
    with pytest.raises(DesignError, match=f"objectives.aim.{message}"):
        simulate(pressed(objects=objects, objectives={"aim": objective}))


@pytest.mark.parametrize("table", ["objectives", "constraints"])
def test_an_object_that_is_not_there_is_refused_with_the_closest_name(table, result):
    target = {"metric": "contact_area", "max": "100 mm^2"}
    target = target if table == "constraints" else {"minimize": "contact_area"}
    with pytest.raises(DesignError, match=rf'{table}.aim.object: .*"plat".*did you mean "plate"'):
        pressed(**{table: {"aim": {**target, "object": "plat"}}})
    with pytest.raises(DesignError, match=r'object: there is no object "pots".*"post"'):
        result.metric("contact_gap", object="pots")
    with pytest.raises(DesignError, match=r'object: there is no object "pots".*"post"'):
        result.gap_to("pots")


def test_a_metric_of_a_users_may_ask_for_an_object(result):
    @vs.metric(name="pressure_of_test", kind="pressure", needs={"object"})
    def mean_pressure(state, target):
        found = next(each for each in state.contacts if target.object in each.of)
        return found.pressed / found.area

    assert METRICS["pressure_of_test"].needs == {"object"}
    (contact,) = result.contacts
    value = result.metric("pressure_of_test", object="plate")
    assert value == pytest.approx(contact.pressed / SIDE**2)
    with pytest.raises(DesignError, match="object: is missing"):
        result.metric("pressure_of_test")


def test_the_command_line_prints_them(result, tmp_path):
    file = tmp_path / "pressed.toml"
    save(result.design, file)
    assert load(file) == result.design
    ran = CliRunner().invoke(app, ["run", str(file), "--json", "--error", "off"])
    shown = json.loads(ran.stdout)["metrics"]
    assert shown["push"] == pytest.approx(result.metrics["push"], rel=1e-6)
    assert shown["grip"] == pytest.approx(result.metrics["grip"], abs=1e-6)


@pytest.mark.slow
def test_a_study_strives_for_them(tmp_path):
    design = vs.Design(
        name="press",
        voxel_size=6 * mm,
        parameters={"depth": {"value": "1 mm", "min": "0.5 mm", "max": "1.5 mm"}},
        parts=[vs.Part(shape=BLOCK, material=RUBBER)],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        objects=[{**PLATE.model_dump(), "motion": {"displacement": [0, 0, "= -depth"]}}],
        objectives={"push": {"maximize": "contact_force", "object": "plate"}},
    )
    study = vs.Study(design, {"depth": ["0.75 mm", "1.5 mm"]}, folder=tmp_path)
    light, heavy = (trial.objectives["push"] for trial in study.grid(workers=1).trials)
    assert 0.0 < light < heavy
