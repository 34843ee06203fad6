"""Molds by the mouse: from the design to files for a printer, and a sheet that says how."""

import re
import zipfile

import pytest
from auditing import Audit

pytestmark = pytest.mark.browser

CUP = """
schema = "voxsoft/1"
name = "cup"
voxel_size = "2 mm"

[parameters]
height = { value = "12 mm", min = "8 mm", max = "20 mm" }

[shapes]
out = { kind = "cylinder", radius = "7 mm", height = "= height" }
room = { kind = "cylinder", radius = "4 mm", height = "= height - 6 mm", base = [0, 0, "3 mm"] }
body = { kind = "difference", of = ["out", "room"] }

[[parts]]
shape = "body"
material = "ecoflex-00-30"

[[clamps]]
region = { z = [0, 0] }
"""


@pytest.fixture
def cup(tmp_path, serving):
    server = serving(tmp_path, CUP, "cup.toml")
    yield server
    server.stop()


def parameter(tab, text):
    field = tab.find("parameter-height").get_by_role("textbox", name="height")
    field.fill(text)
    field.press("Enter")


def test_molds_are_made_looked_at_and_fetched(axe, cup, open_tab):
    tab = open_tab(cup.address, mode="design")
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.find("mode-make").click()
    pane = tab.find("make-pane")
    tab.page.get_by_role("tab", name="Sheet").click()
    tab.page.get_by_text("No sheet yet").wait_for()
    tab.page.get_by_role("tab", name="View").click()
    tab.find("make-molds").click()
    made = tab.find("made")
    made.get_by_text("Cast in halves and bonded").wait_for()
    assert made.get_by_text("the plane z = 9 mm opens it for a core").count() == 1
    rows = tab.find("castings").locator("tbody tr")
    assert rows.count() == 2
    # pi (7² 12 - 4² 6) mm³ without the inlet, 2.7 mm wide and 3 mm long; polygons lack 0.4 %.
    volumes = [float(rows.nth(k).locator("td").nth(1).inner_text()) for k in (0, 1)]
    assert sum(volumes) == pytest.approx(1.5285, rel=0.004)
    # Half of 1.07 g/mL and 15 % more.
    assert "Mix 0.94 g of A and 0.94 g of B" in tab.find("mix").inner_text()
    sheet = tab.page.frame_locator("iframe[title='Sheet of the molds']")
    sheet.get_by_role("heading", name="Steps").wait_for()
    assert sheet.locator("img").count() == 2
    assert sheet.locator("img").first.evaluate("(image) => image.naturalWidth") > 100
    tab.shot("make")
    audit = Audit(tab)
    audit.look("make")
    assert audit.found == {}, audit.report()
    with tab.page.expect_download() as waiting:
        tab.find("molds-zip").click()
    assert waiting.value.suggested_filename == "cup-molds.zip"
    held = zipfile.ZipFile(waiting.value.path()).namelist()
    parts = {"body-low-lower", "body-low-upper", "body-high-lower", "plate-1"}
    wanted = {f"cup-molds/{name}.3mf" for name in parts} | {"cup-molds/sheet.html"}
    assert wanted <= set(held)
    # A change of the design makes them molds of the past, which the page says.
    tab.find("mode-design").click()
    parameter(tab, "14 mm")
    tab.find("mode-make").click()
    pane.get_by_text("of the design before its last change").wait_for()
    pane.get_by_role("button", name="Make again").click()
    pane.get_by_text("of the design before its last change").wait_for(state="detached")
    assert tab.errors == []


def test_molds_that_cannot_be_made_say_why_and_a_wrong_limit_is_named(cup, open_tab):
    tab = open_tab(cup.address, mode="make")
    pane = tab.find("make-pane")
    pane.get_by_label("Way", exact=True).select_option("cast")
    tab.find("make-molds").click()
    problems = tab.find("mold-problems")
    problems.get_by_text("it has undercuts for every pair of mold parts").wait_for()
    assert tab.find("molds-zip").count() == 0
    pane.get_by_label("Way", exact=True).select_option("")
    wall = pane.get_by_label("Thinnest wall", exact=True)
    wall.fill("8 N")
    wall.press("Enter")
    tab.find("make-molds").click()
    tab.find("toast").get_by_text(re.compile("wall.*8 N")).wait_for()
    wall.fill("0.8 mm")
    wall.press("Enter")
    room = pane.get_by_label("Room", exact=True)
    room.fill("25 mm, 25 mm, 25 mm")
    room.press("Enter")
    tab.find("make-molds").click()
    pane.get_by_text(re.compile(r"Join the \d segments of body-low-lower")).wait_for()
