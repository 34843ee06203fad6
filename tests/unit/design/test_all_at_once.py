"""All that is wrong with a design is told at once, whatever kinds of mistakes come together."""

import copy
import itertools

import pytest

from voxsoft.design import Design
from voxsoft.errors import DesignError, FormulaError
from voxsoft.files import load

SOUND = {
    "name": "pad",
    "voxel_size": "2 mm",
    "parameters": {"wall": "5 mm", "cap": {"value": "= wall/2"}},
    "shapes": {
        "outer": {"kind": "box", "size": ["20 mm", "20 mm", "= 4*wall"]},
        "hole": {"kind": "sphere", "radius": "= wall - cap"},
        "body": {"kind": "difference", "of": ["outer", "hole"]},
    },
    "parts": [{"shape": "body", "material": "ecoflex-00-30"}],
    "clamps": [{"region": {"z": [0, 0]}}],
    "loads": [{"kind": "pressure", "value": "4 kPa"}],
    "probes": {"top": {"z": ["9 mm", "inf"]}},
    "objectives": {"rise": {"maximize": "displacement", "probe": "top"}},
}

#: A mistake of each sort: its place, its text, and the place of the message.
MISTAKES = {
    "unit": (("voxel_size",), 5, "voxel_size"),
    "formula": (("loads", 0, "value"), "= presure", "loads[0].value"),
    "formula of a parameter": (("parameters", "cap", "value"), "= wal", "parameters.cap.value"),
    "parameter without a unit": (
        ("parameters", "q"),
        {"value": 5, "min": "1 mm"},
        "parameters.q.value",
    ),
    "kind": (("shapes", "outer", "kind"), "bocks", "shapes.outer.kind"),
    "formula in a shape": (("shapes", "outer", "size", 1), "= x", "shapes.outer.size[1]"),
    "shape": (("shapes", "body", "of", 1), "hol", "shapes.body.of[1]"),
    "circle": (("shapes", "ring"), {"kind": "union", "of": ["ring"]}, "shapes.ring"),
    "material": (("parts", 0, "material"), "ecoflex", "parts[0].material"),
    "card": (("parts", 0, "material"), "none.toml", "parts[0].material"),
    "probe": (("objectives", "rise", "probe"), "tip", "objectives.rise.probe"),
    "key": (("clamps", 0, "axis"), "x", "clamps[0].axis"),
    "number": (("loads", 0, "cavity"), -1, "loads[0].cavity"),
    "range": (("clamps", 0, "region", "z"), ["9 mm", "5 mm"], "clamps[0].region.z"),
    "schema": (("schema",), "voxsoft/9", "schema"),
}


def with_mistakes(*names):
    document = copy.deepcopy(SOUND)
    for name in names:
        (*way, last), value, _ = MISTAKES[name]
        here = document
        for step in way:
            here = here[step]
        here[last] = value
    return document


def reported(document):
    with pytest.raises(DesignError) as caught:
        Design.from_document(document)
    return [problem.where for problem in caught.value.problems]


def test_the_sound_design_is_sound():
    assert Design.from_document(SOUND).name == "pad"


@pytest.mark.parametrize("pair", [*itertools.combinations(MISTAKES, 2)], ids=" and ".join)
def test_two_mistakes_are_reported_together(pair):
    places = {MISTAKES[name][2] for name in pair}
    found = reported(with_mistakes(*pair))
    assert set(found) == places
    assert len(found) == len(places)


def test_all_mistakes_are_reported_together():
    assert set(reported(with_mistakes(*MISTAKES))) == {where for *_, where in MISTAKES.values()}


def test_formulas_alone_keep_their_type():
    with pytest.raises(FormulaError):
        Design.from_document(with_mistakes("formula", "formula of a parameter"))


def test_a_file_tells_them_in_the_order_of_its_lines(tmp_path):
    (tmp_path / "bad.toml").write_text(
        'name = "bad"\nvoxel_size = 5\n[parameters]\nwall = "= wal"\n'
        '[shapes]\nbody = { kind = "ball" }\n[[parts]]\nshape = "bode"\nmaterial = "soft"\n'
    )
    with pytest.raises(DesignError) as caught:
        load(tmp_path / "bad.toml")
    lines = [problem.where.split(", ")[1] for problem in caught.value.problems]
    assert lines == ["line 2", "line 4", "line 6", "line 8", "line 9"]
