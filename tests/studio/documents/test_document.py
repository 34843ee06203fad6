"""The design document: text, form, undo, and where errors stand."""

import tomllib
from pathlib import Path

import pytest

from voxsoft.design import families
from voxsoft.errors import DesignError, FileError
from voxsoft.files.toml_edits import with_swapped, with_value
from voxsoft.studio.documents.document import MOST_DOCUMENTS, DesignDocument
from voxsoft.studio.documents.opening import template_document
from voxsoft.studio.documents.positions import span_of

CYLINDER = (Path(__file__).parents[3] / "examples" / "cylinder.toml").read_text()


def document(text=CYLINDER):
    return DesignDocument(text, "cylinder.toml")


def marked(text, found):
    return text.splitlines()[found.line - 1][found.column - 1 : found.end_column - 1]


@pytest.mark.parametrize(
    ("old", "new", "reported", "under"),
    [
        ('value = "25 mm"', 'value = "40 mm"', "above max", '"40 mm"'),
        ('voxel_size = "5 mm"', "voxel_size = 5", "has no unit", "5"),
        ('"= radius - wall"', '"= radius - wal"', "wal", '"= radius - wal"'),
        ('material = "ecoflex-00-30-lattice"', 'material = "ecoflx"', "ecoflx", '"ecoflx"'),
        ('kind = "pressure"', 'kind = "presure"', "presure", '"presure"'),
        ("region = { z = [0, 0] }", "region = { z = [0, 5] }", "5 has no unit", "5"),
        ('axis = "z" }', 'axis = "w" }', '"w" came', '"w"'),
        ('name = "cylinder"', 'name = "cylinder', "is not TOML", None),
    ],
)
def test_an_error_underlines_the_fault(old, new, reported, under):
    text = CYLINDER.replace(old, new, 1)
    assert text != CYLINDER
    broken = document(text)
    assert not broken.valid
    found = broken.diagnostics[0]
    assert reported in f"{found.what} {found.hint}"
    line = text.splitlines()[found.line - 1]
    assert (new.splitlines()[0] in line) or under in line
    if under is not None:
        assert marked(text, found) == under


@pytest.mark.parametrize(
    ("text", "there"),
    [
        ("a = 1\n\n[[b]]\nx = 1\n", "x = 1\n\n[[b]]\nx = 9\n"),
        ("[[b]]\nx = 1\n\n[c]\ny = 1\n", "x = 1\n\n[[b]]\nx = 9\n\n[c]\n"),
        ("[[b]]\nx = 1\n[[b]]\nx = 2\n", "x = 2\n[[b]]\nx = 9\n"),
    ],
)
def test_a_section_that_is_added_stands_apart_as_the_others_do(text, there):
    assert there in with_value(text, ["b", text.count("[[b]]")], {"x": 9})


def test_text_of_a_form_is_laid_out_as_that_of_templates():
    text = with_value('name = "robot"\n', ["shapes", "body"], {"kind": "box", "hole": {}})
    text = with_value(text, ["parts", 0], {"shape": "body"})
    text = with_value(text, ["loads"], [{"kind": "gravity"}])
    assert text == (
        'name = "robot"\n\n[shapes]\nbody = { kind = "box", hole = {} }\n\n'
        '[[parts]]\nshape = "body"\n\n[[loads]]\nkind = "gravity"\n'
    )


def test_the_last_good_design_stays():
    edited = document()
    good = edited.design
    edited.replace("a = [")
    assert not edited.valid
    assert edited.design is good
    assert edited.event().parameters[0].name == "radius"


def test_a_slider_changes_one_value_and_keeps_the_comments():
    edited = document()
    edited.edit(["parameters", "radius", "value"], "20 mm")
    assert edited.text == CYLINDER.replace('value = "25 mm"', 'value = "20 mm"', 1)
    assert edited.design.parameters["radius"].value == pytest.approx(0.02)


def test_a_parameter_tells_its_value_at_opening_or_at_the_last_saving(tmp_path):
    edited = document()
    former = lambda: edited.event().parameters[0].former  # noqa: E731
    edited.edit(["parameters", "radius", "value"], "20 mm")
    assert former() == pytest.approx(0.025)
    edited.replace("a = [")
    edited.undo()
    assert former() == pytest.approx(0.025)
    edited.save(tmp_path / "cylinder.toml")
    assert former() == pytest.approx(0.02)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (["loads", 1], {"kind": "gravity"}),
        (["loads", 0], None),
        (["clamps", 0], None),
        (["parts", 0, "material"], {"model": "lattice", "edge": "20 kPa", "bulk": "100 kPa"}),
        (["solver", "method"], "statics"),
        (["shapes", "ball"], {"kind": "sphere", "radius": "5 mm"}),
        (["shapes", "cavity", "base", 1], "1 mm"),
        (["constraints"], {"light": {"metric": "mass", "max": "30 g"}}),
        (["parameters", "cap"], "4 mm"),
        (["description"], 'says "hello"\nand more'),
    ],
)
def test_an_edit_in_toml_agrees_with_its_data(path, value):
    due = tomllib.loads(CYLINDER)
    here = due
    for step in path[:-1]:
        here = here.setdefault(step, {}) if isinstance(step, str) else here[step]
    if value is None:
        del here[path[-1]]
    elif isinstance(here, list) and path[-1] == len(here):
        here.append(value)
    else:
        here[path[-1]] = value
    found = tomllib.loads(with_value(CYLINDER, path, value))
    assert {k: v for k, v in found.items() if v != []} == {k: v for k, v in due.items() if v != []}


LISTS = """\
of = [
  "rod",   # first
  "ball",  # second
]

# pushes
[[loads]]
kind = "pressure"  # of air
value = "4 kPa"

[solver]
method = "statics"

# pulls
[[loads]]
kind = "gravity"
"""


@pytest.mark.parametrize("path", [["of"], ["loads"]])
def test_two_entries_of_a_list_are_exchanged_with_their_comments(path):
    due = tomllib.loads(LISTS)
    due[path[0]].reverse()
    text = with_swapped(LISTS, path, 0, 1)
    assert tomllib.loads(text) == due
    for comment in ("# first", "# second", "# pushes", "# of air", "# pulls"):
        assert comment in text
    assert tomllib.loads(with_swapped(text, path, 1, 0)) == tomllib.loads(LISTS)


@pytest.mark.parametrize(
    ("path", "second"),
    [(["of"], 2), (["of"], -1), (["solver"], 0), (["nothing"], 1), (["of", 0], 1)],
)
def test_no_two_entries_are_not_exchanged(path, second):
    with pytest.raises(DesignError, match="cannot be reordered"):
        with_swapped(LISTS, path, 0, second)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (["voxel_size", "inner"], 1),
        (["parts", 9, "material"], "a"),
        (["parts", "first"], "a"),
        (["nothing", "there"], None),
        (["name"], object()),
    ],
)
def test_an_edit_that_leads_nowhere_is_reported_and_changes_nothing(path, value):
    edited = document()
    with pytest.raises(DesignError, match="cannot be set"):
        edited.edit(path, value)
    assert edited.text == CYLINDER


def test_undo_takes_back_a_drag_of_a_slider_as_one():
    edited = document()
    for step in range(20, 25):
        edited.edit(["parameters", "radius", "value"], f"{step} mm", now=0.1 * step)
    edited.edit(["voxel_size"], "2.5 mm", now=3.0)
    assert edited.undo()
    assert edited.text == CYLINDER.replace('value = "25 mm"', 'value = "24 mm"', 1)
    assert edited.undo()
    assert edited.text == CYLINDER
    assert not edited.undo()
    assert edited.redo()
    assert edited.redo()
    assert not edited.redo()
    assert '"2.5 mm"' in edited.text


def test_values_typed_quickly_into_one_field_are_changes_of_their_own():
    edited = document()
    for step in (20, 21, 22):
        edited.edit(["parameters", "radius", "value"], f"{step} mm", stroke=step, now=0.1 * step)
    for value in ("22", "21", "20", "25"):
        assert f'value = "{value} mm", min' in edited.text
        edited.undo()
    assert edited.text == CYLINDER


def test_a_slider_that_was_dragged_back_leaves_nothing_to_undo():
    edited = document()
    edited.edit(["voxel_size"], "2.5 mm", now=0.0)
    fine = edited.text
    for step, size in enumerate(("20 mm", "25 mm", "22 mm", "21 mm")):
        edited.edit(["parameters", "radius", "value"], size, now=2.0 + 0.1 * step)
    assert edited.undo()
    assert edited.text == fine
    for step, size in enumerate(("20 mm", "25 mm")):
        edited.edit(["parameters", "radius", "value"], size, now=4.0 + 0.1 * step)
    assert edited.undo()
    assert edited.text == CYLINDER


def test_unsaved_documents_are_offered_newest_first():
    first, clean, second, third = (document(f"{CYLINDER}# {i}") for i in range(4))
    clean.saved = clean.text
    for later, earlier in ((clean, first), (second, clean), (third, second)):
        later.follow(earlier)
    assert third.rev > second.rev > clean.rev > first.rev
    assert (third.before, second.before, first.before) == (second, first, None)
    assert first.after is second
    assert (third.event().can_undo, third.event().before) == (False, "cylinder.toml")
    first.replace(CYLINDER)
    assert first.after is second


def test_only_so_many_documents_are_kept_open():
    newest = document("a = 0")
    for number in range(MOST_DOCUMENTS + 5):
        following = document(f"a = {number + 1}")
        following.follow(newest)
        newest = following
    kept = 0
    while newest.before is not None:
        newest, kept = newest.before, kept + 1
    assert kept == MOST_DOCUMENTS


def test_saving_needs_a_name_of_a_design_file(tmp_path):
    edited = document()
    with pytest.raises(FileError, match="no file yet"):
        edited.save()
    with pytest.raises(FileError, match="no name of a design file"):
        edited.save(tmp_path / "profile")
    edited.save(tmp_path / "arm.toml")
    assert not edited.dirty
    edited.edit(["voxel_size"], "2.5 mm")
    assert edited.dirty
    edited.save()
    assert "2.5 mm" in (tmp_path / "arm.toml").read_text()


@pytest.mark.parametrize("name", families.FAMILIES)
def test_every_template_is_a_good_document(name):
    opened = document(families.family_text(name))
    assert opened.valid
    event = opened.event()
    assert all(
        p.value / p.factor == pytest.approx(_number(p.text))
        for p in event.parameters
        if not p.formula
    )


def _number(text):
    return float(text.partition(" ")[0])


def test_a_place_that_is_not_in_the_text_is_its_first_line():
    assert span_of("a = 1\nb = 2", ["c", "d"]).line == 1
    assert span_of("", ["c"]).line == 1


def test_a_relative_mesh_is_looked_for_beside_the_file(tmp_path):
    text = families.family_text("paper-beam").replace(
        "[shapes]", '[shapes]\nscan = { kind = "mesh", path = "scan.stl", unit = "mm" }', 1
    )
    opened = DesignDocument(text, "a.toml", folder=tmp_path)
    assert opened.design.shapes["scan"].path == str(tmp_path / "scan.stl")


class TestWhatIsNotSaved:
    def test_a_document_that_was_just_opened_is_not_edited(self, tmp_path):
        opened = template_document("sphere", tmp_path)
        assert not opened.edited
        opened.replace(opened.text + "# mine\n")
        assert opened.edited
        opened.undo()
        assert not opened.edited
        # A draft that was brought back differs from something that nobody knows any more.
        assert DesignDocument(opened.text, "sphere.toml", restored=True).edited

    def test_it_is_called_and_saved_by_the_name_that_its_design_was_given(self, tmp_path):
        opened = template_document("sphere", tmp_path)
        assert opened.event().name == "sphere.toml"
        assert opened.event().folder == str(tmp_path)
        opened.edit(["name"], "my chamber")
        assert opened.event().name == "my-chamber.toml"
        written = opened.save(Path(opened.title))
        assert written == tmp_path / "my-chamber.toml"
        assert written.read_text() == opened.text
        opened.edit(["name"], "another")
        assert opened.event().name == "my-chamber.toml"


def test_a_text_that_describes_nothing_yet_is_empty_and_no_fault(tmp_path):
    begun = template_document("empty", tmp_path)
    assert begun.empty
    assert not begun.valid
    assert begun.event().diagnostics == []
    shapes = {"ball": {"kind": "sphere", "radius": "20 mm"}}
    begun.edit(["shapes"], shapes, now=0.0)
    # A shape without a part is a fault: somebody has begun.
    assert not begun.empty
    assert [each.where for each in begun.diagnostics] == ["parts"]
    begun.edit(["parts", 0], {"shape": "ball", "material": "ecoflex-00-30"}, now=9.0)
    assert begun.valid
    assert begun.event().hash
    begun.undo()
    begun.undo()
    assert begun.empty
    assert begun.design is None
    begun.replace(begun.text.replace("5 mm", "5"))
    assert not begun.empty
    assert {each.where for each in begun.diagnostics} == {"voxel_size", "parts"}


def test_a_file_has_one_id_and_new_documents_have_others(tmp_path):
    first, second = document(), document()
    assert first.id != second.id
    first.save(tmp_path / "cylinder.toml")
    opened = DesignDocument.of_file(tmp_path / "cylinder.toml")
    assert opened.id == DesignDocument.of_file(tmp_path / "cylinder.toml").id
    kept = opened.id
    opened.edit(["parameters", "radius", "value"], "20 mm")
    assert opened.id == kept
    assert opened.hash != first.hash
    opened.undo()
    assert opened.hash == first.hash
