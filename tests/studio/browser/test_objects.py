"""Rigid objects in the picture: gray beside the body, where a solution has them, chosen by name."""

import re
from pathlib import Path

import pytest

pytestmark = pytest.mark.browser

PINCH = Path(__file__).parents[3] / "examples" / "pinch.toml"

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
    # All of the ball is in the picture, whichever of it and the body came first.
    assert tab.find("label-object-ball").is_visible()
    tab.shot("objects_at_rest")
    tab.find("rest").click()
    tab.until("voxsoft.state === 'at-rest'")
    tab.until("Math.abs(voxsoft.objectPosition('ball')[2] - 0.009) < 1e-6")
    card = tab.find("contacts")
    assert card.locator("strong").all_inner_texts() == ["body on ball"]
    assert "mm²" in card.inner_text()
    # Nothing holds without friction, which is no fault to be shown red.
    assert "slips" not in card.inner_text()
    assert re.search(r"Friction\s+none", card.inner_text())
    fields = tab.page.get_by_label("Color by")
    fields.select_option(label="Contact pressure")
    tab.find("legend").get_by_text("kPa").wait_for()
    tab.until("document.querySelector('.legend-ticks') !== null")
    tab.shot("objects_solved")
    tab.find("reset").click()
    tab.until("Math.abs(voxsoft.objectPosition('ball')[2] - 0.013) < 1e-6")
    tab.find("legend-unknown").wait_for()
    assert card.count() == 0
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


STL = """solid wedge
facet normal 0 0 0
outer loop
vertex 100 0 0
vertex 100 10 0
vertex 110 0 0
endloop
endfacet
facet normal 0 0 0
outer loop
vertex 100 0 0
vertex 110 0 0
vertex 100 0 10
endloop
endfacet
facet normal 0 0 0
outer loop
vertex 100 0 0
vertex 100 0 10
vertex 100 10 0
endloop
endfacet
facet normal 0 0 0
outer loop
vertex 110 0 0
vertex 100 10 0
vertex 100 0 10
endloop
endfacet
endsolid wedge
"""


def test_objects_to_grip_are_added_beside_the_body_and_taken_back(served, open_tab, tmp_path):
    tab = open_tab(served.address, mode="design")
    page = tab.page
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    for kind, name in (("sphere", "ball"), ("box", "box"), ("cylinder", "cylinder")):
        tab.find("add-object").select_option(kind)
        tab.until(f"voxsoft.objectPosition('{name}') !== null")
    file = tmp_path / "wedge.stl"
    file.write_text(STL)
    tab.find("object-file").set_input_files(file)
    tab.find("import-now").click()
    tab.until("voxsoft.objectPosition('wedge') !== null")
    # The finger is held at its left end and 10 mm wide: all stand in a row to the right of it.
    places = page.evaluate(
        "['ball', 'box', 'cylinder', 'wedge'].map((name) => voxsoft.objectPosition(name))"
    )
    along = [place[0] for place in places]
    assert along == sorted(along)
    assert along[0] > 0.04
    # Tips of the wedge are rounded by a third of a voxel of 5 mm: its box is smaller by some.
    assert [place[1] for place in places] == pytest.approx([0.005] * 4, abs=1.7e-3)
    assert page.get_by_text("deep in").count() == 0
    tab.shot("objects_added")
    entry = tab.find("objects-3")
    entry.get_by_label("Motion", exact=True).select_option("free")
    entry.get_by_label("Mass", exact=True).wait_for()
    tab.shot("objects_free")
    for index, name in ((3, "wedge"), (2, "cylinder"), (1, "box"), (0, "ball")):
        # One step each; the motion of the last is one of its own unless it came within a second.
        while tab.find(f"objects-{index}").count() > 0:
            rev = page.evaluate("voxsoft.rev")
            page.get_by_role("button", name="Undo").click()
            tab.until(f"voxsoft.rev > {rev}")
        tab.until(f"voxsoft.objectPosition('{name}') === null")
        assert tab.find(f"objects-{index - 1}").count() == int(index > 0)
    assert tab.errors == []


RUBBER = '{ model = "neo-hookean", young = "1 MPa", poisson = 0.45, density = "1100 kg/m^3" }'
LATTICE = '{ model = "lattice", edge = "400 kPa", bulk = "1 MPa", density = "1100 kg/m^3" }'


@pytest.fixture
def pinch(tmp_path, serving):
    server = serving(tmp_path, PINCH.read_text(), "pinch.toml")
    yield server
    server.stop()


@pytest.fixture
def pinch_of_lattice(tmp_path, serving):
    text = PINCH.read_text().replace('end_time = "0.5 s"', 'end_time = "0.2 s"')
    assert RUBBER in text
    server = serving(tmp_path, text.replace(RUBBER, LATTICE), "pinch.toml")
    yield server
    server.stop()


def test_pads_touch_a_plate_live_and_it_is_shown(pinch, open_tab):
    tab = open_tab(pinch.address, mode="simulate", size=(1000, 640))
    tab.until("window.voxsoft !== undefined && voxsoft.objectPosition('plate') !== null")
    assert tab.find("not-live").count() == 0
    began = tab.page.evaluate("voxsoft.objectPosition('plate')[2]")
    tab.find("play").click()
    tab.until(f"voxsoft.objectPosition('plate')[2] < {began} - 1e-6")
    tab.until("document.querySelector('[data-testid=contacts] .touch') !== null")
    assert "plate" in tab.find("contacts").inner_text()
    tab.until("voxsoft.time > 0.3")
    # Held by friction, not fallen: 0.2 s of a free fall would be 20 cm.
    assert tab.page.evaluate("voxsoft.objectPosition('plate')[2]") > began - 2e-3
    tab.shot("objects_live")
    assert tab.errors == []


def test_a_small_page_without_time_shows_the_film_of_a_solution(pinch_of_lattice, open_tab):
    tab = open_tab(pinch_of_lattice.address, mode="simulate", size=(1000, 640))
    tab.until("window.voxsoft !== undefined && voxsoft.objectPosition('plate') !== null")
    banner = tab.find("not-live")
    banner.wait_for()
    assert "Live motion does not know spring lattice and contact" in banner.inner_text()
    assert tab.find("play").is_disabled()
    tab.shot("objects_not_live")
    # A press on the body turns the view: nothing answers to a pull.
    x, y = tab.middle()
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    tab.page.mouse.move(x + 40, y, steps=3)
    tab.page.mouse.up()
    tab.find("not-live-solve").click()
    tab.until("voxsoft.state === 'at-rest' && Math.abs(voxsoft.time - 0.2) < 1e-9")
    tab.until("document.querySelector('[data-testid=not-live]') === null")
    last = tab.page.evaluate("voxsoft.frame")
    assert last > 5
    tab.find("scrubber").fill("2")
    tab.until("voxsoft.frame === 2")
    began = tab.page.evaluate("voxsoft.objectPosition('plate')[2]")
    tab.find("play").click()
    tab.until(f"voxsoft.frame === {last}")
    assert tab.page.evaluate("voxsoft.objectPosition('plate')[2]") < began
    tab.shot("objects_film")
    assert tab.errors == []


def test_an_object_is_sized_by_its_grip(served, open_tab):
    tab = open_tab(served.address, mode="design", symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.find("add-object").select_option("sphere")
    tab.until("voxsoft.objectPosition('ball') !== null && voxsoft.vertexPosition(0) !== null")
    radius = tab.find("objects-0").get_by_label("Radius", exact=True)
    began = float(radius.input_value().removesuffix(" mm"))
    grip = tab.find("size-object")
    grip.press("ArrowUp")
    value = "parseFloat(document.querySelector('[aria-label=\"Radius\"]').value)"
    tab.until(f"Math.abs({value} - {began + 0.5}) < 1e-9")
    tab.until("voxsoft.objectPosition('ball') !== null && voxsoft.vertexPosition(0) !== null")
    box = grip.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    tab.page.mouse.move(x - 30, y + 30, steps=4)
    tab.shot("objects_sized")
    tab.page.mouse.up()
    tab.until(f"{value} > {began + 1}")
    # Its middle stays, and one step takes it back.
    tab.page.get_by_role("button", name="Undo").click()
    tab.until(f"Math.abs({value} - {began + 0.5}) < 1e-9")
    tab.page.get_by_role("button", name="Undo").click()
    tab.page.get_by_role("button", name="Undo").click()
    tab.find("objects-0").wait_for(state="detached")
    assert tab.errors == []
