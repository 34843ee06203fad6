"""The way of a new user: from `voxsoft studio cylinder.toml` to an optimized, exported actuator.

Only text on the page is used, in one window, as the paper's users would go. Where
VOXSOFT_SCREENSHOTS names a folder, each step leaves a picture for people to look at.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[3] / "examples"
SIZES = {"wide": (1600, 900), "narrow": (1280, 720)}
# The 105 designs take a second on a free machine; the patience is for a busy one, in ms.
JOB = 240_000

HIGHEST = """(() => {
  let high = -1;
  for (let i = 0, at; (at = voxsoft.vertexPosition(i)); i++) high = Math.max(high, at[2]);
  return high;
})()"""


@pytest.fixture
def studio(tmp_path):
    """The command itself, in a folder with a copy of the example; gives its address."""
    shutil.copy(EXAMPLES / "cylinder.toml", tmp_path)
    command = [str(Path(sys.executable).with_name("voxsoft")), "studio", "cylinder.toml"]
    server = subprocess.Popen(
        [*command, "--no-browser"],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        env={**os.environ, "XDG_STATE_HOME": str(tmp_path)},
    )
    yield server.stdout.readline().strip()
    server.terminate()
    server.wait(30)
    server.stdout.close()


@pytest.mark.browser
@pytest.mark.parametrize("size", ["wide", pytest.param("narrow", marks=pytest.mark.slow)])
def test_from_the_open_page_to_an_exported_actuator(studio, open_tab, alone, tmp_path, size):
    tab = open_tab(studio, size=SIZES[size], mode="design")
    page = tab.page
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.shot(f"new-user-{size}-1-design")

    # Blow it up.
    tab.find("mode-simulate").click()
    unloaded = page.evaluate(HIGHEST)
    tab.find("play").click()
    tab.until("voxsoft.state === 'at-rest'")
    tab.until(f"{HIGHEST} > {unloaded} + 0.004")
    tab.shot(f"new-user-{size}-2-simulate")

    # Try the 105 designs, and open the best of them.
    tab.find("mode-optimize").click()
    start = tab.find("study-start")
    start.get_by_text("Try 105 designs").wait_for()
    start.click()
    page.locator("[data-testid=job-study][data-state=done]").wait_for(timeout=JOB)
    tab.find("trial-count").get_by_text("105 designs").wait_for()
    best = tab.find("trials-table").locator("tbody tr").first
    # The largest, with the thinnest wall: the paper's answer too.
    for value in ("best", "25 mm", "35 mm", "5 mm"):
        assert value in best.inner_text()
    number = best.locator("td").nth(1).inner_text()
    best.click()
    tab.find("document-name").get_by_text(f"cylinder-study-{number}").wait_for()
    tab.until("voxsoft.state === 'at-rest'")
    tab.shot(f"new-user-{size}-3-optimize")

    # Take it away as one page.
    tab.find("export").click()
    with page.expect_download() as waiting:
        tab.find("export-html").get_by_role("button").click()
    tab.shot(f"new-user-{size}-4-export")
    taken = tmp_path / waiting.value.suggested_filename
    waiting.value.save_as(taken)
    assert tab.errors == []

    # The page alone, with no server and no network: it blows up, and goes back without pressure.
    away = alone(taken.as_uri())
    away.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    away.find("play").click()
    away.until(f"{HIGHEST} > {unloaded} + 0.004")
    away.until("voxsoft.state === 'at-rest'")
    away.shot(f"new-user-{size}-5-page")
    away.page.get_by_label("pressure in all cavities slider").focus()
    away.page.keyboard.press("Home")
    away.until(f"Math.abs({HIGHEST} - {unloaded}) < 2e-4")
    assert [url for url in away.requests if not url.startswith(("file:", "blob:", "data:"))] == []
    assert away.errors == []
