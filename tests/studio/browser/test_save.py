"""Saving asks for a name in the page itself, and nothing that was edited is lost without a word."""

import pytest

pytestmark = pytest.mark.browser


@pytest.fixture
def design(own_server, open_tab):
    tab = open_tab(own_server.address, mode="design")
    tab.find("parameter-length").wait_for()
    return tab


def open_template(tab, name):
    if tab.find(f"template-{name}").count() == 0:
        tab.find("templates").click()
    tab.find(f"template-{name}").click()


def edit(tab, value):
    rev = tab.page.evaluate("voxsoft.rev")
    field = tab.find("parameter-length").get_by_role("textbox", name="length", exact=True)
    field.fill(value)
    field.press("Enter")
    tab.until(f"voxsoft.rev > {rev}")


def test_a_new_design_is_saved_under_its_name(design, own_server):
    open_template(design, "sphere")
    title = design.find("document-name")
    title.get_by_text("sphere.toml").wait_for()
    assert "not saved yet" in title.inner_text()
    assert "edited" not in title.inner_text()
    name = design.find("design-form").get_by_label("Name", exact=True).first
    name.fill("mychamber")
    name.press("Enter")
    title.get_by_text("mychamber.toml").wait_for()
    design.page.keyboard.press("Escape")
    design.page.locator(".viewport canvas").focus()
    design.page.keyboard.press("Control+s")
    sheet = design.find("save-sheet")
    sheet.wait_for()
    assert sheet.get_by_label("File").input_value() == "mychamber.toml"
    assert str(own_server.source.parent) in design.find("save-folder").inner_text()
    design.shot("save")
    design.find("save-now").click()
    sheet.wait_for(state="detached")
    written = own_server.source.with_name("mychamber.toml")
    assert 'name = "mychamber"' in written.read_text()
    assert not list(own_server.source.parent.glob("*.toml.toml"))
    assert design.errors == []


def test_a_file_that_is_there_is_replaced_only_after_a_warning(design, own_server):
    before = own_server.source.read_text()
    open_template(design, "sphere")
    design.find("document-name").get_by_text("sphere.toml").wait_for()
    design.page.keyboard.press("Control+Shift+S")
    field = design.find("save-sheet").get_by_label("File")
    field.fill("finger")
    field.press("Enter")
    design.find("save-replaces").get_by_text("is there already").wait_for()
    assert own_server.source.read_text() == before
    design.find("save-now").get_by_text("Replace").click()
    design.find("save-sheet").wait_for(state="detached")
    assert 'name = "sphere"' in own_server.source.read_text()
    assert design.errors == []


def test_edited_work_is_not_replaced_without_a_question(design, own_server):
    edit(design, "55 mm")
    open_template(design, "sphere")
    sheet = design.find("discard-sheet")
    sheet.get_by_text("finger.toml has changes").wait_for()
    design.page.keyboard.press("Escape")
    sheet.wait_for(state="detached")
    assert "finger.toml" in design.find("document-name").inner_text()
    open_template(design, "sphere")
    design.find("save-first").click()
    design.find("save-now").click()
    design.find("document-name").get_by_text("sphere.toml").wait_for()
    assert '"55 mm"' in own_server.source.read_text()
    # A document without edits is replaced at once.
    open_template(design, "beam")
    design.find("document-name").get_by_text("beam.toml").wait_for()
    edit(design, "80 mm")
    open_template(design, "sphere")
    design.find("discard").click()
    design.find("document-name").get_by_text("sphere.toml").wait_for()
    design.page.get_by_role("button", name="Undo (Ctrl+Z)").click()
    design.find("toast").get_by_role("button", name="Back to beam.toml").click()
    design.find("document-name").get_by_text("beam.toml").wait_for()
    assert design.errors == []
