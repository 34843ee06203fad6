"""A study of grippers: pictures with the ball, and designs that open as they were solved."""

import tomllib
from concurrent.futures import ThreadPoolExecutor

import pytest
from fingers import open_atlas
from gripped_ball import GRIPPER

from voxsoft.design import Design
from voxsoft.study import Study

pytestmark = pytest.mark.browser

SQUEEZES = [0.3e-3, 0.5e-3, 0.7e-3]


@pytest.fixture(scope="module")
def studied(serving, tmp_path_factory):
    """A gripper that is open, and a study of others."""
    folder = tmp_path_factory.mktemp("studio")
    design = Design.from_document(tomllib.loads(GRIPPER))
    with ThreadPoolExecutor(1) as threads:
        study = Study(design, {"squeeze": SQUEEZES}, folder=folder / "runs" / "grippers")
        study.grid(executor=threads)
    server = serving(folder, GRIPPER, "gripper.toml")
    yield server
    server.stop()


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_a_gripper_of_a_study_opens_as_it_was_solved(studied, open_tab, scheme):
    tab = open_tab(studied.address, mode="runs", scheme=scheme)
    open_atlas(tab, len(SQUEEZES))
    assert tab.page.locator(".trial-unloaded").count() == 0
    tab.shot(f"gripper-study-atlas-{scheme}")
    checks = tab.find("trials-table").get_by_role("checkbox")
    checks.nth(0).check()
    checks.nth(2).check()
    tab.find("compare-pinned").click()
    tab.page.locator("[data-testid^=largest]").nth(1).wait_for()
    tab.shot(f"gripper-study-compare-{scheme}")
    tab.page.get_by_role("tab", name="Atlas").click()
    tab.page.locator(".trial-frame.is-best").dblclick()
    tab.until("voxsoft.state === 'at-rest'")
    tab.find("mode-simulate").click()
    tab.find("missing").get_by_text("Only the end").wait_for()
    assert "held" in tab.find("grips").inner_text()
    assert "ball" in tab.find("contacts").inner_text()
    card = tab.find("equilibrium").locator("dl").first.inner_text()
    tab.shot(f"gripper-study-opened-{scheme}")
    tab.find("solve-again").click()
    tab.find("missing").wait_for(state="detached")
    tab.until("voxsoft.state === 'at-rest'")
    tab.find("equilibrium").wait_for()
    assert tab.find("equilibrium").locator("dl").first.inner_text() == card
    assert tab.errors == []
