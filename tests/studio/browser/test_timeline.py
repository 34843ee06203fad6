"""Histories over time: points are dragged, added, removed and typed, each as one step of undo."""

import pytest

pytestmark = pytest.mark.browser

HISTORIES = """
[histories]
breath = { sine = { period = "1 s" }, repeat = 2 }

[[loads]]
kind = "force"
region = { x = ["= length", "= length"] }
value = [0, 0, "10 mN"]
history = { time = ["0 s", "500 ms", "1 s"], factor = [0, 1, 0.5] }

[[loads]]
kind = "force"
region = { x = ["= length", "= length"] }
value = [0, "5 mN", 0]
history = "breath"
"""

ROW = "history-loads-1-history"


@pytest.fixture
def server(serving, tmp_path, coarse):
    one = serving(tmp_path, text=coarse + HISTORIES)
    yield one
    one.stop()


@pytest.fixture
def timeline(server, open_tab):
    tab = open_tab(server.address)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.page.get_by_text("Timeline", exact=True).click()
    tab.find(ROW).wait_for()
    yield tab
    assert tab.errors == []


def points(tab):
    found = tab.find(ROW).get_by_role("slider")
    return [one.get_attribute("aria-valuetext") for one in found.all()]


def is_now(tab, *expected):
    sliders = f"document.querySelectorAll('[data-testid=\"{ROW}\"] [role=slider]')"
    texts = f"[...{sliders}].map((one) => one.getAttribute('aria-valuetext')).join('; ')"
    tab.until(f"{texts} === {'; '.join(expected)!r}")


FIRST, MIDDLE, LAST = "0 s, factor 0", "0.5 s, factor 1", "1 s, factor 0.5"


def test_a_point_is_dragged_as_one_step(timeline):
    assert points(timeline) == [FIRST, MIDDLE, LAST]
    box = timeline.find(ROW).get_by_role("slider").nth(1).bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    mouse = timeline.page.mouse
    mouse.move(x, y)
    mouse.down()
    for step in range(1, 9):
        mouse.move(x + 4 * step, y + 3 * step)
    mouse.up()
    is_another = f"document.querySelectorAll('[data-testid=\"{ROW}\"] [role=slider]')[1]"
    timeline.until(f"{is_another}.getAttribute('aria-valuetext') !== {MIDDLE!r}")
    moved = points(timeline)
    assert moved[0] == FIRST
    assert moved[2] == LAST
    timeline.find("document-name").get_by_text("edited").wait_for()
    timeline.shot("timeline")
    timeline.page.keyboard.press("Control+z")
    is_now(timeline, FIRST, MIDDLE, LAST)


def test_the_keyboard_moves_adds_and_removes(timeline):
    point = timeline.find(ROW).get_by_role("slider").nth(1)
    point.focus()
    point.press("ArrowDown")
    is_now(timeline, FIRST, "0.5 s, factor 0.95", LAST)
    point.press("Shift+ArrowRight")
    is_now(timeline, FIRST, "0.51 s, factor 0.95", LAST)
    timeline.page.keyboard.press("Control+z")
    is_now(timeline, FIRST, "0.5 s, factor 0.95", LAST)
    point.press("Enter")
    is_now(timeline, FIRST, "0.5 s, factor 0.95", "0.75 s, factor 0.725", LAST)
    timeline.find(ROW).get_by_role("slider").nth(2).press("Delete")
    is_now(timeline, FIRST, "0.5 s, factor 0.95", LAST)


RECORD = """([row]) => {
  const point = document.querySelectorAll(`[data-testid="${row}"] [role=slider]`)[1];
  window.seen = [];
  new MutationObserver(() => window.seen.push(Number(point.getAttribute("aria-valuenow"))))
    .observe(point, { attributes: true, attributeFilter: ["aria-valuenow"] });
}"""


def test_quick_steps_never_jump_back(timeline):
    """Documents of earlier steps arrive while later ones are made; none of those is lost."""
    point = timeline.find(ROW).get_by_role("slider").nth(1)
    point.focus()
    timeline.page.evaluate(RECORD, [ROW])
    for _ in range(8):
        timeline.page.keyboard.press("ArrowDown")
    is_now(timeline, FIRST, "0.5 s, factor 0.6", LAST)
    timeline.find("document-name").get_by_text("edited").wait_for()
    timeline.page.keyboard.press("Control+s")
    timeline.find("document-name").get_by_text("edited").wait_for(state="detached")
    seen = timeline.page.evaluate("window.seen")
    assert seen == sorted(seen, reverse=True)
    assert seen[-1] == pytest.approx(0.6)


def test_numbers_are_typed_and_the_text_keeps_its_units(timeline, server):
    timeline.find(ROW).get_by_role("slider").nth(1).focus()
    field = timeline.find(ROW).get_by_label("Time 2", exact=True)
    field.fill("0.3 s")
    field.press("Enter")
    is_now(timeline, FIRST, "0.3 s, factor 1", LAST)
    # The drawn state is ahead of the document: there is something to save once that has it.
    timeline.find("document-name").get_by_text("edited").wait_for()
    timeline.page.keyboard.press("Control+s")
    timeline.find("document-name").get_by_text("edited").wait_for(state="detached")
    assert '"300 ms"' in server.source.read_text()


def test_a_double_click_adds_a_point(timeline):
    plot = timeline.find(ROW).locator("svg")
    box = plot.bounding_box()
    plot.dblclick(position={"x": 0.3 * box["width"], "y": 0.7 * box["height"]})
    timeline.until(
        f"document.querySelectorAll('[data-testid=\"{ROW}\"] [role=slider]').length === 4"
    )


def test_histories_without_a_table_are_drawn_with_their_text(timeline):
    breath = timeline.find("history-histories-breath")
    assert "sine of 0 to 1, period 1 s" in breath.inner_text()
    assert "Force (1 is 5 mN)" in breath.inner_text()
    assert breath.get_by_role("slider").count() == 0


def test_a_load_without_a_history_gets_one(timeline):
    timeline.page.get_by_role("button", name="Add a history to Gravity").click()
    timeline.find("history-loads-0-history").get_by_role("slider").first.wait_for()
    assert timeline.find("history-loads-0-history").get_by_role("slider").count() == 2


def test_it_fits_a_small_window_in_light(server, open_tab):
    tab = open_tab(server.address, size=(1280, 720), scheme="light")
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.page.get_by_text("Timeline", exact=True).click()
    tab.find(ROW).wait_for()
    tab.find(ROW).get_by_role("slider").nth(1).focus()
    tab.page.keyboard.press(" ")
    tab.until("voxsoft.time > 0.2")
    tab.shot("timeline-light")
    wide = "document.querySelector('[data-testid=timeline-pane]')"
    assert tab.page.evaluate(f"{wide}.scrollWidth <= {wide}.clientWidth")
    assert tab.errors == []


FINGER = """

[[loads]]
kind = "force"
region = { x = ["= length", "= length"] }
value = [0, 0, "10 mN"]
history = "breath"

[histories]
breath = { time = ["0 s", "1 s"], factor = [0, 1] }
"""
HAND = """
schema = "voxsoft/1"
name = "hand"
voxel_size = "5 mm"

[[bodies]]
name = "left"
design = "finger.toml"

[[bodies]]
name = "right"
design = "finger.toml"
position = [0, "80 mm", 0]
"""


def test_histories_in_the_file_of_a_body_are_drawn_and_say_where_they_are(
    serving, open_tab, tmp_path, coarse
):
    (tmp_path / "finger.toml").write_text(coarse + FINGER)
    server = serving(tmp_path, HAND, "hand.toml")
    try:
        tab = open_tab(server.address)
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        tab.page.get_by_text("Timeline", exact=True).click()
        row = tab.find("history-bodies-0-design-histories-breath")
        words = row.inner_text()
        assert "of left" in words
        assert "of right" in words
        assert "written in finger.toml, changed there" in words
        assert row.get_by_role("slider").count() == 0
        tab.shot("timeline-bodies")
        assert tab.errors == []
    finally:
        server.stop()
