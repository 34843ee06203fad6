"""Pressures of supplies over time, drawn once the motion is solved for."""

from pathlib import Path

import pytest

pytestmark = pytest.mark.browser

FINGER = Path(__file__).parents[3] / "examples" / "pulsed_finger.toml"


def test_the_pressure_of_each_chamber_is_drawn_over_time(serving, tmp_path, open_tab):
    text = FINGER.read_text()
    # A short one, for a moment.
    text = text.replace("end_time = ", 'end_time = "40 ms" # ')
    server = serving(tmp_path, text=text)
    try:
        tab = open_tab(server.address)
        tab.page.get_by_text("Simulate", exact=True).click()
        tab.page.get_by_text("Chambers", exact=True).click()
        tab.page.get_by_text("No chamber was filled over time yet").wait_for()
        tab.page.get_by_role("button", name="Solve", exact=True).first.click()
        tab.find("plot-chambers").wait_for()
        # The requested solution is done, and its motion can be shown again.
        assert tab.find("not-live").count() == 0
        tab.page.get_by_label("Show the motion that was solved (Space)").wait_for()
        tab.shot("chambers")
        tab.page.get_by_label("What of the chambers").select_option("volume")
        tab.page.get_by_label("Volume of the chambers over time").wait_for()
        tab.page.reload()
        tab.page.get_by_text("Chambers", exact=True).click()
        tab.find("plot-chambers").wait_for()
        assert tab.errors == []
    finally:
        server.stop()
