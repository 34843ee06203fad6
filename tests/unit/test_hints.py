"""Suggestions of errors: each works, and none repeats the word that was refused."""

from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design import AnyLoad, families
from voxsoft.materials.model import AnyMaterial
from voxsoft.records import closest
from voxsoft.simulation.simulator import Simulator


def problems_of(document):
    with pytest.raises(vs.VoxSoftError) as caught:
        vs.Design.from_document(document)
    return caught.value.problems


WORDS = st.text("abce", min_size=1, max_size=4)


@given(WORDS, st.lists(WORDS))
def test_a_wrong_name_is_never_suggested(name, known):
    assert f'"{name}"' not in closest(name, known)
    assert name not in closest(name, known).removeprefix("known are ").split(", ")


def fields_by(tag, union):
    """The fields of each record of a union, by its word for the tag."""
    records = get_args(get_args(union)[0])
    return {
        record.model_fields[tag].default: {
            info.alias or name for name, info in record.model_fields.items()
        }
        for record in records
    }


LOADS = fields_by("kind", AnyLoad)
MATERIALS = fields_by("model", AnyMaterial)


def cases():
    for place, kinds in (("loads", LOADS), ("material", MATERIALS)):
        for kind, own in kinds.items():
            yield from (
                (place, kind, own, field) for field in sorted(set().union(*kinds.values()) - own)
            )


@pytest.mark.parametrize(("place", "kind", "own", "field"), [*cases()])
def test_a_field_of_another_kind_is_answered_by_fields_of_this_one(place, kind, own, field):
    document = families.beam().document
    if place == "loads":
        document["loads"] = [{"kind": kind, field: 1}]
        where = f"loads[0].{field}"
    else:
        document["parts"][0]["material"] = {"model": kind, field: 1}
        where = f"parts[0].material.{field}"
    (hint,) = (each.hint for each in problems_of(document) if each.where == where)
    meant = hint.removeprefix("did you mean ").removeprefix("known are ").removesuffix("?")
    assert meant
    assert {name.strip('"') for name in meant.split(", ")} <= own


def test_a_body_by_name_without_bodies_learns_that_there_is_one():
    document = families.beam().document
    document["probes"]["tip"] = {"x": [0, "100 mm"], "body": "body"}
    (problem,) = problems_of(document)
    assert problem.where == "probes.tip.body"
    assert problem.hint == "leave it out: without [[bodies]] there is one body"
    del document["probes"]["tip"]["body"]
    assert vs.Design.from_document(document)


def test_new_takes_a_name_with_its_suffix(tmp_path):
    outcome = CliRunner().invoke(app, ["new", "q.toml", "--folder", str(tmp_path)])
    assert outcome.exit_code == 0
    assert [each.name for each in tmp_path.iterdir()] == ["q.toml"]


def test_an_invalid_design_has_no_mass(tmp_path):
    file = tmp_path / "loose.toml"
    families.beam().replace(clamps=[], loads=[vs.Gravity()]).save(file)
    report = vs.check(vs.files.load(file))
    assert not report.valid
    assert report.mass is None
    assert "mass" not in str(report)
    shown = CliRunner().invoke(app, ["check", str(file)]).output
    assert "vertices" in shown
    assert "mass" not in shown
    assert vs.check(families.beam()).mass > 0


def test_a_tendon_is_no_load_of_a_simulator():
    beam = families.beam().replace(
        loads=[],
        tendons=[{"name": "flexor", "through": [[0, 0.005, 0.005], [0.1, 0.005, 0.005]],
                  "tension": "0.1 N"}],
    )  # fmt: skip
    with pytest.raises(vs.VoxSoftError, match=r"flexor.*is a tendon.*history") as caught:
        Simulator(beam, time_step="20 ms").step({"flexor": "0.3 N"})
    assert "[[loads]]" not in str(caught.value)
