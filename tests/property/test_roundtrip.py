"""Every form of every field is saved, copied and replaced without change, and so is the run design.

The forms are read off the records (`tests/forms.py`), so a new field is tried without a line here:
some forms of each record in the quick tests, all of them in the slow ones.
"""

import copy
import csv
import json
import math
import pickle
from collections.abc import Mapping
from pathlib import Path

import forms
import pytest
from forms import NAMES, PARAMETERS, all_models, base, has_formula, models_in, records

import voxsoft as vs
from voxsoft.design import Design, families
from voxsoft.design.file_mesh import FileMesh
from voxsoft.errors import VoxSoftError
from voxsoft.files import load, save
from voxsoft.files.cards import load_card_file, save_card
from voxsoft.files.exports import export
from voxsoft.files.meshes import read_mesh_file
from voxsoft.files.run_folder import write_run
from voxsoft.materials import Card, Lattice
from voxsoft.shapes import Function, Shape, Sphere
from voxsoft.units import mm

#: Not in files: Python code.
PYTHON_ONLY = {Function}
# A body of a file needs the file: tests/unit/design/test_file_bodies.py saves and loads one.
MODELS = [
    model for model in all_models() if model not in PYTHON_ONLY and model not in (Card, FileMesh)
]
AT_ONCE = 120


def world(names=NAMES, **entries):
    """A design that holds whatever can be named, of every name, with some entries more."""
    given = {
        "name": "world",
        "voxel_size": "5 mm",
        "parameters": PARAMETERS,
        "shapes": {name: Sphere(radius=0.01) for name in names},
        "materials": {name: Lattice(edge="20 kPa", bulk="1 kPa") for name in names},
        "probes": {name: {"point": (0, 0, 0)} for name in names},
        "objects": [{"name": name, "shape": "plain"} for name in names],
        "chambers": {name: {"point": (0, 0, 0)} for name in names},
        "parts": [{"shape": "plain", "material": "plain"}],
        "objectives": {"least": {"minimize": "mass"}},
    }
    for key, value in entries.items():
        before = given.get(key)
        given[key] = {**before, **value} if isinstance(before, dict) else value
    if "bodies" in entries:  # they have the parts, and their names are not those of objects
        given |= {"parts": [], "objects": []}
    if len(names) == 1:  # one entry at a time: a small world does, and is quicker
        used = {name for name in PARAMETERS if name in str(entries)}
        given["parameters"] = {name: PARAMETERS[name] for name in used}
    return given


def placed(model, tables):
    """Ways to put tables of a model into a design: keys of one or more designs."""
    for name, info in Design.model_fields.items():
        if model in models_in(info.annotation):
            yield from _entries(name, info, tables)
    for parent in MODELS:
        # A shape in a shape is one of the forms of its operand.
        if parent is Design or issubclass(parent, Shape) or issubclass(model, Shape):
            continue
        for name, info in parent.model_fields.items():
            if model in models_in(info.annotation):
                many = "tuple" in str(info.annotation)[:20]
                beside = forms.BESIDE.get((parent, name), {})
                first = forms.FIRST.get((parent, name), ())
                inside = [
                    {
                        **base(parent),
                        **beside,
                        info.alias or name: [*first, table] if many else table,
                    }
                    for table in tables
                ]
                yield from placed(parent, [t for t in inside if forms.is_taken(parent, t)])


def _entries(name, info, tables):
    text = str(info.annotation)
    at_once = 1 if name == "symmetry" else AT_ONCE  # of planes there is one across each axis
    for start in range(0, len(tables), at_once):
        some = tables[start : start + at_once]
        if text.startswith("tuple"):
            yield {name: list(_of_own_names(some)) if name in ("objects", "bodies") else some}
        elif "Mapping" in text[:30]:
            yield {name: {f"e{index}": table for index, table in enumerate(some)}}
        else:
            yield from ({name: table} for table in some)


def _of_own_names(objects):
    """Give objects different names."""
    taken = set()
    for index, each in enumerate(objects):
        name = each["name"] if isinstance(each, dict) else each.name
        if name in taken:
            name = f"o{index}"
            each = {**each, "name": name} if isinstance(each, dict) else each.replace(name=name)
        taken.add(name)
        yield each


def designs_of(model):
    """Designs that hold all forms of a model: typed as tables, and as records where they can be."""
    if model is Design:
        found, barren = design_forms()
    else:
        tables, barren = records(model)
        made = [model(**table) for table in tables if not has_formula(table)]
        found = [*placed(model, tables)]
        for name, info in Design.model_fields.items():
            if model in models_in(info.annotation):
                found += _entries(name, info, made)
    assert not barren, f"no form of {barren} of {model.__name__} is taken: see tests/forms.py"
    for entries in found:
        # One entry at a time needs no shape of every name.
        many = any(map(is_many, entries.values()))
        yield world(**entries) if many else world(["plain"], **entries)


def design_forms():
    """Forms of a design's own plain entries, and of the empty tables."""
    found, barren = [], []
    for name, info in Design.model_fields.items():
        if models_in(info.annotation) or name == "schema_":
            continue
        given = [{name: form} for form in forms.forms_of(Design, name)]
        taken = [entries for entries in given if _is_design(world(["plain"], **entries))]
        found += taken
        barren += [] if len(taken) == len(given) else [name]
    return [*found, {"schema": "voxsoft/1"}, {"schema_": "voxsoft/1"}, {"objectives": {}}], barren


def _is_design(given):
    try:
        Design(**given)
    except VoxSoftError:
        return False
    return True


def is_many(value):
    return isinstance(value, list) or (isinstance(value, dict) and "e0" in value)


def check(design, folder, many):
    """The laws: whatever is done to a design but to change it, it stays the same."""
    file = Path(folder, "design.toml")
    save(design, file)
    again = load(file)
    assert_same(again, design)
    assert again.document == design.document
    assert again.hash == design.hash
    json.dumps([design.document, design.resolved], allow_nan=False)  # as a study stores it
    assert hash(again) == hash(design)
    assert_same(pickle.loads(pickle.dumps(design)), design)
    assert_same(design.with_parameters(), design)
    if not many:
        return
    for other in (copy.copy(design), copy.deepcopy(design), design.replace()):
        assert_same(other, design)
    resolved = Path(folder, "resolved.toml")
    save(design, resolved, resolved=True)
    assert load(resolved).hash == design.hash


def assert_same(other, design):
    for name in Design.model_fields:
        left, right = getattr(other, name), getattr(design, name)
        if isinstance(right, Mapping):
            assert {k: v for k, v in left.items() if v != right.get(k)} == {}, name
            assert left.keys() == right.keys(), name
        assert left == right, name
    assert other == design


def count_of(given):
    """Number of forms that a design was typed with, beside those of every world."""
    many = [value for value in given.values() if is_many(value) and len(value) > 1]
    return (
        sum(len([k for k in v if k not in NAMES]) if isinstance(v, dict) else len(v) for v in many)
        or 1
    )


def roundtrip(model, folder, most=None):
    """Try a model's designs, or so many of them from the first to the last; how many forms."""
    designs, tried = list(designs_of(model)), 0
    for given in designs[:: 1 if most is None else math.ceil(len(designs) / most)]:
        check(Design(**given), folder, any(map(is_many, given.values())))
        tried += count_of(given)
    assert tried
    return tried


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.__name__)
def test_roundtrip_of_some_forms(model, tmp_path, monkeypatch, record_property):
    monkeypatch.chdir(tmp_path)
    record_property("forms", roundtrip(model, tmp_path, most=2))


@pytest.mark.slow
@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.__name__)
def test_roundtrip_of_every_form(model, tmp_path, monkeypatch, record_property):
    monkeypatch.chdir(tmp_path)
    record_property("forms", roundtrip(model, tmp_path))


def test_roundtrip_of_places_of_bodies(tmp_path, record_property):
    """Bodies of every name, and all that may be of one: parts, regions, points, contact."""
    shape, names = Sphere(radius=0.01), [name for name in NAMES if name not in ("body", "floor")]
    at = {"point": (0, 0, 0)}
    design = Design(
        **world(
            bodies=[{"name": name, "position": (i, 0, 0)} for i, name in enumerate(names)],
            clamps=[{"region": {"body": name}} for name in names],
            layers=[
                {"region": {"body": n, "z": (0, 0)}, "young": 1e6, "thickness": 1e-4} for n in names
            ],
            loads=[{"kind": "force", "region": {"body": n}, "value": (1, 0, 0)} for n in names],
            probes={name: {"body": name, **at} for name in names},
            chambers={name: {"body": name, **at} for name in names},
            contact={"pairs": [{"of": [name, names[0]], "kind": "none"} for name in names]},
        )
        | {"parts": [{"shape": shape, "material": "plain", "body": name} for name in names]}
    )
    check(design, tmp_path, many=True)
    record_property("forms", len(names))


def test_roundtrip_of_every_form_of_a_card(tmp_path, record_property):
    tables, barren = records(Card)
    assert not barren
    cards = [Card(**table) for table in tables if not has_formula(table)]
    for card in cards:
        save_card(card, tmp_path / "card.toml")
        assert load_card_file(tmp_path / "card.toml") == card
        again = pickle.loads(pickle.dumps(card))
        assert again == card
        assert hash(again) == hash(card)
    record_property("forms", len(cards))


def test_roundtrip_of_names_through_a_run(tmp_path, record_property):
    """Whatever `check` takes as the name of a probe, every file of the run takes too."""
    beam = families.beam(length="40 mm").with_values("voxel_size=5 mm", objectives={})
    probes = {name: vs.Probe(point=(40 * mm, 5 * mm, 5 * mm)) for name in NAMES}
    named = beam.replace(probes=probes, name=NAMES[1])
    assert vs.check(named).valid
    folder = write_run(vs.simulate(named, end_time=0.04), tmp_path / "run")
    wanted = {f"probe_{name}" for name in NAMES}
    for suffix in (".vtu", ".inp", ".msh", ".csv"):
        export(folder, tmp_path / f"out{suffix}")
        if suffix != ".csv":
            assert wanted <= read_mesh_file(tmp_path / f"out{suffix}").regions.keys()
    rows = list(csv.reader((tmp_path / "out.csv").read_text(encoding="utf-8").splitlines()))
    assert [row[0] for row in rows[1:]] == list(NAMES)
    with (folder / "history.csv").open(encoding="utf-8", newline="") as file:
        head = next(csv.reader(file))
    assert head[1::3] == [f"{name}_dx_m" for name in NAMES]
    assert load(folder / "design.toml").hash == named.hash
    record_property("forms", len(NAMES))


@pytest.mark.parametrize("letter", ["\0", "\n", "\x1b", "\x7f", "\x85", "\u2028", "\ufffe"])
def test_roundtrip_of_a_name_that_no_file_holds_is_not_begun(letter):
    for entries in (
        {"name": f"a{letter}b"},
        {"probes": {f"a{letter}b": {"point": (0, 0, 0)}}},
        {"shapes": {f"a{letter}": Sphere(radius=0.01)}},
        {"parts": [{"shape": "plain", "material": "plain", "name": letter}]},
    ):
        with pytest.raises(VoxSoftError, match="holds a control character"):
            Design(**world(**entries))
