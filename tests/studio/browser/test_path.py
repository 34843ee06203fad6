"""A path of equilibria by the mouse: choose a load, follow it, see numbers over it."""

from pathlib import Path

import pytest

pytestmark = pytest.mark.browser

ROOT = Path(__file__).parents[3]


@pytest.fixture
def gripper(serving, tmp_path):
    text = (ROOT / "examples" / "magnetic_gripper.toml").read_text()
    server = serving(tmp_path, text=text, name="gripper.toml")
    yield server
    server.stop()


def test_a_field_is_followed_and_seen_again_after_a_reload(gripper, open_tab, tmp_path):
    tab = open_tab(gripper.address)
    tab.page.get_by_text("Path", exact=True).click()
    pane = tab.find("path-pane")
    pane.get_by_label("Change", exact=True).select_option("loads[0].value[2]")
    pane.get_by_label("To", exact=True).fill("12 mT")
    pane.get_by_label("To", exact=True).press("Enter")
    pane.get_by_label("Equilibria", exact=True).fill("5")
    pane.get_by_label("Equilibria", exact=True).press("Enter")
    tab.find("path-start").click()
    end = tab.find("path-end")
    end.wait_for()
    assert "5 equilibria" in end.inner_text()
    numbers = pane.get_by_label("Number along the path")
    assert numbers.input_value() == "lift"
    tab.find("plot-path").wait_for()
    tab.shot("path")
    measured = tmp_path / "measured.csv"
    measured.write_text("field_mT,lift_mm\n0,0\n6,1\n12,2\n")
    tab.find("path-measured").set_input_files(measured)
    tab.find("path-misfit").wait_for()
    assert "root mean square of 3 points" in tab.find("path-misfit").inner_text()
    tab.shot("path-measured")
    numbers.select_option("tip.x")
    tab.page.get_by_label("Displacement of tip along x over magnetic field along z").wait_for()
    tab.page.reload()
    tab.page.get_by_text("Path", exact=True).click()
    tab.find("path-end").wait_for()
    assert tab.errors == []


def test_rubber_creeps_over_time_and_names_its_stiffness(serving, tmp_path, open_tab, coarse):
    rubber = (
        '{ model = "neo-hookean", young = "60 kPa", density = "1000 kg/m^3", '
        'prony = [{ g = 0.4, tau = "10 s" }] }'
    )
    text = coarse.replace('material = "ecoflex-00-30-lattice"', f"material = {rubber}")
    server = serving(tmp_path, text=text)
    try:
        tab = open_tab(server.address)
        tab.page.get_by_text("Path", exact=True).click()
        pane = tab.find("path-pane")
        assert "long-term stiffness" in tab.find("path-stiffness").inner_text()
        pane.get_by_label("Change", exact=True).select_option("time")
        assert "instantaneous" in tab.find("path-stiffness").inner_text()
        # Five relaxation times: less than a hundredth is left.
        assert pane.get_by_label("To", exact=True).input_value().startswith("50")
        pane.get_by_label("Equilibria", exact=True).fill("3")
        pane.get_by_label("Equilibria", exact=True).press("Enter")
        tab.find("path-start").click()
        end = tab.find("path-end")
        end.wait_for()
        assert "3 equilibria" in end.inner_text()
        pane.get_by_label("Number along the path").select_option("tip.z")
        tab.page.get_by_label("Displacement of tip along z over time").wait_for()
        tab.shot("path-creep")
        assert tab.errors == []
    finally:
        server.stop()


def test_a_path_that_is_lost_says_where(serving, tmp_path, open_tab, coarse):
    heavy = coarse.replace(
        'kind = "gravity"',
        'kind = "traction"\nregion = { z = ["10 mm", "10 mm"] }\nvalue = "1 kPa"',
    )
    server = serving(tmp_path, text=heavy.replace("ecoflex-00-30-lattice", "ecoflex-00-30"))
    try:
        tab = open_tab(server.address)
        tab.page.get_by_text("Path", exact=True).click()
        pane = tab.find("path-pane")
        pane.get_by_label("To", exact=True).fill("10 MPa")
        pane.get_by_label("To", exact=True).press("Enter")
        tab.find("path-start").click()
        end = tab.find("path-end")
        end.wait_for()
        assert "lost at traction = " in end.inner_text()
        tab.shot("path-lost")
    finally:
        server.stop()
