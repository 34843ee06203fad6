"""Draw the pictures of the finished robots, as the studio shows them at rest.

    python studio/thumbnails.py              # all of them, some ten minutes
    python studio/thumbnails.py bellows ...  # these alone

They lie beside the designs, in python/voxsoft/design/robots, those of other examples in
docs/images/gallery: WebP, transparent around the robot, so that they stand on a dark page as on a
light one. Chromium and Playwright draw them, Pillow packs them.
"""

from __future__ import annotations

import argparse
import io
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from voxsoft.design.robots import ROBOTS, robot_text
from voxsoft.files.designs import read_text
from voxsoft.files.toml_edits import with_value

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

ROOT: Final = Path(__file__).parents[1]
FOLDER: Final = ROOT / "python/voxsoft/design/robots"
#: Examples that the gallery of the documentation shows too, and where their pictures are.
OTHERS: Final = ("bender", "finger", "gripper_finger", "sphere")
IMAGES: Final = ROOT / "docs/images/gallery"
#: Size of a picture, and how many times larger it is drawn to be smooth.
SIZE: Final = (480, 320)
FINER: Final = 2
#: What of a shot is left out at its edges [pixels].
EDGE: Final = 8
#: Share of the picture that is free at its edges.
MARGIN: Final = 0.04
#: Seconds for one solution: the crawler takes its steps for three minutes.
PATIENCE: Final = 900.0

SERVE: Final = """
import sys
from pathlib import Path
from voxsoft.studio.server.process import StudioServer
server = StudioServer(Path(sys.argv[1]), runs=Path(sys.argv[2]))
server.run_and_exit(lambda address: print(address, flush=True))
"""

# As on the page's own tests: software draws where there is no graphics card.
FLAGS: Final = (
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
)

#: The page without all that is no robot; the sky gets a color of its own.
BARE: Final = """([color]) => {
  if (!document.getElementById("bare")) {
    const bare = document.createElement("style");
    bare.id = "bare";
    bare.textContent = "body * { visibility: hidden } .viewport canvas { visibility: visible }";
    document.head.append(bare);
  }
  const style = document.documentElement.style;
  style.setProperty("--sky-top", color);
  style.setProperty("--sky-bottom", color);
  document.documentElement.dataset.theme = document.documentElement.dataset.theme;
}"""

#: What the view shows: no grid, words, edges or symbols.
VIEW: Final = '{"symbols": false, "grid": false, "edges": false, "forces": false}'


@dataclass(frozen=True)
class Shot:
    """How a robot is drawn.

    Attributes
    ----------
    turn
        How far the camera is turned from its view, in pixels of the mouse.
    view
        The key of the standard view that it is turned from; default: from a corner.
    values
        What differs from the design, by its place in it: a moment of a motion, in place of its end.
    """

    turn: tuple[int, int] = (0, 0)
    view: str = "7"
    values: Mapping[tuple[str | int, ...], object] = field(default_factory=dict)


SHOTS: Final[Mapping[str, Shot]] = {
    # Its can in the air, before it is let go.
    "pumped_gripper": Shot((50, 30), "1", {("solver", "end_time"): "0.8 s"}),
    # Both halves bent.
    "crawler": Shot((0, 40), values={("solver", "end_time"): "0.5 s"}),
    "starfish": Shot((0, 70)),  # from above, with all arms
}
#: Pressures of the moving picture as shares of the design's, there and back.
BREATH: Final = (0.0, 0.1, 0.25, 0.45, 0.65, 0.85, 1.0)
#: The load that breathes, and milliseconds for each picture.
MOVING: Final = ("pneunet", ("loads", 0, "value"), 2000.0)
EVERY: Final = 110
#: How far its camera goes away, so that all of the way is in the picture [pixels of the wheel].
AWAY: Final = 300


@contextmanager
def page_of(browser: Browser, text: str, folder: Path) -> Iterator[Page]:
    """The studio on a design, in a page that shows its view."""
    source = folder / "robot.toml"
    source.write_text(text, encoding="utf-8")
    command = [sys.executable, "-c", SERVE, str(source), str(folder / "runs")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        address = server.stdout.readline().strip()
        context = browser.new_context(
            viewport={"width": 1500, "height": 900},
            device_scale_factor=FINER,
            reduced_motion="reduce",
            color_scheme="dark",
        )
        context.add_init_script("localStorage.setItem('voxsoft.tour', '{\"seen\":true}')")
        context.add_init_script(f"localStorage.setItem('voxsoft.view', '{VIEW}')")
        try:
            page = context.new_page()
            page.goto(f"{address}#mode=simulate")
            wait(page, "window.voxsoft !== undefined && voxsoft.triangles > 0")
            page.get_by_label("Show as").select_option("smooth")
            yield page
        finally:
            context.close()
            server.terminate()


def wait(page: Page, condition: str) -> None:
    """Wait for a condition in the page; its policy forbids Playwright's own way.

    Raises
    ------
    TimeoutError
        It did not come true in time.
    """
    for _ in range(int(PATIENCE / 0.1)):
        if page.evaluate(condition):
            return
        page.wait_for_timeout(100)
    raise TimeoutError(condition)


def rested(page: Page) -> None:
    """Solve for the equilibrium, or to the end of the motion."""
    frame = page.evaluate("voxsoft.frame")
    page.locator(".viewport canvas").focus()
    page.keyboard.press("r")
    wait(page, f"voxsoft.frame > {frame} && ['at-rest', 'paused'].includes(voxsoft.state)")
    page.wait_for_timeout(800)


def framed(page: Page, shot: Shot) -> None:
    """Turn the camera from a standard view, with all of the body in it."""
    canvas = page.locator(".viewport canvas")
    canvas.focus()
    page.keyboard.press(shot.view)
    box = canvas.bounding_box()
    assert box is not None
    x, y = box["x"] + 12, box["y"] + box["height"] / 2
    if shot.turn != (0, 0):
        page.mouse.move(x, y)
        page.mouse.down(button="right")
        page.mouse.move(x + shot.turn[0], y + shot.turn[1], steps=4)
        page.mouse.up(button="right")
    page.keyboard.press("f")
    page.wait_for_timeout(500)


def drawn(page: Page) -> Image.Image:
    """The body alone: what differs on black and on white is behind it."""
    black, white = (_on(page, color) for color in ("#000000", "#ffffff"))
    alpha = 1 - (white - black).mean(axis=2, keepdims=True).clip(0, 1)
    color = np.divide(black, alpha, out=np.zeros_like(black), where=alpha > 1 / 255)
    pixels = np.concatenate([color.clip(0, 1), alpha], axis=2)
    return Image.fromarray((255 * pixels).round().astype(np.uint8), "RGBA")


def _on(page: Page, color: str) -> NDArray[np.float64]:
    page.evaluate(BARE, [color])
    page.wait_for_timeout(500)
    content = page.locator(".viewport canvas").screenshot()
    with Image.open(io.BytesIO(content)) as image:
        # A screen may round the edges of the canvas to pixels of what is beside it.
        inner = (EDGE, EDGE, image.width - EDGE, image.height - EDGE)
        return np.asarray(image.convert("RGB").crop(inner), dtype=np.float64) / 255


def cut(images: Sequence[Image.Image]) -> list[Image.Image]:
    """Cut pictures alike, to the smallest part that holds what all of them show."""
    boxes = [image.getchannel("A").point(lambda a: 255 * (a > 8)).getbbox() for image in images]
    found = [box for box in boxes if box is not None]
    left, top = (min(box[i] for box in found) for i in (0, 1))
    right, bottom = (max(box[i] for box in found) for i in (2, 3))
    width, height = SIZE
    scale = (1 + 2 * MARGIN) * max((right - left) / width, (bottom - top) / height)
    x, y = (left + right - scale * width) / 2, (top + bottom - scale * height) / 2
    window = (round(x), round(y), round(x + scale * width), round(y + scale * height))
    return [image.crop(window).resize(SIZE, Image.Resampling.LANCZOS) for image in images]


def picture(browser: Browser, name: str) -> None:
    """Draw a robot at rest."""
    shot = SHOTS.get(name, Shot())
    is_other = name in OTHERS
    text = read_text(ROOT / f"examples/{name}.toml") if is_other else robot_text(name)
    for place, value in shot.values.items():
        text = with_value(text, list(place), value)
    with tempfile.TemporaryDirectory() as folder, page_of(browser, text, Path(folder)) as page:
        rested(page)
        framed(page, shot)
        (image,) = cut([drawn(page)])
    folder = IMAGES if is_other else FOLDER
    image.save(folder / f"{name}.webp", quality=88, method=6)


def moving_picture(browser: Browser) -> None:
    """Draw the first robot on its way under pressure and back."""
    name, place, most = MOVING
    images = []
    for share in BREATH:
        text = with_value(robot_text(name), list(place), f"{share * most:g} Pa")
        with tempfile.TemporaryDirectory() as folder, page_of(browser, text, Path(folder)) as page:
            # One camera for all, and colors that mean the same in all: those of the materials.
            page.get_by_label("Color by").select_option("parts")
            page.locator(".viewport canvas").hover()
            page.mouse.wheel(0, AWAY)  # a camera that was moved stays where it is
            if share > 0:
                rested(page)
            images.append(drawn(page))
    way = cut(images)
    way += way[-2:0:-1]
    way[0].save(
        FOLDER / f"{name}-moving.webp",
        save_all=True,
        append_images=way[1:],
        duration=EVERY,
        loop=0,
        quality=80,
        method=6,
    )


def main() -> int:
    """Draw what the command line names."""
    known = [*(robot.name for robot in ROBOTS), *OTHERS]
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("name", nargs="*", help=f"of {', '.join([*known, 'moving'])}")
    names = parser.parse_args().name or [*known, "moving"]
    if unknown := set(names) - {*known, "moving"}:
        parser.error(f"there is no {', '.join(sorted(unknown))}")
    from playwright.sync_api import sync_playwright

    found = (shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome"))
    with sync_playwright() as driver:
        executable = next((path for path in found if path), None)
        browser = driver.chromium.launch(executable_path=executable, args=list(FLAGS))
        for name in names:
            if name == "moving":
                moving_picture(browser)
            else:
                picture(browser, name)
            print(f"{name} is drawn", flush=True)
        browser.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
