"""Cost of pictures: coarse while they move where graphics are slow, and none in a hidden tab."""

import io
import struct

import pytest
from PIL import Image

pytestmark = pytest.mark.browser

# Graphics that take their time, whatever this machine has: each fence passes late.
SLOW_GRAPHICS = """
const P = WebGL2RenderingContext.prototype;
const [fence, parameter] = [P.fenceSync, P.getSyncParameter];
const passed = new WeakMap();
P.fenceSync = function (...given) {
  const made = fence.apply(this, given);
  passed.set(made, performance.now() + 400);
  return made;
};
P.getSyncParameter = function (sync, name) {
  const late = performance.now() < passed.get(sync);
  return late && name === this.SYNC_STATUS ? this.UNSIGNALED : parameter.call(this, sync, name);
};
"""
# A tab that is hidden and shown again by hand: a headless browser shows all of its tabs.
HIDING = """
let shown = "visible";
Object.defineProperty(document, "visibilityState", { get: () => shown });
addEventListener("test:show", event => {
  shown = event.detail;
  document.dispatchEvent(new Event("visibilitychange"));
});
window.drawCalls = 0;
const P = WebGL2RenderingContext.prototype;
for (const name of ["drawElements", "drawArrays"]) {
  const draw = P[name];
  P[name] = function (...given) { window.drawCalls += 1; return draw.apply(this, given); };
}
"""
FRAME = 2
WIDTHS = """(() => {
  const canvas = document.querySelector(".viewport canvas");
  return [canvas.width, canvas.clientWidth];
})()"""


@pytest.fixture(scope="module")
def swinging(tmp_path_factory, coarse, serving):
    """A server on a finger that swings for long."""
    text = coarse + '\n[solver]\nmethod = "xpbd"\ndamping = "0.1 1/s"\n'
    server = serving(tmp_path_factory.mktemp("swinging"), text)
    yield server
    server.stop()


@pytest.fixture
def prepared(open_tab, swinging):
    """Opens the page at time zero, after a script of the test's own."""

    def opening(script):
        tab = open_tab(swinging.address, symbols=False)
        tab.page.add_init_script(f"(() => {{ {script} }})()")
        tab.page.reload()
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        tab.find("reset").click()
        tab.until("voxsoft.time === 0 && voxsoft.state !== 'playing'")
        return tab

    return opening


def test_slow_graphics_coarsen_moving_pictures_only(prepared):
    tab = prepared(SLOW_GRAPHICS)
    width, whole = tab.page.evaluate(WIDTHS)
    assert width == whole
    tab.find("play").click()
    tab.until(f"{WIDTHS}[0] <= {whole} / 2 + 1")
    assert tab.page.evaluate("voxsoft.state") == "playing"
    tab.find("play").click()
    tab.until("voxsoft.state === 'paused'")
    tab.until(f"{WIDTHS}[0] === {whole}")
    assert tab.errors == []


def test_a_picture_that_is_saved_while_pictures_are_coarse_is_whole(prepared):
    tab = prepared(SLOW_GRAPHICS)
    whole = tab.page.evaluate(WIDTHS)[1]
    tab.find("play").click()
    tab.until(f"{WIDTHS}[0] < {whole}")
    with tab.page.expect_download() as reported:
        tab.page.keyboard.press("Control+k")
        tab.find("palette").wait_for()
        tab.page.keyboard.type("Save a picture at 2 times")
        tab.page.keyboard.press("Enter")
    saved = Image.open(io.BytesIO(reported.value.path().read_bytes()))
    assert saved.width == 2 * whole
    tab.find("play").click()


def test_a_hidden_tab_is_sent_no_frames_and_draws_nothing(prepared):
    tab = prepared(HIDING)
    frames = []

    def listen(socket):
        def received(data):
            if isinstance(data, bytes) and data[4] == FRAME:
                frames.append(struct.unpack_from("<d", data, 16)[0])

        socket.on("framereceived", received)

    tab.page.on("websocket", listen)
    tab.page.reload()
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    clock = "Number.parseFloat(document.querySelector('[data-testid=clock]').innerText)"
    tab.find("play").click()
    tab.until("voxsoft.time > 0.02")
    show = "state => dispatchEvent(new CustomEvent('test:show', { detail: state }))"
    tab.page.evaluate(show, "hidden")
    # Frames on their way may still come; then time goes on without a frame.
    began = tab.until(clock)
    tab.until(f"{clock} > {began} + 0.05")
    tab.until("(now => window.drawn === now || (window.drawn = now, false))(drawCalls)")
    had, drawn = len(frames), tab.page.evaluate("drawCalls")
    tab.until(f"{clock} > {began} + 0.4")
    assert len(frames) == had
    assert tab.page.evaluate("drawCalls") == drawn
    tab.page.evaluate(show, "visible")
    tab.until(f"drawCalls > {drawn} && voxsoft.time > {began} + 0.4")
    assert len(frames) > had
    tab.find("play").click()
    assert tab.errors == []
