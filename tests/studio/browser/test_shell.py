"""The page around the panes: modes, keys, connection, and its requests to the network."""

import re

import pytest

from voxsoft.studio.protocol.wire import PROTOCOL

pytestmark = pytest.mark.browser


def test_nothing_leaves_the_machine_and_nothing_goes_wrong(tab, outside):
    for mode in ("design", "calibrate", "optimize", "runs", "simulate"):
        tab.find(f"mode-{mode}").click()
        tab.until(f"location.hash.includes('mode={mode}')")
    tab.find("pane-run").wait_for()
    assert outside(tab) == []
    assert tab.errors == []


def test_the_palette_finds_an_action_and_starts_it(tab):
    tab.page.keyboard.press("Control+k")
    tab.find("palette").wait_for()
    tab.page.keyboard.type("go to optim")
    tab.page.keyboard.press("Enter")
    tab.until("location.hash.includes('mode=optimize')")
    assert tab.find("palette").count() == 0


def test_the_help_sheet_opens_by_a_key_and_goes_away_with_escape(tab):
    tab.page.locator(".viewport canvas").focus()
    tab.page.keyboard.press("?")
    sheet = tab.find("shortcuts")
    sheet.wait_for()
    assert "Play or pause" in sheet.inner_text()
    tab.page.keyboard.press("Escape")
    sheet.wait_for(state="detached")


def test_keys_typed_into_a_field_start_nothing(tab):
    state = tab.page.evaluate("voxsoft.state")
    field = tab.find("pane-run").get_by_label("Spring", exact=True)
    field.fill("7")
    field.press("f")
    field.press("Space")
    field.press("Escape")
    assert tab.page.evaluate("voxsoft.state") == state
    field.fill("0.2 N/mm")
    field.press("Enter")
    tab.until("document.querySelector('[aria-label=Spring]').value === '200 N/m'")
    field.fill("3 kPa")
    field.press("Enter")
    assert "expected a stiffness" in tab.find("pane-run").inner_text()


def test_space_plays_after_a_click_and_presses_a_focused_button(tab):
    for clicked in ("mode-design", "ghost"):
        tab.find(clicked).click()
        tab.page.keyboard.press("Space")
        tab.until("voxsoft.state === 'playing'")
        tab.page.keyboard.press("Space")
        tab.until("voxsoft.state === 'paused'")
    ghost = tab.find("ghost")
    assert ghost.get_attribute("aria-pressed") == "true"
    # Keyboard: away from the button and back to it.
    tab.page.keyboard.press("Tab")
    tab.page.keyboard.press("Shift+Tab")
    assert tab.page.evaluate("document.activeElement.dataset.testid") == "ghost"
    tab.page.keyboard.press("Space")
    tab.until("document.querySelector('[data-testid=ghost]').ariaPressed === 'false'")
    tab.page.keyboard.press("Enter")
    tab.until("document.querySelector('[data-testid=ghost]').ariaPressed === 'true'")
    assert tab.page.evaluate("voxsoft.state") == "paused"


def test_space_plays_while_a_slider_has_the_focus(tab):
    slider = tab.find("pane-run").locator("input[type=range]").first
    slider.focus()
    before = slider.input_value()
    tab.page.keyboard.press("Space")
    tab.until("voxsoft.state === 'playing'")
    assert slider.input_value() == before


def test_the_theme_follows_the_system_and_can_be_turned(served, open_tab):
    tab = open_tab(served.address, scheme="light")
    assert tab.page.evaluate("document.documentElement.dataset.theme") == "light"
    tab.find("theme").click()
    assert tab.page.evaluate("document.documentElement.dataset.theme") == "dark"
    tab.page.reload()
    tab.find("top-bar").wait_for()
    assert tab.page.evaluate("document.documentElement.dataset.theme") == "dark"


def test_the_tour_has_six_steps_and_comes_once(served, open_tab):
    tab = open_tab(served.address, tour=True)
    tab.find("tour").wait_for()
    for step in range(6):
        assert f"{step + 1} of 6" in tab.find("tour").inner_text()
        tab.find("tour-next").click()
    tab.find("tour").wait_for(state="detached")
    tab.page.reload()
    tab.find("link").get_by_text("connected", exact=True).wait_for()
    assert tab.find("tour").count() == 0


def test_the_layout_survives_a_reload(tab):
    tab.page.locator(".dv-default-tab", has_text="Log").click()
    tab.find("pane-log").wait_for()
    # Layouts are kept a moment after they change.
    tab.until(
        "(localStorage.getItem('voxsoft.layout.simulate') ?? '').includes('\"activeView\":\"log\"')"
    )
    tab.page.reload()
    tab.find("pane-log").wait_for()


@pytest.mark.parametrize("size", [(1600, 900), (1280, 720)], ids=["1600x900", "1280x720"])
def test_the_page_fits_its_window(served, open_tab, size):
    tab = open_tab(served.address, size=size)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.find("rest").click()
    tab.until("voxsoft.state === 'at-rest'")
    assert tab.page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert tab.page.evaluate("document.documentElement.scrollHeight <= innerHeight")
    width = tab.page.locator(".viewport canvas").bounding_box()["width"]
    assert width > 0.4 * size[0]
    for mode in ("design", "simulate"):
        tab.find(f"mode-{mode}").click()
        tab.find("view-more").wait_for()


def test_another_version_of_the_protocol_is_reported_and_not_tried_again(served, chromium):
    context = chromium.new_context()
    page = context.new_page()
    opened = []

    def between(socket):
        opened.append(socket)
        server = socket.connect_to_server()
        socket.on_message(
            lambda reported: server.send(
                reported.replace(f'"protocol":{PROTOCOL}', '"protocol":99')
            )
        )

    page.route_web_socket(re.compile("/ws$"), between)
    page.goto(served.address)
    band = page.get_by_test_id("disconnected")
    band.get_by_text("speaks version 99").wait_for()
    assert page.get_by_test_id("link").inner_text() == "refused"
    assert len(opened) == 1
    page.unroute_all()
    band.get_by_role("button", name="Reload the page").click()
    context.close()


def test_a_studio_with_another_token_differs_from_an_absent_one(own_server, open_tab):
    tab = open_tab(own_server.address)
    own_server.stop()
    tab.find("disconnected").get_by_text("retrying").wait_for()
    own_server.token = "another-token-that-this-page-does-not-know"
    own_server.start()
    band = tab.find("disconnected")
    band.get_by_text("opens only by the address").wait_for()
    assert "Open the address" in band.inner_text()


def test_a_server_that_dies_and_comes_back(own_server, open_tab):
    tab = open_tab(own_server.address)
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    own_server.stop()
    tab.find("disconnected").wait_for()
    # Each try says "connecting" for a moment.
    tab.find("link").get_by_text("retrying").wait_for()
    own_server.start()
    tab.find("disconnected").wait_for(state="detached")
    tab.find("play").click()
    tab.until("voxsoft.time > 0.01")
