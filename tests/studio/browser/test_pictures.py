"""Pictures for the documentation: VOXSOFT_SCREENSHOTS=docs/images pytest tests/studio/browser."""

import os
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[3] / "examples"

pytestmark = pytest.mark.skipif(
    "VOXSOFT_SCREENSHOTS" not in os.environ, reason="VOXSOFT_SCREENSHOTS names no folder"
)


@pytest.fixture
def bender(tmp_path, serving):
    server = serving(tmp_path, (EXAMPLES / "pneunet.toml").read_text(), "pneunet.toml")
    yield server
    server.stop()


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_pictures_of_design_and_simulation(bender, open_tab, scheme):
    tab = open_tab(bender.address, scheme=scheme, mode="design")
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.find("pane-text").locator(".cm-content").wait_for()
    tab.shot(f"studio-design-{scheme}")
    tab.find("mode-simulate").click()
    tab.find("play").click()
    tab.until("voxsoft.state === 'at-rest' || voxsoft.time > 0.4")
    tab.page.get_by_label("Color by").select_option(label="Von Mises stress")
    tab.find("ghost").click()
    tab.page.locator(".viewport canvas").focus()
    tab.page.keyboard.press("f")
    tab.until("document.querySelector('.legend-title').textContent.includes('Mises')")
    tab.page.wait_for_timeout(500)  # the camera and the colors of a picture, not of a check
    tab.shot(f"studio-simulate-{scheme}")
    assert tab.errors == []
