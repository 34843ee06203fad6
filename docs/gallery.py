"""Fill the page of the gallery: each robot with picture, live page, command, figures and text.

All of it is made as the documentation is built (`make docs`): the command is run, the page is
exported. What was made is kept in target/gallery until the design or the version of VoxSoft
changes, since error bars take minutes.
"""

from __future__ import annotations

import hashlib
import html
import json
import math
import shlex
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from voxsoft import __version__
from voxsoft.design.robots import ROBOTS, robot

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files
    from mkdocs.structure.pages import Page

ROOT: Final = Path(__file__).resolve().parents[1]
MADE: Final = ROOT / "target/gallery"
PAGE: Final = "gallery.md"
PLACE: Final = "<!-- robots -->"


@dataclass(frozen=True)
class Figure:
    """A number of a result.

    Attributes
    ----------
    title
        What it is.
    path
        Where it stands in the JSON of `voxsoft run`: the group, the name, and the axis of a probe.
    unit, factor
        The unit to show, and how much of it one of the SI unit is.
    """

    title: str
    path: tuple[str, str, str]
    unit: str = "mm"
    factor: float = 1e3


@dataclass(frozen=True)
class Entry:
    """A robot of the gallery: the name of its example, and what to say of its result.

    `options` are those of its command; `title` and `sentence` may be left to the robot of that
    name.
    """

    name: str
    figures: tuple[Figure, ...]
    title: str = ""
    sentence: str = ""
    options: str = ""

    @property
    def heading(self) -> str:
        """What to call it."""
        return self.title or robot(self.name).title

    @property
    def words(self) -> str:
        """What it is and does."""
        return self.sentence or robot(self.name).sentence

    @property
    def design(self) -> Path:
        """Its design file."""
        return ROOT / "examples" / f"{self.name}.toml"

    @property
    def picture(self) -> Path:
        """Its picture: `python studio/thumbnails.py` draws it."""
        if any(each.name == self.name for each in ROBOTS):
            return ROOT / "python/voxsoft/design/robots" / f"{self.name}.webp"
        return ROOT / "docs/images/gallery" / f"{self.name}.webp"

    @property
    def command(self) -> str:
        """What gives the figures."""
        return f"voxsoft run examples/{self.name}.toml{self.options}"


def along(title: str, probe: str, axis: str) -> Figure:
    """How far a probe moves along an axis."""
    return Figure(title, ("probes", probe, axis))


ENTRIES: Final = (
    Entry("pneunet", (along("tip, downward", "tip", "z"),)),
    # Its wall has too few voxels to be halved: smaller ones give the error.
    Entry("bellows", (along("lid, upward", "top", "z"),), options=" --error finer"),
    Entry("starfish", (along("end of an arm, downward", "tip", "z"),)),
    Entry("tendon_trunk", (along("tip, sideways", "tip", "x"), along("tip, upward", "tip", "z"))),
    Entry("magnetic_gripper", (along("tip of an arm, upward", "tip", "z"),)),
    Entry("wound_tube", (along("stroke", "top", "z"),)),
    Entry("wound_bender", (along("end, sideways", "top", "x"),)),
    Entry("tendon_finger", (along("tip, downward", "tip", "z"),)),
    Entry("shape_memory_finger", (along("tip, upward", "tip", "z"),)),
    Entry(
        "bender",
        (along("tip, downward", "tip", "z"),),
        "Bar on fabric",
        "One long chamber on a sheet that does not stretch.",
    ),
    Entry(
        "gripper_finger",
        (along("tip, inward", "tip", "x"),),
        "Hanging finger",
        "A chamber behind a film; three of them make a gripper.",
    ),
    Entry(
        "finger",
        (Figure("largest displacement", ("metrics", "max_displacement", "")),),
        "Gyroid finger",
        "A skin around a gyroid, pushed at its tip.",
        " --error finer",  # voxels twice as large would be another lattice
    ),
    Entry(
        "sphere",
        (along("top, upward", "top", "z"),),
        "Sphere",
        "A ball with a spherical chamber, clamped at its foot.",
        " --set 'voxel_size=2.5 mm' --error finer",  # on 5 mm the error is as large as the rise
    ),
)


def made(entry: Entry) -> tuple[Path, dict[str, Any]]:
    """Export the live page of a robot and run its command, where that was not done yet.

    Returns
    -------
    tuple
        The page, and the JSON of `voxsoft run`.
    """
    text = entry.design.read_bytes()
    key = hashlib.sha256(text + f"{__version__} {entry.options}".encode()).hexdigest()[:12]
    page, result = MADE / f"{entry.name}-{key}.html", MADE / f"{entry.name}-{key}.json"
    MADE.mkdir(parents=True, exist_ok=True)
    if not page.is_file():
        voxsoft("export", f"examples/{entry.name}.toml", "--html", str(page))
    if not result.is_file():
        runs = MADE / "runs" / f"{entry.name}-{key}"
        arguments = shlex.split(entry.command)[1:]
        result.write_text(voxsoft(*arguments, "--json", "--out", str(runs)), encoding="utf-8")
    return page, json.loads(result.read_text(encoding="utf-8"))


def voxsoft(*arguments: str) -> str:
    """Run the command of this environment; gives what it prints.

    Raises
    ------
    RuntimeError
        It ended with an error.
    """
    program = Path(sys.executable).with_name("voxsoft")
    done = subprocess.run(
        [program, *arguments], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise RuntimeError(f"voxsoft {shlex.join(arguments)}: {done.stderr.strip()}")
    return done.stdout


def shown(figure: Figure, result: dict[str, Any]) -> str:
    """A number with its error bar, such as "16.9 ± 0.4 mm", or as it was solved."""
    group, name, axis = figure.path
    bar = result["error_bars"].get(group, {}).get(name)
    if bar and axis:
        bar = bar[axis]
    if bar:
        value, error = (figure.factor * bar[key] for key in ("estimate", "error"))
        # The error with two digits, and the value as far as the error lets it be known.
        digits = max(0, 1 - math.floor(math.log10(error))) if error > 0 else 2
        return f"{value:.{digits}f} ± {error:.{digits}f} {figure.unit}"
    solved = result[group][name]
    if axis:
        solved = solved["displacement"]["xyz".index(axis)]
    return f"{figure.factor * solved:.3g} {figure.unit}, without an error bar"


def section(entry: Entry, result: dict[str, Any]) -> str:
    """The part of the page that shows a robot, in Markdown."""
    rows = "\n".join(f"| {each.title} | {shown(each, result)} |" for each in entry.figures)
    text = html.escape(entry.design.read_text(encoding="utf-8"))
    live = f"{entry.name}.html"
    return f"""
## {entry.heading}

<a href="{live}">
<img src="{entry.name}.webp" alt="{entry.heading} at rest under its loads" width="480" height="320">
</a>

{entry.words} <a href="{live}">Open its live page</a>: pull on it, change its loads.

    {entry.command}

| {result["voxels"]:,} voxels, {result["solver"]} | |
|---|---|
{rows}

<details><summary><code>examples/{entry.name}.toml</code></summary><pre><code>{text}</code></pre></details>
"""


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the live pages and pictures to the files of the documentation."""
    from mkdocs.structure.files import File

    for entry in ENTRIES:
        page, _ = made(entry)
        for source, name in ((page, f"{entry.name}.html"), (entry.picture, f"{entry.name}.webp")):
            files.append(File.generated(config, f"gallery/{name}", abs_src_path=str(source)))
    return files


def on_page_markdown(markdown: str, page: Page, **_: Any) -> str:  # noqa: ANN401 - what mkdocs passes
    """Put the robots in their place on the page of the gallery."""
    if page.file.src_uri != PAGE:
        return markdown
    return markdown.replace(PLACE, "".join(section(each, made(each)[1]) for each in ENTRIES))
