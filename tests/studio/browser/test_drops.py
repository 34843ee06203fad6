"""Files that are dropped anywhere on the page go where they belong."""

from pathlib import Path

import pytest
from dropping import drag, drop

pytestmark = pytest.mark.browser

DATA = Path(__file__).parents[3] / "examples" / "data"
TENSILE = (DATA / "tensile" / "ecoflex-00-30.csv").read_text()


def has_text(tab, piece):
    tab.until(f"document.querySelector('.cm-content')?.innerText.includes({piece!r})")


def test_a_tensile_test_becomes_the_material_of_a_part(served, open_tab):
    tab = open_tab(served.address, mode="design", symbols=False)
    tab.find("text-editor").locator(".cm-content").wait_for()
    drop(tab, "my-silicone.csv", TENSILE)
    # Two actions from the file to the part: the drop, and this press.
    use = tab.find("coupon-use")
    use.wait_for()
    tab.find("plot-coupon").locator(".plot-key").get_by_text("my-silicone.csv").wait_for()
    facts = tab.find("coupon-facts").inner_text()
    assert "Young's modulus" in facts
    assert "kPa" in facts
    tab.shot("tensile")
    use.click()
    tab.page.get_by_text("body is made of my-silicone", exact=True).wait_for()
    tab.page.get_by_role("button", name="Design", exact=True).click()
    has_text(tab, 'material = "my-silicone"')
    has_text(tab, "my-silicone = {")
    tab.until("document.querySelector('[data-testid=text-editor] .cm-lintRange-error') === null")
    assert tab.errors == []


def test_a_tensile_test_on_the_box_of_measured_points_is_fitted(served, open_tab):
    tab = open_tab(served.address, mode="calibrate", symbols=False)
    tab.find("calibrate-form").wait_for()
    drop(tab, "coupon.csv", TENSILE, ".drop-table")
    tab.find("plot-coupon").wait_for()
    assert tab.find("measured").count() == 0
    # Another test of it is fitted with the first.
    drop(tab, "second.csv", TENSILE)
    tab.find("plot-coupon").locator(".plot-key").get_by_text("second.csv").wait_for()
    tab.page.get_by_role("button", name="Remove second.csv").click()
    tab.find("plot-coupon").locator(".plot-key").get_by_text("second.csv").wait_for(
        state="detached"
    )


def test_a_table_of_forces_asks_for_the_specimen(served, open_tab):
    rows = "".join(f"\n{3 * i},{0.3 * i}" for i in range(12))
    tab = open_tab(served.address, mode="calibrate", symbols=False)
    tab.find("calibrate-form").wait_for()
    drop(tab, "machine.csv", "Extension (mm),Load (N)" + rows)
    tab.find("coupon-problem").get_by_text("holds forces").wait_for()
    for label, size in (("Cross section", "18 mm^2"), ("Gauge length", "33 mm")):
        field = tab.find("coupon-pane").get_by_label(label)
        field.fill(size)
        field.press("Enter")
    tab.find("plot-coupon").wait_for()
    tab.find("coupon-problem").wait_for(state="detached")


BEAM = (DATA / "paper_beams" / "ecoflex-00-30.csv").read_text()
SAG = "case,gravity (m/s^2),tip_z_mm,angle_deg\na,0,0,0\nb,4,-1,3\nc,9.81,-2.5,8\n"


def test_points_of_a_beam_go_to_the_calibration(served, open_tab):
    tab = open_tab(served.address, symbols=False)
    tab.find("run-form").or_(tab.find("reset")).first.wait_for()
    drag(tab, "beam.csv", BEAM)
    tab.page.locator(".drop-here").get_by_text("a table of measurements (.csv)").wait_for()
    drop(tab, "beam.csv", BEAM)
    tab.find("measured").get_by_text("9 stations").wait_for()
    tab.page.locator(".drop-here").wait_for(state="detached")


@pytest.mark.parametrize("first", ["table", "path"])
def test_a_measured_curve_lies_over_the_path(served, open_tab, first):
    tab = open_tab(served.address, symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    pane = tab.find("path-pane")
    if first == "path":
        tab.page.get_by_text("Path", exact=True).click()
    else:
        # Dropped on the view: the pane comes to the front, and follows what the table is over.
        drop(tab, "sag.csv", SAG, ".viewport")
        tab.find("path-table").get_by_text("sag.csv").wait_for()
        assert pane.get_by_label("Change", exact=True).input_value().startswith("loads[0]")
    tab.find("path-start").click()
    tab.find("path-end").wait_for()
    if first == "path":
        drop(tab, "sag.csv", SAG)
    tab.find("path-misfit").get_by_text("root mean square of 3 points").wait_for()
    tab.page.get_by_label("Displacement of tip along z over gravity").wait_for()
    tab.shot("path-dropped")
    # A number of another kind than all of them says so, and names a head that would be read.
    drop(tab, "heated.csv", "gravity (m/s^2),inside_K\n0,300\n5,310\n")
    tab.find("path-problem").get_by_text("“inside_K” (a temperature)").wait_for()
    tab.page.get_by_role("button", name="Remove heated.csv").click()
    tab.find("path-problem").wait_for(state="detached")
    tab.find("path-misfit").wait_for()
    assert tab.errors == []


def finger(unit):
    """Triangles of a box of 40 mm x 10 mm x 10 mm, as text in STL."""
    x, y, z = (side / unit for side in (0.04, 0.01, 0.01))
    corners = [(i & 1, i >> 1 & 1, i >> 2) for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    lines = ["solid finger"]
    for a, b, c, d in quads:
        for triangle in ((a, b, c), (a, c, d)):
            at = (corners[k] for k in triangle)
            spots = (f"vertex {i * x!r} {j * y!r} {k * z!r}" for i, j, k in at)
            lines += ["facet normal 0 0 0", "outer loop", *spots, "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid finger", ""])


def test_a_mesh_in_meters_asks_for_its_unit_with_all_sizes(own_server, open_tab):
    tab = open_tab(own_server.address, mode="design", symbols=False)
    tab.find("text-editor").locator(".cm-content").wait_for()
    drop(tab, "finger.stl", finger(unit=1.0))
    sheet = tab.find("import-sheet")
    sheet.wait_for()
    sizes = sheet.locator(".import-units").inner_text()
    for size in ("40 × 10 × 10 µm", "0.4 × 0.1 × 0.1 mm", "40 × 10 × 10 mm"):
        assert size in sizes
    assert sheet.get_by_role("radio", name="40 × 10 × 10 mm").is_checked()
    result = tab.find("import-result")
    assert "voxels of 1.2 mm" in result.inner_text() or "voxels of 1.3 mm" in result.inner_text()
    tab.shot("import")
    # The voxels follow the unit, the factor and the turn.
    sheet.get_by_label("Scale").fill("2")
    sheet.get_by_label("Scale").press("Tab")
    result.get_by_text("80 × 20 × 20 mm, in voxels of 2.5 mm").wait_for()
    sheet.get_by_label("Up in the file").select_option("x")
    result.get_by_text("20 × 20 × 80 mm, in voxels of 2.5 mm").wait_for()
    tab.find("import-now").click()
    has_text(tab, 'voxel_size = "2.5 mm"')
    has_text(tab, 'kind = "rotate"')
    tab.until("voxsoft.triangles > 0 && document.querySelector('.cm-lintRange-error') === null")
    assert tab.errors == []


def test_a_mesh_that_was_given_up_leaves_the_design(served, open_tab):
    tab = open_tab(served.address, mode="design", symbols=False)
    tab.find("text-editor").locator(".cm-content").wait_for()
    rev = tab.page.evaluate("voxsoft.rev")
    drop(tab, "finger.stl", finger(unit=1e-3))
    tab.find("import-sheet").wait_for()
    tab.page.keyboard.press("Escape")
    tab.find("import-sheet").wait_for(state="detached")
    assert tab.page.evaluate("voxsoft.rev") == rev
