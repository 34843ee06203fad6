"""The tools over the picture, and the speed of time."""

import pytest


def boxes(tab, selector):
    """Where elements are on the page: left, top, right and bottom of what encloses them all."""
    return tab.page.evaluate(
        """(selector) => {
          const found = [...document.querySelectorAll(selector)];
          const all = found.map((one) => one.getBoundingClientRect());
          return [
            Math.min(...all.map((b) => b.left)), Math.min(...all.map((b) => b.top)),
            Math.max(...all.map((b) => b.right)), Math.max(...all.map((b) => b.bottom)),
          ];
        }""",
        selector,
    )


def apart(one, other):
    return one[2] <= other[0] or other[2] <= one[0] or one[3] <= other[1] or other[3] <= one[1]


@pytest.mark.parametrize("size", [(1600, 900), (1280, 720), (1280, 560), (1100, 420)])
def test_the_legend_leaves_room_for_the_cube(served, open_tab, size):
    tab = open_tab(served.address, mode="runs", size=size)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.find("play").click()
    tab.until("document.querySelector('.legend-scale') !== null")
    tab.find("play").click()
    legend, cube = boxes(tab, ".legend"), boxes(tab, ".cube-face")
    stage = boxes(tab, ".view-stage")
    assert apart(legend, cube)
    for one in (legend, cube):
        assert stage[0] <= one[0]
        assert stage[1] <= one[1]
        assert one[2] <= stage[2]
        assert one[3] <= stage[3]


def test_slow_motion_shows_every_step_and_follows_the_keys(tab):
    speed = tab.page.get_by_label("Speed of time")
    speed.select_option("1/50")
    tab.find("play").click()
    tab.until("voxsoft.frame > 5")
    assert "Shown 50 times slower than real time." in tab.find("pane-run").inner_text()
    time, frame = tab.page.evaluate("[voxsoft.time, voxsoft.frame]")
    # A frame of the picture is 1/60 s of the clock, a fiftieth of it in time, or one step.
    assert time <= frame / 60 / 50 + 0.0005
    tab.until(f"document.querySelector('[data-testid=scrubber]').max >= {frame}")
    tab.page.locator(".viewport canvas").focus()
    tab.page.keyboard.press(".")
    tab.until("document.querySelector('.transport select').value === '0.1'")
    for slower in ("0.02", "0.005"):
        tab.page.keyboard.press(",")
        tab.until(f"document.querySelector('.transport select').value === '{slower}'")
    speed.select_option("auto")
    tab.until("document.querySelector('.transport select').value === 'auto'")
    assert tab.errors == []
