"""Bodies of a design with the mouse: chosen, placed, copied, mirrored, arranged, added, solved."""

import shutil
import tomllib
from pathlib import Path

import pytest

pytestmark = pytest.mark.browser

EXAMPLES = Path(__file__).parents[3] / "examples"

PAD = """
schema = "voxsoft/1"
name = "pad"
voxel_size = "5 mm"

[parameters]
tall = { value = "10 mm", min = "10 mm", max = "20 mm" }

[shapes]
block = { kind = "box", size = ["20 mm", "10 mm", "= tall"] }

[materials]
soft = { model = "neo-hookean", young = "100 kPa", poisson = 0.4 }

[[parts]]
shape = "block"
material = "soft"

[[clamps]]
region = { z = [0, 0] }
"""

STACK = """
# Two pads face to face.
schema = "voxsoft/1"
name = "stack"
voxel_size = "5 mm"

[[bodies]]
name = "lower"
design = "pad.toml"

[[bodies]]
name = "upper"
design = "pad.toml"
position = [0, 0, "20.5 mm"]
mirror = "z"
motion = { displacement = [0, 0, "-1.5 mm"] }

[contact]
friction = 0.5
"""


@pytest.fixture
def stack(tmp_path, serving):
    (tmp_path / "pad.toml").write_text(PAD)
    server = serving(tmp_path, STACK, "stack.toml")
    yield server
    server.stop()


def saved(tab, server):
    """The document as it stands, by way of its file."""
    rev = tab.page.evaluate("voxsoft.rev")
    tab.page.keyboard.press("Control+s")
    tab.page.get_by_text("Saved ").first.wait_for()
    assert tab.page.evaluate("voxsoft.rev") == rev
    return tomllib.loads(server.source.read_text())


def open_entry(tab, name):
    entry = tab.find(name)
    entry.get_by_role("button", expanded=False).first.click()
    entry.locator(".entry-body").wait_for()
    return entry


def shown(tab, *names):
    """Wait until the picture has these bodies and no others."""
    labels = [f"label-body-{name}" for name in names]
    quoted = ", ".join(f"'{label}'" for label in labels)
    tab.until(
        f"[{quoted}].every((id) => document.querySelector(`[data-testid='${{id}}']`) !== null) && "
        f"document.querySelectorAll('[data-testid^=label-body-]').length === {len(labels)}"
    )


def test_a_body_is_chosen_moved_turned_and_renamed(stack, open_tab):
    tab = open_tab(stack.address, mode="design")
    shown(tab, "lower", "upper")
    tab.find("label-body-upper").click()
    entry = tab.find("bodies-1")
    entry.locator(".entry-body").wait_for()
    tab.shot("bodies_chosen")
    # A grip for each axis moves it: with the mouse, and with keys by a millimeter.
    grip = tab.find("move-x")
    box = grip.bounding_box()
    start = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    tab.page.mouse.move(*start)
    tab.page.mouse.down()
    tab.page.mouse.move(start[0] + 40, start[1] + 4, steps=4)
    tab.shot("bodies_dragged")
    tab.page.mouse.up()
    value = "document.querySelector('[aria-label=\"Position x\"]').value"
    tab.until(f"{value}.endsWith(' mm')")
    dragged = tab.page.evaluate(value)
    assert float(dragged.removesuffix(" mm")) > 1
    grip.press("ArrowRight")
    tab.until(f"Math.abs(parseFloat({value}) - parseFloat('{dragged}') - 1) < 1e-6")
    x = entry.get_by_label("Position x", exact=True)
    x.fill("40")
    x.press("Enter")
    tab.until("document.querySelector('[aria-label=\"Position x\"]').value.includes('40')")
    entry.get_by_role("button", name="Turn…").click()
    angle = entry.get_by_label("Angle", exact=True)
    angle.fill("90 deg")
    angle.press("Enter")
    name = entry.get_by_label("Name", exact=True)
    name.fill("beside")
    name.press("Enter")
    shown(tab, "lower", "beside")
    assert tab.errors == []
    document = saved(tab, stack)
    body = document["bodies"][1]
    assert body["position"] == ["40 mm", 0, "20.5 mm"]
    assert body["rotation"] == {"axis": [0, 0, 1], "angle": "90 deg"}
    assert body["name"] == "beside"
    assert stack.source.read_text().startswith("\n# Two pads face to face.")


def test_bodies_are_copied_mirrored_arranged_added_and_taken_out(stack, open_tab):
    tab = open_tab(stack.address, mode="design")
    shown(tab, "lower", "upper")
    entry = open_entry(tab, "bodies-0")
    entry.get_by_test_id("copy-beside").click()
    shown(tab, "lower", "upper", "lower-2")
    tab.page.get_by_role("button", name="Undo").click()
    shown(tab, "lower", "upper")
    entry.get_by_test_id("copy-around").click()
    through = entry.get_by_label("Through x", exact=True)
    through.fill("50 mm")
    through.press("Enter")
    entry.get_by_test_id("around-do").click()
    shown(tab, "lower", "upper", "lower-2", "lower-3")
    tab.shot("bodies_arranged")
    entry.get_by_test_id("copy-mirror").click()
    entry.get_by_label("Plane").select_option(label="across y")
    at = entry.get_by_label("At y", exact=True)
    at.fill("-20 mm")
    at.press("Enter")
    entry.get_by_test_id("mirror-do").click()
    shown(tab, "lower", "upper", "lower-2", "lower-3", "lower-4")
    tab.find("add-body").select_option("file:pad.toml")
    shown(tab, "lower", "upper", "lower-2", "lower-3", "lower-4", "pad")
    tab.shot("bodies_added")
    tab.page.get_by_role("button", name="Remove lower-3").click()
    shown(tab, "lower", "upper", "lower-2", "lower-4", "pad")
    assert tab.errors == []
    bodies = saved(tab, stack)["bodies"]
    center = ["50 mm", 0, 0]
    turned = {"axis": [0, 0, 1], "angle": "120 deg", "center": center}
    assert bodies[2] == {**bodies[2], "name": "lower-2", "rotation": turned}
    assert bodies[3] == {**bodies[3], "name": "lower-4", "mirror": "y"}
    assert bodies[3]["position"] == [0, "-40 mm", 0]
    # On the voxels of its own, past the copies.
    assert bodies[4]["design"] == "pad.toml"


def test_the_body_of_a_design_is_copied_into_a_design_of_several(tmp_path, serving, open_tab):
    server = serving(tmp_path, PAD, "pad.toml")
    try:
        tab = open_tab(server.address, mode="design")
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        tools = tab.find("copy-body")
        tools.get_by_test_id("copy-beside").click()
        shown(tab, "pad", "pad-2")
        tab.shot("bodies_of_one")
        slider = tab.page.get_by_label("tall slider")
        slider.focus()
        before = tab.page.evaluate("voxsoft.triangles")
        slider.press("End")
        tab.until(f"voxsoft.triangles > {before}")  # both became taller
        tab.page.get_by_role("button", name="Undo").click()
        tab.page.get_by_role("button", name="Undo").click()
        tab.until("document.querySelectorAll('[data-testid^=label-body-]').length === 0")
        assert tab.errors == []
        assert (tmp_path / "pad.toml").read_text() == PAD
    finally:
        server.stop()


@pytest.mark.slow  # 1,200 voxels drawn by software; the pads above are the quick sibling
def test_the_gripper_of_three_is_made_again_from_one_finger(tmp_path, serving, open_tab):
    shutil.copy(EXAMPLES / "gripper_finger.toml", tmp_path)
    text = (EXAMPLES / "gripper_three.toml").read_text()
    server = serving(tmp_path, text, "gripper_three.toml")
    try:
        tab = open_tab(server.address, mode="design")
        shown(tab, "first", "second", "third")
        tab.shot("gripper_three")
        for name in ("third", "second"):
            tab.page.get_by_role("button", name=f"Remove {name}").click()
            tab.until(f"document.querySelector('[data-testid=label-body-{name}]') === null")
        entry = open_entry(tab, "bodies-0")
        tab.shot("gripper_one")
        entry.get_by_test_id("copy-around").click()
        entry.get_by_test_id("around-do").click()
        shown(tab, "first", "first-2", "first-3")
        tab.shot("gripper_arranged")
        assert tab.errors == []
        bodies = saved(tab, server)["bodies"]
    finally:
        server.stop()
    # Text that the example has written by hand, formulas and all.
    unnamed = [{key: body[key] for key in body if key != "name"} for body in bodies]
    by_hand = tomllib.loads(text)["bodies"]
    assert unnamed == [{key: body[key] for key in body if key != "name"} for body in by_hand]


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_two_bodies_are_pressed_together_and_the_card_says_so(stack, open_tab, scheme):
    tab = open_tab(stack.address, mode="simulate", scheme=scheme)
    shown(tab, "lower", "upper")
    tab.find("rest").click()
    tab.until("voxsoft.state === 'at-rest'")
    card = tab.find("contacts")
    card.wait_for()
    assert card.locator("strong").all_inner_texts() == ["lower on upper"]
    assert "Friction" in card.inner_text()
    # The force as an arrow, with the meaning of it and its color; it can be switched off.
    legend = tab.find("force-legend")
    legend.wait_for()
    assert "10 mm = " in legend.inner_text()
    label = tab.find("label-force-lower-upper")
    assert "sticks" in label.inner_text()
    tab.shot(f"bodies_solved_{scheme}")
    fields = tab.page.get_by_label("Color by")
    fields.select_option(label="Contact pressure")
    tab.find("legend").get_by_text("kPa").wait_for()
    tab.until("document.querySelector('.legend-ticks') !== null")
    tab.page.get_by_label("Show as").select_option(label="Smooth shape")
    tab.shot(f"bodies_pressure_{scheme}")
    tab.find("view-more").click()
    tab.page.get_by_label("Contact forces").uncheck()
    tab.until("document.querySelector('[data-testid=force-legend]') === null")
    label.wait_for(state="detached")
    assert tab.errors == []
