"""After every main action every mode is there: whole, with all its panes, also after a reload.

In dark and in light, on a small screen, a usual one and a very large one. One page in a fresh
profile and one server, as a user works.
"""

import re

import pytest
from over_panels import OVER_PANELS
from waiting import until

pytestmark = pytest.mark.browser

# Long enough for the short jobs on two busy cores, in milliseconds.
JOB = 120_000

# Seconds until a mode is whole, where software draws a picture of 8 million pixels.
PATIENCE = 60.0

MODES = ("design", "simulate", "calibrate", "optimize", "make", "runs")

MEASURED = "s (mm),dz (mm)\n10,-0.3\n25,-1.7\n40,-4.0\n"

# Faults of the page as it stands, or "": a pane that is empty, has no size or failed, a
# page that is wider than its window, a word of the picture under a card, a bar or a banner.
FAULTS = """((mode) => {
  if (document.querySelector(`[data-testid=mode-${mode}][aria-current=page]`) === null)
    return `the mode ${mode} is not there`;
  const panes = [...document.querySelectorAll('.dock [data-testid^=pane-]')]
    .filter((pane) => pane.checkVisibility());
  if (panes.length < 2) return `${panes.length} panes are seen`;
  const name = (pane) => pane.dataset.testid;
  if (!panes.some((pane) => name(pane) === 'pane-view')) return 'there is no view';
  for (const pane of panes) {
    const { width, height } = pane.getBoundingClientRect();
    if (width < 50 || height < 50) return `${name(pane)} is ${width} by ${height} pixels`;
    const drawn = pane.querySelector('canvas, svg, input') !== null;
    if (!drawn && pane.innerText.trim().length < 10) return `${name(pane)} is blank`;
    if (pane.innerText.includes('stopped working')) return `${name(pane)} has failed`;
  }
  const wide = document.documentElement.scrollWidth;
  if (wide > innerWidth) return `the page is ${wide} pixels wide in a window of ${innerWidth}`;
  const over = OVER_PANELS;
  if (over) return over;
  for (const key of Object.keys(localStorage).filter((key) => key.startsWith('voxsoft.layout')))
    if (localStorage[key].includes('"views":[]')) return `${key} is kept without views`;
  return '';
})""".replace("OVER_PANELS", OVER_PANELS)


def visit(tab, mode):
    """Go to a mode, and wait until all of it is there."""
    tab.find(f"mode-{mode}").click()
    whole(tab, mode)


def whole(tab, mode):
    """Wait until there is no fault; a lasting one fails the test."""

    def fault():
        return tab.page.evaluate(f"{FAULTS}('{mode}')")

    until(lambda: fault() == "", lambda: f"in {mode}: {fault()}", PATIENCE)
    assert tab.errors == []


def reload(tab, mode):
    tab.page.reload()
    tab.find("link").get_by_text("connected", exact=True).wait_for()
    whole(tab, mode)


def state(*names):
    return " || ".join(f"voxsoft.state === '{name}'" for name in names)


class Actions:
    """Actions of a user, by name; the modes are visited after each."""

    def __init__(self, tab, folder):
        self.tab, self.page, self.folder = tab, tab.page, folder

    def open(self):
        self.tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")

    def edit(self):
        visit(self.tab, "design")
        rev = self.page.evaluate("voxsoft.rev")
        field = self.tab.find("parameter-length").get_by_role("textbox", name="length")
        field.fill("45 mm")
        field.press("Enter")
        self.tab.until(f"voxsoft.rev > {rev}")

    def save(self):
        self.page.keyboard.press("Control+s")
        self.tab.find("toast").get_by_text("Saved").wait_for()

    def undo(self):
        rev = self.page.evaluate("voxsoft.rev")
        self.page.get_by_role("button", name="Undo (Ctrl+Z)").click()
        self.tab.until(f"voxsoft.rev > {rev}")

    def redo(self):
        rev = self.page.evaluate("voxsoft.rev")
        self.page.get_by_role("button", name="Redo (Ctrl+Shift+Z)").click()
        self.tab.until(f"voxsoft.rev > {rev}")

    def play(self):
        visit(self.tab, "simulate")
        self.tab.find("play").click()
        self.tab.until("voxsoft.time > 0")

    def pause(self):
        if self.page.evaluate("voxsoft.state") == "playing":
            self.tab.find("play").click()
        self.tab.until(state("paused", "at-rest"))

    def rest(self):
        visit(self.tab, "simulate")
        self.tab.find("rest").click()
        self.tab.until(state("at-rest"))

    def look_back(self):
        self.page.keyboard.press("ArrowLeft")
        self.tab.until(state("past"))

    def reset(self):
        self.tab.find("reset").click()
        self.tab.until("voxsoft.time === 0")

    def keep_as_a_run(self):
        visit(self.tab, "simulate")
        self.page.get_by_role("button", name="Keep as a run").click()
        visit(self.tab, "runs")
        self.tab.find("runs-table").locator("tbody tr").first.wait_for(timeout=JOB)

    def change_the_view(self):
        visit(self.tab, "simulate")
        self.page.keyboard.press("x")
        self.page.keyboard.press("g")

    def study(self):
        visit(self.tab, "optimize")
        self.page.get_by_role("button", name="Add an objective").click()
        goal = self.tab.find("objectives-goal")
        goal.get_by_role("button", name="goal", exact=False).first.click()
        goal.get_by_label("Metric", exact=True).select_option("displacement")
        self.page.get_by_label("Sampler").select_option("random")
        self.page.get_by_role("textbox", name="Budget").fill("2")
        self.page.get_by_role("textbox", name="Budget").press("Enter")
        self.tab.find("study-start").click()
        self.page.locator("[data-testid=job-study][data-state=done]").wait_for(timeout=JOB)

    def open_a_trial(self):
        visit(self.tab, "optimize")
        self.tab.find("trials-table").locator("tbody tr").first.click()
        self.tab.find("document-name").get_by_text(re.compile("-study")).wait_for()

    def calibrate(self):
        visit(self.tab, "calibrate")
        self.page.get_by_role("button", name="Open the cantilever beam").click()
        self.tab.find("document-name").get_by_text("beam").wait_for()
        file = self.folder / "beam.csv"
        file.write_text(MEASURED)
        self.tab.find("measurement-file").set_input_files(file)
        self.tab.find("measured").get_by_text("3 stations").wait_for()
        for name, value in (("Generations", "1"), ("Population", "4")):
            self.page.get_by_role("textbox", name=name).fill(value)
            self.page.get_by_role("textbox", name=name).press("Enter")
        self.page.get_by_label("refine").uncheck()
        self.page.get_by_label("ask what the data determine").uncheck()
        self.tab.find("calibrate-start").click()
        self.page.locator("[data-testid=job-calibrate][data-state=done]").wait_for(timeout=JOB)

    def export(self):
        visit(self.tab, "design")
        self.tab.find("export").click()
        with self.page.expect_download():
            self.tab.find("export-toml").get_by_role("button").click()

    def new_from_a_template(self):
        self.page.keyboard.press("Control+k")
        self.page.keyboard.type("new from template")
        self.page.keyboard.press("Enter")
        self.tab.find("palette").wait_for(state="detached")

    def delete_a_run(self):
        visit(self.tab, "runs")
        row = self.tab.find("runs-table").locator("tbody tr").last
        row.hover()
        row.get_by_role("button", name="Delete").click()
        self.tab.find("toast").get_by_role("button", name="Undo").click()


ALL = [name for name, value in vars(Actions).items() if callable(value) and name[0] != "_"]
# Software draws each mode's view anew: all of them take minutes on two cores.
FEW = ["open", "rest", "save"]
SIZES = [(1280, 720), (1920, 1080), (3840, 2160)]


def name_of(value):
    if isinstance(value, tuple):
        return "x".join(map(str, value))
    return value if isinstance(value, str) else f"{len(value)} actions"


@pytest.mark.parametrize(
    ("chosen", "size", "scheme"),
    [
        (FEW, (1280, 720), "light"),
        (["open"], (3840, 2160), "dark"),
        *(
            pytest.param(ALL, size, scheme, marks=[pytest.mark.slow, pytest.mark.timeout(900)])
            for size in SIZES
            for scheme in ("dark", "light")
        ),
    ],
    ids=name_of,
)
def test_no_action_leaves_a_mode_blank(own_server, open_tab, tmp_path, chosen, size, scheme):
    tab = open_tab(own_server.address, mode="design", size=size, scheme=scheme)
    actions = Actions(tab, tmp_path)
    pairs = 0
    for number, name in enumerate(chosen):
        getattr(actions, name)()
        for mode in MODES:
            visit(tab, mode)
            tab.shot(f"{name_of(size)}-{scheme}-{number:02d}-{name}-{mode}")
            if chosen is ALL:
                reload(tab, mode)
            pairs += 1
    if chosen is not ALL:
        reload(tab, MODES[-1])
    print(f"{pairs} pairs of a mode and an action ({len(chosen)} actions)")
    assert pairs == len(MODES) * len(chosen)
