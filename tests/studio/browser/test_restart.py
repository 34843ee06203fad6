"""Restarts of the server: open tabs come back to it, with edits that they kept."""

import pytest

pytestmark = pytest.mark.browser


@pytest.fixture
def restarted(serving, tmp_path, monkeypatch):
    """A server with a token of its own, whose state is in a folder of the test."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    server = serving(tmp_path, token="")
    yield server
    server.stop()


def connected(tab):
    tab.find("link").get_by_text("connected", exact=True).wait_for()


def test_a_tab_comes_back_with_its_edits_after_a_restart(restarted, open_tab):
    tab = open_tab(restarted.address, mode="design")
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    restarted.stop()
    tab.find("disconnected").get_by_text("retrying").wait_for()
    length = tab.find("parameter-length").get_by_role("textbox", name="length")
    length.fill("45 mm")
    length.press("Enter")
    restarted.start()
    connected(tab)
    tab.until("document.querySelector('.cm-content').innerText.includes('45 mm')")
    tab.until("voxsoft.rev > 1")


def test_a_refused_tab_comes_back_when_the_new_address_is_opened(restarted, open_tab):
    tab = open_tab(restarted.address, mode="design")
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    old = restarted.address
    restarted.stop()
    restarted.token = "another-token-that-the-tests-know-too"
    restarted.start()
    tab.find("link").get_by_text("refused").wait_for()
    second = tab.page.context.new_page()
    second.goto(restarted.address)
    second.get_by_test_id("link").get_by_text("connected", exact=True).wait_for()
    connected(tab)
    # The old address takes the right to be there away from nobody.
    second.goto(old)
    second.get_by_test_id("link").get_by_text("connected", exact=True).wait_for()
    second.reload()
    second.get_by_test_id("link").get_by_text("connected", exact=True).wait_for()


def test_an_old_address_reads_a_plain_sentence(restarted, chromium):
    context = chromium.new_context()
    errors = []
    page = context.new_page()
    page.on("console", lambda m: errors.append(m.text) if m.type == "error" else None)
    page.goto(f"http://127.0.0.1:{restarted.port}/?token=that-of-last-week")
    page.get_by_text("This address is no longer valid").wait_for()
    assert "voxsoft studio" in page.inner_text("body")
    assert len(errors) <= 1  # the refusal itself
    context.close()
