"""One fault gives one exit code in every verb, and a message in words."""

import contextlib
import json
import re
import resource
import signal
import sys
from pathlib import Path

import pytest
import tiny_design
from typer.testing import CliRunner

from voxsoft.cli.app import app
from voxsoft.cli.exits import MEANINGS

ROOT = Path(__file__).parents[2]
CYLINDER = ROOT / "examples" / "cylinder.toml"
BEAM = ROOT / "examples" / "beam.toml"
CARD = ROOT / "python/voxsoft/materials/cards/ecoflex-00-30-lattice.toml"
MEASURED = ROOT / "examples" / "data" / "paper_beams" / "ecoflex-00-30.csv"

#: With a name.
TINY = f'name = "tiny"{tiny_design.TINY}'
TENSILE = "strain,stress_kPa\n" + "".join(f"{s / 50},{s * 1.4}\n" for s in range(40))

QUICK = ["design.toml", "--outside", "none", "--voxel-sizes", "none", "--splits", "1"]

#: Option for the output of each verb, after DESIGN and its other arguments.
OUT = {
    "mesh": ["design.toml", "--out", "OUT/body.vtu"],
    "run": ["design.toml", "--out", "OUT"],
    "sweep": ["design.toml", "--workers", "1", "--out", "OUT"],
    "optimize": ["design.toml", "--budget", "1", "--workers", "1", "--out", "OUT"],
    "compare": [*QUICK, "--output", "OUT/a.html"],
    "export": ["design.toml", "OUT/body.stl"],
    "material fit": ["tensile.csv", "--out", "OUT"],
    "new": ["mine", "--folder", "OUT"],
}
READING = ["check", "mesh", "run", "sweep", "optimize", "compare", "export", "calibrate"]


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("design.toml").write_text(TINY)
    Path("tensile.csv").write_text(TENSILE)


def call(verb, arguments):
    return CliRunner().invoke(app, [*verb.split(), *map(str, arguments)])


def assert_reported(outcome, code, *words):
    assert outcome.exit_code == code, outcome.output
    assert isinstance(outcome.exception, SystemExit | None)
    for word in words:
        assert word in outcome.stderr
    assert "Traceback" not in outcome.stderr


def more(verb):
    return {"calibrate": [MEASURED], "export": ["out.stl"]}.get(verb, [])


@contextlib.contextmanager
def files_of_at_most(size):
    """Let the system refuse every write past this size [bytes], as a full disk does."""
    before, most = resource.getrlimit(resource.RLIMIT_FSIZE)
    ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, most))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (before, most))
        signal.signal(signal.SIGXFSZ, ignored)


@pytest.mark.skipif(not hasattr(resource, "RLIMIT_FSIZE"), reason="no limit on files here")
@pytest.mark.parametrize("verb", OUT)
def test_a_full_disk_exits_with_5(verb):
    Path("out").mkdir()
    arguments = [argument.replace("OUT", "out") for argument in OUT[verb]]
    # 300 bytes hold a semaphore of Python's, but none of the files.
    with files_of_at_most(300):
        outcome = call(verb, arguments)
    assert_reported(outcome, 5, "cannot be written: File too large")


@pytest.mark.parametrize("verb", OUT)
def test_a_folder_that_cannot_be_made_is_5(verb):
    Path("in-the-way").write_text("a file\n")
    outcome = call(verb, [argument.replace("OUT", "in-the-way/out") for argument in OUT[verb]])
    assert_reported(outcome, 5, "in-the-way", "Not a directory")


@pytest.mark.parametrize("verb", READING)
@pytest.mark.parametrize(
    ("content", "words"),
    [
        (TINY.replace('"5 mm"', '"5 kPa"', 1), "pressure"),
        ("not toml", "is not TOML"),
        (CARD.read_text(encoding="utf-8"), "is a material card, not a design"),
    ],
    ids=["invalid", "no-toml", "card"],
)
def test_invalid_input_exits_with_3(verb, content, words):
    Path("wrong.toml").write_text(content, encoding="utf-8")
    assert_reported(call(verb, ["wrong.toml", *more(verb)]), 3, words)


@pytest.mark.parametrize("verb", READING)
def test_a_file_that_is_not_there_is_2(verb):
    assert_reported(call(verb, ["missing.toml", *more(verb)]), 2)


@pytest.mark.parametrize("verb", ["sweep", "optimize"])
def test_a_package_that_is_missing_is_2(verb, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    outcome = call(verb, ["design.toml", "--scheduler", "tcp://localhost:1"])
    assert_reported(outcome, 2, "distributed")


@pytest.mark.parametrize("verb", ["sweep", "optimize"])
def test_a_storage_that_does_not_answer_is_5(verb):
    outcome = call(verb, ["design.toml", "--storage", "sqlite:////no/such/folder/a.db"])
    assert_reported(outcome, 5, "the storage failed")


def test_memory_that_is_short_is_5_and_reported_in_json(monkeypatch):
    def none_left(*_, **__):
        raise MemoryError

    monkeypatch.setattr("voxsoft.simulation.simulate", none_left)
    outcome = call("run", ["design.toml", "--json"])
    assert_reported(outcome, 5, "memory: is short")
    assert json.loads(outcome.stdout)["problems"][0]["where"] == "memory"


def test_the_documentation_has_this_table():
    page = (ROOT / "docs" / "reference" / "command-line.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d+) \| (.+?) \|$", page, flags=re.MULTILINE)
    assert {int(code): meaning for code, meaning in rows} == MEANINGS


def test_a_name_that_reads_like_an_emoji_is_shown_as_it_is():
    Path("design.toml").write_text(TINY.replace('"body"', '":x:"'))
    assert ":x:" in call("check", ["design.toml"]).stderr


@pytest.mark.parametrize(
    "text", ["1" + "+1" * 20_000, "height" * 8_000, "(" * 40_000, "é" * 40_000]
)
@pytest.mark.parametrize("verb", ["check", "run"])
def test_long_text_is_not_echoed_whole(verb, text):
    Path("long.toml").write_text(TINY.replace("= height", f"= {text}"), encoding="utf-8")
    outcome = call(verb, ["long.toml", "--json"])
    assert outcome.exit_code == 3
    assert len(outcome.stderr) < 3_000
    assert len(outcome.stdout) < 4_000
