"""The view and the run pane, driven as a user drives them."""

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

pytestmark = pytest.mark.browser

EXAMPLES = Path(__file__).parents[3] / "examples"


def picture(tab):
    box = tab.page.locator(".viewport canvas").bounding_box()
    png = tab.page.screenshot(clip=box)
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


def colors(tab):
    return len(np.unique(picture(tab).reshape(-1, 3), axis=0))


def changed(before, after):
    """Number of pixels that differ visibly."""
    return int((np.abs(before - after).max(axis=2) > 12).sum())


def settled(tab):
    """The picture once it stands still: in motion it may be coarser."""
    before, unchanged = picture(tab), 0
    while unchanged < 3:  # a busy machine takes its time to draw a coarse picture whole
        tab.page.wait_for_timeout(400)
        now = picture(tab)
        unchanged = unchanged + 1 if changed(before, now) == 0 else 0
        before = now
    return before


def farthest_vertex(tab):
    """A vertex of the free end: the one that lies farthest along x."""
    return tab.page.evaluate(
        """() => {
          let [best, far] = [0, -Infinity];
          for (let i = 0; ; i++) {
            const at = voxsoft.vertexPosition(i);
            if (!at) return best;
            if (at[0] > far) [best, far] = [i, at[0]];
          }
        }"""
    )


def test_time_runs_and_the_body_sags(tab):
    tab.find("play").click()
    tab.until("voxsoft.time > 0.02")
    vertex = farthest_vertex(tab)
    assert tab.page.evaluate(f"voxsoft.vertexPosition({vertex})[2]") < 0.01
    assert colors(tab) > 200
    assert tab.errors == []


def test_a_pull_moves_the_vertex_under_the_mouse(tab):
    # The body stands still until the hand pulls: the pressed vertex is where it was looked up.
    vertex = farthest_vertex(tab)
    x, y = tab.page.evaluate(f"voxsoft.screenOf({vertex})")
    # The corner itself may lie on the silhouette: press a little inside of it.
    cx, cy = tab.middle()
    before = tab.page.evaluate(f"voxsoft.vertexPosition({vertex})[2]")
    px, py = x + 0.15 * (cx - x), y + 0.15 * (cy - y)
    tab.page.mouse.move(px, py)
    tab.page.mouse.down()
    tab.page.mouse.move(px, py - 120, steps=6)
    tab.find("grab").wait_for()
    tab.until("document.querySelector('.view-label.force') !== null")
    tab.until(f"voxsoft.vertexPosition({vertex})[2] > {before} + 0.001")
    assert "N" in tab.page.locator(".view-label.force").inner_text()
    tab.page.mouse.up()
    tab.until("document.querySelector('[data-testid=grab]') === null")
    assert tab.errors == []


def test_shift_leaves_a_spring_pinned_and_its_word_takes_it_away(tab):
    x, y = tab.middle()
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    tab.page.mouse.move(x, y - 60, steps=4)
    tab.find("grab").wait_for()
    tab.page.keyboard.down("Shift")
    tab.page.mouse.up()
    tab.page.keyboard.up("Shift")
    label = tab.page.locator("button.view-label.force")
    label.wait_for()
    assert tab.find("grab").count() == 1
    label.click()
    tab.until("document.querySelector('[data-testid=grab]') === null")


def test_a_load_follows_its_slider_by_keyboard(tab):
    tab.find("play").click()
    tab.until("voxsoft.time > 0.01")
    slider = tab.find("pane-run").locator("input[type=range]").first
    before = float(slider.input_value())
    seq = tab.page.evaluate("voxsoft.seq")
    slider.focus()
    for _ in range(5):
        tab.page.keyboard.press("ArrowRight")
    tab.until(f"voxsoft.seq > {seq}")
    tab.until(
        "Number(document.querySelector('[data-testid=pane-run] input[type=range]').value)"
        f" > {before}"
    )
    assert tab.errors == []


def test_a_stored_frame_is_held_and_live_goes_back(tab):
    tab.find("play").click()
    tab.until("voxsoft.time > 0.05")
    tab.until("!document.querySelector('[data-testid=scrubber]').disabled")
    scrubber = tab.find("scrubber")
    scrubber.focus()
    tab.page.keyboard.press("Home")
    tab.until("voxsoft.state === 'past'")
    tab.until("voxsoft.time < 0.03")
    held = tab.page.evaluate("voxsoft.time")
    assert tab.find("live").get_attribute("aria-pressed") == "false"
    tab.find("live").click()
    tab.until(f"voxsoft.time > {held} + 0.02")
    assert tab.find("live").get_attribute("aria-pressed") == "true"


def test_reset_goes_back_to_the_unloaded_shape(tab):
    tab.find("play").click()
    tab.until("voxsoft.time > 0.02")
    tab.find("reset").click()
    tab.until("voxsoft.time === 0")
    vertex = farthest_vertex(tab)
    # Positions travel with 16 bits over the size of the body: a micrometer here.
    x = tab.page.evaluate(f"voxsoft.vertexPosition({vertex})[0]")
    assert x == pytest.approx(0.04, abs=2e-6)


def test_each_way_to_show_the_body_draws_another_picture(tab):
    show = tab.page.get_by_label("Show as")
    plain = picture(tab)
    show.select_option("wireframe")
    tab.until("voxsoft.triangles === 0")
    assert changed(plain, picture(tab)) > 500
    show.select_option("tets")
    # Four faces for each of the five tetrahedra of 8 x 2 x 2 voxels.
    tab.until("voxsoft.triangles === 640")
    show.select_option("voxels")
    surface = tab.until("voxsoft.triangles !== 640 && voxsoft.triangles")
    assert surface == 2 * 2 * (2 * 2 + 2 * 8 + 2 * 8)
    tab.find("section").click()
    tab.find("section-tools").wait_for()
    tab.until("document.querySelector('.view-tools') !== null")
    assert changed(plain, picture(tab)) > 500
    assert tab.errors == []


def test_the_smooth_shape_moves_with_the_voxels(tab):
    tab.page.get_by_label("Show as").select_option("smooth")
    still = settled(tab)
    tab.find("play").click()
    tab.until("voxsoft.state === 'at-rest'")
    tab.until("document.querySelector('[data-testid=fps]') === null")
    assert changed(still, settled(tab)) > 1000
    # It is colored by the field as the voxels are: the map's many colors, and their legend.
    assert tab.find("legend").is_visible()
    by_field = settled(tab)
    tab.page.get_by_label("Color by").select_option("parts")
    assert changed(by_field, settled(tab)) > 1000
    tab.page.get_by_label("Color by").select_option("0")
    tab.find("reset").click()
    tab.until("voxsoft.time === 0")
    # A busy machine may stand at a coarse picture for a while.
    for _ in range(100):
        if changed(still, settled(tab)) < 100:
            break
    assert changed(still, settled(tab)) < 100
    assert tab.errors == []


def test_keys_turn_the_camera_and_a_new_mesh_leaves_it(tab):
    before = tab.page.evaluate("voxsoft.screenOf(0)")
    tab.page.locator(".viewport canvas").focus()
    tab.page.keyboard.press("1")
    tab.until(f"Math.abs(voxsoft.screenOf(0)[0] - {before[0]}) > 5")
    corner = tab.page.evaluate("voxsoft.vertexPosition(0)")
    place = tab.page.evaluate("voxsoft.screenOf(0)")
    topology = tab.page.evaluate("voxsoft.topology")
    tab.page.locator(".dv-default-tab", has_text="Design").click()
    field = tab.find("pane-design").get_by_label("length", exact=True)
    field.fill("5.5 cm")
    field.press("Enter")
    tab.until(f"voxsoft.topology !== {topology} && voxsoft.triangles > 0")
    tab.until("voxsoft.vertexPosition(0) !== null")
    assert tab.page.evaluate("voxsoft.vertexPosition(0)") == pytest.approx(corner, abs=1e-5)
    # The first vertex is the corner at the clamp, which no length moves: it stays on its pixel.
    assert tab.page.evaluate("voxsoft.screenOf(0)") == pytest.approx(place, abs=0.1)
    tab.page.keyboard.press("Escape")
    tab.page.locator(".viewport canvas").focus()
    tab.page.keyboard.press("Control+z")
    tab.until("Math.abs(voxsoft.vertexPosition(0)[0]) < 1e-5")


def test_a_click_tells_all_values_and_adds_a_plot(tab):
    tab.find("play").click()
    tab.until("voxsoft.time > 0.02")
    tab.page.mouse.click(*tab.middle())
    picked = tab.find("picked")
    picked.wait_for()
    assert "mm" in picked.inner_text()
    tab.find("plot-picked").click()
    tab.until("document.querySelectorAll('[data-testid=plot-probes] .plot-key span').length === 2")


def test_a_picture_is_saved_at_twice_the_size(tab):
    tab.find("view-film").click()
    with tab.page.expect_download() as waiting:
        tab.find("picture-2").click()
    picture = Image.open(waiting.value.path())
    box = tab.page.locator(".viewport canvas").bounding_box()
    assert picture.size == (2 * round(box["width"]), 2 * round(box["height"]))
    assert len(np.unique(np.asarray(picture).reshape(-1, 4), axis=0)) > 200
    assert waiting.value.suggested_filename.startswith("finger-")


def test_a_body_that_diverges_says_so_in_the_picture_and_comes_back(
    tmp_path, coarse, serving, open_tab
):
    # Silicone ten times softer, under ten thousand times its own weight: nothing can carry that.
    soft = '{ model = "neo-hookean", young = "10 kPa", poisson = 0.45, density = "1070 kg/m^3" }'
    server = serving(tmp_path, coarse.replace('"ecoflex-00-30-lattice"', soft))
    try:
        tab = open_tab(server.address)
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        assert tab.find("diverged").count() == 0
        gravity = tab.find("pane-run").get_by_label("gravity", exact=True)
        gravity.fill("98100 m/s^2")
        gravity.press("Enter")
        tab.find("play").click()
        banner = tab.find("diverged")
        banner.wait_for()
        tab.until("voxsoft.state === 'diverged'")
        assert "Diverged at" in banner.inner_text()
        assert "smaller load" in banner.inner_text()
        banner.get_by_role("button").click()
        banner.wait_for(state="detached")
        tab.until("voxsoft.time === 0 && voxsoft.state === 'paused'")
        # The load is the design's own again, and the body comes to rest under it.
        tab.find("play").click()
        tab.until("voxsoft.state === 'at-rest'")
        assert tab.errors == []
    finally:
        server.stop()


def test_the_tape_measures_between_two_points(tab):
    corner = tab.page.evaluate("voxsoft.screenOf(0)")
    tab.page.locator(".viewport canvas").focus()
    tab.page.keyboard.press("1")
    tab.until(f"Math.abs(voxsoft.screenOf(0)[0] - {corner[0]}) > 5")
    vertices = tab.page.evaluate(
        """() => {
          const all = [];
          for (let i = 0; voxsoft.vertexPosition(i); i++) {
            all.push([...voxsoft.vertexPosition(i).map((a) => 1000 * a), ...voxsoft.screenOf(i)]);
          }
          return all;
        }"""
    )
    # On the side toward the eye, half way up: 5 mm and 35 mm along a finger of 40 mm.
    vertices = np.array(vertices)
    front = vertices[np.isclose(vertices[:, 1], vertices[:, 1].min(), atol=0.1)]
    middle = front[np.isclose(front[:, 2], np.median(front[:, 2]), atol=0.1)]
    tab.find("tape").click()
    tab.until("document.querySelector('.view-labels.passive') !== null")
    for x in (5, 35):
        end = middle[np.abs(middle[:, 0] - middle[:, 0].min() - x).argmin()]
        tab.page.mouse.click(*end[3:])
    label = tab.find("label-tape")
    label.wait_for()
    # A pixel of the page is about 0.06 mm of the body here.
    assert float(label.inner_text().removesuffix(" mm")) == pytest.approx(30, abs=0.3)


def test_words_that_make_room_for_others_lead_back_to_their_points(tmp_path, serving, open_tab):
    # Nine stations along a beam that is short on the screen: their words cannot all be shown.
    server = serving(tmp_path, (EXAMPLES / "beam.toml").read_text(), "beam.toml")
    try:
        tab = open_tab(server.address, size=(1280, 720), mode="runs")
        tab.until("document.querySelectorAll('.view-label.probe').length === 9")
        tab.until("document.querySelectorAll('.view-label.probe.moved').length > 0")
        boxes = tab.page.evaluate(
            """[...document.querySelectorAll('.view-label:not(.crowded)')]
               .map((one) => one.getBoundingClientRect())
               .map((box) => [box.left, box.top, box.right, box.bottom])"""
        )
        for i, (left, top, right, bottom) in enumerate(boxes):
            for other_left, other_top, other_right, other_bottom in boxes[:i]:
                apart = right <= other_left or other_right <= left
                assert apart or bottom <= other_top or other_bottom <= top
        dots = tab.page.locator(".view-label.probe.crowded")
        for i in range(dots.count()):
            assert dots.nth(i).get_attribute("title").startswith("station-")
    finally:
        server.stop()


def test_an_equilibrium_has_numbers_and_is_kept_as_it_is(tab):
    lamp = tab.find("live")
    tab.find("play").click()
    tab.until("document.querySelector('[data-testid=live]').classList.contains('on')")
    tab.until("voxsoft.state === 'at-rest'")
    tab.find("reset").click()
    load = tab.find("pane-run").get_by_role("textbox", name="gravity", exact=True)
    load.fill("15 m/s^2")
    load.press("Enter")
    tab.find("rest").click()
    card = tab.find("equilibrium")
    card.get_by_text("Probe tip").wait_for()
    assert "Largest strain" in card.inner_text()
    assert "on" not in lamp.get_attribute("class").split()
    tab.shot("equilibrium")
    tab.page.get_by_role("button", name="Keep as a run").click()
    tab.find("toast").get_by_text("Kept as finger-run").wait_for()
    tab.find("mode-runs").click()
    row = tab.find("runs-table").locator("tbody tr").first
    row.get_by_text("finger-run").wait_for()
    tab.find("mode-simulate").click()
    tab.find("reset").click()
    card.wait_for(state="detached")
    assert tab.errors == []


def test_an_equilibrium_after_motion_has_no_time(tab):
    clock = tab.find("clock")
    tab.find("play").click()
    tab.until("voxsoft.time > 0.02")
    tab.find("play").click()
    assert clock.inner_text().endswith(" s")
    tab.find("rest").click()
    tab.find("equilibrium").get_by_text("Probe tip").wait_for()
    tab.until("document.querySelector('[data-testid=clock]').innerText === 'at rest'")
    tab.shot("clock")
    tab.find("reset").click()
    tab.until("document.querySelector('[data-testid=clock]').innerText === '0.000 s'")
    assert tab.errors == []


def test_an_equilibrium_of_rubber_gets_error_bars(own_server, open_tab):
    own_server.stop()
    own_server.source.write_text(own_server.source.read_text().replace("-lattice", ""))
    own_server.start()
    tab = open_tab(own_server.address)
    tab.find("rest").click()
    card = tab.find("equilibrium")
    card.get_by_text("Error bars from voxels of 5 mm and 2.5 mm").wait_for()
    assert "±" in card.locator(".estimate").first.inner_text()
    tab.shot("error-bars")
    assert tab.errors == []


def test_solving_can_be_canceled(own_server, open_tab):
    # Rubber of 16,384 voxels takes minutes: a press comes in time, however busy the machine is.
    text = own_server.source.read_text().replace('voxel_size = "5 mm"', 'voxel_size = "0.625 mm"')
    text = text.replace("-lattice", "")
    own_server.stop()
    own_server.source.write_text(text)
    own_server.start()
    tab = open_tab(own_server.address)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.find("rest").click()
    tab.find("cancel").click()
    tab.find("rest").wait_for()
    assert tab.page.evaluate("voxsoft.state") == "paused"
    assert "Canceled" in tab.find("sentence").inner_text()
    assert tab.errors == []
