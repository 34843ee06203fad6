"""The first view of a body: smooth where a shape cuts voxels, until a hand chooses."""

import pytest

import voxsoft as vs

pytestmark = pytest.mark.browser

ROD = """
schema = "voxsoft/1"
name = "rod"
voxel_size = "5 mm"

[parameters]
length = { value = "40 mm", min = "20 mm", max = "60 mm", step = "5 mm" }

[shapes]
body = { kind = "cylinder", radius = "8 mm", height = "= length" }

[[parts]]
shape = "body"
material = "ecoflex-00-30"

[[clamps]]
region = { z = [0, 0] }

[[loads]]
kind = "gravity"
"""

TRACED = """(() => {
  const option = document.querySelector("[aria-label='Show as'] option[value=smooth]");
  return option !== null && !option.disabled && voxsoft.triangles > 0;
})()"""

# Triangles of the voxels of a rod: 8 layers of 4 x 4. The shape that is traced has more.
MOST = 2 * (2 * 4 * 4 + 4 * 4 * 8)


@pytest.fixture
def opened(serving, tmp_path, open_tab):
    """Opens a fresh tab on a design, once its smooth shape is there."""
    servers = []

    def opening(text):
        servers.append(serving(tmp_path, text))
        tab = open_tab(servers[-1].address, symbols=False)
        tab.until(f"window.voxsoft !== undefined && {TRACED}")
        return tab, tab.page.get_by_label("Show as")

    yield opening
    for server in servers:
        server.stop()


def test_cut_voxels_are_drawn_smooth_until_a_hand_chooses(opened):
    tab, show = opened(ROD)
    assert show.input_value() == "smooth"
    tab.until(f"voxsoft.triangles > {2 * MOST}")
    tab.shot("cut-voxels")
    show.select_option("voxels")
    voxels = tab.until(f"voxsoft.triangles <= {MOST} && voxsoft.triangles")
    # The choice stays for the next body.
    topology = tab.page.evaluate("voxsoft.topology")
    tab.page.locator(".dv-default-tab", has_text="Design").click()
    field = tab.find("pane-design").get_by_label("length", exact=True)
    field.fill("5 cm")
    field.press("Enter")
    tab.until(f"voxsoft.topology !== {topology} && {TRACED}")
    assert show.input_value() == "voxels"
    assert tab.page.evaluate("voxsoft.triangles") == voxels + 2 * 2 * 4 * 4
    assert tab.errors == []


def test_a_page_from_disk_draws_cut_voxels_smooth(alone, tmp_path):
    (tmp_path / "rod.toml").write_text(ROD)
    path = tmp_path / "rod.html"
    vs.load(tmp_path / "rod.toml").show().save(path)
    tab = alone(path.as_uri())
    tab.until(f"window.voxsoft !== undefined && {TRACED} && voxsoft.triangles > {2 * MOST}")
    show = tab.page.get_by_label("Show as")
    assert show.input_value() == "smooth"
    tab.shot("page-of-cut-voxels")
    tab.find("play").click()
    tab.until("voxsoft.time > 0.01")
    show.select_option("voxels")
    tab.until(f"voxsoft.triangles <= {MOST}")
    assert tab.errors == []


def test_chambers_are_surfaces_of_voxels(opened):
    tab, show = opened(ROD)
    smooth = tab.page.evaluate("voxsoft.triangles")
    tab.find("cavities").click()
    tab.until(f"voxsoft.triangles < {smooth}")
    assert show.input_value() == "voxels"
    tab.find("cavities").click()
    tab.until(f"voxsoft.triangles === {smooth}")
    assert show.input_value() == "smooth"
    assert tab.errors == []


def test_a_body_on_the_grid_is_drawn_by_its_voxels(opened, coarse):
    tab, show = opened(coarse.replace("ecoflex-00-30-lattice", "ecoflex-00-30"))
    assert show.input_value() == "voxels"
    assert tab.page.evaluate("voxsoft.triangles") == 2 * 2 * (2 * 2 + 2 * 8 + 2 * 8)
    assert tab.errors == []
