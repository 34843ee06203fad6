"""Ready features and actions that are found by their names."""

import pytest

pytestmark = pytest.mark.browser


@pytest.mark.long
def test_a_bellows_from_nothing_is_solved_with_error_bars(empty):
    tab, hand = empty
    hand.press(test_id="start-bellows")
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 1000")
    tab.find("parameter-folds").wait_for()
    tab.shot("feature-bellows")
    hand.press(test_id="mode-simulate")
    hand.press(test_id="rest")
    tab.until("voxsoft.state === 'at-rest'")
    tab.page.get_by_text("±").first.wait_for()
    assert tab.errors == []


def test_the_palette_adds_shapes_and_entries(served, open_tab):
    tab = open_tab(served.address, mode="simulate", symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    for words, entry in (("add torus", "shapes-torus"), ("add fixture", "clamps-1")):
        tab.page.keyboard.press("Control+k")
        tab.find("palette").wait_for()
        tab.page.keyboard.type(words)
        tab.page.keyboard.press("Enter")
        tab.find(entry).wait_for()
    tab.page.keyboard.press("Control+k")
    tab.page.keyboard.type("stl")
    tab.page.keyboard.press("Enter")
    tab.until("document.activeElement?.getAttribute('aria-label') === 'Unit of the surface'")
    tab.page.get_by_role("button", name="Undo").click()
    tab.page.get_by_role("button", name="Undo").click()
    assert tab.errors == []
