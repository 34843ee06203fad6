"""Designs: reading, formulas, references, identity."""

import copy
import json
import pickle

import jsonschema
import pytest

from voxsoft.design import (
    Clamp,
    Design,
    Gravity,
    Parameter,
    Part,
    Pressure,
    Probe,
    Region,
)
from voxsoft.errors import DesignError, FormulaError, UnitError
from voxsoft.shapes import Box, Function
from voxsoft.units import kPa, mm

CYLINDER = {
    "schema": "voxsoft/1",
    "name": "cylinder",
    "voxel_size": "5 mm",
    "parameters": {
        "radius": {"value": "25 mm", "min": "5 mm", "max": "25 mm", "step": "5 mm"},
        "height": {"value": "35 mm", "min": "5 mm", "max": "35 mm", "step": "5 mm"},
        "wall": {"value": "5 mm", "min": "5 mm", "max": "15 mm", "step": "5 mm"},
        "cap": "5 mm",
    },
    "shapes": {
        "outer": {"kind": "cylinder", "radius": "= radius", "height": "= height"},
        "cavity": {
            "kind": "cylinder",
            "radius": "= radius - wall",
            "height": "= height - 2*cap",
            "base": [0, 0, "= cap"],
        },
        "body": {"kind": "difference", "of": ["outer", "cavity"]},
    },
    "parts": [{"shape": "body", "material": "ecoflex-00-30"}],
    "clamps": [{"region": {"z": [0, 0]}}],
    "loads": [{"kind": "pressure", "value": "4 kPa"}],
    "probes": {"top": {"z": ["= height", "= height"]}},
    "objectives": {"rise": {"maximize": "displacement", "probe": "top", "axis": "z"}},
}


def changed(*path_and_value):
    """Return the cylinder's document with one entry changed."""
    *path, last, value = path_and_value
    document = copy.deepcopy(CYLINDER)
    here = document
    for step in path:
        here = here[step]
    here[last] = value
    return document


def problems(document, **overrides):
    with pytest.raises(DesignError) as caught:
        Design.from_document(document, overrides)
    return caught.value.problems


def beam(**entries):
    """Return a small design made in Python, with some entries replaced."""
    given = {
        "name": "beam",
        "voxel_size": 5 * mm,
        "shapes": {"body": Box(size=(100 * mm, 10 * mm, 10 * mm))},
        "parts": [Part(shape="body", material="ecoflex-00-30")],
        "clamps": [Clamp(region=Region(x=(0, 10 * mm)))],
        "loads": [Gravity(), Pressure(value=4 * kPa)],
        "probes": {"tip": Probe(point=(100 * mm, 5 * mm, 5 * mm))},
    }
    return Design(**{**given, **entries})


# --- values -------------------------------------------------------------------------------------


def test_formulas_become_values_in_si():
    design = Design.from_document(CYLINDER)
    assert design.shapes["cavity"].radius == pytest.approx(0.02, rel=1e-15)
    assert design.shapes["cavity"].base == (0.0, 0.0, 0.005)
    assert design.probes["top"].z == (0.035, 0.035)
    assert design.loads[0].value == 4000.0
    assert design.parameters["radius"].step == 0.005


def test_parameters_change_everything_that_uses_them():
    design = Design.from_document(CYLINDER).with_parameters(height=20 * mm, wall="10 mm")
    assert design.shapes["outer"].height == 0.02
    assert design.shapes["cavity"].radius == pytest.approx(0.015)
    assert design.probes["top"].z == (0.02, 0.02)
    assert design.parameters["wall"].value == 0.01


def test_parameters_may_depend_on_each_other():
    document = changed("parameters", "cap", {"value": "= wall/2", "max": "= wall"})
    design = Design.from_document(document, {"wall": "10 mm"})
    assert design.parameters["cap"].value == 0.005
    assert design.shapes["cavity"].base[2] == 0.005


def test_python_and_document_give_the_same_design():
    document = {
        "name": "beam",
        "voxel_size": "5 mm",
        "shapes": {"body": {"kind": "box", "size": ["100 mm", "10 mm", "10 mm"]}},
        "parts": [{"shape": "body", "material": "ecoflex-00-30"}],
        "clamps": [{"region": {"x": [0, "10 mm"]}}],
        "loads": [{"kind": "gravity"}, {"kind": "pressure", "value": "4 kPa"}],
        "probes": {"tip": {"point": ["100 mm", "5 mm", "5 mm"]}},
    }
    assert beam().hash == Design.from_document(document).hash


def test_python_takes_shapes_and_materials_without_names():
    part = Part(
        shape=Box(size=(1 * mm, 1 * mm, 1 * mm)),
        material={"model": "lattice", "edge": "60 kPa", "bulk": "400 kPa"},
    )
    design = beam(parts=[part], shapes={})
    assert design.material_of(design.parts[0]).edge == 60e3


def test_own_materials_come_before_cards():
    own = {"ecoflex-00-30": {"model": "lattice", "edge": "1 kPa", "bulk": "2 kPa"}}
    design = beam(materials=own)
    assert design.material_of(design.parts[0]).edge == 1e3


# --- what is wrong ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("document", "where", "words"),
    [
        (changed("voxel_size", 5), "voxel_size", "has no unit"),
        (changed("voxel_size", "5 kPa"), "voxel_size", "expected a length"),
        (changed("voxel_size", "0 mm"), "voxel_size", "not positive"),
        (changed("voxel_size", "= wal"), "voxel_size", '"wal" is not a parameter'),
        (changed("voxel_size", "= wall*wall"), "voxel_size", "gives an area"),
        (changed("voxl_size", "5 mm"), "voxl_size", "is not known here"),
        (changed("schema", "voxsoft/9"), "schema", "voxsoft/1"),
        (changed("parts", []), "parts", "expected at least 1"),
        (changed("parts", 0, "materal", "x"), "parts[0].materal", "is not known here"),
        (changed("parts", 0, "material", "ecoflex"), "parts[0].material", 'no material "ecoflex"'),
        (changed("parts", 0, "shape", "bod"), "parts[0].shape", 'no shape "bod"'),
        (changed("shapes", "body", "of", ["outer", "cave"]), "shapes.body.of[1]", "no shape"),
        (changed("shapes", "outer", "radius", "-5 mm"), "shapes.outer.radius", "not positive"),
        (changed("shapes", "outer", "kind", "tin"), "shapes.outer.kind", "is not known"),
        (changed("clamps", 0, "axes", "xx"), "clamps[0].axes", "does not name axes"),
        (changed("clamps", 0, "region", {}), "clamps[0].region", "says nowhere"),
        (changed("clamps", 0, "region", {"radius": "5 mm"}), "clamps[0].region", "both"),
        (changed("loads", 0, "kind", "presure"), "loads[0].kind", "is not known"),
        (changed("loads", 0, "cavity", -1), "loads[0].cavity", "greater than or equal to 0"),
        (
            changed("loads", 0, "history", {"time": [0], "factor": []}),
            "loads[0].history.factor",
            "at least 1",
        ),
        (changed("probes", "top", {"z": ["9 mm", "5 mm"]}), "probes.top.z", "above its end"),
        (changed("probes", "top", {"z": [0, 0], "point": [0, 0, 0]}), "probes.top", "both a point"),
        (changed("objectives", "rise", "probe", "tip"), "objectives.rise.probe", 'no probe "tip"'),
        (changed("objectives", "rise", "minimize", "mass"), "objectives.rise", "one of"),
        (changed("constraints", {"m": {"metric": "mass"}}), "constraints.m", "has no bound"),
        (changed("solver", {"substeps": 0}), "solver.substeps", "greater than or equal to 1"),
        (changed("solver", {"damping": "heavy"}), "solver.damping", "does not start with"),
        (changed("parameters", "two-caps", "9 mm"), "parameters.two-caps", "cannot be the name"),
        (changed("parameters", "min", "9 mm"), "parameters.min", "cannot be the name"),
        (changed("parameters", "cap", {"max": "9 mm"}), "parameters.cap", "has no value"),
        (changed("parameters", "wall", "value", 5), "parameters.wall", "5 has no unit"),
        (changed("parameters", "cap", True), "parameters.cap", "is not a quantity"),
        (changed("parameters", "radius", "step", "5 kPa"), "parameters.radius.step", "a length"),
        (changed("parameters", "radius", "step", "-5 mm"), "parameters.radius.step", "positive"),
        (changed("parameters", "radius", "min", "30 mm"), "parameters.radius.min", "above max"),
    ],
)
def test_each_mistake_is_named_with_its_place(document, where, words):
    found = problems(document)
    assert [p.where for p in found] == [where], found
    assert words in found[0].what


def test_suggestions_name_the_closest():
    assert problems(changed("parts", 0, "materal", "x"))[0].hint == 'did you mean "material"?'
    assert problems(changed("voxel_size", "= wal"))[0].hint == 'did you mean "wall"?'
    assert problems(changed("parts", 0, "material", "ecoflex-0030"))[0].hint == (
        'did you mean "ecoflex-00-30"?'
    )


def test_all_mistakes_are_listed_at_once():
    document = changed("parts", 0, "materal", "x")
    document["voxel_size"] = 5
    assert {p.where for p in problems(document)} == {"parts[0].materal", "voxel_size"}


def test_formula_mistakes_have_their_own_error_type():
    with pytest.raises(FormulaError, match="runs in a circle: cap → wall → cap"):
        Design.from_document(
            changed("parameters", {"cap": "= wall", "wall": "= cap", "radius": "5 mm"})
        )


def test_long_chains_of_parameters_are_refused():
    chain = {f"p{i}": f"= p{i + 1}" for i in range(150)} | {"p150": "5 mm"}
    found = problems(changed("parameters", {**CYLINDER["parameters"], **chain}))
    assert all("chains more than" in p.what for p in found)


def test_a_shape_made_of_itself_names_the_circle():
    document = changed("shapes", "outer", {"kind": "union", "of": ["body", "cavity"]})
    (found,) = problems(document)
    assert found.what == "is made of itself: outer → body → outer"


def test_values_outside_their_range_are_refused():
    design = Design.from_document(CYLINDER)
    with pytest.raises(DesignError, match="30 mm is above max, 25 mm"):
        design.with_parameters(radius=30 * mm)
    with pytest.raises(DesignError, match="1 mm is below min, 5 mm"):
        design.with_parameters(wall="1 mm")
    with pytest.raises(DesignError, match='did you mean "radius"'):
        design.with_parameters(radios=5 * mm)
    with pytest.raises(DesignError, match="expected a length"):
        design.with_parameters(radius="5 kPa")


def test_sums_of_floats_reach_the_end_of_a_range():
    parameter = Parameter(value=0.1 + 0.2, max=0.3, kind="length")
    assert parameter.value == pytest.approx(0.3)


def test_nesting_without_end_is_refused():
    deep = []
    for _ in range(200):
        deep = [deep]
    with pytest.raises(DesignError, match="nests deeper"):
        Design.from_document(changed("probes", {"top": {"z": deep}}))


def test_plain_si_numbers_need_a_kind_in_python():
    assert Parameter(value=0.025, min=0.005, kind="length").dimension.length == 1
    design = beam(
        parameters={"length": Parameter(value=0.1, kind="length")},
        shapes={"body": {"kind": "box", "size": ["= length", 0.01, 0.01]}},
    )
    assert design.with_parameters(length=0.05).shapes["body"].size == (0.05, 0.01, 0.01)
    with pytest.raises(DesignError, match="plain number; expected a length"):
        beam(parameters={"mu": 0.005}, voxel_size="= mu")


# --- what a subtraction leaves ------------------------------------------------------------------


@pytest.mark.parametrize(("radius", "height", "wall"), [(15, 35, 15), (25, 10, 5), (5, 5, 15)])
def test_a_cavity_without_size_leaves_the_body_whole(radius, height, wall):
    design = Design.from_document(
        CYLINDER, {"radius": radius * mm, "height": height * mm, "wall": wall * mm}
    )
    assert design.empty_shapes == ("cavity",)
    assert "cavity" not in design.shapes
    assert design.shapes["body"].of == ("outer",)
    assert Design.from_document(design.document).hash == design.hash
    assert design.with_parameters(radius="25 mm", height="35 mm", wall="5 mm").empty_shapes == ()


def test_the_whole_family_of_the_paper_is_valid():
    family = Design.from_document(CYLINDER)
    designs = [
        family.with_parameters(radius=r * 5 * mm, height=h * 5 * mm, wall=w * 5 * mm)
        for r in range(1, 6)
        for h in range(1, 8)
        for w in range(1, 4)
    ]
    with_cavity = [design for design in designs if not design.empty_shapes]
    # radius > wall in 9 of the 15 pairs, height > 2 caps in 5 of the 7 heights
    assert (len(designs), len(with_cavity)) == (105, 45)
    # Without a cavity the wall has no meaning: 5 radii of 2 heights, 3 radii of the other 5.
    assert len({design.hash for design in designs}) == 45 + 5 * 2 + 3 * 5


def test_an_empty_member_leaves_a_subtracted_union():
    document = changed("shapes", "body", "of", ["outer", "holes"])
    document["shapes"]["holes"] = {"kind": "union", "of": ["cavity", "slit"]}
    document["shapes"]["slit"] = {"kind": "box", "size": ["5 mm", "5 mm", "5 mm"]}
    design = Design.from_document(document, {"wall": "15 mm", "radius": "15 mm"})
    assert design.empty_shapes == ("cavity",)
    assert design.shapes["holes"].of == ("slit",)


def test_differences_of_differences_lose_their_empty_operands():
    document = changed("shapes", "final", {"kind": "difference", "of": ["body", "hole"]})
    document["shapes"]["hole"] = {"kind": "sphere", "radius": "= wall - wall"}
    design = Design.from_document(document, {"wall": "15 mm", "radius": "15 mm"})
    assert set(design.empty_shapes) == {"cavity", "hole"}
    assert set(design.shapes) == {"outer", "body", "final"}


def test_a_difference_of_itself_is_refused_if_the_rest_is_empty():
    document = changed("shapes", "body", "of", ["body", "cavity"])
    found = problems(document, wall="15 mm", radius="15 mm")
    assert found[0].what == "is made of itself: body → body"


def test_an_empty_shape_has_no_other_use():
    document = changed("clamps", 0, "region", {"shape": "cavity"})
    found = problems(document, wall="15 mm", radius="15 mm")
    assert found[0].what == 'the shape "cavity" is empty at these parameters'


def test_sizes_that_are_not_subtracted_or_not_formulas_stay_errors():
    found = problems(changed("shapes", "outer", "radius", "= radius - radius"))
    assert [p.where for p in found] == ["shapes.outer.radius"]
    found = problems(changed("shapes", "cavity", "radius", "0 mm"))
    assert [p.where for p in found] == ["shapes.cavity.radius"]


# --- identity and writing -----------------------------------------------------------------------


def test_the_hash_knows_physics_only():
    design = Design.from_document(CYLINDER)
    same = [
        changed("name", "other"),
        changed("description", "a note"),
        changed("objectives", {}),
        changed("parameters", "radius", "max", "50 mm"),
        changed("shapes", "outer", "radius", "2.5 cm"),
        changed("shapes", "outer", "radius", "= 5*(radius/5)"),
    ]
    other = [
        changed("voxel_size", "2.5 mm"),
        changed("loads", 0, "value", "4.000001 kPa"),
        changed("parts", 0, "material", "ecoflex-00-50"),
        changed("probes", {}),
    ]
    assert {Design.from_document(d).hash for d in same} == {design.hash}
    assert design.hash not in {Design.from_document({**d, "objectives": {}}).hash for d in other}


def test_documents_keep_formulas_and_resolved_ones_do_not():
    design = Design.from_document(CYLINDER)
    assert design.document == CYLINDER
    resolved = Design.from_document(design.resolved)
    assert resolved.hash == design.hash
    assert "=" not in json.dumps(design.resolved)


def test_a_design_made_in_python_writes_units_and_formulas():
    design = beam(
        parameters={"length": "100 mm"},
        shapes={"body": {"kind": "box", "size": ["= length", 0.01, "10 mm"]}},
    )
    document = design.document
    assert document["shapes"]["body"]["size"] == ["= length", "10 mm", "10 mm"]
    again = Design.from_document(document)
    assert again.hash == design.hash
    assert again.with_parameters(length="50 mm").shapes["body"].size[0] == 0.05


def test_a_python_function_works_until_it_would_have_to_be_written():
    ball = Function(function=lambda x, y, z: x - 1, low=(0, 0, 0), high=(1, 1, 1))
    design = beam(shapes={"body": ball}, parameters={"mu": "5 mm"}, voxel_size="= mu")
    assert design.with_parameters(mu="2 mm").voxel_size == 0.002
    for use in (lambda: design.hash, design.to_toml, lambda: design.document):
        with pytest.raises(DesignError, match="Python function"):
            use()
    assert "Function" in str(design)


def test_a_printed_design_is_its_file():
    assert str(Design.from_document(CYLINDER)).splitlines()[0] == 'schema = "voxsoft/1"'


def test_designs_travel_between_processes():
    design = Design.from_document(CYLINDER, {"wall": "10 mm"})
    again = pickle.loads(pickle.dumps(design))
    assert again == design
    assert again.hash == design.hash
    assert again.with_parameters(wall="5 mm").parameters["wall"].value == 0.005


def test_designs_are_immutable():
    with pytest.raises(ValueError, match="does not change"):
        Design.from_document(CYLINDER).name = "other"


FULL = {
    **CYLINDER,
    "parameters": {**CYLINDER["parameters"], "count": 3, "half": {"value": "= wall/2"}},
    "floor": {"z": "-1 mm"},
    "solver": {"damping": "critical", "substeps": "= count", "tolerance": 1e-4},
    "constraints": {"light": {"metric": "mass", "max": "30 g"}},
    "loads": [
        {"kind": "gravity", "history": {"time": ["0 s", "1 s"], "factor": [0, "= count"]}},
        {"kind": "traction", "region": {"shape": "outer"}, "value": [0, 0, "1 kPa"]},
    ],
    "materials": {"soft": {"model": "lattice", "edge": "1 kPa", "bulk": "= 2/count * 0"}},
}


def test_the_json_schema_agrees_with_the_model():
    schema = Design.json_schema()
    validator = jsonschema.Draft202012Validator(schema)
    for document in (CYLINDER, FULL, Design.from_document(CYLINDER).resolved):
        validator.validate(document)
    for wrong in (changed("parts", 0, "materal", "x"), changed("loads", 0, "kind", "pull")):
        assert not validator.is_valid(wrong)


def test_formulas_may_stand_for_whole_numbers():
    document = {**FULL, "materials": {}}
    assert Design.from_document(document).solver.substeps == 3
    document["solver"] = {"substeps": "= count/2"}
    assert problems(document)[0].what.endswith("expected a whole number")


def test_unit_errors_do_not_escape_as_pydantic_errors():
    with pytest.raises(DesignError) as caught:
        Region(x=("5", 0))
    assert not isinstance(caught.value, UnitError)
    assert caught.value.problems[0].where == "x[0]"


def test_any_value_can_be_changed():
    design = Design.from_document(CYLINDER).with_values("voxel_size=2.5 mm", "wall=10 mm")
    assert design.voxel_size == 0.0025
    assert design.parameters["wall"].value == 0.01
    with pytest.raises(DesignError, match="no material"):
        design.with_values("parts.0.material=steel")
