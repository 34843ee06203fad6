"""Pages that are written from a table of the program follow it."""

import runpy
import shlex
from pathlib import Path

import pytest

from voxsoft.cli.app import app
from voxsoft.formats.registry import FORMATS

DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize("script", ["compatibility.py", "files.py", "formats.py"])
def test_a_page_is_written_from_its_table(script):
    written = runpy.run_path(str(DOCS / script))
    text = written["PAGE"].read_text(encoding="utf-8")
    assert text == written["page"](), f"write it anew: python docs/{script}"


@pytest.mark.parametrize("form", [f for f in FORMATS if f.reader], ids=lambda f: f.suffix + f.kind)
def test_a_format_to_read_has_its_row_for_users(form):
    assert all((form.states, form.parts, form.trap)), "say its unit, its parts and its trap"
    program, verb, *words = shlex.split(form.command)
    verbs = {command.callback.__name__: command for command in app.registered_commands}
    assert program == "voxsoft"
    assert verb in verbs or verb == "material"
    # A test of instruments names its files; every other command names one of this format.
    files = [word for word in words if word.endswith(form.suffixes) or word == "test.toml"]
    assert len(files) == 1
