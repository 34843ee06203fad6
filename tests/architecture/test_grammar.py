"""Comments are plain technical English: a noun or a verb first, no sentence built on "what"."""

import re
from pathlib import Path

import pytest

CRATES = Path(__file__).parents[2] / "crates"
COMMENT = re.compile(r"^\s*//[/!]?\s?(.*)$")
#: Words with which no comment begins: a clause in place of a noun, or an ellipsis.
OPENINGS = re.compile(r"(?:What|Where|How|Whether|Of|By|As|The same|That of|Those of)\b")
RELATIVE = re.compile(r"\bwhat\b", re.IGNORECASE)


def blocks_of(text):
    """The comments of Rust source, a list of lines for each block."""
    block = []
    for line in text.splitlines():
        found = COMMENT.match(line)
        if found:
            block.append(found[1])
        elif block:
            yield block
            block = []
    if block:
        yield block


def faults_in(text):
    """The lines of comments that a search would not find."""
    for block in blocks_of(text):
        paragraph = True
        for line in block:
            if (paragraph and OPENINGS.match(line)) or RELATIVE.search(line):
                yield line
            paragraph = not line.strip()


@pytest.mark.parametrize("path", sorted(CRATES.rglob("*.rs")), ids=lambda path: path.stem)
def test_comments_are_plain(path):
    found = list(faults_in(path.read_text(encoding="utf-8")))
    assert not found, 'begin with a noun or a verb, and name the thing instead of "what ..."'


@pytest.mark.parametrize(
    "comment",
    [
        "/// Of each vertex.",
        "/// The same with friction.",
        "/// Where the search begins.",
        "// Nothing is left of what was pressed.",
    ],
)
def test_the_private_grammar_is_known(comment):
    assert list(faults_in(comment))


def test_plain_comments_pass():
    assert not list(
        faults_in("/// Contact penalty in units of E/h.\n///\n/// Grows where it slips.")
    )
