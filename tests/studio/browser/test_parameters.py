"""Numbers of the form become parameters by one press, and histories are chosen by their names."""

import tomllib

import pytest

pytestmark = pytest.mark.browser

LIFTED = """
schema = "voxsoft/1"
name = "lifted"
voxel_size = "5 mm"

[shapes]
body = { kind = "box", size = ["40 mm", "10 mm", "10 mm"] }

[[parts]]
shape = "body"
material = "ecoflex-00-30"

[[clamps]]
region = { x = [0, 0] }
motion = { displacement = [0, 0, "5 mm"], history = "lift" }

[histories]
lift = { time = ["0 s", "1 s"], factor = [0, 1] }
late = { time = ["1 s", "2 s"], factor = [0, 1] }

[solver]
method = "dynamics"
end_time = "2 s"
"""


@pytest.fixture
def lifted(tmp_path, serving):
    server = serving(tmp_path, LIFTED, "lifted.toml")
    yield server
    server.stop()


def saved(tab, server):
    tab.page.keyboard.press("Control+s")
    tab.page.get_by_text("Saved ").first.wait_for()
    return tomllib.loads(server.source.read_text())


def test_a_number_becomes_a_parameter_in_one_step(lifted, open_tab):
    tab = open_tab(lifted.address, mode="design")
    entry = tab.find("clamps-0")
    entry.get_by_role("button", expanded=False).first.click()
    lift = entry.get_by_label("Displacement z", exact=True)
    lift.hover()
    tab.shot("parameter-offered")
    entry.get_by_role("button", name="Make a parameter of Displacement z").click()
    tab.find("parameter-clamp_displacement_z").wait_for()
    assert lift.input_value() == "= clamp_displacement_z"
    # A formula is none of its own any more.
    assert entry.get_by_role("button", name="Make a parameter of Displacement z").count() == 0
    tab.shot("parameter-made")
    document = saved(tab, lifted)
    assert document["parameters"] == {
        "clamp_displacement_z": {"value": "5 mm", "min": "2.5 mm", "max": "7.5 mm"}
    }
    assert document["clamps"][0]["motion"]["displacement"] == [0, 0, "= clamp_displacement_z"]
    tab.page.get_by_role("button", name="Undo (Ctrl+Z)").click()
    tab.find("parameter-clamp_displacement_z").wait_for(state="detached")
    assert lift.input_value() == "5 mm"
    assert tab.errors == []


def test_a_history_is_chosen_by_its_name_and_renamed(lifted, open_tab):
    tab = open_tab(lifted.address, mode="design")
    entry = tab.find("clamps-0")
    entry.get_by_role("button", expanded=False).first.click()
    chosen = entry.get_by_label("History", exact=True)
    assert chosen.input_value() == "lift"
    chosen.select_option("late")
    late = tab.find("histories-late")
    late.get_by_role("button", expanded=False).first.click()
    name = late.get_by_label("Name", exact=True)
    name.fill("rise")
    name.press("Enter")
    tab.find("histories-rise").wait_for()
    tab.shot("histories")
    document = saved(tab, lifted)
    assert document["clamps"][0]["motion"]["history"] == "rise"
    assert set(document["histories"]) == {"lift", "rise"}
    assert tab.errors == []


GRIPPED = """
schema = "voxsoft/1"
name = "gripped"
voxel_size = "5 mm"

[shapes]
body = { kind = "box", size = ["20 mm", "10 mm", "10 mm"] }

[[parts]]
shape = "body"
material = "ecoflex-00-30"

[[clamps]]
region = { x = [0, 0] }

[[objects]]
name = "ball"
shape = { kind = "sphere", radius = "5 mm", center = ["10 mm", "5 mm", "16 mm"] }

[contact]
friction = 0.5

[probes]
tip = { x = ["20 mm", "20 mm"] }

[objectives]
goal = { maximize = "mass" }

[constraints]
reach = { metric = "displacement", probe = "tip", max = "2 mm" }
"""


def test_friction_and_the_bound_of_a_goal_become_parameters(tmp_path, serving, open_tab):
    server = serving(tmp_path, GRIPPED, "gripped.toml")
    try:
        tab = open_tab(server.address, mode="design")
        entry = tab.find("objects-0")
        entry.get_by_role("button", expanded=False).first.click()
        slider = entry.get_by_label("Friction slider")
        slider.wait_for()
        entry.get_by_label("Friction", exact=True).hover()
        tab.shot("parameter-friction")
        entry.get_by_role("button", name="Make a parameter of Friction").click()
        tab.find("parameter-friction").wait_for()
        slider.wait_for(state="detached")
        assert entry.get_by_label("Friction", exact=True).input_value() == "= friction"
        goal = tab.find("constraints-reach")
        goal.get_by_role("button", expanded=False).first.click()
        goal.get_by_role("button", name="Make a parameter of At most").click()
        tab.find("parameter-reach_max").wait_for()
        tab.shot("parameter-bound")
        document = saved(tab, server)
        assert document["contact"]["friction"] == "= friction"
        assert document["constraints"]["reach"]["max"] == "= reach_max"
        assert document["parameters"] == {
            "friction": {"value": 0.5, "min": 0.25, "max": 0.75},
            "reach_max": {"value": "2 mm", "min": "1 mm", "max": "3 mm"},
        }
        assert tab.errors == []
    finally:
        server.stop()
