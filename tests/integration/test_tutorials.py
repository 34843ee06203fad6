"""The documents' pages, executed: every block runs, in order, and prints the text of the page.

On a page, ``toml`` and ``csv`` blocks with a title are written as files, ``python`` blocks run in
one namespace, the ``$`` lines of ``console`` blocks run in a shell. A ``text`` block, and the other
lines of a ``console`` block, is the expected output; ``...`` stands for anything. ``sh`` blocks are
for the reader alone: they need a network, another program or another machine.

A line that only calls ``voxsoft`` is run in this process, without the seconds that Python takes to
start.
"""

import contextlib
import doctest
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
from typer.testing import CliRunner

from voxsoft.cli.app import app
from voxsoft.cli.output import console
from voxsoft.metrics import registry

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [DOCS / "start.md", *sorted(DOCS.glob("tutorials/*.md")), *sorted(DOCS.glob("how-to/*.md"))]
#: Pages whose Python is also run as a script.
SCRIPTS = {DOCS / "start.md", *DOCS.glob("tutorials/*.md"), DOCS / "how-to" / "dask.md"}
#: Pages that take ten seconds or more; the way of a new user is always run.
LONG = {
    "calibrate-a-beam.md",
    "activate.md",
    "compare.md",
    "crawl.md",
    "dask.md",
    "design-and-study.md",
    "error-bars.md",
    "export.md",
    "fluids.md",
    "gait.md",
    "grip.md",
    "gripper.md",
    "layers-and-fibers.md",
    "load-history.md",
    "magnets.md",
    "make.md",
    "material-card.md",
    "measured-data.md",
    "paths.md",
    "pneunet.md",
    "refine.md",
    "repeat-a-job.md",
    "softening.md",
    "squeeze.md",
    "tendons.md",
    "trunk.md",
    "wound-tubes.md",
}
#: Examples that a tutorial shows as a whole.
SHOWN = {
    "gripper.md": "pumped_gripper.toml",
    "pneunet.md": "toolkit_pneunet.toml",
    "trunk.md": "tendon_trunk.toml",
}
FENCE = re.compile(r'^```(\w+)(?: title="([^"]+)")?\n(.*?)^```$', re.MULTILINE | re.DOTALL)
KNOWN = {"python", "console", "text", "toml", "csv", "sh", "yaml"}
#: Progress of a long command when it has no terminal; a page leaves it out.
PROGRESS = re.compile(r"^[\w ]+: \d+/\d+, .*\n", re.MULTILINE)
OUTPUT = doctest.OutputChecker()
LOOSE = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


@dataclass(frozen=True)
class Block:
    language: str
    title: str | None
    text: str
    line: int


def blocks_of(page):
    text = page.read_text(encoding="utf-8")
    for match in FENCE.finditer(text):
        yield Block(match[1], match[2], match[3], text.count("\n", 0, match.start()) + 1)


def assert_prints(expected, got, where):
    assert OUTPUT.check_output(expected, got, LOOSE), f"{where}\nexpected:\n{expected}\ngot:\n{got}"


def run_python(block, namespace, where):
    # Blank lines before the code, as many as on the page: a traceback names the page's line.
    code = compile("\n" * block.line + block.text, where, "exec")
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(code, namespace)
    return printed.getvalue()


def run_console(block, where):
    """Run each ``$`` line; the lines up to the next one are its output."""
    commands = re.split(r"^\$ ", block.text, flags=re.MULTILINE)
    assert not commands[0], f"{where}: a console block starts with '$ '"
    for command in commands[1:]:
        line, _, expected = command.partition("\n")
        code, printed = in_a_shell(line) if needs_a_shell(line) else in_process(line)
        assert code == 0, f"{where}: {line}\n{printed}"
        if expected.strip():
            assert_prints(expected, PROGRESS.sub("", printed), f"{where}: {line}")


def needs_a_shell(line):
    """Check if a line does more than call the command with words."""
    words = shlex.shlex(line, posix=True, punctuation_chars=True)
    words.whitespace_split = True
    first, *others = words
    return first != "voxsoft" or any(word[0] in "|&;<>()" for word in others)


def in_a_shell(line):
    """The exit code of a line, and all that it printed."""
    done = subprocess.run(
        ["bash", "-c", line],
        env=shell_environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    return done.returncode, done.stdout


def in_process(line):
    """Run a call of the command in this process."""
    console.cache_clear()  # it asks for the width of the terminal once
    done = CliRunner().invoke(app, shlex.split(line)[1:], env=shell_environment())
    console.cache_clear()
    if done.exception and not isinstance(done.exception, SystemExit):
        raise done.exception
    return done.exit_code, done.output


def shell_environment():
    scripts = str(Path(sys.executable).parent)
    path = os.pathsep.join([scripts, os.environ["PATH"]])
    return os.environ | {"PATH": path, "COLUMNS": "100", "TERM": "dumb", "NO_COLOR": "1"}


def run_page(page):
    namespace = {"__name__": "__main__"}
    printed = ""
    for block in blocks_of(page):
        where = f"{page.relative_to(ROOT)}:{block.line}"
        if block.language == "python":
            printed = run_python(block, namespace, where)
        elif block.language == "console":
            run_console(block, where)
        elif block.language == "text":
            assert_prints(block.text, printed, where)
        elif block.title:
            Path(block.title).write_text(block.text, encoding="utf-8")


def run_script(page):
    """Run the Python of a page as one script, as readers paste it, in a process of its own."""
    blocks = [block.text for block in blocks_of(page) if block.language == "python"]
    if not blocks:
        return
    Path("pasted.py").write_text("\n".join(blocks), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "pasted.py"],
        env=shell_environment() | {"MPLBACKEND": "agg"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, f"{page.name} as a script\n{done.stderr}"


@pytest.mark.long
@pytest.mark.parametrize(
    "page",
    [pytest.param(page, marks=[pytest.mark.slow] * (page.name in LONG)) for page in PAGES],
    ids=lambda page: str(page.relative_to(DOCS)),
)
def test_a_page_runs_as_written(page, tmp_path, monkeypatch):
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    before = dict(registry._ALL)
    run_page(page)
    registry._ALL.clear()  # metrics that the page added
    registry._ALL.update(before)


@pytest.mark.parametrize(("page", "example"), SHOWN.items())
def test_a_page_shows_the_example_as_it_is(page, example):
    (design, *more) = [b.text for b in blocks_of(DOCS / "tutorials" / page) if b.title]
    assert not more
    assert design == (ROOT / "examples" / example).read_text(encoding="utf-8")
    assert len(design.splitlines()) <= 40


@pytest.mark.slow
@pytest.mark.parametrize("page", sorted(SCRIPTS), ids=lambda page: str(page.relative_to(DOCS)))
def test_the_python_of_a_page_runs_as_a_script(page, tmp_path, monkeypatch):
    """Readers paste it, and worker processes import it then."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    run_page(page)
    run_script(page)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(DOCS)))
def test_blocks_are_of_a_kind_that_is_understood(page):
    blocks = list(blocks_of(page))
    assert {block.language for block in blocks} <= KNOWN
    assert any(block.language in ("python", "console") for block in blocks)
    # Every fence opens and closes: nothing on the page escapes the tests.
    fences = re.findall(r"^ *```", page.read_text(encoding="utf-8"), re.MULTILINE)
    assert len(fences) == 2 * len(blocks)


def test_a_page_that_prints_otherwise_fails(tmp_path, monkeypatch):
    page = ROOT / "docs" / "wrong.md"
    monkeypatch.setattr(
        Path, "read_text", lambda *_, **__: "```python\nprint(1)\n```\n```text\n2\n```\n"
    )
    monkeypatch.chdir(tmp_path)
    with pytest.raises(AssertionError, match=r"wrong\.md:4"):
        run_page(page)
