"""A replaced design or record has its stated values: for the solver, for studies, on disk."""

import copy
import pickle
import sys
from concurrent.futures import ThreadPoolExecutor

import forms
import pytest
from forms import all_models, has_formula

import voxsoft as vs
from voxsoft.design import Design, families
from voxsoft.errors import DesignError, VoxSoftError
from voxsoft.shapes import Function
from voxsoft.units import kPa, mm

MODELS = [model for model in all_models() if model not in (Design, Function)]


@pytest.mark.long
@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.__name__)
def test_replace_agrees_with_the_constructor(model, record_property):
    tables = [table for table in forms.records(model)[0] if not has_formula(table)]
    first = model(**tables[0])
    for table in tables[1:]:
        wanted = model(**table)
        changes = {name: getattr(wanted, name) for name in model.model_fields}
        assert first.replace(**changes) == wanted
        assert first.model_copy(update=changes) == wanted
        assert first.__replace__(**changes) == wanted
        assert wanted.replace() == wanted == copy.copy(wanted) == copy.deepcopy(wanted)
        assert hash(pickle.loads(pickle.dumps(wanted))) == hash(wanted)
    with pytest.raises(VoxSoftError, match="is not known here"):
        first.replace(no_such_entry=1)
    with pytest.raises(VoxSoftError):
        first.replace(**{next(iter(model.model_fields)): object()})
    record_property("forms", len(tables))


def pad(**entries):
    """A small pressurized pad, made in Python."""
    outer, inner = vs.Box((20 * mm, 20 * mm, 10 * mm)), vs.Box((10 * mm, 10 * mm, 5 * mm))
    given = {
        "name": "pad",
        "voxel_size": 2.5 * mm,
        "parameters": {"load": vs.Parameter(value="1 kPa", min="1 kPa", max="2 kPa")},
        "parts": [
            vs.Part(
                shape=outer - inner.translate((5 * mm, 5 * mm, 2.5 * mm)),
                material="ecoflex-00-30-lattice",
            )
        ],
        "clamps": [vs.Clamp(region=vs.Region(z=("-inf", 0)))],
        "loads": [{"kind": "pressure", "value": "= load"}],
        "probes": {"top": vs.Probe(z=(10 * mm, "inf"))},
        "objectives": {"rise": vs.Objective(maximize="displacement", probe="top", axis="z")},
    }
    return vs.Design(**{**given, **entries})


@pytest.fixture(params=["python", "file"])
def design(request, tmp_path):
    made = pad()
    if request.param == "python":
        return made
    made.save(tmp_path / "pad.toml")
    return vs.load(tmp_path / "pad.toml")


CHANGES = {
    "loads": {"loads": [vs.Pressure(value=3 * kPa)]},
    "parameters": {"parameters": {"load": "1.5 kPa"}},
    "fill": {"fill": "fraction", "voxel_size": "2.2 mm"},
    "clamps": {"clamps": [vs.Clamp(region=vs.Region(z=(0, 2.5 * mm)))]},
    "solver": {"solver": vs.Solver(method="statics", tolerance=1e-3)},
    "materials": {"materials": {"ecoflex-00-30-lattice": vs.Lattice(edge="48 kPa", bulk="60 kPa")}},
}


@pytest.mark.long
@pytest.mark.parametrize("changes", CHANGES.values(), ids=CHANGES)
def test_replace_is_seen_by_simulate_and_study_and_on_disk_alike(design, changes, tmp_path):
    changed = design.replace(**changes)
    expected = vs.simulate(changed).metrics["rise"]
    assert expected != vs.simulate(design).metrics["rise"]
    file = tmp_path / "changed.toml"
    changed.save(file)
    assert vs.load(file) == changed
    for same in (vs.load(file), changed.with_parameters(), changed.with_values("name=other")):
        assert vs.simulate(same).metrics["rise"] == expected
    with ThreadPoolExecutor(1) as threads:
        load = changed.parameters["load"].value
        bounds = {"load": (load, 1.9 * kPa, 1.9 * kPa - load)}
        study = vs.Study(changed, bounds, folder=tmp_path / "study")
        trial = study.grid(executor=threads).trials[0]
    assert trial.hash == changed.hash
    assert trial.objectives["rise"] == expected


def test_replace_keeps_formulas_elsewhere():
    cylinder = families.paper_cylinder()
    changed = cylinder.replace(loads=[vs.Pressure(value=1 * kPa)], voxel_size="2.5 mm")
    thick = changed.with_parameters(wall="10 mm")
    assert thick.shapes["cavity"].radius == pytest.approx(0.015)
    assert thick.loads[0].value == 1000.0
    assert thick.voxel_size == 0.0025
    assert "= radius - wall" in changed.to_toml()


def test_replace_of_parameters_evaluates_formulas_again():
    cylinder = families.paper_cylinder()
    larger = {**cylinder.parameters, "radius": vs.Parameter(value="30 mm")}
    changed = cylinder.replace(parameters=larger)
    assert changed.shapes["outer"].radius == 0.03
    assert changed.shapes["cavity"].radius == pytest.approx(0.025)


def test_replace_keeps_formulas_of_entries_that_are_handed_on():
    """Clamps of the family that stand among the new ones follow its parameters as before."""
    beam = families.beam()
    down = vs.Motion(displacement=(0, 0, "-1 mm"))
    press = vs.Clamp(region=vs.Region(x=(0.1, 0.1)), motion=down)
    changed = beam.replace(clamps=[*beam.clamps, press])
    assert "= clamped" in str(changed.document["clamps"][0])
    longer = changed.with_parameters(clamped="20 mm", length="90 mm")
    assert (
        longer.clamps[0].region.x[1] == beam.with_parameters(clamped="20 mm").clamps[0].region.x[1]
    )
    assert longer.clamps[1] == press
    part = changed.parts[0].replace(material="ecoflex-00-50")
    inline = changed.replace(parts=[part])
    assert inline.shapes == changed.shapes


def test_replace_of_an_empty_shape_family():
    """A design whose chamber has vanished is saved, copied and opened again with it."""
    solid = families.paper_cylinder(wall="15 mm", radius="15 mm")
    assert solid.empty_shapes == ("cavity",)
    renamed = solid.replace(name="solid", shapes=dict(solid.shapes))
    assert renamed.replace(voxel_size="5 mm") == renamed
    python = vs.Design(**solid.document)
    assert python.empty_shapes == ("cavity",)
    assert python == solid
    assert python.document["shapes"]["cavity"]["radius"] == "= radius - wall"
    opened = python.with_parameters(radius="25 mm", wall="5 mm")
    assert opened.shapes["cavity"].radius == pytest.approx(0.02)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"lodas": ()}, 'lodas: is not known here. Try: did you mean "loads"'),
        ({"loads": "abc"}, 'loads: "abc" came; expected a list'),
        ({"voxel_size": "2 kPa"}, "expected a length"),
        ({"voxel_size": -1}, "not positive"),
        ({"parts": ()}, "at least 1"),
        ({"probes": {}}, 'there is no probe "top"'),
    ],
)
def test_replace_is_checked(design, change, words):
    for way in (design.replace, lambda **update: design.model_copy(update=update)):
        with pytest.raises(DesignError, match=words):
            way(**change)
    if sys.version_info >= (3, 13):
        with pytest.raises(DesignError, match=words):
            copy.replace(design, **change)


def test_replace_is_the_only_way_to_change(design):
    with pytest.raises(DesignError, match=r"voxel_size: cannot be set.*design.replace") as caught:
        design.voxel_size = 3
    assert "pydantic" not in str(caught.value)
    for change in (
        lambda: design.parameters.update(load="2 kPa"),
        lambda: design.parameters.__setitem__("load", "2 kPa"),
        lambda: design.probes.pop("top"),
        lambda: design.shapes.clear(),
        lambda: design.materials.setdefault("x", 1),
    ):
        with pytest.raises(DesignError, match=r"cannot be set in place.*design.replace"):
            change()
    for way in ("copy", "construct", "model_construct"):
        with pytest.raises(TypeError, match="leave out the checks"):
            getattr(design, way)(name="x")
    with pytest.raises(TypeError, match="leave out the checks"):
        design.parts[0].copy(update={"material": 3})


def test_replace_ignores_later_changes_by_the_caller():
    parts = [{"shape": {"kind": "sphere", "radius": "= r"}, "material": "ecoflex-00-30"}]
    ball = vs.Design(name="ball", voxel_size=1e-3, parameters={"r": "5 mm"}, parts=parts)
    parts[0]["shape"]["radius"] = "1 mm"
    parts.clear()
    assert ball.with_parameters(r="6 mm").parts[0].shape.radius == 0.006
    ball.document["parts"].clear()
    assert ball.document["parts"]


def test_replace_by_keywords_of_with_values(design):
    assert design.with_values(voxel_size="5 mm", load=1.5 * kPa).loads[0].value == 1500.0
    both = design.with_values("parts[0].material=ecoflex-00-50", voxel_size=5 * mm)
    assert (both.voxel_size, both.parts[0].material) == (0.005, "ecoflex-00-50")
    with pytest.raises(DesignError, match='did you mean "voxel_size"'):
        design.with_values(voxl_size="5 mm")
