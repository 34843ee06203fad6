"""Comments are plain technical English: a noun or a verb first, no sentence built on "what"."""

import ast
import io
import re
import tokenize
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CRATES = ROOT / "crates"
PACKAGE = ROOT / "python/voxsoft"
STUDIO = ROOT / "studio"
#: Packages of VoxSoft; the files beside them are those of ".".
PACKAGES = (".", *sorted(path.parent.name for path in PACKAGE.glob("*/__init__.py")))
#: Folders of the studio's page and of its tests.
PAGES = sorted(
    {
        path.parent.relative_to(STUDIO).as_posix()
        for folder in ("src", "tests")
        for path in (STUDIO / folder).rglob("*.ts*")
    }
)
COMMENT = re.compile(r"^\s*//[/!]?\s?(.*)$")
#: Words with which no comment begins: a clause in place of a noun, or an ellipsis.
OPENINGS = re.compile(r"(?:What|Where|How|Whether|Of|By|As|The same|That of|Those of)\b")
#: Names of entries that a docstring describes below, such as ``where, hint``.
NAMES = re.compile(r"(?:\*{0,2}\w+)(?:, \*{0,2}\w+)*(?: : .*)?$")
RELATIVE = re.compile(r"\bwhat\b", re.IGNORECASE)
#: Names of tests that a clause stands in, and the most letters of one.
CLAUSE = re.compile(r"_(?:what|whether)(?:_|$)")
LONGEST_NAME = 74
BLOCK = re.compile(r"\{?/\*\*?\s?(.*?)(\*/.*)?$")


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


def blocks_of_typescript(text):
    """The comments of TypeScript source that have lines of their own."""
    block, inside = [], False
    for line in map(str.strip, text.splitlines()):
        if inside:
            inside = "*/" not in line
            block.append(line.replace("*/", "").lstrip("*").strip())
        elif (found := COMMENT.match(line)) and not line.startswith("///"):
            block.append(found[1])
        else:
            yield block
            found = BLOCK.match(line)
            block = [found[1].strip()] if found else []
            inside = found is not None and found[2] is None
    yield block


def blocks_of_python(text):
    """The comments of Python source, and its docstrings without doctests.

    The description of a parameter or an attribute counts as a paragraph.
    """
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
        if isinstance(node, (ast.Module, ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            lines, in_code, indent = [], False, 0
            for line in (ast.get_docstring(node) or "").splitlines():
                in_code = bool(line.strip()) and (in_code or line.lstrip().startswith(">>>"))
                start = len(line) - len(line.lstrip())
                if start > indent and lines and NAMES.match(lines[-1]):
                    lines[-1] = ""
                lines.append("" if in_code else line.strip())
                indent = start
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


def faults_of(paths, blocks):
    """The faults of some files by their names."""
    found = {
        path.name: [*faults_in(blocks(path.read_text(encoding="utf-8")))] for path in sorted(paths)
    }
    return {name: lines for name, lines in found.items() if lines}


@pytest.mark.parametrize("name", PACKAGES)
def test_docstrings_of_a_package_are_plain(name):
    paths = PACKAGE.glob("*.py") if name == "." else (PACKAGE / name).rglob("*.py")
    assert not faults_of(paths, blocks_of_python)


@pytest.mark.parametrize("folder", PAGES)
def test_comments_of_the_page_are_plain(folder):
    assert not faults_of((STUDIO / folder).glob("*.ts*"), blocks_of_typescript)


@pytest.mark.parametrize(
    "source",
    [
        "// Where it is.",
        "// ---- what it draws ----",
        "/** Of the body. */",
        "/**\n * Whether it moves.\n */",
        "{/* How it ends. */}",
        "const a = 1;\n  /** Text.\n   *\n   * By hand. */",
    ],
)
def test_the_private_grammar_is_known_in_typescript(source):
    assert len(list(faults_in(blocks_of_typescript(source)))) == 1


def test_plain_comments_of_typescript_pass():
    source = (
        '/** Edge of a voxel, m. */\nconst what = "where";\n// Drawn once.\n// By hand after it.'
    )
    assert not list(faults_in(blocks_of_typescript(source)))


@pytest.mark.parametrize(
    "docstring",
    [
        "Whether it moves.",
        "A body.\n\n    Parameters\n    ----------\n    at\n        Where it is.",
        "A body.\n\n    Parameters\n    ----------\n    a, b : float\n        Of the body.",
    ],
)
@pytest.mark.parametrize("head", ["class A:", "def f():"])
def test_the_private_grammar_is_known_in_docstrings(head, docstring):
    assert len(list(faults_in(blocks_of_python(f'{head}\n    """{docstring}\n    """\n')))) == 1


def test_names_of_tests_are_short_and_have_a_subject():
    names = [
        name
        for path in (ROOT / "tests").rglob("*.py")
        for name in re.findall(
            r"^ *(?:async )?def (test_\w+)", path.read_text(encoding="utf-8"), re.M
        )
    ]
    assert not [name for name in names if CLAUSE.search(name) or len(name) > LONGEST_NAME]


@pytest.mark.parametrize(
    "name", ["test_what_is_free_falls", "test_says_what", "test_whether_it_is"]
)
def test_names_without_a_subject_are_known(name):
    assert CLAUSE.search(name)


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
