"""Press a face of the body, and clamp, push, press or measure it there."""

import pytest
from waiting import until

import voxsoft as vs

pytestmark = pytest.mark.browser

CHAMBER = """
schema = "voxsoft/1"
name = "chamber"
voxel_size = "5 mm"

[parameters]
height = { value = "30 mm", min = "20 mm", max = "60 mm" }
wall = "5 mm"

[shapes]
outside = { kind = "box", size = ["30 mm", "30 mm", "= height"] }
room.kind = "box"
room.size = ["20 mm", "20 mm", "= height - 2*wall"]
room.corner = ["= wall", "= wall", "= wall"]
body = { kind = "difference", of = ["outside", "room"] }

[[parts]]
shape = "body"
material = "ecoflex-00-30"

[[clamps]]
region = { z = [0, 0] }
"""


@pytest.fixture
def chamber(serving, tmp_path):
    server = serving(tmp_path, text=CHAMBER)
    yield server
    server.stop()


def pressed(tab, x, y):
    tab.page.mouse.click(x, y)
    tab.find("face-verbs").wait_for()


def look(tab, key):
    """Look from one of the standard sides, and wait until the picture does."""
    place = "String(voxsoft.screenOf(0))"
    before = tab.page.evaluate(place)
    tab.page.keyboard.press(key)
    tab.until(f"{place} !== {before!r}")


def saved(tab, server, condition):
    """The design, once the file meets a condition."""
    tab.page.keyboard.press("Control+s")
    return until(lambda: design if condition(design := vs.load(server.source)) else None)


def test_a_face_is_pressed_probed_and_pushed(chamber, open_tab):
    tab = open_tab(chamber.address, symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.page.locator(".viewport canvas").focus()
    tab.page.keyboard.press("5")  # from above
    pressed(tab, *tab.middle())
    tab.shot("face")
    assert "z = 30 mm" in tab.page.get_by_label("Where").inner_text()
    before = tab.page.evaluate("voxsoft.topology")
    tab.find("here-probe").click()
    tab.find("face-verbs").wait_for(state="detached")
    design = saved(tab, chamber, lambda design: design.probes)
    assert design.probes["probe"].z == (0.03, 0.03)
    # The body is built with the probe, and a press on the picture before that is lost.
    tab.until(f"voxsoft.topology > {before}")
    pressed(tab, *tab.middle())
    tab.find("here-push").click()
    design = saved(tab, chamber, lambda design: design.loads)
    assert design.loads[0].value == (0.0, 0.0, -0.1)
    # The text follows the parameter: a taller chamber is pushed at its new top.
    taller = design.with_values("height=40 mm")
    assert taller.loads[0].region.z == (0.04, 0.04)
    assert vs.simulate(taller).probes["probe"][2] < 0.0
    assert tab.errors == []


def test_a_chamber_is_filled_from_within(chamber, open_tab):
    tab = open_tab(chamber.address, symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.page.locator(".viewport canvas").focus()
    tab.page.keyboard.press("1")  # from the front
    tab.page.keyboard.press("x")  # cut open
    tab.shot("face-cut")
    x, y = tab.middle()
    pressed(tab, x + 40, y + 20)  # beside the handle of the cut
    tab.shot("face-inside")
    tab.find("here-fill").click()
    design = saved(tab, chamber, lambda design: design.loads)
    assert design.loads[0].cavity == "chamber"
    result = vs.simulate(design)
    assert result.status == "ok"
    assert result.cavity_volumes[0] > 8e-6
    assert tab.errors == []


def test_a_tendon_runs_through_places_that_are_pressed(chamber, open_tab):
    tab = open_tab(chamber.address, symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.page.locator(".viewport canvas").focus()
    tab.page.keyboard.press("5")  # from above
    x, y = tab.middle()
    pressed(tab, x - 80, y)
    tab.find("here-tendon").click()
    pressed(tab, x, y)
    tab.shot("tendon-to")
    tab.find("here-tendon-to").click()
    saved(tab, chamber, lambda design: design.tendons)
    tab.page.get_by_text("tension of tendon").wait_for()  # the body that has it is there
    pressed(tab, x + 80, y)
    tab.find("here-tendon-on").click()
    design = saved(
        tab, chamber, lambda design: design.tendons and len(design.tendons[0].through) == 3
    )
    [tendon] = design.tendons
    begin, middle, end = tendon.through
    assert begin[0] < middle[0] < end.point[0]
    # Half a voxel below the roof, pulled by its other end.
    assert begin[2] == middle[2] == end.point[2] == pytest.approx(0.0275)
    result = vs.simulate(design)
    assert result.status == "ok"
    assert result.tendons[tendon.name].tension == pytest.approx(0.1)
    tab.page.keyboard.press("2")
    tab.shot("tendon-on")
    assert tab.errors == []


def test_a_plate_touches_a_face_and_follows_it(chamber, open_tab):
    tab = open_tab(chamber.address)
    tab.until("window.voxsoft !== undefined && voxsoft.vertexPosition(0) !== null")
    tab.page.locator(".viewport canvas").focus()
    look(tab, "5")  # from above
    pressed(tab, *tab.middle())
    tab.find("here-touch").select_option("press")
    tab.find("label-object-plate").wait_for()
    tab.page.keyboard.press("0")
    tab.until(
        "document.querySelector('[data-testid^=label-meets]')?.textContent === 'friction 0.8'"
    )
    tab.shot("touch-plate")
    design = saved(tab, chamber, lambda design: design.objects)
    assert design.contact.friction == 0.8
    result = vs.simulate(design)
    assert result.status == "ok"
    [touch] = [each for each in result.contacts if each.of == ("body", "plate")]
    assert touch.force[2] < -0.1
    assert result.objects["plate"].position[2] == pytest.approx(0.035 - 0.003)
    # The plate stays on the face when the chamber is made taller.
    taller = design.with_values("height=40 mm")
    assert vs.simulate(taller).objects["plate"].position[2] == pytest.approx(0.045 - 0.003)
    tab.page.keyboard.press("Control+z")
    tab.find("label-object-plate").wait_for(state="detached")
    assert tab.errors == []


HELD = "[[clamps]]\nregion = { z = [0, 0] }"
HEAVY = '[[loads]]\nkind = "gravity"'


def test_a_plate_beside_a_clamp_can_be_pressed(chamber, open_tab):
    tab = open_tab(chamber.address)
    tab.until("window.voxsoft !== undefined && voxsoft.vertexPosition(0) !== null")
    tab.page.locator(".viewport canvas").focus()
    look(tab, "1")  # from the front, whose lower end is held
    pressed(tab, *tab.middle())
    tab.find("here-touch").select_option("press")
    design = saved(tab, chamber, lambda design: design.objects)
    taller = design.with_values("height=40 mm")
    assert taller.objects[0].shape.size[2] == pytest.approx(0.035)
    for each in (design, taller):
        result = vs.simulate(each)
        assert result.status == "ok"
        assert result.contacts[0].force[1] > 0.1
    assert tab.errors == []


def test_a_floor_is_put_under_the_lowest_face(serving, open_tab, tmp_path):
    server = serving(tmp_path, text=CHAMBER.replace(HELD, HEAVY))
    try:
        under_the_lowest_face(server, open_tab(server.address, scheme="light"))
    finally:
        server.stop()


def under_the_lowest_face(server, tab):
    tab.until("window.voxsoft !== undefined && voxsoft.vertexPosition(0) !== null")
    tab.page.locator(".viewport canvas").focus()
    look(tab, "6")  # from below
    pressed(tab, *tab.middle())
    tab.find("here-touch").select_option("floor")
    tab.find("label-floor").wait_for()
    look(tab, "7")
    tab.shot("touch-floor")
    design = saved(tab, server, lambda design: design.floor)
    assert design.floor.z == 0.0
    result = vs.simulate(design)
    assert result.status == "ok"
    [touch] = result.contacts
    assert touch.of == ("body", "floor")
    assert touch.force[2] == pytest.approx(9.81 * 1070 * 19e-6, rel=1e-3)  # its weight
    assert tab.errors == []


def test_a_plate_is_bonded_by_keys(chamber, open_tab):
    tab = open_tab(chamber.address)
    tab.until("window.voxsoft !== undefined && voxsoft.vertexPosition(0) !== null")
    tab.page.locator(".viewport canvas").focus()
    look(tab, "5")  # from above
    tab.page.keyboard.press("Enter")  # presses the middle of the picture
    tab.find("here-bond").wait_for()
    tab.until("document.querySelector('.picked-facts')?.contains(document.activeElement)")
    tab.find("here-bond").focus()
    for key in ("ArrowDown", "ArrowDown", "Enter"):  # opens the list, chooses its first line
        tab.page.keyboard.press(key)
    tab.find("label-bond-body-plate").wait_for()
    look(tab, "7")  # at an angle
    tab.shot("bond-plate")
    design = saved(tab, chamber, lambda design: design.objects)
    assert design.contact.pairs[0].kind == "bonded"
    result = vs.simulate(design.with_values("height=40 mm"))
    assert result.status == "ok"
    [touch] = result.contacts
    assert touch.bonded == pytest.approx(9e-4)
    tab.page.keyboard.press("Control+z")
    tab.find("label-bond-body-plate").wait_for(state="detached")
    assert tab.errors == []
