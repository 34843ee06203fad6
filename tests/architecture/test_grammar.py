"""Comments are plain technical English: a noun or a verb first, no sentence built on "what"."""

import ast
import io
import re
import tokenize
from pathlib import Path

import pytest

CRATES = Path(__file__).parents[2] / "crates"
PACKAGE = Path(__file__).parents[2] / "python/voxsoft"
#: Packages whose comments and docstrings of functions are plain; others will follow.
PLAIN = (
    "calibration",
    "comparison",
    "files",
    "formats",
    "jobs",
    "materials",
    "metrics",
    "plot",
    "scoreboard",
    "search",
    "shapes",
    "simulation",
    "study",
    "units",
    "voxels",
)
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


def blocks_of_python(text):
    """The comments of Python source and the docstrings of its functions, without doctests."""
    block, last = [], 0
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            if token.start[0] > last + 1 and block:
                yield block
                block = []
            block.append(token.string.lstrip("#: "))
            last = token.start[0]
    yield block
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.FunctionDef, ast.AsyncFunctionDef)):
            lines, in_code = [], False
            for line in (ast.get_docstring(node) or "").splitlines():
                in_code = bool(line.strip()) and (in_code or line.lstrip().startswith(">>>"))
                lines.append("" if in_code else line.strip())
            yield lines


def faults_in(blocks):
    """The lines of comments that a search would not find."""
    for block in blocks:
        paragraph = True
        for line in block:
            if (paragraph and OPENINGS.match(line)) or RELATIVE.search(line):
                yield line
            paragraph = not line.strip()


@pytest.mark.parametrize("path", sorted(CRATES.rglob("*.rs")), ids=lambda path: path.stem)
def test_comments_are_plain(path):
    found = list(faults_in(blocks_of(path.read_text(encoding="utf-8"))))
    assert not found, 'begin with a noun or a verb, and name the thing instead of "what ..."'


@pytest.mark.parametrize("name", PLAIN)
def test_docstrings_of_a_package_are_plain(name):
    found = {
        path.name: lines
        for path in sorted((PACKAGE / name).rglob("*.py"))
        if (lines := [*faults_in(blocks_of_python(path.read_text(encoding="utf-8")))])
    }
    assert not found


def test_the_private_grammar_is_known_in_python():
    source = (
        'def f():\n    """Return it.\n\n    What is left.\n\n    >>> what\n    """\n    # Of it\n'
    )
    assert len(list(faults_in(blocks_of_python(source)))) == 2


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
    assert list(faults_in(blocks_of(comment)))


def test_plain_comments_pass():
    plain = "/// Contact penalty in units of E/h.\n///\n/// Grows where it slips."
    assert not list(faults_in(blocks_of(plain)))
