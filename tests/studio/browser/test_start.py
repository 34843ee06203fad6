"""The start screen: finished robots, the three questions of New, and files of before."""

import pytest

pytestmark = pytest.mark.browser


def focused(tab):
    return tab.page.evaluate("document.activeElement?.dataset.testid ?? null")


def test_a_robot_opens_smooth_and_moves(bare, open_tab):
    tab = open_tab(bare.address, mode="design")
    start = tab.find("start")
    start.wait_for()
    # All pictures are there, and nothing behind the screen can be reached.
    robots = start.locator(".robot img")
    tab.until(
        "[...document.querySelectorAll('.start-screen img')].every((one) => one.loading === 'lazy' "
        "|| (one.complete && one.naturalWidth > 0))"
    )
    assert robots.count() >= 7
    assert tab.page.evaluate("document.querySelector('.top-bar').closest('[inert]') !== null")
    assert focused(tab) == "start-new"
    tab.shot("start")
    tab.find("robot-tendon_finger").click()
    start.wait_for(state="detached")
    tab.find("document-name").get_by_text("tendon_finger.toml").wait_for()
    tab.until("voxsoft.time > 0 && voxsoft.triangles > 0")
    assert tab.page.get_by_label("Show as").input_value() == "smooth"
    assert "edited" not in tab.find("document-name").inner_text()
    # It is not in the way again, and comes when it is asked for.
    tab.page.reload()
    tab.find("document-name").get_by_text("tendon_finger.toml").wait_for()
    assert start.count() == 0
    tab.find("brand").click()
    start.wait_for()
    assert focused(tab) == "start-go-on"
    tab.page.keyboard.press("Enter")
    start.wait_for(state="detached")
    assert tab.errors == []


def test_three_questions_are_answered_by_keys_alone(bare, open_tab):
    tab = open_tab(bare.address, mode="design", size=(1280, 720))
    tab.find("start").wait_for()
    page = tab.page
    page.keyboard.press("Enter")  # New has the focus
    questions = tab.find("new-robot")
    questions.wait_for()
    # To the first question behind the other buttons, and to its second answer.
    while not page.evaluate("document.activeElement.matches('input[name=drive]')"):
        page.keyboard.press("Tab")
    page.keyboard.press("ArrowDown")
    assert questions.get_by_label("Tendons").is_checked()
    assert questions.get_by_label("Bellows").is_disabled()
    page.keyboard.press("Tab")
    page.keyboard.press("ArrowDown")
    assert questions.get_by_label("Trunk").is_checked()
    page.keyboard.press("Tab")
    page.keyboard.press("Space")
    page.keyboard.press("ArrowDown")
    assert questions.get_by_label("Lift").is_checked()
    tab.shot("start-new")
    begin = tab.find("new-begin")
    begin.wait_for()
    page.keyboard.press("Tab")
    assert focused(tab) == "new-begin"
    page.keyboard.press("Enter")
    tab.find("document-name").get_by_text("tendon_trunk.toml").wait_for()
    left = tab.find("parameter-left").get_by_role("textbox", name="left", exact=True)
    assert left.input_value() == "4 N"
    assert tab.errors == []


def test_work_goes_on_where_it_was_left(bare, open_tab):
    tab = open_tab(bare.address, mode="design")
    tab.find("start").wait_for()
    tab.find("start-empty").click()
    tab.page.get_by_text("None yet. Add a box or a cylinder").wait_for()
    tab.page.keyboard.press("Control+s")
    tab.find("save-sheet").get_by_label("File").fill("mine.toml")
    tab.find("save-now").click()
    tab.find("save-sheet").wait_for(state="detached")
    bare.stop()
    bare.start()
    again = open_tab(bare.address, mode="design")
    go_on = again.find("start-go-on")
    go_on.get_by_text("Go on with mine.toml").wait_for()
    assert again.find("start-recent").get_by_text("just now").count() == 1
    again.shot("start-recent")
    assert focused(again) == "start-go-on"
    again.page.keyboard.press("Enter")
    again.find("document-name").get_by_text("mine.toml").wait_for()
    again.page.keyboard.press("Control+o")
    again.find("start").wait_for()
    again.page.keyboard.press("Escape")
    again.find("start").wait_for(state="detached")
    assert again.errors == []


@pytest.mark.parametrize("size", [(1280, 720), (3840, 2160)], ids=str)
@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_it_fits_every_screen(bare, open_tab, size, scheme):
    tab = open_tab(bare.address, size=size, scheme=scheme)
    tab.find("start").wait_for()
    tab.until("[...document.querySelectorAll('.start-hero img')].every((one) => one.complete)")
    # Nothing is beside the page, and the first robots are on it.
    wide = "document.querySelector('.start-screen').scrollWidth <= innerWidth"
    assert tab.page.evaluate(wide)
    box = tab.find("robot-pneunet").bounding_box()
    assert box["y"] + box["height"] < size[1]
    tab.shot(f"start-{size[0]}-{scheme}")
    assert tab.errors == []
