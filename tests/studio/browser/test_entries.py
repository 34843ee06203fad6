"""Entries of the form: a new one is no error, and one in use goes with all that depends on it."""

import pytest

pytestmark = pytest.mark.browser

HOLLOW = """
[shapes]
hole = { kind = "box", size = ["20 mm", "4 mm", "4 mm"], center = ["20 mm", 0, "5 mm"] }
body = { kind = "difference", of = ["bar", "hole"] }
bar = { kind = "box", size = ["= length", "10 mm", "10 mm"] }
"""


def added(tab, name, section):
    """Add an entry by its button, and wait for the text that has it."""
    tab.page.get_by_role("button", name=f"Add {name}", exact=True).click()
    tab.until(f"document.querySelector('.cm-content').innerText.includes('[{section}')")


def problems(tab):
    return tab.page.locator(".faults, .badge.bad, .entry .bad").count()


def test_a_new_entry_is_no_error(serving, tmp_path, open_tab, coarse):
    server = serving(tmp_path, text=coarse)
    try:
        tab = open_tab(server.address, mode="design", size=(1600, 2400))
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        added(tab, "a constraint", "constraints")
        limit = tab.find("constraints-limit")
        # It is open: its bound is a proposal that the body keeps.
        assert limit.get_by_label("Metric", exact=True).input_value() == "mass"
        assert limit.get_by_label("At most", exact=False).first.input_value().endswith(" g")
        added(tab, "an objective", "objectives")
        for name in ("a connection", "a supply"):
            button = tab.page.get_by_label(f"Add {name}", exact=True)
            assert button.is_disabled()
            assert "this body has none" in button.get_attribute("title")
        assert problems(tab) == 0
    finally:
        server.stop()


def test_a_shape_in_use_is_asked_about_and_takes_along_all_that_needs_it(
    serving, tmp_path, open_tab, coarse
):
    text = coarse.replace(coarse[coarse.index("[shapes]") : coarse.index("[[parts]]")], HOLLOW)
    server = serving(tmp_path, text=text)
    try:
        tab = open_tab(server.address, mode="design", size=(1600, 1600))
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        sheet = tab.find("remove-sheet")
        remove = lambda name: tab.page.get_by_label(f"Remove {name}", exact=True).click()  # noqa: E731
        # One of several operands: the rest stays.
        remove("hole")
        sheet.get_by_text("shape body", exact=True).wait_for()
        tab.shot("remove-operand")
        tab.find("remove-all").click()
        tab.find("shapes-hole").wait_for(state="detached")
        tab.until("voxsoft.triangles > 0")
        assert problems(tab) == 0
        # The bar is all there is: the body, its part and the picture go with it.
        remove("bar")
        sheet.get_by_text("part 1 (body)", exact=True).wait_for()
        tab.page.keyboard.press("Escape")
        sheet.wait_for(state="detached")
        assert tab.find("shapes-bar").count() == 1
        remove("bar")
        tab.find("remove-all").click()
        tab.find("empty-stage").wait_for()
        tab.until("voxsoft.triangles === 0")
        assert problems(tab) == 0
        tab.page.get_by_role("button", name="Undo (Ctrl+Z)").click()
        tab.until("voxsoft.triangles > 0")
        tab.find("parts-0").wait_for()
        assert tab.errors == []
    finally:
        server.stop()
