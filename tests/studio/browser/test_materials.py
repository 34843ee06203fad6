"""The browser of materials: find one, read its data, and make a part of it."""

import pytest

pytestmark = pytest.mark.browser

TIP = """
[[parts]]
name = "tip"
shape = { kind = "box", size = ["10 mm", "10 mm", "10 mm"], corner = ["40 mm", 0, 0] }
material = "ecoflex-00-30-lattice"
"""


@pytest.fixture
def design(serving, tmp_path, open_tab, coarse):
    server = serving(tmp_path, text=coarse)
    tab = open_tab(server.address, mode="design")
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    yield tab
    assert tab.errors == []
    server.stop()


def has_text(tab, piece):
    tab.until(f"document.querySelector('.cm-content')?.innerText.includes({piece!r})")


def browse(tab):
    tab.page.get_by_role("button", name="Browse…").click()
    pane = tab.find("materials-pane")
    tab.find("material-ecoflex-00-30").wait_for()
    return pane


def test_one_press_makes_the_only_part_of_a_material(design):
    pane = browse(design)
    assert design.find("material-ecoflex-00-30-lattice").get_by_text("in use").count() == 1
    pane.get_by_label("Search materials").fill("dragon 30A")
    design.find("material-ecoflex-00-30").wait_for(state="detached")
    pane.get_by_role("button", name="Use dragon-skin-30 for body", exact=True).click()
    has_text(design, 'material = "dragon-skin-30"')
    design.find("material-dragon-skin-30").get_by_text("in use").wait_for()
    design.page.keyboard.press("Control+z")
    has_text(design, 'material = "ecoflex-00-30-lattice"')


def test_unstated_values_stay_empty(design):
    browse(design)
    item = design.find("material-ecoflex-00-30")
    item.get_by_role("button", expanded=False).click()
    facts = item.locator(".facts").inner_text()
    assert "Shore hardness\n00-30" in facts
    assert "Tested stretch\nnot stated" in facts
    design.page.get_by_role("img", name="Stress of ecoflex-00-30 over strain").wait_for()
    design.shot("materials")


def test_models_are_filtered_and_numbers_sorted(design):
    pane = browse(design)
    pane.get_by_label("Model", exact=True).select_option("lattice")
    names = pane.locator(".material-name")
    assert len(names.all()) == 3
    pane.get_by_label("Model", exact=True).select_option("")
    pane.get_by_label("Sort by", exact=True).select_option("young")
    assert names.first.inner_text().startswith("dragon-skin-fx-pro-slacker")


def test_a_card_becomes_a_material_of_the_design(design):
    browse(design)
    item = design.find("material-ecoflex-00-30")
    item.get_by_role("button", expanded=False).click()
    item.get_by_role("button", name="Copy into the design").click()
    has_text(design, "ecoflex-00-30-own")
    design.find("material-ecoflex-00-30-own").get_by_text("of this design").wait_for()


def test_a_material_is_dragged_on_a_part(design):
    browse(design)
    design.find("material-dragon-skin-20").drag_to(design.find("parts-0"))
    has_text(design, 'material = "dragon-skin-20"')


def test_a_part_of_several_is_chosen_for_and_a_mixture_is_named(
    serving, tmp_path, open_tab, coarse
):
    server = serving(tmp_path, text=coarse + TIP)
    try:
        tab = open_tab(server.address, mode="design", scheme="light")
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        tab.find("parts-1").get_by_role("button", expanded=False).click()
        tab.page.get_by_role("button", name="Browse materials for part 2").click()
        pane = tab.find("materials-pane")
        tab.find("material-dragon-skin-10").wait_for()
        assert pane.get_by_label("For part").input_value() == "1"
        item = tab.find("material-dragon-skin-10")
        item.get_by_role("button", expanded=False).click()
        item.get_by_text("Mixes rubber with a spring lattice of body").wait_for()
        item.get_by_role("button", name="Use for tip").click()
        tab.find("materials-mixed").get_by_text("mixes a spring lattice with rubber").wait_for()
        tab.shot("materials-mixed")
        assert tab.errors == []
    finally:
        server.stop()
