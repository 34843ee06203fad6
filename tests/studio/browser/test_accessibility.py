"""An audit of the page by axe: start screen, modes and sheets, dark and light.

axe-core comes with the page's development dependencies (`npm ci` in studio/); without it, or
without Chromium, these tests are skipped. It sees names, roles, contrast and structure.
"""

from pathlib import Path

import pytest

pytestmark = pytest.mark.browser

AXE = Path(__file__).parents[3] / "studio/node_modules/axe-core/axe.min.js"
MODES = ("design", "simulate", "calibrate", "optimize", "runs")
KEYS = {"Control+k": "palette", "?": "shortcuts", "Control+Shift+S": "save-sheet"}
SCHEMES = ("dark", "light")

#: What axe found that is serious or critical, as lines that name the rule and the element.
FOUND = """async () => {
  const run = await axe.run(document, { resultTypes: ["violations"] });
  return run.violations
    .filter((one) => ["serious", "critical"].includes(one.impact))
    .flatMap((one) => one.nodes.map((node) =>
      `${one.impact} ${one.id}: ${node.target.join(" ")} ${node.html.slice(0, 160)} ` +
      (node.any[0]?.message ?? node.all[0]?.message ?? node.none[0]?.message ?? "")));
}"""

#: Panes are loaded when they are first shown.
LOADED = """(() => {
  const panes = [...document.querySelectorAll(".pane-host")];
  return panes.length > 0 && panes.every((one) => one.childElementCount > 0);
})()"""


class Audit:
    """Collects what is found in one page after the other."""

    def __init__(self, tab):
        self.tab, self.found = tab, {}

    def look(self, where):
        page = self.tab.page
        if not page.evaluate("typeof axe === 'object'"):
            page.evaluate(AXE.read_text(encoding="utf-8"))
        page.mouse.move(2, 400)
        for line in page.evaluate(FOUND):
            self.found.setdefault(line, where)

    def report(self):
        return "\n".join(f"{where}: {line}" for line, where in self.found.items())


@pytest.fixture
def axe():
    if not AXE.is_file():
        pytest.skip("axe-core is not installed: npm ci in studio/")


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_start_screen_is_accessible(axe, bare, open_tab, scheme):
    tab = open_tab(bare.address, scheme=scheme, mode="design")
    tab.find("start").wait_for()
    audit = Audit(tab)
    audit.look("start")
    tab.find("start-new").click()
    tab.find("new-robot").get_by_label("Heat").check()
    tab.find("new-begin").wait_for()
    audit.look("new")
    assert audit.found == {}, audit.report()


@pytest.mark.parametrize("scheme", SCHEMES)
def test_every_mode_and_sheet_is_accessible(axe, served, open_tab, scheme):
    tab = open_tab(served.address, scheme=scheme, mode="design")
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    audit, page = Audit(tab), tab.page
    for mode in MODES:
        tab.find(f"mode-{mode}").click()
        tab.until(LOADED)
        audit.look(mode)
        if mode == "design":
            tab.find("add-shape").click()
            tab.find("shape-picker").wait_for()
            audit.look("shape picker")
            page.keyboard.press("Escape")
            tab.find("shapes-body").get_by_role("button", name="body").first.click()
            tab.find("shape-size-y").wait_for()
            audit.look("chosen shape")
    tab.find("mode-design").click()
    for keys, sheet in KEYS.items():
        page.locator(".viewport canvas").focus()
        page.keyboard.press(keys)
        tab.find(sheet).wait_for()
        audit.look(sheet)
        page.keyboard.press("Escape")
        tab.find(sheet).wait_for(state="detached")
    field = tab.find("parameter-length").get_by_role("textbox", name="length", exact=True)
    field.fill("45 mm")
    field.press("Enter")
    tab.find("document-name").get_by_text("edited").wait_for()
    page.keyboard.press("Control+o")
    tab.find("start-empty").click()
    tab.find("discard-sheet").wait_for()
    audit.look("discard")
    page.keyboard.press("Escape")
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+o")
    tab.find("start-tour").click()
    tab.find("tour").wait_for()
    audit.look("tour")
    page.keyboard.press("Escape")
    assert audit.found == {}, audit.report()
    assert tab.errors == []


def test_delete_closes_the_pane_whose_tab_has_the_focus(served, open_tab):
    tab = open_tab(served.address, mode="design")
    pane, view = tab.page.get_by_role("tab", name="Text"), tab.page.get_by_role("tab", name="View")
    pane.focus()
    tab.page.keyboard.press("Delete")
    pane.wait_for(state="detached")
    view.focus()
    tab.page.keyboard.press("Delete")
    assert view.count() == 1
    assert tab.errors == []
