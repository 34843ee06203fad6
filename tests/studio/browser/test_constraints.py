"""Studies whose designs break a constraint: the page says which one, and by how much."""

import pytest
from fingers import open_atlas

pytestmark = [pytest.mark.browser, pytest.mark.long]

LIMITED = """
schema = "voxsoft/1"
name = "bar"
voxel_size = "5 mm"

[parameters]
length = { value = "40 mm", min = "20 mm", max = "40 mm", step = "10 mm" }
width  = { value = "10 mm", min = "10 mm", max = "20 mm", step = "10 mm" }

[shapes]
body = { kind = "box", size = ["= length", "= width", "10 mm"] }

[[parts]]
shape = "body"
material = "ecoflex-00-30"

[[clamps]]
region = { x = [0, 0] }

[[loads]]
kind = "gravity"

[probes]
tip = { x = ["= length", "= length"] }

[objectives]
sag = { maximize = "displacement", probe = "tip" }

[constraints]
limit = { metric = "mass", max = "LIMIT" }
"""
# Bars of Ecoflex 00-30 (1,070 kg/m3): the lightest has 2.14 g, the heaviest 8.56 g.
SOME, NONE = "5 g", "1 g"


@pytest.fixture
def studied(serving, tmp_path, open_tab):
    """Opens the studio on bars with a limit, and runs the study of six."""
    servers = []

    def opening(limit):
        server = serving(tmp_path, LIMITED.replace("LIMIT", limit), "bar.toml")
        servers.append(server)
        tab = open_tab(server.address, mode="optimize", symbols=False)
        tab.find("study-start").click()
        tab.page.locator("[data-testid=job-study][data-state=done]").wait_for()
        return tab

    yield opening
    for server in servers:
        server.stop()


def test_a_design_that_is_not_allowed_says_why(studied):
    tab = studied(SOME)
    table = tab.find("trials-table")
    table.get_by_role("button", name="limit at most 5 g").wait_for()
    bad = table.locator("tr", has_text="not allowed")
    bad.first.wait_for()
    assert "limit is " in bad.first.inner_text()
    assert "at most 5 g" in bad.first.inner_text()
    open_atlas(tab)
    # One histogram: the mass itself would be drawn twice.
    requirements = tab.find("requirements")
    requirements.get_by_text("allowed: at most 5 g").wait_for()
    assert tab.find("requirement-mass").count() == 0
    assert requirements.locator(".range-bound").count() == 1
    dimmed = tab.page.locator(".trial-frame.is-dimmed").count()
    assert dimmed == bad.count() > 0
    tab.shot("constraints")
    assert tab.errors == []


def test_a_limit_that_no_design_keeps_is_named(studied):
    tab = studied(NONE)
    job = tab.find("job-study")
    job.get_by_text("no design is allowed: it is 2.14 g to 8.56 g in all of 6").wait_for()
    assert tab.errors == []


def test_ranges_of_a_study_stay(studied):
    tab = studied(SOME)
    high = tab.page.get_by_label("length to", exact=True)
    high.fill("30 mm")
    high.press("Enter")
    tab.find("study-start").get_by_text("Try 4 designs").wait_for()
    tab.page.reload()
    tab.find("study-start").get_by_text("Try 4 designs").wait_for()
    assert tab.errors == []
