"""Another name for a thing of a design, everywhere its text speaks of it."""

import tomllib

import pytest

from voxsoft.design.document.formula import with_renamed
from voxsoft.errors import DesignError
from voxsoft.studio.documents.renaming import renamed

TEXT = """
[parameters] # wall
wall = { value = "5 mm" }
height = { value = "= 2*wall" } # twice the "= wall"
[shapes]
wall = { kind = "box", size = ["= height-wall", '= 2 * wall', 1] } # the wall
all = { kind = "union", of = ["wall", "other"] }
[histories]
lift = { time = [0] }
[[loads]]
history = "lift" # lift
[[parts]]
shape = "wall"
name = "wall"
""".strip()

HAND = """
[shapes]
left = { kind = "box" }
all = { kind = "union", of = ["left", "other"] }
[[bodies]]
name = "left" # the left one
set = { left = "= left" }
[[clamps]]
region = { body = "left", z = [0, 0] }
[[loads]]
cavity = "left.air"
[[objects]]
name = "lefty"
shape = "left"
[contact]
pairs = [{ of = ["left", "lefty"] }]
[objectives]
a = { minimize = "displacement", probe = "left.tip" }
b = { minimize = "contact_area", object = "lefty" }
""".strip()


def changes(text, section, name, to):
    """Lines that are other ones."""
    after = renamed(text, section, name, to).split("\n")
    return [new for old, new in zip(text.split("\n"), after, strict=True) if new != old]


def test_a_parameter_is_renamed_in_its_definition_and_in_formulas_only():
    assert changes(TEXT, "parameters", "wall", "skin") == [
        'skin = { value = "5 mm" }',
        'height = { value = "= 2*skin" } # twice the "= wall"',
        """wall = { kind = "box", size = ["= height-skin", '= 2 * skin', 1] } # the wall""",
    ]


def test_a_shape_is_renamed_where_shapes_are_named():
    assert changes(TEXT, "shapes", "wall", "hull") == [
        """hull = { kind = "box", size = ["= height-wall", '= 2 * wall', 1] } # the wall""",
        'all = { kind = "union", of = ["hull", "other"] }',
        'shape = "hull"',
    ]


def test_a_history_is_renamed_where_loads_call_it():
    assert changes(TEXT, "histories", "lift", "rise") == [
        "rise = { time = [0] }",
        'history = "rise" # lift',
    ]


def test_bodies_and_objects_are_renamed_where_they_are_spoken_of():
    assert changes(HAND, "bodies", "left", "thumb") == [
        'name = "thumb" # the left one',
        'region = { body = "thumb", z = [0, 0] }',
        'cavity = "thumb.air"',
        'pairs = [{ of = ["thumb", "lefty"] }]',
        'a = { minimize = "displacement", probe = "thumb.tip" }',
    ]
    assert changes(HAND, "objects", "lefty", "cube") == [
        'name = "cube"',
        'pairs = [{ of = ["left", "cube"] }]',
        'b = { minimize = "contact_area", object = "cube" }',
    ]


def test_sections_of_their_own_and_quoted_keys_are_definitions():
    text = '[shapes.wall]\nkind = "box"\n[shapes."rib"]\nof = "wall"'
    assert changes(text, "shapes", "wall", "hull") == ["[shapes.hull]", 'of = "hull"']
    assert changes(text, "shapes", "rib", "web") == ["[shapes.web]"]


@pytest.mark.parametrize(
    ("section", "name", "to", "word"),
    [
        ("shapes", "wall", "all", "taken"),
        ("shapes", "wall", "a wall", "cannot be called"),
        ("shapes", "height", "hull", "nothing called"),
        ("objects", "wall", "hull", "nothing called"),
        ("parameters", "wall", "thick-wall", "cannot be called"),
    ],
)
def test_names_that_cannot_be_given_are_refused(section, name, to, word):
    with pytest.raises(DesignError, match=word):
        renamed(TEXT, section, name, to)


def test_a_name_in_a_table_on_one_line_is_left_to_the_text():
    with pytest.raises(DesignError, match="on one line"):
        renamed('parameters = { wall = "5 mm" }', "parameters", "wall", "skin")


def test_a_text_that_is_no_toml_yet_can_be_renamed():
    broken = TEXT + "\nvoxel_size = "
    with pytest.raises(tomllib.TOMLDecodeError):
        tomllib.loads(broken)
    assert "skin = {" in renamed(broken, "parameters", "wall", "skin")


@pytest.mark.parametrize(
    ("formula", "after"),
    [
        ("= m + 5 m - 2 * m", "= height + 5 m - 2 * height"),
        ("=m", "=height"),
        ("= mm + min(m, 1 mm)", "= mm + min(height, 1 mm)"),
        ("= -(m-m)/2", "= -(height-height)/2"),
    ],
)
def test_units_are_no_parameters(formula, after):
    assert with_renamed(formula, "m", "height") == after
