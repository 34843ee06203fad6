"""Files of a design stay in its folder, with any name of it, on every system."""

import contextlib
import json
import tempfile
import unicodedata
from pathlib import Path, PureWindowsPath

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from tiny_design import TINY
from typer.testing import CliRunner

from voxsoft._folders import LONGEST, folder_name
from voxsoft.cli.app import app
from voxsoft.files import load
from voxsoft.study import Study

NASTY = [
    "/elsewhere/evil", "../../escaped", "finger/v2", "a\0b", "..", ".", "...", "", " ", "/", "\\",
    "C:\\Windows\\evil", "C:evil", "con", "CON.txt", "com1", "COM¹", "lpt9.x", "nul", "a" * 5000,
    "ü" * 300, "\U0001f916" * 90, "-rf", "--out", "~", "~root", ".bashrc", "x.", "x ", "a\nb",
    "a\u202eb", "\u200b", "$(id)", "`id`", "%2e%2e%2f", "a:b", "a|b", "a?b*", "\ud800", "‥", "．．",
]  # fmt: skip

PIECES = st.sampled_from(["/", "\\", "..", ".", ":", "\0", "con", " ", "~", "ü", "\u202e", "．"])
NAMES = st.one_of(st.text(), st.lists(PIECES, max_size=9).map("".join), st.sampled_from(NASTY))


@given(NAMES)
@settings(deadline=None)
@example("/elsewhere/evil")
def test_a_name_is_that_of_one_folder_here(name):
    made = folder_name(name)
    assert made == unicodedata.normalize("NFKC", made)
    assert Path("runs", made).name == made
    assert PureWindowsPath("runs", made).name == made
    assert 0 < len(made.encode("utf-8")) <= LONGEST + len("_")
    assert made.isprintable()
    assert not made.startswith((".", "-"))
    assert not made.endswith((".", " "))
    device = made.split(".")[0].upper()
    assert device not in {"CON", "PRN", "AUX", "NUL"}
    assert not (device[:3] in {"COM", "LPT"} and device[3:].isdigit() and len(device) == 4)
    assert folder_name(made) == made


@pytest.mark.parametrize("name", NASTY, ids=repr)
def test_a_folder_of_any_name_can_be_made(tmp_path, name):
    folder = tmp_path / f"{folder_name(name)}-12345678-comparison.html"
    folder.mkdir()
    assert [child.name for child in tmp_path.iterdir()] == [folder.name]


def names_of_designs():
    """Those that a design can have: text that can be seen, of at most 200 characters."""
    return st.sampled_from([n for n in NASTY if 0 < len(n) <= 200 and n.isprintable()])


@contextlib.contextmanager
def in_a_fresh_folder():
    """Give a folder to work in below one that nothing may be written to."""
    with tempfile.TemporaryDirectory() as outer:
        home = Path(outer, "a", "b", "home")
        home.mkdir(parents=True)
        with contextlib.chdir(home):
            yield home
        strays = {p for p in Path(outer).rglob("*") if p.is_file() and home not in p.parents}
        assert not strays
        assert [child.name for child in Path(outer).iterdir()] == ["a"]


@pytest.mark.long
@given(names_of_designs())
@settings(deadline=None, max_examples=6, suppress_health_check=[HealthCheck.too_slow])
@example("../../escaped")
@example("/elsewhere/evil")
def test_files_of_a_design_stay_below_the_folder(name):
    with in_a_fresh_folder() as home:
        file = design_called(name, home)
        outcome = CliRunner().invoke(app, ["run", str(file)])
        assert outcome.exit_code == 0, outcome.output
        Study(load(file))
        assert_named(name, home, ("runs", "studies"))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["../../escaped", "/elsewhere/evil"])
def test_reports_and_sweeps_stay_there_too(name):
    with in_a_fresh_folder() as home:
        file = design_called(name, home)
        quick = ["--outside", "none", "--voxel-sizes", "none", "--splits", "1"]
        for call in (["compare", str(file), *quick], ["sweep", str(file)]):
            outcome = CliRunner().invoke(app, call)
            assert outcome.exit_code == 0, outcome.output
        # The report of the comparison, the folder of its job, and that of the sweep.
        assert_named(name, home, ("runs",), count=3)


def design_called(name, home):
    file = home / "design.toml"
    # TOML knows no pairs of surrogates, to which JSON escapes characters beyond 16 bits.
    quoted = json.dumps(name, ensure_ascii=False)
    file.write_text(f"name = {quoted}\n{TINY}", encoding="utf-8")
    return file


def assert_named(name, home, folders, count=2):
    assert {child.name for child in home.iterdir()} == {"design.toml", *folders}
    made = [child.name for folder in folders for child in (home / folder).iterdir()]
    assert len(made) == count
    starts = folder_name(name), folder_name(name, "study")
    assert all(each.startswith(starts) for each in made)
