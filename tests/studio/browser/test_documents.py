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
        pane.get_by_text("No path yet").wait_for()
        assert not pane.get_by_label("To", exact=True).input_value().startswith("5 ")
        # The own one has the curve again, until it is changed.
        reopen(tab, "finger.toml")
        tab.find("path-curve").wait_for()
        assert tab.find("past-note").count() == 0
        assert tab.find("path-misfit").count() == 0
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
