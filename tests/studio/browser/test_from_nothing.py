"""Robots built from nothing by the mouse alone, with no text: how many actions it takes."""

import pytest
from waiting import until

import voxsoft as vs

pytestmark = pytest.mark.browser


class Hand:
    """Counts what a person does: presses, choices and numbers that are typed."""

    def __init__(self, tab):
        self.tab, self.actions = tab, 0

    def press(self, *, text=None, name=None, test_id=None, first=False):
        where = self.tab.page.get_by_role("button", name=name, exact=True) if name else None
        where = self.tab.find(test_id) if test_id else where
        where = self.tab.page.get_by_text(text, exact=True) if text else where
        (where.first if first else where).click()
        self.actions += 1

    def choose(self, label, value):
        self.tab.page.get_by_label(label, exact=True).select_option(value)
        self.actions += 1

    def item(self, label):
        self.tab.page.get_by_role("menuitem", name=label, exact=True).click()
        self.actions += 1

    def key(self, key):
        self.tab.page.locator(".viewport canvas").focus()
        self.tab.page.keyboard.press(key)
        self.actions += 1

    def body(self, dx=0, dy=0):
        x, y = self.tab.middle()
        self.tab.page.mouse.click(x + dx, y + dy)
        self.tab.find("face-verbs").wait_for()
        self.actions += 1


def test_a_chamber_from_nothing_to_rest_under_pressure(serving, tmp_path, open_tab):
    server = serving(tmp_path)
    try:
        tab = open_tab(server.address, mode="design")
        tab.page.wait_for_selector("[data-testid='design-form']")
        hand = Hand(tab)
        hand.press(test_id="templates")
        hand.press(test_id="template-empty")
        tab.page.get_by_text("None yet. Add a box or a cylinder").wait_for()
        topology = tab.page.evaluate("voxsoft.topology")
        hand.choose("Add a shape", "box")
        tab.until(f"voxsoft.topology !== {topology} && voxsoft.triangles > 0")
        tab.shot("nothing-1-box")
        topology = tab.page.evaluate("voxsoft.topology")
        hand.press(name="What to do with box")
        hand.item("Hollow it out")
        tab.until(f"voxsoft.topology !== {topology} && voxsoft.triangles > 0")
        hand.body()
        hand.press(test_id="here-clamp")
        tab.find("face-verbs").wait_for(state="detached")
        hand.key("1")
        hand.key("x")
        hand.body(60, 40)
        tab.shot("nothing-2-wall")
        hand.press(test_id="here-fill")
        tab.find("face-verbs").wait_for(state="detached")
        hand.key("r")
        tab.until("voxsoft.state === 'at-rest'")
        tab.shot("nothing-3-rest")
        tab.page.keyboard.press("Control+s")
        tab.page.get_by_role("button", name="Save", exact=True).last.click()
        file = tmp_path / "robot.toml"
        until(file.exists)
        design = vs.load(file)
        assert [load.kind for load in design.loads] == ["pressure"]
        result = vs.simulate(design)
        assert result.status == "ok"
        assert result.cavity_volumes[0] > 1.01 * result.mesh.cavities[0].volume
        assert tab.errors == []
        # The aim of a first user: a dozen actions.
        assert hand.actions <= 12
    finally:
        server.stop()
