"""Narrow windows, as of a page at 150 %: nothing wraps out of sight, numbers keep units."""

import pytest

pytestmark = [pytest.mark.browser, pytest.mark.long]

PLACED = """
schema = "voxsoft/1"
name = "a-design-with-a-rather-long-name"
voxel_size = "5 mm"

[shapes]
body = { kind = "box", size = ["40.25 mm", "10 mm", "10 mm"], center = ["19.95 mm", 0, "-27.3 mm"] }

[[parts]]
shape = "body"
material = "ecoflex-00-30-lattice"

[[clamps]]
region = { x = ["-0.175 mm", "-0.175 mm"] }
"""
# Controls of the header that are cut, or lie below another line.
HEADER = """(() => {
  const bar = document.querySelector('[data-testid=top-bar]').getBoundingClientRect();
  return [...document.querySelectorAll('[data-testid=top-bar] button')]
    .map((one) => [one.getAttribute('aria-label') ?? one.innerText, one.getBoundingClientRect()])
    .filter(([, at]) => at.top < bar.top || at.bottom > bar.bottom || at.right > innerWidth
      || at.width < 20)
    .map(([name]) => name);
})()"""
# Fields of three numbers whose text is wider than they are.
CUT = """[...document.querySelectorAll('.field.tuple input')]
  .filter((one) => one.checkVisibility() && one.scrollWidth > one.clientWidth)
  .map((one) => one.getAttribute('aria-label'))"""


@pytest.mark.parametrize("size", [(960, 600), (1024, 700), (1280, 720)])
def test_nothing_is_cut_in_a_narrow_window(serving, tmp_path, open_tab, size):
    server = serving(tmp_path, PLACED, "placed.toml")
    try:
        tab = open_tab(server.address, mode="design", symbols=False, size=size)
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        assert tab.page.evaluate(HEADER) == []
        assert tab.find("document-name").bounding_box()["width"] > 70
        tab.find("shapes-body").get_by_role("button").first.click()
        tab.page.get_by_label("Center x", exact=True).wait_for()
        assert tab.page.get_by_label("Center x", exact=True).input_value() == "19.95 mm"
        assert tab.page.evaluate(CUT) == []
        tab.shot(f"narrow-{size[0]}")
        assert tab.errors == []
    finally:
        server.stop()
