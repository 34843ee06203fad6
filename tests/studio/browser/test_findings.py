"""Stumbling blocks of a new user: findings without a place, numbers that are none, a lamp that
is lit for nothing, and materials that stop time."""

import pytest

pytestmark = pytest.mark.browser

#: Two blocks that touch along an edge alone, and a probe beside both.
HINGED = """
schema = "voxsoft/1"
name = "hinged"
voxel_size = "5 mm"

[shapes]
low = { kind = "box", size = ["20 mm", "10 mm", "10 mm"] }
corner = { kind = "box", size = ["20 mm", "10 mm", "10 mm"] }
high = { kind = "translate", by = ["20 mm", 0, "10 mm"], of = "corner" }
body = { kind = "union", of = ["low", "high"] }

[[parts]]
shape = "body"
material = "ecoflex-00-30"

[[clamps]]
region = { x = [0, 0] }

[[loads]]
kind = "gravity"
"""


@pytest.fixture
def hinged(serving, tmp_path, open_tab):
    server = serving(tmp_path, text=HINGED, name="hinged.toml")
    tab = open_tab(server.address, mode="design", symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    yield tab
    server.stop()
    assert tab.errors == []


def test_a_finding_names_its_subject_and_leads_to_its_place(hinged):
    finding = hinged.find("findings").locator("button.finding").first
    finding.wait_for()
    assert "edge" in finding.inner_text()
    before = hinged.page.evaluate("voxsoft.screenOf(0)")
    finding.click()
    hinged.until("document.querySelector('.view-label.spot') !== null")
    hinged.until(f"String(voxsoft.screenOf(0)) !== String({before})")
    box = hinged.page.locator(".view-label.spot").bounding_box()
    stage = hinged.page.locator(".viewport canvas").bounding_box()
    assert stage["x"] < box["x"] < stage["x"] + stage["width"]
    assert stage["y"] < box["y"] < stage["y"] + stage["height"]
    hinged.shot("finding")


def test_a_body_that_cannot_be_solved_has_no_mass_of_nothing(serving, tmp_path, open_tab, coarse):
    text = coarse
    text = text.replace('tip = { x = ["= length", "= length"] }', 'top = { z = ["1 m", "1 m"] }')
    server = serving(tmp_path, text=text)
    tab = open_tab(server.address, mode="design", symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    finding = tab.find("findings").get_by_text("top")
    finding.first.wait_for()
    # The subject comes first, by its name and not by its index.
    assert (
        tab.find("findings").inner_text().replace("✕", "").strip().lower().startswith("probe top")
    )
    mass = tab.page.locator("dt", has_text="Mass").locator("xpath=following-sibling::dd")
    assert mass.inner_text() != "0 g"
    assert tab.errors == []
    server.stop()


def test_the_lamp_of_the_present_is_lit_while_time_runs_alone(tab):
    lit = "document.querySelector('[data-testid=live]').classList.contains('on')"
    assert tab.page.evaluate(lit) is False
    tab.find("play").click()
    tab.until(lit)
    tab.find("play").click()
    tab.until(f"!{lit}")
    tab.find("rest").click()
    tab.until("voxsoft.state === 'at-rest'")
    assert tab.page.evaluate(lit) is False


def test_another_material_is_solved_by_whichever_solver_it_needs(
    serving, tmp_path, open_tab, coarse
):
    server = serving(tmp_path, text=coarse)
    tab = open_tab(server.address, mode="simulate", symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    for material in ("dragon-skin-30", "ecoflex-00-30", "ecoflex-00-30-lattice"):
        rev = tab.page.evaluate("voxsoft.rev")
        tab.find("mode-design").click()
        part = tab.find("parts-0")
        part.wait_for()
        if part.get_by_label("Material", exact=True).count() == 0:
            part.get_by_role("button", name="body", exact=False).first.click()
        part.get_by_label("Material", exact=True).select_option(material)
        tab.until(f"voxsoft.rev > {rev}")
        tab.find("mode-simulate").click()
        tab.until("voxsoft.state !== 'meshing'")
        tab.find("rest").click()
        tab.until("voxsoft.state === 'at-rest'")
    assert tab.errors == []
    server.stop()
