"""The studio in a real browser: frames shown, their bytes, and the way from a slider to the eye.

``python benchmarks/studio.py [--json]``. Needs Chromium and Playwright. Headless Chromium draws by
software here, so that frames per second say what a machine without a graphics card shows. What
one with a card could show stands beside them: the frames that the server makes for a client which
takes each at once, and the processor time of the page for a picture, without that of drawing. A
figure counts only once the page shows a body of the right number of voxels that moves, and once
the tip in the page is where the frame of the server says.
"""

from __future__ import annotations

import json
import math
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from measure import Report
from studio_wire import pulled_alone, wire

from voxsoft.design.families import family_text

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

FLAGS = [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
#: How long frames are counted, in s, and how long to wait for what must come.
WINDOW, PATIENCE = 5.0, 120.0
#: Bars of 2 mm voxels as (length, width) in voxels.
BODIES = {2_000: (20, 10), 5_120: (20, 16), 20_000: (50, 20)}
#: How far a hand goes round on the screen, and steps of the mouse for each second.
CIRCLE, MOUSE = 60.0, 30
MOVES = 9
#: Between two moves of the slider, so that what follows a shape is over, in ms.
REST = 1500

BAR = """
schema = "voxsoft/1"
name = "bar"
voxel_size = "2 mm"

[parameters]
length = {{ value = "{length} mm", min = "20 mm", max = "140 mm", step = "2 mm" }}

[shapes]
body = {{ kind = "box", size = ["= length", "{width} mm", "{width} mm"] }}

[[parts]]
shape = "body"
material = "ecoflex-00-30-lattice"

[[clamps]]
region = {{ x = [0, 0] }}

[[loads]]
kind = "gravity"

[solver]
method = "xpbd"
damping = "0.1 1/s"

[probes]
tip = {{ x = ["= length", "= length"] }}
"""


@contextmanager
def served(design: Path, runs: Path) -> Iterator[str]:
    """The address of a studio in a process of its own."""
    voxsoft = Path(sys.executable).with_name("voxsoft")
    command = [str(voxsoft), "studio", str(design), "--no-browser", "--runs", str(runs)]
    environment = {**os.environ, "XDG_STATE_HOME": str(runs), "XDG_CACHE_HOME": str(runs)}
    server = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=environment
    )
    try:
        assert server.stdout is not None
        yield server.stdout.readline().strip()
    finally:
        server.terminate()
        server.wait(30)


def until(page: Page, expression: str) -> Any:
    """What an expression in the page gives once it is true (its policy forbids `eval`)."""
    end = time.monotonic() + PATIENCE
    while not (value := page.evaluate(expression)):
        if time.monotonic() > end:
            raise SystemExit(f"wrong answer: never came: {expression}")
        page.wait_for_timeout(20)
    return value


@contextmanager
def opened(browser: Browser, address: str) -> Iterator[tuple[Page, list[int]]]:
    """A page with the studio in it, and the sizes of the binary messages that reach it."""
    sizes: list[int] = []
    page = browser.new_page(viewport={"width": 1600, "height": 900}, reduced_motion="reduce")
    page.add_init_script("localStorage.setItem('voxsoft.tour', '{\"seen\":true}')")
    page.add_init_script(MARKS)

    def listen(socket: Any) -> None:
        socket.on(
            "framereceived",
            lambda data: sizes.append(len(data)) if isinstance(data, bytes) else None,
        )

    page.on("websocket", listen)
    page.goto(address)
    until(page, "window.voxsoft && voxsoft.triangles > 0")
    yield page, sizes
    page.close()


def require_voxels(page: Page, count: int) -> None:
    """Refuse to time a page that shows another body."""
    words = f"{count:,} voxels"
    until(page, f"document.body.innerText.includes({json.dumps(words)})")


def frames(report: Report, browser: Browser, count: int, address: str) -> None:
    """Frames per second end to end, their bytes, and the server's step beside them."""
    with opened(browser, address) as (page, sizes):
        require_voxels(page, count)
        page.get_by_role("button", name="Simulate", exact=True).click()
        page.get_by_test_id("play").click()
        until(page, "voxsoft.time > 0.005")
        sizes.clear()
        devtools = page.context.new_cdp_session(page)
        devtools.send("Performance.enable", {"timeDomain": "threadTicks"})
        busy = page_seconds(devtools)
        # Pictures are counted in the page: a frame that was sent and never drawn is none.
        shown, seconds = page.evaluate(
            """window => new Promise(done => {
              const start = performance.now();
              let [count, last] = [0, voxsoft.frame];
              const look = () => {
                if (voxsoft.frame !== last) [count, last] = [count + 1, voxsoft.frame];
                const gone = (performance.now() - start) / 1000;
                gone < window ? requestAnimationFrame(look) : done([count, gone]);
              };
              look();
            })""",
            WINDOW,
        )
        if shown == 0 or not sizes:
            raise SystemExit(f"wrong answer: {count:,} voxels do not move in the page")
        busy = page_seconds(devtools) - busy
        pane = page.get_by_test_id("pane-run").inner_text()
        report.add(f"{count:,} voxels: frames shown", shown / seconds, "1/s")
        report.add(f"{count:,} voxels: the page's own work for one", 1e3 * busy / shown, "ms")
        report.add(f"{count:,} voxels: bytes of a frame", statistics.median(sizes), "B")
        step = re.search(r"Substep\s+([\d.]+) (ms|µs)", pane)
        if step:
            scale = 1e-3 if step[2] == "µs" else 1.0
            report.add(f"{count:,} voxels: substep of the server", float(step[1]) * scale, "ms")


def pulled(report: Report, browser: Browser, name: str, address: str) -> None:
    """Frames per second and the share of real time while a hand pulls a body around."""
    with opened(browser, address) as (page, _):
        page.get_by_role("button", name="Simulate", exact=True).click()
        page.get_by_test_id("play").click()
        until(page, "voxsoft.time > 0")
        box = page.locator(".viewport canvas").bounding_box()
        assert box is not None
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x, y - CIRCLE, steps=4)
        page.get_by_test_id("grab").wait_for()
        page.evaluate(
            """() => {
              const start = { clock: performance.now(), time: voxsoft.time };
              let [count, last] = [0, voxsoft.frame];
              const look = () => {
                if (voxsoft.frame !== last) [count, last] = [count + 1, voxsoft.frame];
                const clock = (performance.now() - start.clock) / 1000;
                window.pulled = [count / clock, (voxsoft.time - start.time) / clock];
                requestAnimationFrame(look);
              };
              look();
            }"""
        )
        for step in range(round(WINDOW * MOUSE)):
            angle = 2 * math.pi * step / MOUSE
            page.mouse.move(x + CIRCLE * math.sin(angle), y - CIRCLE * math.cos(angle))
            page.wait_for_timeout(1000 / MOUSE)
        shown, share = page.evaluate("window.pulled")
        page.mouse.up()
        if shown == 0:
            raise SystemExit(f"wrong answer: {name} does not move in the page")
        report.add(f"{name}, pulled: frames shown", shown, "1/s")
        report.add(f"{name}, pulled: simulated time over the clock's", share, "")


def page_seconds(devtools: Any) -> float:
    """Processor time of the page's main thread [s]: its scripts, layout and paint, no drawing."""
    metrics = devtools.send("Performance.getMetrics")["metrics"]
    return float(next(one["value"] for one in metrics if one["name"] == "TaskDuration"))


# Notes in the page when an edit is sent, how long it was meshed, and when the shape comes.
MARKS = """
window.marks = {};
window.WebSocket = class extends WebSocket {
  constructor(...given) {
    super(...given);
    this.addEventListener("message", ({ data }) => {
      if (typeof data !== "string") {
        if (new DataView(data).getUint8(4) === 1) window.marks.came ??= performance.now();
      } else if (data.includes('"t":"body"')) window.marks.meshed ??= JSON.parse(data).seconds;
    });
  }
  send(data) {
    if (String(data).includes('"t":"edit"')) window.marks.sent ??= performance.now();
    super.send(data);
  }
};
"""


def slider(report: Report, browser: Browser, count: int, address: str) -> None:
    """From a slider's move to the first picture of the new shape."""
    with opened(browser, address) as (page, _):
        require_voxels(page, count)
        page.get_by_role("button", name="Design", exact=True).click()
        field = page.get_by_test_id("pane-design").locator("input[type=range]").first
        field.wait_for()
        field.focus()
        times: dict[str, list[float]] = {}
        for move in range(MOVES):
            key = "ArrowRight" if move % 2 == 0 else "ArrowLeft"
            # Watched in the page itself, from the key on, so that the driver adds nothing.
            page.evaluate(
                """before => {
                  window.moved = new Promise(done => {
                    addEventListener("keydown", () => {
                      const start = performance.now();
                      window.marks = {};
                      const look = () => {
                        if (voxsoft.topology === before || !marks.meshed) {
                          requestAnimationFrame(look);
                          return;
                        }
                        const drawn = performance.now();
                        done({
                          "whole": drawn - start,
                          "the page, to the command": marks.sent - start,
                          "server and wire, to the shape": marks.came - marks.sent,
                          "of which meshing": 1000 * marks.meshed,
                          "the page, to the picture": drawn - marks.came,
                        });
                      };
                      look();
                    }, { once: true, capture: true });
                  });
                }""",
                page.evaluate("voxsoft.topology"),
            )
            page.keyboard.press(key)
            for part, time_of_part in page.evaluate("window.moved").items():
                times.setdefault(part, []).append(float(time_of_part))
            page.wait_for_timeout(REST)
        name = f"{count:,} voxels: from a slider's move to the new shape"
        for part, all_times in times.items():
            title = name if part == "whole" else f"  {part}"
            report.add(title, statistics.median(all_times[1:]), "ms")


def first_paint(report: Report, browser: Browser, address: str) -> None:
    """From the request to the first paint, in a page that has nothing cached."""
    times = []
    for _ in range(5):
        context = browser.new_context()
        page = context.new_page()
        page.goto(address)
        paint = "performance.getEntriesByName('first-contentful-paint')[0]?.startTime"
        times.append(float(until(page, paint)))
        context.close()
    report.add("first paint with content", statistics.median(times), "ms")


def rubber_bodies() -> dict[str, str]:
    """Bodies of silicone rubber, as design files."""
    length, width = BODIES[5_120]
    bar = BAR.format(length=2 * length, width=2 * width).replace("-lattice", "")
    bar = bar.replace('method = "xpbd"\ndamping = "0.1 1/s"', "")
    return {"pneunet template, rubber": family_text("pneunet"), "bar of 5,120 voxels, rubber": bar}


def main() -> None:
    """Run everything."""
    report = Report("The studio in headless Chromium, drawn by software")
    executable = shutil.which("chromium") or shutil.which("google-chrome")
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        raise SystemExit("needs Playwright: pip install playwright") from None
    if executable is None:
        raise SystemExit("needs Chromium (Debian and Ubuntu: apt install chromium)")
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=executable, args=FLAGS)
        for count, (length, width) in BODIES.items():
            design = Path(folder) / f"bar_{count}.toml"
            design.write_text(BAR.format(length=2 * length, width=2 * width), encoding="utf-8")
            with served(design, Path(folder) / f"runs_{count}") as address:
                if count == 5_120:
                    slider(report, browser, count, address)
                else:
                    wire(report, count, address)
                    frames(report, browser, count, address)
                if count == 2_000:
                    first_paint(report, browser, address)
        for name, text in rubber_bodies().items():
            design = Path(folder) / f"{name.split()[0]}.toml"
            design.write_text(text, encoding="utf-8")
            with served(design, Path(folder) / f"runs_{design.stem}") as address:
                pulled_alone(report, name, address)
                pulled(report, browser, name, address)
        browser.close()
    report.show()


if __name__ == "__main__":
    main()
