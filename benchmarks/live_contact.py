"""Live motion in contact: the server's step with and without it, and what a browser shows.

``python benchmarks/live_contact.py [--json] [--case 0] [--browser]``. Three bodies of rubber that
move all the time, as when someone plays with them: a block of 4,913 voxels that a plate presses
and lets go, two fingers of 5,040 voxels of which the one swings onto the other, and
``examples/gripper.toml``. Without contact the block is pressed by a clamp in place of the plate,
the fingers pass through each other, and the gripper closes on nothing.

The step is the median and the mean over all frames of 1/60 s; both runs take theirs in turn, so
that other programs slow both alike. The ratio is that to the run without contact. A run counts
only where it touches in a third of the frames at least; how deep it was beyond what live contact
allows is told.

With ``--browser`` the block is shown in headless Chromium, too, drawn by software: by the studio,
and by its exported page, which is opened from disk and moves by the core in the page. Frames count
once the page tells who touches whom; those from disk only if the page asked for nothing from
elsewhere. Needs Chromium and Playwright.
"""

from __future__ import annotations

import shutil
import statistics
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

from measure import Report
from studio import FLAGS, WINDOW, opened, require_voxels, served, until

import voxsoft as vs
from voxsoft.design import Contact, History, Object
from voxsoft.files.designs import load
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.motion.player import Player
from voxsoft.studio.outputs.html import page_of
from voxsoft.studio.protocol import commands, events
from voxsoft.units import kPa, mm

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

EXAMPLES = Path(__file__).parents[1] / "examples"
FRAME = 1 / 60
RUBBER = vs.NeoHookean(young=100 * kPa, poisson=0.45, density=1070)
#: What swings to and fro five times, from nothing.
SWINGS = 5
SWING = History(
    time=[0.5 * half for half in range(2 * SWINGS + 1)],
    factor=[half % 2 for half in range(2 * SWINGS + 1)],
)


def block(*, contact: bool) -> vs.Design:
    """A block of 17 voxels along an edge, pressed by a tenth and let go, once a second."""
    size, foot = 34 * mm, vs.Clamp(region=vs.Region(z=(0, 0)))
    down = vs.Motion(displacement=(0, 0, -3.4 * mm), history=SWING)
    part = vs.Part(shape=vs.Box(size=(size, size, size)), material=RUBBER)
    body = vs.Design(name="block", voxel_size=2 * mm, parts=[part], clamps=[foot])
    if not contact:
        top = vs.Clamp(region=vs.Region(z=(size, size)), motion=down)
        return body.replace(clamps=[foot, top])
    plate = vs.Box(size=(2 * size, 2 * size, 4 * mm), corner=(-size / 2, -size / 2, size))
    held = Object(name="plate", shape=plate, motion=down)
    return body.replace(objects=[held], contact=Contact(friction=0.4))


def fingers(*, contact: bool) -> vs.Design:
    """Two fingers of 6 x 6 x 70 voxels: the one is pulled onto the other once a second."""
    width, length = 12 * mm, 140 * mm
    box = vs.Box(size=(width, width, length))
    other = vs.Box(size=(width, width, length), corner=(14 * mm, 0, 0))
    tip = vs.Region(x=(0, width), z=(length, length))
    pull = vs.Traction(region=tip, value=(0.03 * kPa, 0, 0), history=SWING)
    body = vs.Design(
        name="fingers",
        voxel_size=2 * mm,
        parts=[vs.Part(shape=box | other, material=RUBBER)],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[pull],
    )
    return body.replace(contact=Contact(friction=0.4)) if contact else body


def gripper(*, contact: bool) -> vs.Design:
    """The gripper of the examples."""
    design = load(EXAMPLES / "gripper.toml")
    if contact:
        return design
    return design.replace(objects=(), contact=None, floor=None, objectives={}, constraints={})


CASES = {
    "block of 4,913 voxels under a plate": (block, 5.0),
    "two fingers of 5,040 voxels": (fingers, 5.0),
    "gripper": (gripper, 2.0),
}


def main() -> None:
    """Time all bodies."""
    report = Report(
        "Steps of live motion with contact",
        {"case": (None, "only the case of this number, from 0")},
        browser="also frames in headless Chromium, and the exported page",
    )
    wanted = report.options["case"]
    for number, (name, (make, seconds)) in enumerate(CASES.items()):
        if wanted in (None, number):
            measure(report, name, {way: make(contact=way) for way in (True, False)}, seconds)
    if report.options["browser"]:
        in_browser(report)
    report.show()


def measure(report: Report, name: str, designs: dict[bool, vs.Design], seconds: float) -> None:
    """One body, with and without contact."""
    players = {way: Player(StudioBody.of(design, 1, 1)) for way, design in designs.items()}
    for player in players.values():
        player.do(commands.Pace(seq=0, factor=1.0))
        player.do(commands.Play(seq=0))
    times: dict[bool, list[float]] = {True: [], False: []}
    touching, deepest, unsettled = 0, 0.0, 0
    for _ in range(round(seconds / FRAME)):
        for way, player in players.items():
            started = time.perf_counter()
            reported = player.advance(FRAME, 60.0)
            times[way].append(time.perf_counter() - started)
            for event in reported:
                if isinstance(event, events.MomentNews):
                    touching += bool(event.moment.contacts)
                    deepest = max(deepest, event.moment.depth or 0.0)
        unsettled += "did not settle" in players[True].stat().sentence
        if players[True].state == "diverged":
            raise SystemExit(f"{name}: diverged")
    count = len(times[True])
    if touching < count / 3:
        raise SystemExit(f"{name}: touches in {touching} of {count} frames only")
    report.add(f"{name}: frames in contact", touching / count, "")
    report.add(f"{name}: deeper than it should be", 1e6 * deepest, "µm")
    report.add(f"{name}: frames that did not settle", unsettled / count, "")
    for what, of in (("median", statistics.median), ("mean", statistics.fmean), ("longest", max)):
        without, found = of(times[False]), of(times[True])
        report.add(f"{name}: step without contact, {what}", 1e3 * without, "ms")
        report.add(f"{name}: step with contact, {what}", 1e3 * found, "ms", found / without)


#: Frames shown and seconds of the body over seconds of the clock, in the page itself.
COUNT = """window => new Promise(done => {
  const start = { clock: performance.now(), time: voxsoft.time };
  let [count, last] = [0, voxsoft.frame];
  const look = () => {
    if (voxsoft.frame !== last) [count, last] = [count + 1, voxsoft.frame];
    const clock = (performance.now() - start.clock) / 1000;
    if (clock < window) requestAnimationFrame(look);
    else done([count / clock, (voxsoft.time - start.time) / clock]);
  };
  look();
})"""


def in_browser(report: Report) -> None:
    """The block in the studio and in its page, with and without contact."""
    executable = shutil.which("chromium") or shutil.which("google-chrome")
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        raise SystemExit("needs Playwright: pip install playwright") from None
    if executable is None:
        raise SystemExit("needs Chromium (Debian and Ubuntu: apt install chromium)")
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=executable, args=FLAGS)
        for contact in (False, True):
            way = "with contact" if contact else "without contact"
            design = block(contact=contact)
            file = Path(folder) / f"block_{contact}.toml"
            design.save(file)
            with (
                served(file, Path(folder) / f"runs_{contact}") as address,
                opened(browser, address) as (page, _),
            ):
                require_voxels(page, 17**3)
                page.get_by_role("button", name="Simulate", exact=True).click()
                frames(report, page, f"studio, {way}", contact=contact)
            from_disk(report, browser, design, Path(folder) / f"{contact}.html", way)
        browser.close()


def from_disk(report: Report, browser: Browser, design: vs.Design, file: Path, way: str) -> None:
    """The exported page, opened from disk."""
    page_of(design).save(file)
    report.add(f"page from disk, {way}: size", file.stat().st_size / 1e6, "MB")
    page = browser.new_page(viewport={"width": 1600, "height": 900})
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    started = time.perf_counter()
    page.goto(file.as_uri())
    until(page, "window.voxsoft && voxsoft.triangles > 0")
    report.add(f"page from disk, {way}: until it shows", time.perf_counter() - started, "s")
    frames(report, page, f"page from disk, {way}", contact=design.contact is not None)
    if elsewhere := [url for url in asked if not url.startswith(("file:", "blob:", "data:"))]:
        raise SystemExit(f"wrong answer: the page asked for {elsewhere[0]}")
    page.close()


def frames(report: Report, page: Page, name: str, *, contact: bool) -> None:
    """Frames shown per second, once the body moves and, where there is contact, touches."""
    page.get_by_test_id("play").click()
    until(page, "voxsoft.time > 0.1")
    if contact:
        until(page, "document.querySelector('[data-testid=contacts] .touch') !== null")
    shown, share = page.evaluate(COUNT, WINDOW)
    if shown == 0:
        raise SystemExit(f"wrong answer: {name} does not move")
    report.add(f"{name}: frames shown", shown, "1/s")
    report.add(f"{name}: simulated time over the clock's", share, "")


if __name__ == "__main__":
    main()
