"""Habits of designers who come from other programs, each of which met a trap once."""

import pytest

from voxsoft.design import families

pytestmark = pytest.mark.browser

HIGH = """
schema = "voxsoft/1"
name = "high"
voxel_size = "5 mm"

[shapes]
body = { kind = "box", size = ["20 mm", "10 mm", "30 mm"], corner = [0, 0, "-7.5 mm"] }

[[parts]]
shape = "body"
material = "ecoflex-00-30-lattice"

[[loads]]
kind = "gravity"
"""


def test_keys_go_to_the_picture_after_enter(served, open_tab):
    tab = open_tab(served.address, mode="design", symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    size = tab.find("parameter-length").get_by_role("textbox", name="length")
    size.fill("50 mm")
    size.press("Enter")
    # Without the pointer in the picture the field keeps them: text goes on by the keyboard.
    assert size.evaluate("field => field === document.activeElement")
    tab.page.mouse.move(*tab.middle())
    tab.until("document.activeElement?.tagName === 'CANVAS'")
    tab.page.keyboard.press("1")
    assert size.input_value() == "50 mm"
    # A field that was typed into again keeps its keys, wherever the pointer goes.
    size.click()
    size.press("Enter")
    size.press_sequentially("1")
    tab.page.mouse.move(*tab.middle())
    assert size.evaluate("field => field === document.activeElement")
    size.press("Escape")


def test_escape_closes_the_card_of_a_place(served, open_tab):
    tab = open_tab(served.address, mode="design", symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.page.mouse.click(*tab.middle())
    tab.find("face-verbs").wait_for()
    tab.page.locator(".picked").wait_for()
    tab.page.keyboard.press("Escape")
    tab.find("face-verbs").wait_for(state="detached")
    tab.page.locator(".picked").wait_for(state="detached")


def test_a_clamp_of_the_form_holds_the_lowest_layer(serving, tmp_path, open_tab):
    server = serving(tmp_path, HIGH, "high.toml")
    try:
        tab = open_tab(server.address, mode="design", symbols=False)
        tab.find("text-editor").locator(".cm-content").wait_for()
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        tab.page.get_by_role("button", name="Add a clamp").click()
        tab.find("clamps-0").get_by_text("z: [-7.5 mm, -7.5 mm]").wait_for()
        labels = tab.page.locator("[aria-label^='Add a']").evaluate_all(
            "all => all.map(each => each.ariaLabel)"
        )
        assert {"Add a refine", "Add a symmetry", "Add an activation"} <= set(labels)
    finally:
        server.stop()


def test_a_section_is_open_on_the_side_of_the_eye(served, open_tab):
    tab = open_tab(served.address, mode="design", symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.find("section").click()
    tab.page.get_by_label("Section axis").select_option("y")
    other = tab.page.get_by_role("button", name="Other side")
    # From the front, whose eye is at smaller y, and from the back.
    for view, flipped in (("Front", "true"), ("Back", "false"), ("Front", "true")):
        tab.page.keyboard.press("Control+k")
        tab.page.keyboard.type(f"{view} view")
        tab.page.keyboard.press("Enter")
        other.and_(tab.page.locator(f"[aria-pressed={flipped}]")).wait_for()
    other.click()
    other.and_(tab.page.locator("[aria-pressed=false]")).wait_for()


def test_a_body_that_was_solved_has_numbers_in_place_of_a_vertical_line(tab):
    tab.find("rest").click()
    tab.until("voxsoft.state === 'at-rest'")
    values = tab.find("last-probes")
    values.get_by_text("mm").first.wait_for()
    assert tab.find("plot-probes").count() == 0
    # Time that runs is plotted again.
    tab.find("reset").click()
    tab.find("play").click()
    tab.find("plot-probes").wait_for()
    tab.find("play").click()
    assert tab.errors == []


def test_a_section_that_is_no_list_leaves_the_form_standing(serving, tmp_path, open_tab):
    server = serving(tmp_path, HIGH, "high.toml")
    try:
        tab = open_tab(server.address, mode="design", symbols=False)
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        tab.page.locator(".cm-content").click()
        tab.page.keyboard.press("Control+a")
        tab.page.keyboard.insert_text('schema = "voxsoft/1"\nparts = 3\nshapes = "box"\n')
        tab.find("faults").wait_for()
        tab.find("design-form").get_by_label("Add a part", exact=True).wait_for()
        assert "stopped working" not in tab.page.content()
        assert tab.errors == []
    finally:
        server.stop()


@pytest.mark.long
def test_a_wall_that_whole_voxels_round_says_so_at_its_field(serving, tmp_path, open_tab):
    server = serving(tmp_path, families.family_text("pneunet"), "pneunet.toml")
    try:
        tab = open_tab(server.address, mode="design", symbols=False)
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        assert tab.find("grid-note-wall").count() == 0
        wall = tab.find("parameter-wall").get_by_role("textbox", name="wall")
        wall.fill("3.75 mm")
        wall.press("Enter")
        note = tab.find("grid-note-wall")
        note.get_by_text("3.75 mm is 1.5 voxels: whole ones hold 2.5 mm or 5 mm.").wait_for()
        note.get_by_role("button", name="Voxels of 1.25 mm").click()
        note.wait_for(state="detached")
        tab.find("pane-body").get_by_text("1.25 mm").wait_for()
        assert tab.errors == []
    finally:
        server.stop()
