"""The page of features and uses is that of the table."""

import runpy
from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"


def test_the_page_is_written_from_the_table():
    page = runpy.run_path(str(DOCS / "compatibility.py"))["page"]()
    written = (DOCS / "compatibility.md").read_text(encoding="utf-8")
    assert written == page, "write it anew: python docs/compatibility.py"
