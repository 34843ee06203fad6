"""A body in itself is amber in the picture, with marks that lead there; its rest is not green."""

from pathlib import Path

import pytest

DATA = Path(__file__).parents[2] / "data"


@pytest.fixture
def gripper(tmp_path, serving):
    server = serving(tmp_path, (DATA / "gripper.toml").read_text(), "gripper.toml")
    yield server
    server.stop()


@pytest.mark.slow
def test_a_gripper_in_its_ball_is_shown_in_amber(gripper, open_tab):
    tab = open_tab(gripper.address, mode="simulate")
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    assert tab.find("overlap").count() == 0
    tab.find("rest").click()
    banner = tab.find("overlap")
    banner.wait_for()
    assert "contact is not simulated" in banner.inner_text()
    assert "ball" in banner.inner_text()
    tab.until("voxsoft.state === 'at-rest'")
    assert "is-doubtful" in tab.find("sentence").get_attribute("class")
    tab.shot("studio_overlap")
    mark = tab.find("label-overlap-0")
    assert mark.inner_text().endswith("mm")
    before = tab.page.evaluate("voxsoft.screenOf(0)")
    tab.find("overlap-show").click()
    tab.until(f"voxsoft.screenOf(0)[0] !== {before[0]}")
    tab.shot("studio_overlap_near")
    tab.find("reset").click()
    tab.until("document.querySelector('[data-testid=overlap]') === null")
    assert tab.errors == []
