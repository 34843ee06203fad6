"""Nothing that was typed is lost, however soon something else is asked."""

import json

import pytest
from waiting import until

pytestmark = pytest.mark.browser


@pytest.fixture
def word(request):
    """Text that a test types; tests share a document, so each has a word of its own."""
    return f"# {request.node.name}"


@pytest.fixture
def typed(served, open_tab, word):
    """The mode Design with a word typed into the text, which the server has not got yet."""
    tab = open_tab(served.address, mode="design")
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
    # The end of typing never comes: only another request can send the text.
    tab.page.evaluate(
        "window.setTimeout = ((set) => (f, ms) => ms === 700 ? 0 : set(f, ms))(setTimeout)"
    )
    tab.page.keyboard.type(f" {word}")
    return tab


def text(tab):
    return tab.page.evaluate("document.querySelector('.cm-content').innerText")


def draft_holds(word, server):
    draft = server.runs / ".studio" / "draft.json"
    until(
        lambda: draft.exists() and word in json.loads(draft.read_text())["text"],
        "a draft with what was typed",
    )


def test_undo_and_redo_of_the_top_bar_cover_typed_text(typed, word):
    typed.page.get_by_role("button", name="Undo (Ctrl+Z)").click()
    typed.until(f"!document.querySelector('.cm-content').innerText.includes({word!r})")
    assert "50 mm" in text(typed)
    typed.page.get_by_role("button", name="Redo").click()
    typed.until(f"document.querySelector('.cm-content').innerText.includes({word!r})")


def test_a_change_of_the_mode_sends_typed_text(typed, served, word):
    typed.find("mode-runs").click()
    draft_holds(word, served)


def test_a_value_of_the_form_follows_typed_text(typed, word):
    size = typed.find("parameter-length").get_by_role("textbox", name="length", exact=True)
    size.fill("55 mm")
    size.press("Enter")
    typed.until("document.querySelector('.cm-content').innerText.includes('55 mm')")
    assert word in text(typed)


def test_a_new_name_follows_typed_text(typed, word):
    typed.find("shapes-body").get_by_role("button", name="body", exact=False).first.click()
    name = typed.find("shapes-body").get_by_label("Name", exact=True)
    name.fill("bar")
    name.press("Enter")
    typed.find("shapes-bar").wait_for()
    assert word in text(typed)


def test_opening_another_document_keeps_typed_text_for_undo(typed, word):
    typed.find("templates").click()
    typed.find("template-sphere").click()
    typed.find("discard").click()
    typed.find("document-name").get_by_text("sphere").wait_for()
    typed.page.get_by_role("button", name="Undo (Ctrl+Z)").click()
    typed.find("toast").get_by_role("button", name="Back to finger.toml").click()
    typed.find("document-name").get_by_text("finger").wait_for()
    typed.until(f"document.querySelector('.cm-content').innerText.includes({word!r})")


def test_closing_the_tab_sends_typed_text(typed, served, word):
    typed.page.close()
    draft_holds(word, served)
