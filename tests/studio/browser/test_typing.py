"""Nothing that was typed is lost, however soon something else is asked."""

import json

import pytest

pytestmark = pytest.mark.browser

TYPED = "# typed"


@pytest.fixture
def typed(own_server, open_tab):
    """The mode Design with a word typed into the text, which the server has not got yet."""
    tab = open_tab(own_server.address, mode="design")
    tab.find("parameter-length").wait_for()
    content = tab.find("text-editor").locator(".cm-content")
    content.wait_for()
    # Some change, so that there is something to undo.
    size = tab.find("parameter-length").get_by_role("textbox", name="length", exact=True)
    size.fill("50 mm")
    size.press("Enter")
    tab.until("document.querySelector('.cm-content').innerText.includes('50 mm')")
    content.locator(".cm-line", has_text="[parameters]").click()
    tab.page.keyboard.press("End")
    # What typing waits for never comes: only another wish can send the text.
    tab.page.evaluate(
        "window.setTimeout = ((set) => (f, ms) => ms === 700 ? 0 : set(f, ms))(setTimeout)"
    )
    tab.page.keyboard.type(f" {TYPED}")
    return tab


def text(tab):
    return tab.page.evaluate("document.querySelector('.cm-content').innerText")


def draft_holds_it(server, tab):
    draft = server.runs / ".studio" / "draft.json"
    for _ in range(600):
        if draft.exists() and TYPED in json.loads(draft.read_text())["text"]:
            return
        tab.page.wait_for_timeout(50)
    raise AssertionError("the draft never held what was typed")


def test_undo_of_the_top_bar_takes_back_what_was_typed_and_redo_gives_it_back(typed):
    typed.page.get_by_role("button", name="Undo (Ctrl+Z)").click()
    typed.until(f"!document.querySelector('.cm-content').innerText.includes({TYPED!r})")
    assert "50 mm" in text(typed)
    typed.page.get_by_role("button", name="Redo").click()
    typed.until(f"document.querySelector('.cm-content').innerText.includes({TYPED!r})")


def test_a_change_of_the_mode_sends_what_was_typed(typed, own_server):
    typed.find("mode-runs").click()
    draft_holds_it(own_server, typed)


def test_a_value_of_the_form_comes_on_top_of_what_was_typed(typed):
    size = typed.find("parameter-length").get_by_role("textbox", name="length", exact=True)
    size.fill("55 mm")
    size.press("Enter")
    typed.until("document.querySelector('.cm-content').innerText.includes('55 mm')")
    assert TYPED in text(typed)


def test_a_new_name_comes_on_top_of_what_was_typed(typed):
    typed.find("shapes-body").get_by_role("button", name="body", exact=False).first.click()
    name = typed.find("shapes-body").get_by_label("Name", exact=True)
    name.fill("bar")
    name.press("Enter")
    typed.find("shapes-bar").wait_for()
    assert TYPED in text(typed)


def test_opening_another_document_keeps_what_was_typed_for_undo(typed):
    typed.find("templates").click()
    typed.find("template-sphere").click()
    typed.find("discard").click()
    typed.find("document-name").get_by_text("sphere").wait_for()
    typed.page.get_by_role("button", name="Undo (Ctrl+Z)").click()
    typed.find("document-name").get_by_text("finger").wait_for()
    typed.until(f"document.querySelector('.cm-content').innerText.includes({TYPED!r})")


def test_closing_the_tab_sends_what_was_typed(typed, own_server, open_tab):
    typed.page.close()
    other = open_tab(own_server.address, mode="design")
    draft_holds_it(own_server, other)
