"""Robots built from nothing by the mouse alone, with no text: how many actions it takes."""

import pytest
from waiting import until

import voxsoft as vs

pytestmark = pytest.mark.browser


class Hand:
    """Counts what a person does: presses, choices and numbers that are typed."""

    def __init__(self, tab):
        self.tab, self.actions = tab, 0

    def press(self, *, name=None, test_id=None, then=None):
        """A button, and then an entry of the menu that it opens."""
        page = self.tab.page
        (
            self.tab.find(test_id) if test_id else page.get_by_role("button", name=name, exact=True)
        ).click()
        self.actions += 1
        if then:
            page.get_by_role("menuitem", name=then, exact=True).click()
            self.actions += 1

    def choose(self, label, value):
        self.tab.page.get_by_label(label, exact=True).select_option(value)
        self.actions += 1

    def number(self, field, text):
        field.fill(text)
        field.press("Enter")
        self.actions += 1

    def here(self, verb):
        """What is offered at the face that was pressed; the body comes anew with it."""
        renewed(self.tab, lambda: self.press(test_id=verb))

    def key(self, key):
        self.tab.page.locator(".viewport canvas").focus()
        self.tab.page.keyboard.press(key)
        drawn(self.tab)
        self.actions += 1

    def body(self, dx=0, dy=0):
        x, y = self.tab.middle()
        self.tab.page.mouse.click(x + dx, y + dy)
        self.tab.find("face-verbs").wait_for()
        self.actions += 1

    def face(self, axis, side):
        """Press the outermost face of the body along an axis, in its middle."""
        x, y = self.tab.page.evaluate(MIDDLE_OF_FACE, [axis, side])
        self.tab.page.mouse.click(x, y)
        self.tab.find("face-verbs").wait_for()
        self.actions += 1


#: Where the middle of the outermost face along an axis is on the page.
MIDDLE_OF_FACE = """([axis, side]) => {
    const all = [];
    for (let i = 0, at; (at = window.voxsoft.vertexPosition(i)) !== null; i++) all.push(at[axis]);
    const far = Math.max(...all.map((x) => side * x));
    const seen = [...all.keys()]
        .filter((i) => side * all[i] > far - 1e-4)
        .map((i) => window.voxsoft.screenOf(i));
    return [0, 1].map((k) => seen.reduce((sum, at) => sum + at[k], 0) / seen.length);
}"""


def drawn(tab):
    """The camera is where a key or a new body put it once it has been drawn."""
    tab.page.evaluate(
        "() => new Promise((drawn) => "
        "requestAnimationFrame(() => requestAnimationFrame(() => drawn(null))))"
    )


def renewed(tab, change):
    """Make a change, and wait until the body that comes of it is shown."""
    topology = tab.page.evaluate("voxsoft.topology")
    change()
    tab.until(f"voxsoft.topology !== {topology} && voxsoft.vertexPosition(0) !== null")


def first_shape(tab, hand, kind):
    renewed(tab, lambda: hand.choose("Add a shape", kind))


def saved(tab, file):
    """The design, saved under its own name."""
    tab.page.keyboard.press("Control+s")
    tab.page.get_by_role("button", name="Save", exact=True).last.click()
    until(file.exists)
    return vs.load(file)


@pytest.fixture
def empty(serving, tmp_path, open_tab):
    """An empty design in the mode Design, and the hand that opened it."""
    server = serving(tmp_path)
    try:
        tab = open_tab(server.address, mode="design", symbols=False)
        tab.page.wait_for_selector("[data-testid='design-form']")
        hand = Hand(tab)
        hand.press(test_id="templates")
        hand.press(test_id="template-empty")
        tab.page.get_by_text("None yet. Add a box or a cylinder").wait_for()
        yield tab, hand
        assert tab.errors == []
    finally:
        server.stop()


def test_a_chamber_from_nothing_to_rest_under_pressure(empty, tmp_path):
    tab, hand = empty
    first_shape(tab, hand, "box")
    tab.shot("nothing-1-box")
    renewed(tab, lambda: hand.press(name="What to do with box", then="Hollow it out"))
    hand.body()
    hand.here("here-clamp")
    hand.key("1")
    hand.key("x")
    hand.body(60, 40)
    tab.shot("nothing-2-wall")
    hand.here("here-fill")
    hand.key("r")
    tab.until("voxsoft.state === 'at-rest'")
    tab.shot("nothing-3-rest")
    design = saved(tab, tmp_path / "robot.toml")
    assert [load.kind for load in design.loads] == ["pressure"]
    result = vs.simulate(design)
    assert result.status == "ok"
    assert result.cavity_volumes[0] > 1.01 * result.mesh.cavities[0].volume
    # The aim of a first user: a dozen actions.
    assert hand.actions <= 12


def test_a_bending_finger_with_a_layer_from_nothing(empty, tmp_path):
    tab, hand = empty
    first_shape(tab, hand, "box")
    entry = tab.find("shapes-box")
    entry.get_by_role("button", expanded=False).first.click()
    hand.actions += 1
    for axis, size in (("x", "100 mm"), ("z", "30 mm")):
        field = entry.get_by_label(f"Size {axis}", exact=True)
        renewed(tab, lambda field=field, size=size: hand.number(field, size))
    renewed(tab, lambda: hand.press(name="What to do with box", then="Hollow it out"))
    drawn(tab)
    for axis, side, verb in ((0, 1, "clamp"), (2, 1, "layer")):
        hand.face(axis, side)
        hand.here(f"here-{verb}")
    hand.key("3")  # from the left, at the free end
    hand.face(0, -1)
    hand.here("here-probe")
    hand.key("1")
    hand.key("x")
    hand.body(60, 20)
    hand.here("here-fill")
    hand.key("r")
    tab.until("voxsoft.state === 'at-rest'")
    tab.shot("finger-rest")
    design = saved(tab, tmp_path / "robot.toml")
    assert [layer.name for layer in design.layers] == ["fabric"]
    bent = vs.simulate(design)
    assert bent.status == "ok"
    # The top cannot stretch: the free end rises.
    assert bent.probes["probe"][2] > 1e-4
    assert hand.actions <= 25
