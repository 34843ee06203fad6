"""The first page of the documentation leads to every other one."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_the_index_leads_to_every_page_of_the_navigation():
    pages = set(re.findall(r": ([\w/-]+\.md)$", (ROOT / "mkdocs.yml").read_text(), re.MULTILINE))
    assert len(pages) > 20
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    linked = {link.partition("#")[0] for link in re.findall(r"\]\(([\w/.#-]+)\)", index)}
    assert pages - {"index.md"} <= linked
    files = {file.relative_to(ROOT / "docs").as_posix() for file in (ROOT / "docs").rglob("*.md")}
    assert files <= pages
