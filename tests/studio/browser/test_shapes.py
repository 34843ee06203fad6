"""Shapes by the mouse: added from the picker, seen by themselves, moved, sized, joined."""

import numpy as np
import pytest
from hands import Hand, add_shape, renewed
from waiting import until

import voxsoft as vs

pytestmark = pytest.mark.browser

PLATE = """
schema = "voxsoft/1"
name = "plate"
voxel_size = "5 mm"

[parameters]
bore = { value = "8 mm", min = "5 mm", max = "12 mm" }

[shapes.hole]
kind = "cylinder"
radius = "= bore"
height = "30 mm"
base = ["20 mm", "20 mm", "-5 mm"]

[shapes]
block = { kind = "box", size = ["60 mm", "40 mm", "20 mm"] }
plate = { kind = "difference", of = ["block", "hole"] }

[[parts]]
shape = "plate"
material = "ecoflex-00-30"

[[clamps]]
region = { x = [0, 0] }

[[loads]]
kind = "gravity"
"""


@pytest.fixture
def plate(serving, open_tab, tmp_path):
    server = serving(tmp_path, PLATE, "plate.toml")
    try:
        tab = open_tab(server.address, mode="design")
        tab.until("window.voxsoft !== undefined && voxsoft.vertexPosition(0) !== null")
        yield tab, Hand(tab)
        assert tab.errors == []
    finally:
        server.stop()


def choose(tab, name):
    """Press a shape of the tree, and wait until it is drawn by itself."""
    tab.find(f"shapes-{name}").get_by_role("button", name=name).first.click()
    tab.until(f"voxsoft.ghosts.includes('{name}')")


def box_of(tab, name):
    return tab.page.evaluate(f"voxsoft.ghostBox('{name}')")


def drag(tab, grip, dx, dy):
    box = tab.find(grip).bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    mouse = tab.page.mouse
    mouse.move(x, y)
    mouse.down()
    mouse.move(x + dx / 2, y + dy / 2)
    mouse.move(x + dx, y + dy)
    mouse.up()


def test_a_new_shape_is_found_by_keys_and_seen_at_once(plate):
    tab, hand = plate
    hand.press(name="Add a shape")
    picker = tab.find("shape-picker")
    tab.shot("shapes-1-picker")
    picker.get_by_role("combobox").fill("sph")
    tab.shot("shapes-2-found")
    tab.page.keyboard.press("Enter")
    picker.wait_for(state="detached")
    entry = tab.find("shapes-sphere")
    entry.get_by_label("Radius", exact=True).wait_for()
    assert "not used yet" in entry.inner_text()
    tab.until("voxsoft.ghosts.includes('sphere')")
    tab.find("label-shape-sphere").wait_for()
    # On top of the body, half of it above.
    assert np.mean(box_of(tab, "sphere"), axis=0) == pytest.approx([0.03, 0.02, 0.02], abs=1e-4)
    tab.shot("shapes-3-ghost")
    # It stays to be seen when another one is chosen.
    choose(tab, "hole")
    tab.until("voxsoft.ghosts.length === 2")
    # Escape gives the focus back to the button that opened the list.
    hand.press(name="Add a shape")
    tab.page.keyboard.press("Escape")
    picker.wait_for(state="detached")
    assert tab.page.evaluate("document.activeElement.dataset.testid") == "add-shape"


def test_cutting_shapes_are_moved_and_sized_in_the_picture(plate, tmp_path):
    tab, _ = plate
    choose(tab, "hole")
    tab.shot("shapes-4-hole")
    before = box_of(tab, "hole")
    assert before[0][2] == pytest.approx(-0.005, abs=1e-6)
    base = tab.find("shapes-hole").get_by_label("Base x", exact=True)
    assert base.input_value().startswith("20")
    # Along x by the mouse: on whole steps, and one step for undo.
    renewed(tab, lambda: drag(tab, "shape-move-x", 70, 10))
    tab.until("voxsoft.ghostBox('hole')[0][0] > 0.0125")
    tab.shot("shapes-5-moved")
    moved = float(base.input_value().split()[0])
    assert moved > 20
    assert moved * 2 == round(moved * 2)
    # The radius is a parameter, which a typed number changes.
    grip = tab.find("shape-radius")
    assert "changes the parameter bore" in grip.get_attribute("aria-label")
    grip.focus()
    tab.page.keyboard.press("Enter")
    field = tab.find("typed-radius")
    field.fill("20")
    field.press("Enter")
    tab.page.get_by_text("must be between 5 mm and 12 mm").wait_for()
    tab.shot("shapes-6-typed")
    field.fill("10")
    renewed(tab, lambda: field.press("Enter"))
    tab.until("voxsoft.ghostBox('hole')[1][1] > 0.0295")
    assert saved_parameter(tab) == "10"
    # Moves by keys along z.
    renewed(tab, lambda: tab.find("shape-move-z").press("ArrowDown"))
    tab.until("voxsoft.ghostBox('hole')[0][2] < -0.0055")
    design = kept(tab, tmp_path / "plate.toml")
    assert design.shapes["hole"].base == pytest.approx((moved * 1e-3, 0.02, -0.006))
    assert design.parameters["bore"].value == pytest.approx(0.01)
    for _ in range(3):
        renewed(tab, lambda: tab.page.keyboard.press("Control+z"))
    tab.until("Math.abs(voxsoft.ghostBox('hole')[0][0] - 0.012) < 1e-4")


def kept(tab, file):
    """The design, saved in the file that it is of."""
    tab.page.keyboard.press("Control+s")
    until(lambda: file.read_text() != PLATE)
    return vs.load(file)


def saved_parameter(tab):
    return tab.find("parameter-bore").get_by_role("textbox").first.input_value().split()[0]


def test_shapes_are_hidden_while_the_body_is_bent(plate):
    tab, hand = plate
    choose(tab, "hole")
    hand.press(test_id="rest")
    tab.until("voxsoft.state === 'at-rest' && voxsoft.ghosts.length === 0")
    assert tab.find("shape-move-x").is_hidden()
    tab.shot("shapes-7-hidden")
    hand.press(test_id="hidden-shape")
    tab.until("voxsoft.ghosts.includes('hole')")


def test_a_shape_is_dragged_on_another_in_the_tree(plate, tmp_path):
    tab, hand = plate
    add_shape(hand, "capsule")
    tab.until("voxsoft.ghosts.includes('capsule')")
    row = tab.find("shapes-capsule").locator(".entry-head")
    row.drag_to(tab.find("shapes-plate").locator(".entry-head"))
    tab.page.get_by_role("menu").wait_for()
    tab.shot("shapes-8-joined")
    renewed(tab, lambda: tab.page.get_by_role("menuitem", name="Cut it out of plate").click())
    design = kept(tab, tmp_path / "plate.toml")
    assert design.shapes["plate"].of == ("block", "hole", "capsule")


OPERATORS = """
schema = "voxsoft/1"
name = "row"
voxel_size = "5 mm"

[parameters]
lean = { value = "20 deg", min = "0 deg", max = "60 deg" }

[shapes]
block = { kind = "box", size = ["20 mm", "10 mm", "10 mm"] }
leaning = { kind = "rotate", of = "block", angle = "= lean", axis = "y" }
both = { kind = "mirror", of = "leaning", normal = "x", point = ["-5 mm", 0, 0], keep = true }
row = { kind = "array", of = "both", count = [1, 3, 1], spacing = [0, "15 mm", 0] }
larger = { kind = "scale", of = "row", factor = 1.5 }

[[parts]]
shape = "larger"
material = "ecoflex-00-30"

[[clamps]]
region = { z = ["-inf", 0] }
"""


@pytest.fixture
def row(serving, open_tab, tmp_path):
    server = serving(tmp_path, OPERATORS, "row.toml")
    try:
        tab = open_tab(server.address, mode="design")
        tab.until("window.voxsoft !== undefined && voxsoft.vertexPosition(0) !== null")
        yield tab
        assert tab.errors == []
    finally:
        server.stop()


def test_operators_that_turn_mirror_repeat_or_scale_have_grips(row, tmp_path):
    tab = row
    # The angle is a parameter, which a drag on its ring changes by whole steps.
    choose(tab, "leaning")
    ring = tab.find("shape-angle")
    assert "changes the parameter lean" in ring.get_attribute("aria-label")
    tab.shot("operators-1-angle")
    renewed(tab, lambda: drag(tab, "shape-angle", 0, 60))
    angle = float(tab.find("parameter-lean").get_by_role("textbox").first.input_value().split()[0])
    assert angle != 20
    assert angle % 5 == 0
    tab.shot("operators-2-turned")
    choose(tab, "both")
    tab.shot("operators-3-plane")
    renewed(tab, lambda: tab.find("shape-plane-x").press("ArrowLeft"))
    choose(tab, "row")
    mouse, grip = tab.page.mouse, tab.find("shape-count-y").bounding_box()
    mouse.move(grip["x"] + 7, grip["y"] + 7)
    mouse.down()
    way = tab.page.evaluate("voxsoft.ghostBox('row')[1][1] - voxsoft.ghostBox('row')[0][1]")
    assert way == pytest.approx(0.04, abs=1e-3)
    mouse.move(grip["x"] + 60, grip["y"] - 20)
    tab.until("document.querySelector('.shape-handle path.outline').getAttribute('d') !== ''")
    tab.shot("operators-4-copies")
    renewed(tab, mouse.up)
    grip = tab.find("shape-spacing-y")
    grip.focus()
    tab.page.keyboard.press("Enter")
    tab.find("typed-spacing-y").fill("12")
    renewed(tab, lambda: tab.page.keyboard.press("Enter"))
    choose(tab, "larger")
    tab.shot("operators-5-factor")
    renewed(tab, lambda: tab.find("shape-factor").press("ArrowUp"))
    tab.page.keyboard.press("Control+s")
    file = tmp_path / "row.toml"
    until(lambda: "1.55" in file.read_text())
    shapes = vs.load(file).shapes
    assert shapes["both"].point == pytest.approx((-0.0055, 0, 0))
    assert shapes["row"].count[1] != 3
    assert shapes["row"].spacing[1] == pytest.approx(0.012)
    assert shapes["larger"].factor == pytest.approx(1.55)
    assert vs.load(file).parameters["lean"].value == pytest.approx(np.radians(angle))
