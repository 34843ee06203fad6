"""An audit of the page by axe: start screen, modes and sheets, dark and light.

axe-core comes with the page's development dependencies (`npm ci` in studio/); without it, or
without Chromium, these tests are skipped. It sees names, roles, contrast and structure.
"""

import pytest
from auditing import Audit
from fingers import open_atlas, study_fingers

pytestmark = pytest.mark.browser

MODES = ("design", "simulate", "calibrate", "optimize", "make", "runs")
KEYS = {"Control+k": "palette", "?": "shortcuts", "Control+Shift+S": "save-sheet"}
SCHEMES = ("dark", "light")

#: Panes are loaded when they are first shown.
LOADED = """(() => {
  const panes = [...document.querySelectorAll(".pane-host")];
  return panes.length > 0 && panes.every((one) => one.childElementCount > 0);
})()"""


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
    tab.find("document-name").click()
    tab.find("versions-none").wait_for()
    audit.look("versions")
    page.keyboard.press("Escape")
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


HISTORY = """
[[loads]]
kind = "force"
region = { x = ["= length", "= length"] }
value = [0, 0, "10 mN"]
history = { time = ["0 s", "1 s"], factor = [0, 1] }
"""


@pytest.mark.parametrize("scheme", SCHEMES)
def test_materials_timeline_and_fineness_are_accessible(
    axe, serving, tmp_path, open_tab, coarse, scheme
):
    text = coarse.replace("ecoflex-00-30-lattice", "ecoflex-00-30") + HISTORY
    server = serving(tmp_path, text=text)
    try:
        tab = open_tab(server.address, scheme=scheme, mode="design")
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        audit = Audit(tab)
        tab.page.get_by_role("tab", name="Materials").click()
        item = tab.find("material-ecoflex-00-30")
        item.get_by_role("button", expanded=False).click()
        item.get_by_text("Copy into the design").wait_for()
        audit.look("materials")
        tab.find("mode-simulate").click()
        tab.page.get_by_role("tab", name="Timeline").click()
        tab.find("timeline-pane").get_by_role("slider").first.focus()
        audit.look("timeline")
        tab.page.get_by_role("tab", name="Run", exact=True).click()
        tab.page.keyboard.press("r")
        tab.find("fineness-open").click()
        tab.find("halve").wait_for()
        audit.look("fineness")
        assert audit.found == {}, audit.report()
        assert tab.errors == []
    finally:
        server.stop()


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_atlas_and_the_versions_of_a_design_are_accessible(
    axe, serving, open_tab, tmp_path, coarse, scheme
):
    server = serving(tmp_path, text=study_fingers(coarse, tmp_path / "runs" / "fingers"))
    tab = open_tab(server.address, scheme=scheme, mode="runs", symbols=False)
    audit, page = Audit(tab), tab.page
    open_atlas(tab)
    audit.look("map")
    page.get_by_label("Arrangement").select_option("grid")
    page.locator(".trial-frame.is-best").click()
    tab.find("trial-card").wait_for()
    audit.look("grid")
    tab.find("take").click()
    tab.find("document-name").get_by_text("edited").wait_for()
    page.keyboard.press("Control+s")
    tab.find("save-now").click()
    tab.find("save-sheet").wait_for(state="detached")
    tab.find("document-name").click()
    tab.find("version-difference").wait_for()
    audit.look("versions")
    server.stop()
    assert audit.found == {}, audit.report()


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
