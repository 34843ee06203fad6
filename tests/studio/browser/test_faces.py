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


def saved(tab, server, condition):
    """The design, once the file has what a condition asks for."""
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
    tab.find("here-probe").click()
    tab.find("face-verbs").wait_for(state="detached")
    design = saved(tab, chamber, lambda design: design.probes)
    assert design.probes["probe"].z == (0.03, 0.03)
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
