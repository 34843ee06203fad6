"""Rigid objects in the picture: gray beside the body, where a solution has them, chosen by name."""

import pytest

pytestmark = pytest.mark.browser

BALL = """
schema = "voxsoft/1"
name = "dented"
voxel_size = "4 mm"

[shapes]
block = { kind = "box", size = ["40 mm", "40 mm", "20 mm"], center = [0, 0, "-10 mm"] }
ball = { kind = "sphere", radius = "12 mm", center = [0, 0, "13 mm"] }

[materials]
rubber = { model = "neo-hookean", young = "100 kPa", poisson = 0.4 }

[[parts]]
shape = "block"
material = "rubber"

[[clamps]]
region = { z = ["-20 mm", "-20 mm"] }

[[objects]]
name = "ball"
shape = "ball"
motion = { displacement = [0, 0, "-4 mm"] }
"""


@pytest.fixture
def dented(tmp_path, serving):
    server = serving(tmp_path, BALL, "dented.toml")
    yield server
    server.stop()


def test_a_ball_is_drawn_solved_and_gone_back_from(dented, open_tab):
    tab = open_tab(dented.address, mode="simulate")
    tab.until("window.voxsoft !== undefined && voxsoft.objectPosition('ball') !== null")
    tab.until("voxsoft.triangles > 0 && voxsoft.state === 'paused'")
    at = tab.page.evaluate("voxsoft.objectPosition('ball')")
    # Its surface is traced to rounding of single precision.
    assert at == pytest.approx([0, 0, 0.013], abs=1e-6)
    tab.shot("objects_at_rest")
    tab.find("rest").click()
    tab.until("voxsoft.state === 'at-rest'")
    tab.until("Math.abs(voxsoft.objectPosition('ball')[2] - 0.009) < 1e-6")
    tab.shot("objects_solved")
    tab.find("reset").click()
    tab.until("Math.abs(voxsoft.objectPosition('ball')[2] - 0.013) < 1e-6")
    assert tab.errors == []


def test_an_object_of_the_form_is_marked_in_the_picture(dented, open_tab):
    tab = open_tab(dented.address, mode="design")
    tab.until("window.voxsoft !== undefined && voxsoft.objectPosition('ball') !== null")
    entry = tab.find("objects-0")
    entry.get_by_role("button", expanded=False).click()
    entry.locator(".entry-body").wait_for()
    tab.find("label-object-ball").wait_for()
    tab.shot("objects_chosen")
    assert tab.errors == []
