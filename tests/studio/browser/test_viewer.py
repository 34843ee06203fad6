"""A result in one file: opened from disk, or in the cell of a notebook, with no server at all."""

import json
import tomllib

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Design
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.outputs.html import page_of, page_of_body

LOWEST = """(() => {
  let low = 1;
  for (let i = 0; voxsoft.vertexPosition(i); i++) low = Math.min(low, voxsoft.vertexPosition(i)[2]);
  return low;
})()"""


@pytest.fixture(scope="module")
def live_page(tmp_path_factory, coarse):
    source = tmp_path_factory.mktemp("design") / "finger.toml"
    source.write_text(coarse)
    return page_of(vs.load(source))


def test_a_page_from_disk_plays_is_pulled_and_follows_its_loads(live_page, alone, tmp_path):
    path = tmp_path / "finger.html"
    live_page.save(path)
    tab = alone(path.as_uri())
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    unloaded = tab.page.evaluate(LOWEST)
    tab.find("play").click()
    tab.until("voxsoft.time > 0.01")
    x, y = tab.middle()
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    tab.page.mouse.move(x, y - 80, steps=5)
    tab.find("grab").wait_for()
    tab.until("document.querySelector('.view-label.force') !== null")
    tab.page.mouse.up()
    tab.until("document.querySelector('[data-testid=grab]') === null")
    # Without gravity the tip goes back up to where it was.
    slider = tab.page.get_by_label("gravity slider")
    slider.focus()
    tab.page.keyboard.press("Home")
    tab.until(f"Math.abs({LOWEST} - {unloaded}) < 2e-4")
    assert [url for url in tab.requests if not url.startswith(("file:", "blob:", "data:"))] == []
    assert tab.errors == []


@pytest.mark.long
def test_a_page_on_a_phone_has_its_loads_below_the_body(live_page, alone, tmp_path):
    path = tmp_path / "finger.html"
    live_page.save(path)
    tab = alone(path.as_uri())
    tab.page.set_viewport_size({"width": 400, "height": 800})
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.until("document.documentElement.scrollWidth <= 400")
    box = tab.page.get_by_label("gravity slider").bounding_box()
    assert box["x"] + box["width"] <= 400
    assert box["y"] + box["height"] <= 800
    assert tab.errors == []


@pytest.mark.long
def test_a_page_of_a_result_opens_as_it_ended_and_plays_the_way_there(coarse, alone, tmp_path):
    source = tmp_path / "finger.toml"
    source.write_text(coarse)
    result = vs.simulate(vs.load(source))
    lowest = float(result.positions[:, 2].min())
    path = tmp_path / "result.html"
    result.show().save(path)
    tab = alone(path.as_uri())
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    # Positions on the wire have 16 bits of the body's size, some 1 um here.
    tab.until(f"Math.abs({LOWEST} - {lowest}) < 1e-5")
    numbers = tab.find("equilibrium")
    numbers.get_by_text("Probe tip").wait_for()
    assert "mm" in numbers.inner_text()
    tab.shot("page-of-a-result")
    # An equilibrium has no time.
    assert tab.find("clock").inner_text() == "at rest"
    tab.find("play").click()
    tab.until(f"{LOWEST} > {lowest} + 1e-3")
    tab.until("voxsoft.state === 'at-rest'")
    assert abs(tab.page.evaluate(LOWEST) - lowest) < 2e-4
    assert tab.errors == []


@pytest.mark.long
def test_a_page_of_a_body_that_was_lifted_shows_all_of_it(coarse, alone, tmp_path):
    body = StudioBody.of(Design.from_document(tomllib.loads(coarse)), rev=1, topology=1)
    lifted = body.mesh.vertices + np.array([0.0, 0.0, 0.15])
    path = tmp_path / "lifted.html"
    page_of_body(body, positions=lifted, at_rest=True).save(path)
    tab = alone(path.as_uri())
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.until(f"{LOWEST} > 0.1")
    tab.until("voxsoft.screenOf(0) !== null")
    tab.shot("page-of-a-lifted-body")
    canvas = tab.page.locator(".viewport canvas").bounding_box()
    outside = """(({ x, y, width, height }) => {
      let count = 0;
      for (let i = 0; voxsoft.vertexPosition(i); i++) {
        const [px, py] = voxsoft.screenOf(i);
        if (px < x || px > x + width || py < y || py > y + height) count++;
      }
      return count;
    })"""
    assert tab.page.evaluate(f"{outside}({json.dumps(canvas)})") == 0
    assert tab.find("clock").inner_text() == "at rest"
    assert tab.errors == []


@pytest.mark.slow
def test_a_page_lives_in_the_cell_of_a_notebook(live_page, alone, tmp_path):
    cell = tmp_path / "cell.html"
    cell.write_text(f"<!doctype html><body>{live_page._repr_html_()}</body>")
    tab = alone(cell.as_uri())
    frame = tab.page.frame_locator("iframe")
    frame.get_by_test_id("play").click()
    tab.until("voxsoft.time > 0.01", frame=tab.page.frames[-1])
    assert tab.errors == []
