"""A real Chromium on a real server; without Chromium or Playwright these tests are skipped."""

import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from auditing import AXE
from hands import Hand
from waiting import until

# Software rendering, so that the tests run where there is no graphics card.
FLAGS = [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-compositing",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
# Generous: on two busy cores a page may take long; an event comes or it does not.
PATIENCE = 120.0

SERVE = """
import sys
from pathlib import Path
from voxsoft.studio.server.process import StudioServer
source, runs, port, token = sys.argv[1:]
source = Path(source) if source else None
server = StudioServer(source, runs=Path(runs), port=int(port), token=token or None)
server.run_and_exit(lambda address: print(address, flush=True))
"""

COARSE = """
schema = "voxsoft/1"
name = "finger"
voxel_size = "5 mm"

[parameters]
length = { value = "40 mm", min = "20 mm", max = "60 mm", step = "5 mm" }

[shapes]
body = { kind = "box", size = ["= length", "10 mm", "10 mm"] }

[[parts]]
shape = "body"
material = "ecoflex-00-30-lattice"

[[clamps]]
region = { x = [0, 0] }

[[loads]]
kind = "gravity"

[probes]
tip = { x = ["= length", "= length"] }
"""


@dataclass
class Served:
    """A server in a process of its own, which can be killed and started again."""

    source: Path | None
    runs: Path
    port: int
    token: str = "a-token-that-the-tests-know-well-enough"
    process: subprocess.Popen[str] | None = field(default=None, repr=False)
    printed: str = ""

    @property
    def address(self):
        if not self.token:  # the server has one of its own
            return self.printed
        return f"http://127.0.0.1:{self.port}/?token={self.token}"

    def start(self):
        command = [sys.executable, "-c", SERVE, str(self.source or ""), str(self.runs)]
        self.process = subprocess.Popen(
            [*command, str(self.port), self.token], stdout=subprocess.PIPE, text=True
        )
        line = self.process.stdout.readline()
        assert line.startswith("http://127.0.0.1:"), line
        self.printed = line.strip()

    def stop(self):
        if self.process is not None:
            self.process.send_signal(signal.SIGINT)
            self.process.wait(timeout=PATIENCE)
            self.process.stdout.close()
            self.process = None


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@pytest.fixture(autouse=True)
def one_browser_at_a_time():
    """Wait for the tests of another process: software that draws takes all cores."""
    fcntl = pytest.importorskip("fcntl")
    with (Path(tempfile.gettempdir()) / "voxsoft-browser-tests.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


@pytest.fixture(scope="session")
def chromium():
    playwright = pytest.importorskip("playwright.sync_api", reason="Playwright is not installed")
    found = [shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome")]
    executable = next((path for path in found if path), None)
    if executable is None:
        pytest.skip("Chromium is not installed")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=executable, args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def coarse():
    """A finger of silicone, so coarse that software can draw it."""
    return COARSE


def serve(folder, text=COARSE, name="finger.toml", **options):
    source = folder / name
    source.write_text(text)
    server = Served(source, folder / "runs", free_port(), **options)
    server.start()
    return server


@pytest.fixture(scope="session")
def serving():
    """Starts a server on a design of the test's own; the test stops it."""
    return serve


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """A server for all tests of a file: starting one takes longer than most tests."""
    server = serve(tmp_path_factory.mktemp("studio"))
    yield server
    server.stop()


@pytest.fixture
def axe():
    if not AXE.is_file():
        pytest.skip("axe-core is not installed: npm ci in studio/")


@pytest.fixture
def own_server(tmp_path):
    """A server that a test may kill."""
    server = serve(tmp_path)
    yield server
    server.stop()


@pytest.fixture
def bare(tmp_path):
    """A server with no design given and nothing to go on with."""
    server = Served(None, tmp_path / "runs", free_port())
    server.start()
    yield server
    server.stop()


@dataclass
class Tab:
    """A page with its log and its requests."""

    page: object
    errors: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def until(self, condition, patience=PATIENCE, frame=None):
        """Wait for a condition in the page; its policy forbids Playwright's own way."""
        where = frame or self.page
        return until(
            lambda: where.evaluate(condition),
            lambda: f"{condition} (logged: {self.errors})",
            patience,
        )

    def find(self, name):
        return self.page.locator(f"[data-testid='{name}']")

    def middle(self):
        box = self.page.locator(".viewport canvas").bounding_box()
        return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def shot(self, name):
        """Keep a picture for people to look at, where a folder for them is named."""
        folder = os.environ.get("VOXSOFT_SCREENSHOTS")
        if folder:
            Path(folder).mkdir(parents=True, exist_ok=True)
            self.page.screenshot(path=Path(folder) / f"{name}.png")


@pytest.fixture
def open_tab(chromium):
    contexts = []

    def opening(
        address, *, size=(1600, 900), scheme="dark", tour=False, mode="simulate", symbols=True
    ):
        context = chromium.new_context(
            viewport={"width": size[0], "height": size[1]},
            color_scheme=scheme,
            reduced_motion="reduce",  # the camera is there at once
        )
        context.set_default_timeout(PATIENCE * 1000)
        contexts.append(context)
        if not tour:
            context.add_init_script(
                "window === top && localStorage.setItem('voxsoft.tour', '{\"seen\":true}')"
            )
        if not symbols:  # words that can be clicked must not lie where a test presses
            context.add_init_script(
                "window === top && localStorage.setItem('voxsoft.view', '{\"symbols\":false}')"
            )
        page = context.new_page()
        tab = Tab(page)
        page.on("console", lambda m: tab.errors.append(m.text) if m.type == "error" else None)
        page.on("pageerror", lambda error: tab.errors.append(str(error)))
        page.on("request", lambda request: tab.requests.append(request.url))
        page.on("websocket", lambda socket: tab.requests.append(socket.url))
        page.goto(f"{address}#mode={mode}")
        tab.find("link").get_by_text("connected", exact=True).wait_for(timeout=PATIENCE * 1000)
        return tab

    yield opening
    for context in contexts:
        context.close()


@pytest.fixture
def tab(served, open_tab):
    """The page on a small cantilever at time zero, in the mode Simulate, with its body drawn."""
    one = open_tab(served.address, symbols=False)
    one.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    one.find("reset").click()
    one.until("voxsoft.time === 0 && voxsoft.state !== 'playing'")
    return one


@pytest.fixture
def alone(chromium):
    """Opens a page without any network."""
    contexts = []

    def opening(address):
        context = chromium.new_context(viewport={"width": 1280, "height": 720}, offline=True)
        contexts.append(context)
        tab = Tab(context.new_page())
        page = tab.page
        page.on("console", lambda m: tab.errors.append(m.text) if m.type == "error" else None)
        page.on("pageerror", lambda error: tab.errors.append(str(error)))
        page.on("request", lambda request: tab.requests.append(request.url))
        page.goto(address)
        return tab

    yield opening
    for context in contexts:
        context.close()


OUTSIDE = re.compile(r"^(?:https?|wss?)://(?!127\.0\.0\.1[:/])")


@pytest.fixture
def outside():
    """Requests that leave this machine."""
    return lambda tab: [url for url in tab.requests if OUTSIDE.match(url)]


@pytest.fixture
def empty(serving, tmp_path, open_tab):
    """An empty design in the mode Design, and the hand that opened it."""
    server = serving(tmp_path)
    try:
        tab = open_tab(server.address, mode="design", symbols=False)
        tab.page.wait_for_selector("[data-testid='design-form']")
        hand = Hand(tab)
        hand.press(test_id="templates")
        hand.press(test_id="template-empty")
        tab.page.get_by_text("None yet. Add a box or a cylinder").wait_for()
        yield tab, hand
        assert tab.errors == []
    finally:
        server.stop()
