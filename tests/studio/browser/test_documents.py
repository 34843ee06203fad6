"""Contents of panes belong to a document: with another one they go, or are marked as past."""

import pytest

pytestmark = pytest.mark.browser


def begin(tab, title):
    """Open a template by the palette."""
    tab.page.keyboard.press("Control+k")
    tab.page.keyboard.type(f"New from template: {title}")
    tab.page.keyboard.press("Enter")


def first(value):
    """Text of the parameter that holds a value."""
    return f'length = {{ value = "{value}"'


def reopen(tab, name):
    """Open a file of the start screen's list."""
    tab.page.keyboard.press("Control+o")
    tab.find("start-recent").get_by_text(name, exact=True).click()


def test_a_path_and_its_measured_curve_stay_with_their_design(serving, tmp_path, open_tab, coarse):
    server = serving(tmp_path, text=coarse)
    try:
        tab = open_tab(server.address)
        tab.page.get_by_text("Path", exact=True).click()
        pane = tab.find("path-pane")
        pane.get_by_label("To", exact=True).fill("5 m/s^2")
        pane.get_by_label("To", exact=True).press("Enter")
        pane.get_by_label("Equilibria", exact=True).fill("2")
        pane.get_by_label("Equilibria", exact=True).press("Enter")
        tab.find("path-start").click()
        tab.find("path-end").wait_for()
        measured = tmp_path / "measured.csv"
        measured.write_text("0,0\n5,1\n")
        tab.find("path-measured").set_input_files(measured)
        tab.find("path-misfit").wait_for()
        # Another design has neither the curve nor the ends that were typed.
        begin(tab, "beam")
        tab.find("document-name").get_by_text("beam.toml").wait_for()
        tab.find("path-curve").wait_for(state="detached")
        assert tab.find("path-table").count() == 0
        pane.get_by_text("No path yet").wait_for()
        assert not pane.get_by_label("To", exact=True).input_value().startswith("5 ")
        # The own one has both curves again, until it is changed.
        reopen(tab, "finger.toml")
        tab.find("path-curve").wait_for()
        assert tab.find("past-note").count() == 0
        tab.find("path-misfit").wait_for()
        tab.page.get_by_test_id("mode-design").click()
        length = tab.find("parameter-length").get_by_role("textbox", name="length")
        length.fill("50 mm")
        length.press("Enter")
        tab.page.get_by_test_id("mode-simulate").click()
        tab.find("past-note").get_by_text("before its last change").wait_for()
        tab.page.keyboard.press("Control+z")
        tab.find("past-note").wait_for(state="detached")
        assert tab.errors == []
    finally:
        server.stop()


def test_an_empty_stage_is_empty(serving, tmp_path, open_tab, coarse):
    server = serving(tmp_path, text=coarse)
    try:
        tab = open_tab(server.address)
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        tab.page.keyboard.press("r")
        tab.find("equilibrium").wait_for()
        tab.page.keyboard.press("Control+o")
        tab.find("start-empty").click()
        stage = tab.find("empty-stage")
        stage.wait_for()
        tab.until("voxsoft.triangles === 0")
        assert tab.find("mode-design").get_attribute("aria-current") == "page"
        assert tab.page.locator(".badge.bad, .faults, .cm-lintRange-error").count() == 0
        assert tab.find("legend").count() == 0
        assert "Nothing is here yet" in tab.find("sentence").inner_text()
        tab.shot("empty-stage")
        tab.find("mode-simulate").click()
        tab.page.get_by_text("Nothing to simulate yet").wait_for()
        assert tab.find("equilibrium").count() == 0
        # A reload shows the same.
        tab.page.reload()
        stage.wait_for()
        tab.find("mode-design").click()
        tab.find("stage-cylinder").click()
        tab.until("voxsoft.triangles > 0")
        stage.wait_for(state="detached")
        tab.find("shapes-cylinder").wait_for()
        # Without its only shape the stage is empty again, and no old body stands on it.
        tab.page.keyboard.press("Control+z")
        stage.wait_for()
        tab.until("voxsoft.triangles === 0")
        assert tab.page.locator(".badge.bad, .faults").count() == 0
        assert tab.errors == []
    finally:
        server.stop()


def test_a_broken_design_shows_no_body_of_another(serving, tmp_path, open_tab, coarse):
    broken = coarse.replace('shape = "body"', 'shape = "boddy"')
    (tmp_path / "broken.toml").write_text(broken)
    server = serving(tmp_path, text=coarse)
    try:
        tab = open_tab(server.address, mode="design")
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        with tab.page.expect_file_chooser() as chooser:
            tab.page.get_by_role("button", name="Open a file…").click()
        chooser.value.set_files(tmp_path / "broken.toml")
        tab.page.get_by_text("No body yet").first.wait_for()
        tab.until("voxsoft.triangles === 0")
        assert tab.page.get_by_text("the last design that was good").count() == 0
        tab.find("faults").wait_for()
    finally:
        server.stop()


def test_undo_stops_at_the_start_of_a_document(serving, tmp_path, open_tab, coarse):
    server = serving(tmp_path, text=coarse)
    try:
        tab = open_tab(server.address, mode="design")
        page = tab.page
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        length = tab.find("parameter-length").get_by_role("textbox", name="length")
        for value in ("45 mm", "50 mm", "55 mm"):  # as quickly as the keys can be sent
            length.fill(value)
            length.press("Enter")
        tab.until("document.querySelector('.cm-content').innerText.includes('55 mm')")
        page.keyboard.press("Control+o")
        tab.find("start-empty").click()
        tab.find("discard").click()
        tab.find("stage-box").click()
        tab.find("shapes-box").wait_for()
        page.mouse.move(*tab.middle())
        undo = page.get_by_role("button", name="Undo (Ctrl+Z)")
        undo.click()
        tab.find("empty-stage").wait_for()
        undo.click()
        undo.click()
        toast = tab.find("toast").filter(has_text="Nothing more to undo in robot.toml")
        toast.wait_for()
        tab.find("document-name").get_by_text("robot.toml").wait_for()
        page.get_by_role("button", name="Redo").click()
        tab.find("shapes-box").wait_for()
        undo.click()
        tab.find("empty-stage").wait_for()
        undo.click()
        toast.get_by_role("button", name="Back to finger.toml").click()
        tab.find("document-name").get_by_text("finger.toml").wait_for()
        # Each typed value is a step of its own.
        for value in ("50 mm", "45 mm", "40 mm"):
            undo.click()
            tab.until(f"document.querySelector('.cm-content').innerText.includes({first(value)!r})")
        assert tab.errors == []
    finally:
        server.stop()


def test_a_new_design_that_is_left_is_listed_as_recent(bare, open_tab):
    tab = open_tab(bare.address, mode="design")
    tab.find("start-empty").click()
    tab.find("stage-sphere").click()
    tab.find("shapes-sphere").wait_for()
    tab.page.keyboard.press("Control+o")
    tab.find("robot-bellows").click()
    tab.find("discard").click()
    tab.find("document-name").get_by_text("bellows.toml").wait_for()
    tab.page.keyboard.press("Control+o")
    recent = tab.find("start-recent").get_by_role("button").filter(has_text="robot.toml")
    recent.get_by_text("not saved yet").wait_for()
    recent.click()
    tab.find("shapes-sphere").wait_for()
    assert tab.errors == []
