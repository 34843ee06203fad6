"""Versions of the document: listed, compared, restored; and pictures of recent files."""

import pytest

pytestmark = pytest.mark.browser


def change(tab, value):
    rev = tab.page.evaluate("voxsoft.rev")
    field = tab.find("parameter-length").get_by_role("textbox", name="length")
    field.fill(value)
    field.press("Enter")
    tab.until(f"voxsoft.rev > {rev}")


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_a_version_is_compared_and_restored_and_nothing_is_lost(own_server, open_tab, scheme):
    tab = open_tab(own_server.address, mode="design", scheme=scheme, symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    page = tab.page
    page.keyboard.press("Control+k")
    page.keyboard.type("versions of the design")
    page.keyboard.press("Enter")
    tab.find("versions-none").wait_for()
    page.keyboard.press("Escape")
    for value in ("45 mm", "50 mm"):
        change(tab, value)
        page.keyboard.press("Control+s")
        tab.find("toast").get_by_text("Saved").wait_for()
    change(tab, "55 mm")
    tab.find("document-name").click()
    rows = tab.find("version")
    rows.nth(2).wait_for()
    assert rows.count() == 3
    tab.until(
        "[...document.querySelectorAll('.version img')].filter(i => i.naturalWidth).length === 3"
    )
    rows.nth(2).click()  # the file as it was before the first save
    lines = tab.find("version-difference")
    lines.locator("[data-mark=gone]").first.wait_for()
    assert "40 mm" in lines.locator("[data-mark=gone]").inner_text()
    assert "55 mm" in lines.locator("[data-mark=new]").inner_text()
    tab.shot(f"versions-{scheme}")
    rev = page.evaluate("voxsoft.rev")
    tab.find("version-restore").click()
    tab.until(f"voxsoft.rev > {rev}")
    tab.find("versions-sheet").wait_for(state="detached")
    field = tab.find("parameter-length").get_by_role("textbox", name="length")
    assert field.input_value().startswith("40")
    page.get_by_role("button", name="Undo (Ctrl+Z)").click()
    tab.until(f"voxsoft.rev > {rev} + 1")
    assert field.input_value().startswith("55")
    tab.find("document-name").click()
    tab.find("version").nth(3).wait_for()  # the earlier text is a version too
    assert tab.find("version").count() == 4
    page.keyboard.press("Escape")
    assert tab.errors == []


def test_recent_files_have_pictures(own_server, open_tab):
    tab = open_tab(own_server.address, mode="design", symbols=False)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.find("brand").click()
    recent = tab.find("start-recent")
    recent.get_by_text("finger.toml").wait_for()
    tab.until("document.querySelector('[data-testid=start-recent] img')?.naturalWidth > 0")
    recent.scroll_into_view_if_needed()
    tab.shot("recent")
    assert tab.errors == []
