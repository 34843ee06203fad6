"""Fineness check of the mesh, asked beside the result."""

import pytest

pytestmark = pytest.mark.browser


@pytest.fixture
def opened(serving, tmp_path, open_tab):
    servers = []

    def opening(text, **options):
        server = serving(tmp_path, text=text)
        servers.append(server)
        tab = open_tab(server.address, **options)
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        tab.page.keyboard.press("r")
        tab.find("equilibrium").wait_for()
        tab.find("fineness-open").click()
        return tab

    yield opening
    for server in servers:
        server.stop()


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_errors_and_costs_are_there_and_halving_is_one_step(opened, coarse, scheme):
    tab = opened(coarse.replace("ecoflex-00-30-lattice", "ecoflex-00-30"), scheme=scheme)
    answer = tab.find("fineness")
    answer.get_by_text("Within 2 %").or_(answer.get_by_text("Beyond")).first.wait_for()
    answer.get_by_role("row", name="Voxels").get_by_text("about 256").wait_for()
    tab.shot(f"fineness-{scheme}")
    tab.find("halve").click()
    tab.find("fineness").wait_for(state="detached")
    tab.until("voxsoft.triangles > 400")
    tab.page.keyboard.press("Control+z")
    tab.until("voxsoft.triangles < 400")
    tab.page.keyboard.press("r")
    tab.find("equilibrium").wait_for()
    tab.find("fineness-open").click()
    tab.shot("fineness-again")
    tab.find("refine-worst").click()
    tab.find("toast").get_by_text("most of the error").wait_for()
    tab.find("fineness").wait_for(state="detached")
    assert tab.errors == []


def test_a_lattice_says_why_and_can_be_asked_for(opened, coarse):
    tab = opened(coarse)
    answer = tab.find("fineness")
    answer.get_by_text("the constants of a lattice are fitted").wait_for()
    tab.find("fineness-estimate").click()
    answer.get_by_text("probe tip").first.wait_for()
    assert tab.find("fineness-estimate").count() == 0
    assert tab.errors == []
