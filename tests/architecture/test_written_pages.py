"""Pages that are written from a table of the program follow it."""

import runpy
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize("script", ["compatibility.py", "formats.py"])
def test_a_page_is_written_from_its_table(script):
    written = runpy.run_path(str(DOCS / script))
    text = written["PAGE"].read_text(encoding="utf-8")
    assert text == written["page"](), f"write it anew: python docs/{script}"
