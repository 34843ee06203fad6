"""The legend of the view: ends of the colors, and values beyond."""

import re

import pytest

pytestmark = pytest.mark.browser

PULLED_AT_A_CORNER = """
schema = "voxsoft/1"
name = "pulled"
voxel_size = "2.5 mm"

[shapes]
body = { kind = "box", size = ["40 mm", "10 mm", "10 mm"], corner = [0, 0, 0] }

[[parts]]
shape = "body"
material = "ecoflex-00-30-lattice"

[[clamps]]
region = { x = [0, 0] }

[[loads]]
kind = "force"
region = { x = ["40 mm", "40 mm"], y = [0, 0], z = [0, 0] }
value = ["50 mN", "0 N", "0 N"]
"""
VON_MISES = "5"


def test_colors_leave_out_a_lone_corner_and_the_legend_names_it(tmp_path, serving, open_tab):
    server = serving(tmp_path, PULLED_AT_A_CORNER, "pulled.toml")
    try:
        tab = open_tab(server.address)
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        tab.find("rest").click()
        tab.until("voxsoft.state === 'at-rest'")
        tab.page.get_by_label("Color by").select_option(VON_MISES)
        clipped = tab.find("legend-clipped")
        clipped.wait_for()
        words = clipped.inner_text().replace("\n", " ")
        found = re.fullmatch(r"clipped at 99 %; max ([\d.]+) kPa at \(40, 0, 0\) mm", words)
        assert found, words
        top = float(tab.page.locator(".legend-ticks > span").first.inner_text())
        assert top < 0.8 * float(found[1])
        tab.shot("legend-clipped")
        # Displacements are never clipped.
        tab.page.get_by_label("Color by").select_option("0")
        clipped.wait_for(state="detached")
        assert tab.errors == []
    finally:
        server.stop()
