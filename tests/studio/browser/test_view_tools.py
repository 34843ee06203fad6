"""The tools over the picture, and the speed of time."""

import io

import numpy as np
import pytest
from over_panels import OVER_PANELS
from PIL import Image

pytestmark = pytest.mark.browser


def boxes(tab, selector):
    """Places of elements on the page: left, top, right and bottom of the box around them all."""
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


def center(tab, name):
    left, top, right, bottom = boxes(tab, f"[data-testid='{name}']")
    return np.array([(left + right) / 2, (top + bottom) / 2])


def by(point, dx, dy):
    """A point of the page, moved by some pixels."""
    return np.add(point, (dx, dy))


def drag(tab, start, end, button="left", held=()):
    for key in held:
        tab.page.keyboard.down(key)
    tab.page.mouse.move(*start)
    tab.page.mouse.down(button=button)
    tab.page.mouse.move(*end, steps=8)
    tab.page.mouse.up(button=button)
    for key in held:
        tab.page.keyboard.up(key)


def share_of_color(tab, color):
    """The part of the picture that has a color."""
    box = tab.page.locator(".viewport canvas").bounding_box()
    image = Image.open(io.BytesIO(tab.page.screenshot(clip=box))).convert("RGB")
    return (np.abs(np.asarray(image).astype(int) - color).max(axis=2) < 6).mean()


CUT = np.array([0xC9, 0x8A, 0x4B])


def test_the_section_follows_its_handle_and_stays_capped(tab):
    assert tab.find("section-move").is_hidden()
    tab.find("section").click()
    tab.find("section-move").wait_for()
    slider = tab.page.get_by_label("Section position")
    before = float(slider.input_value())
    start, turner = center(tab, "section-move"), center(tab, "section-turn")
    end = start + 30 * (turner - start) / np.linalg.norm(turner - start)
    drag(tab, start, end)
    tab.until(f"document.querySelector('[aria-label=\\'Section position\\']').value != {before}")
    # The grip stays under the pointer, and the slider tells the same.
    assert center(tab, "section-move") == pytest.approx(end, abs=4)
    assert share_of_color(tab, CUT) > 0.002
    axis = tab.page.get_by_label("Section axis")
    drag(tab, center(tab, "section-turn"), by(center(tab, "section-turn"), 40, 25))
    tab.until("document.querySelector('[aria-label=\\'Section axis\\']').value === 'free'")
    assert share_of_color(tab, CUT) > 0.002
    axis.select_option("z")
    tab.find("section-turn").focus()
    tab.page.keyboard.press("Shift+ArrowUp")
    tab.until("document.querySelector('[aria-label=\\'Section axis\\']').value === 'free'")
    grip = tab.find("section-move")
    held = int(grip.get_attribute("aria-valuenow"))
    grip.focus()
    for key, step in (("ArrowUp", 1), ("PageDown", -10)):
        tab.page.keyboard.press(key)
        held += step
        tab.until(
            "Math.abs(document.querySelector('[data-testid=section-move]').ariaValueNow"
            f" - {held}) <= 1"
        )
    # Keys of the handle are its own: no frame was taken.
    assert tab.page.evaluate("voxsoft.time") == 0
    tab.find("section").click()
    tab.until("document.querySelector('.section-handle').hidden")
    assert tab.errors == []


def test_a_section_shows_the_field_inside(tab):
    tab.find("section").click()
    tab.find("section-move").wait_for()
    hatched = share_of_color(tab, CUT)
    assert hatched > 0.002  # nothing moves yet, and a map would tell nothing
    tab.find("play").click()
    tab.until("voxsoft.time > 0.02 && voxsoft.cut() > 100")
    tab.find("play").click()
    tab.until("voxsoft.state !== 'playing'")
    assert share_of_color(tab, CUT) < 0.1 * hatched
    tab.shot("section-field")
    # Also of the smooth shape, whose own cut is filled as far as voxels reach.
    tab.page.get_by_label("Show as").select_option("smooth")
    tab.until("voxsoft.cut() > 100")
    assert share_of_color(tab, CUT) < 0.5 * hatched
    tab.shot("section-field-smooth")
    # Colored by parts, and without a section, only the surface comes.
    tab.find("section").click()
    tab.until("voxsoft.cut() === 0")
    assert tab.errors == []


def test_the_mouse_steers_as_in_the_scheme_that_is_chosen(tab):
    far = 20

    # Two vertices tell whether the view has turned: moving shifts both of them alike.
    def spread():
        tab.until("voxsoft.screenOf(0) !== null")
        first, last = tab.page.evaluate(
            f"[voxsoft.screenOf(0), voxsoft.screenOf({far})]",
        )
        return np.subtract(last, first), np.array(first)

    x, y = boxes(tab, ".viewport canvas")[:2]
    start = np.array([x + 60, y + 160])
    tab.find("view-more").click()
    tab.page.get_by_label("Mouse as in").select_option("blender")
    tab.find("view-more").click()
    before, place = spread()
    drag(tab, start, by(start, 60, 0), button="right")
    drag(tab, start, by(start, 60, 0), button="middle", held=["Shift"])
    moved, there = spread()
    assert moved == pytest.approx(before, abs=3)  # perspective changes a little
    assert there[0] - place[0] == pytest.approx(60, abs=6)
    drag(tab, start, by(start, 60, 0), button="middle")
    turned, _ = spread()
    assert np.linalg.norm(turned - before) > 10
    drag(tab, start, by(start, 0, 80), button="middle", held=["Control"])
    small, _ = spread()
    assert np.linalg.norm(small) < 0.8 * np.linalg.norm(turned)
    tab.page.keyboard.press("?")
    tab.find("shortcuts").wait_for()
    assert "MOUSE AS IN BLENDER" in tab.find("shortcuts").inner_text().upper()
    assert tab.page.evaluate("JSON.parse(localStorage['voxsoft.view']).scheme") == "blender"


@pytest.mark.parametrize("display", ["tets", "wireframe", "smooth"])
def test_tape_and_values_work_in_every_display(tab, display):
    tab.page.get_by_label("Show as").select_option(display)
    if display == "tets":
        tab.until("voxsoft.triangles === 640")
    x, y = tab.middle()
    tab.page.mouse.click(x, y)
    tab.find("picked").wait_for()
    tab.find("picked").get_by_label("Close").click()
    tab.find("tape").click()
    tab.until("document.querySelector('.view-labels.passive') !== null")
    tab.page.mouse.click(x - 60, y)
    tab.page.mouse.click(x + 60, y)
    length = tab.find("label-tape")
    length.wait_for()
    assert float(length.inner_text().removesuffix(" mm")) > 5
    assert tab.errors == []


@pytest.mark.parametrize("display", ["tets", "wireframe", "smooth"])
def test_a_pull_works_in_every_display(tab, display):
    tab.page.get_by_label("Show as").select_option(display)
    if display == "tets":
        tab.until("voxsoft.triangles === 640")
    x, y = tab.middle()
    drag_start = np.array([x, y])
    tab.page.mouse.move(*drag_start)
    tab.page.mouse.down()
    tab.page.mouse.move(*by(drag_start, 0, -90), steps=6)
    tab.find("grab").wait_for()
    tab.until("document.querySelector('.view-label.force') !== null")
    # The word tells how far the vertex has come, and the picture follows it.
    tab.until(
        "parseFloat(document.querySelector('.view-label.force').innerText.split('moved ')[1]) > 1"
    )
    tab.page.mouse.up()
    tab.until("document.querySelector('[data-testid=grab]') === null")
    assert tab.errors == []


def test_menus_of_the_view_close_on_escape_and_on_a_press_elsewhere(tab):
    below = by(tab.middle(), 0, 150)
    for button, menu in [("view-film", "film-menu"), ("view-more", "view-menu")]:
        tab.find(button).click()
        tab.find(menu).wait_for()
        tab.page.keyboard.press("Escape")
        tab.find(menu).wait_for(state="detached")
        tab.find(button).click()
        tab.find(menu).wait_for()
        tab.page.mouse.click(*below)
        tab.find(menu).wait_for(state="detached")


def test_messages_cover_nothing_that_can_be_pressed(tab):
    tab.page.keyboard.press("Control+s")
    message = tab.find("toast")
    message.get_by_text("Saved").wait_for()
    place = boxes(tab, ".toasts")
    for control in (".transport", ".status-line", ".cube-face", ".view-bar"):
        assert apart(place, boxes(tab, control)), control
    stage = boxes(tab, ".view-stage")
    assert stage[0] <= place[0]
    assert place[2] <= stage[2]
    tab.shot("toast")


# The finger, twice as long and of the softest silicone: at rest it hangs out of the picture.
LIMP = [
    ('value = "40 mm"', 'value = "60 mm"'),
    ('material = "ecoflex-00-30-lattice"', 'material = "ecoflex-00-20-lattice"'),
    ('"= length", "10 mm", "10 mm"', '"= length", "10 mm", "5 mm"'),
]

IN_PICTURE = """(() => {
  const box = document.querySelector('.viewport canvas').getBoundingClientRect();
  for (let i = 0, at; voxsoft.vertexPosition(i) && (at = voxsoft.screenOf(i)); i++)
    if (at[0] < box.left || at[0] > box.right) return false;
    else if (at[1] < box.top || at[1] > box.bottom) return false;
  return true;
})()"""


HANGING = """(() => {
  for (let i = 0, at; (at = voxsoft.vertexPosition(i)); i++) if (at[2] < -0.03) return true;
  return false;
})()"""


@pytest.mark.parametrize("steered", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_the_view_follows_a_body_unless_a_hand_moved_it(
    open_tab, serving, coarse, tmp_path, steered
):
    text = coarse
    for before, after in LIMP:
        assert before in text
        text = text.replace(before, after)
    server = serving(tmp_path, text)
    try:
        tab = open_tab(server.address, symbols=False)
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        if steered:
            tab.page.mouse.move(*by(tab.middle(), 0, 150))
            tab.page.mouse.wheel(0, -100)
        tab.find("rest").click()
        tab.until(HANGING)
        if steered:
            assert not tab.page.evaluate(IN_PICTURE)
        else:
            tab.until(IN_PICTURE)
    finally:
        server.stop()


def test_a_plane_of_symmetry_is_drawn_with_its_place(serving, tmp_path, open_tab, coarse):
    half = coarse.replace("ecoflex-00-30-lattice", "ecoflex-00-30")
    server = serving(tmp_path, text=half + '\n[[symmetry]]\nplane = "y"\nat = "5 mm"\n')
    try:
        tab = open_tab(server.address)
        word = tab.page.locator(".view-label.plane")
        word.wait_for()
        assert word.inner_text() == "symmetry y = 5 mm"
        tab.shot("symmetry")
        assert tab.errors == []
    finally:
        server.stop()


PANELS = (".legend", ".view-bar", ".cube", ".scale-bar", "[data-testid=picked]")


def test_words_keep_out_of_panels_wherever_the_body_is(served, open_tab):
    tab = open_tab(served.address, size=(1280, 720))
    page = tab.page
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.find("rest").click()
    tab.until("voxsoft.state === 'at-rest'")
    page.mouse.click(*tab.middle())
    tab.find("picked").wait_for()
    # The card, which is higher than this view, scrolls below the bar.
    bar, card = (page.locator(one).bounding_box() for one in (".view-bar", ".picked"))
    assert card["y"] > bar["y"] + bar["height"]
    tab.until(f"{OVER_PANELS} === ''")
    word = page.locator(".view-label", has_text="gravity")
    for panel in PANELS:
        page.locator(".viewport canvas").focus()
        page.keyboard.press("f")  # the word is in the middle again
        word.wait_for()
        tab.until(f"{OVER_PANELS} === ''")
        box, at = page.locator(panel).bounding_box(), word.bounding_box()
        x, y = tab.middle()
        places = page.evaluate("String(voxsoft.screenOf(0))")
        page.mouse.move(x, y)
        page.mouse.down(button="middle")  # moves the picture
        across = box["x"] + box["width"] / 2 - at["x"] - at["width"] / 2
        down = box["y"] + box["height"] / 2 - at["y"] - at["height"] / 2
        page.mouse.move(x + across, y + down, steps=4)
        page.mouse.up(button="middle")
        tab.until(f"String(voxsoft.screenOf(0)) !== '{places}'")
        tab.until(f"{OVER_PANELS} === ''", patience=20)
    tab.shot("words-beside-panels")
    assert tab.errors == []
