"""The atlas of a study: pictures, requirements, and a design that is taken or opened."""

import re

import pytest
from fingers import LENGTHS, open_atlas, study_fingers

pytestmark = pytest.mark.browser


@pytest.fixture
def studied(serving, tmp_path, coarse):
    """A finger that is open, and a study of others."""
    server = serving(tmp_path, text=study_fingers(coarse, tmp_path / "runs" / "fingers"))
    yield server
    server.stop()


def dimmed(tab):
    return tab.page.evaluate("document.querySelectorAll('.trial-frame.is-dimmed').length")


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_designs_are_seen_and_requirements_dim_them(studied, open_tab, scheme):
    tab = open_tab(studied.address, mode="runs", scheme=scheme)
    open_atlas(tab)
    page = tab.page
    # The failed one is an empty frame with its reason.
    failed = page.locator(".trial-frame.is-failed")
    assert failed.count() == 1
    assert failed.locator("img").count() == 0
    assert len(failed.inner_text().strip()) > 10
    assert "7 designs, 1 without result" in tab.find("remaining").inner_text()
    tab.shot(f"atlas-map-{scheme}")
    # A longer finger is drawn larger: all have one scale.
    widths = page.evaluate(
        "[...document.querySelectorAll('.trial-frame img')].map(i => i.clientWidth)"
    )
    assert max(widths) > 1.4 * min(widths)
    page.get_by_label("Arrangement").select_option("grid")
    slider = page.get_by_label("sag, at least")
    slider.focus()
    for _ in range(5):
        page.keyboard.press("PageUp")
    tab.until("document.querySelectorAll('.trial-frame.is-dimmed').length > 1")
    left = int(re.match(r"(\d+) of 7 remain", tab.find("remaining").inner_text())[1])
    assert 0 < left < len(LENGTHS)
    assert dimmed(tab) == 7 - left
    # The table and the parallel axes have the same requirement.
    assert tab.find("trials-table").locator("tbody tr").count() == left
    assert page.locator(".parallel-line:not(.faded)").count() == left
    tab.shot(f"atlas-grid-{scheme}")
    tab.find("clear-requirements").click()
    assert dimmed(tab) == 0
    assert tab.errors == []


def test_a_design_is_taken_into_the_open_document_and_opened_as_its_own(studied, open_tab):
    tab = open_tab(studied.address, mode="runs", symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    open_atlas(tab)  # the design of the study is open now, which is none of its trials
    page = tab.page
    page.get_by_label("Arrangement").select_option("grid")
    frame = page.locator(".trial-frame.is-best")
    frame.click()
    card = tab.find("trial-card")
    card.wait_for()
    tab.find("take").click()
    tab.find("toast").get_by_text("has the parameters of design").wait_for()
    tab.until("voxsoft.state === 'at-rest'")
    name = tab.find("document-name").inner_text()
    tab.find("open-trial").click()
    tab.find("document-name").get_by_text(re.compile(r"fingers-\d+")).wait_for()
    assert tab.find("document-name").inner_text() != name
    tab.until("voxsoft.state === 'at-rest'")
    assert tab.errors == []
