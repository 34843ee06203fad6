"""Actions of a person in the studio, one by one, and their number."""

from waiting import until

import voxsoft as vs


class Hand:
    """Counts the actions of a person: presses, choices and typed numbers."""

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
        """Actions offered at the face that was pressed; the body comes anew with them."""
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


#: Place on the page of the middle of the outermost face along an axis.
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
    """Press a kind of those that stand where there are no shapes yet; its fields are open then."""
    renewed(tab, lambda: hand.press(test_id=f"start-{kind}"))


def add_shape(hand, kind):
    """Open the list of all kinds, and press one; the shape is chosen then, with its fields open."""
    hand.press(name="Add a shape")
    hand.press(test_id=f"kind-{kind}")


def saved(tab, file):
    """The design, saved under its own name."""
    tab.page.keyboard.press("Control+s")
    tab.page.get_by_role("button", name="Save", exact=True).last.click()
    until(file.exists)
    return vs.load(file)
