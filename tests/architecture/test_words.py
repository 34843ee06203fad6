"""One word for each thing, in American spelling: words retired in docs/reference/words.md stay out.

python tests/architecture/test_words.py   # rewrites British spelling where it stands
"""

import io
import re
import subprocess
import sys
import tokenize
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
THIS = Path(__file__).name
#: Tokens of Python that hold text for users; f-strings have kinds of their own from 3.12 on.
READ = {tokenize.STRING, getattr(tokenize, "FSTRING_MIDDLE", tokenize.STRING)}

# --- Spelling -------------------------------------------------------------------------------------

#: From a British stem to the American one, inside any word: `Colours`, `top_centre`, `isCentred`.
SPELLING = {
    "colour": "color",
    "fibre": "fiber",
    "centred": "centered",
    "centring": "centering",
    "centre": "center",
    "behaviour": "behavior",
    "neighbour": "neighbor",
    "favour": "favor",
    "artefact": "artifact",
    "mould": "mold",
    "licence": "license",
    "metre": "meter",
    "fulfilment": "fulfillment",
    "misspelt": "misspelled",
    "labelled": "labeled",
    "labelling": "labeling",
    "modelled": "modeled",
    "modelling": "modeling",
    "travelled": "traveled",
    "analyse": "analyze",
    "catalogue": "catalog",
    "grey": "gray",
    "defence": "defense",
    "programme": "program",
}
#: Whole words.
WORDS = {"fulfil": "fulfill", "towards": "toward", "whilst": "while", "spelt": "spelled"}

_STEM = re.compile("|".join(sorted(SPELLING, key=len, reverse=True)), re.IGNORECASE)
_WORD = re.compile(rf"(?<![A-Za-z])(?:{'|'.join(WORDS)})(?![a-z])", re.IGNORECASE)
_ISE = re.compile(
    r"(?:(?<![A-Za-z\\])[a-z]|[A-Z])[a-z]*?is(?=(?:e|es|ed|er|ers|ing|ation|ations|able|ability)(?![a-z]))"
)
#: Words that end in -ise, -ised, … and are spelled so in America too.
_ISE_STAYS = re.compile(
    r"(?:ra|r|no|po|prom|comprom|prec|conc|prem|surpr|adv|dev|rev|superv|telev|improv|exerc"
    r"|exc|comp|compr|disgu|gu|w|ar|appra|pra|m|dem|expert|enterpr|franch|parad|treat|merchand"
    r"|cru|cr|bru|anch|c|inc|d|l|v|pr|otherw|likew|clockw|counterclockw|pairw|piecew|stepw|elementw"
    r"|componentw|edgew|lengthw)is|(?:v|div|rev|prov|dec|prec|inv)is",
    re.IGNORECASE,
)

#: Text that is not ours to spell: names of files, of columns in them, of others' interfaces.
FOREIGN = re.compile(
    r"Optimising Soft Robot Designs"  # the paper's title
    r"|top_centre_uz_mm"  # a column of tests/data
    r"|`licence`|\"licence\"(?=.*(?:older|earlier))"  # a key that is still taken, and still printed
    r"|(?:\"maximise|\"centre|a\.centre)(?=[\": ])"  # wrong keys, on purpose
)
#: Files that others wrote, or that hold words on purpose.
OTHERS = re.compile(
    r"LICENSE|package-lock\.json|Cargo\.lock|\.(?:png|gif|webp|zip|csv|svg|vtu|stl|scene|wasm)$"
    rf"|{THIS}|docs/reference/words\.md|examples/data/|tests/data/files/[^/]*\.(?!py$|toml$)"
)


@cache
def tracked():
    """The files of the project that hold our own words, each with its text."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    ).stdout.splitlines()
    paths = [ROOT / name for name in listed if not OTHERS.search(name)]
    return {
        path: path.read_text(encoding="utf-8")
        for path in paths
        if path.is_file() and not path.is_symlink()
    }


def american(text):
    """The text in American spelling; foreign text stays."""
    foreign = [found.span() for found in FOREIGN.finditer(text)]

    def stays(found):
        return any(start < found.end() and found.start() < end for start, end in foreign)

    def stem(found):
        return found[0] if stays(found) else like(found[0], SPELLING[found[0].lower()])

    def word(found):
        return found[0] if stays(found) else like(found[0], WORDS[found[0].lower()])

    def ise(found):
        if stays(found) or _ISE_STAYS.fullmatch(found[0]):
            return found[0]
        return found[0][:-1] + "z"

    # A search for plain words is many times as quick as one for patterns.
    small = text.lower()
    if not foreign:
        if not any(word in small for word in (*SPELLING, *WORDS)):
            return _ISE.sub(ise, text)
        return _ISE.sub(ise, _WORD.sub(word, _STEM.sub(stem, text)))
    # Places move where a replacement has another length: one kind at a time, from a fresh search.
    for pattern, change in ((_STEM, stem), (_WORD, word), (_ISE, ise)):
        foreign[:] = [found.span() for found in FOREIGN.finditer(text)]
        text = pattern.sub(change, text)
    return text


def like(old, new):
    """The new word with the capitals of the old one."""
    if old.isupper():
        return new.upper()
    return new.capitalize() if old[0].isupper() else new


def test_spelling_is_american():
    found = []
    for path, text in tracked().items():
        spelled = american(text)
        if spelled == text:
            continue
        lines = zip(text.splitlines(), spelled.splitlines(), strict=True)
        for number, (old, new) in enumerate(lines, 1):
            if old != new:
                found.append(f"{path.relative_to(ROOT)}:{number}: {old.strip()[:90]}")
    hint = f"`python {Path(__file__).relative_to(ROOT)}` rewrites:"
    assert not found, "\n".join([hint, *found])


@pytest.mark.parametrize(
    ("british", "expected"),
    [
        ("The Colour of fibreTips, top_centre", "The Color of fiberTips, top_center"),
        ("factorised by optimisation, voxelises", "factorized by optimization, voxelizes"),
        ("isOptimised and MINIMISED_", "isOptimized and MINIMISED_"),
        ("raised noise, precise promises, otherwise; von_mises", None),
        (r"[objectives]\nrise = 1\traised, isRising", None),
        ("counterclockwise edges of pairwise, arising, advised", None),
        ('see "Optimising Soft Robot Designs", towards a metre', 'see "Optimising Soft Robot '
         'Designs", toward a meter'),
    ],
)  # fmt: skip
def test_the_rewriting_keeps_capitals_and_names(british, expected):
    assert american(british) == (expected or british)


# --- Retired words --------------------------------------------------------------------------------

#: Ordinary uses of retired words: a file, and the text around the word there.
ORDINARY = {
    # ask and tell are the names, in Optuna and any search like it, of the two halves of a trial.
    "tell": r"[\w.]*\btell\(|:meth:`tell`|_tell\b",
    # An element of VTK's XML files.
    "piece": r"findall\(\"Piece\"\)",
}


def rows():
    """Each retired word of the table with its present name, and the scope of the ban."""
    page = (ROOT / "docs/reference/words.md").read_text(encoding="utf-8")
    table = re.findall(r"^\| (`.*) \| (.*) \| (all|text|names) \|$", page, re.MULTILINE)
    return [
        pytest.param(re.findall(r"`([^`]+)`", words), now, scope, id=words.replace("`", ""))
        for words, now, scope in table
    ]


@cache
def apart(text):
    """A text with the parts of its identifiers apart: `may_fly` and `mayFly` are two words."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])|_", " ", text)


@cache
def messages(path, text):
    """Text of a file that a user may read: documents whole, of Python its text between quotes."""
    if path.suffix == ".md":
        return text
    if path.suffix != ".py" or "python/voxsoft" not in path.as_posix():
        return ""
    kept = []
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        inner = token.type in READ and not re.match(r"\w*(\"\"\"|\'\'\')", token.string)
        kept.append((token.start[0], token.string if inner else ""))
    lines = [""] * (text.count("\n") + 2)
    for number, part in kept:
        lines[number - 1] += f" {part}"
    return "\n".join(lines)


@cache
def names(path, text):
    """The names of a Python or Rust file, each where it stands."""
    if path.suffix == ".rs":
        blank = re.sub(r"//[^\n]*|\"(?:\\.|[^\"\\])*\"", lambda m: "\n" * m[0].count("\n"), text)
        return apart(blank)
    if path.suffix not in (".py", ".pyi"):
        return ""
    lines = [""] * (text.count("\n") + 2)
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.NAME:
            lines[token.start[0] - 1] += f" {apart(token.string)}"
    return "\n".join(lines)


@cache
def small(text):
    """A text without capitals and with its identifiers apart, where plain words are found soon."""
    return re.sub(r"\s+", " ", apart(text)).lower()


#: Parts of a file that each scope of the table reads.
SCOPES = {"all": lambda _, text: apart(text), "text": messages, "names": names}


@pytest.mark.parametrize(("words", "now", "scope"), rows())
def test_a_retired_word_does_not_come_back(words, now, scope):
    pattern = re.compile(rf"(?<![a-z])(?:{'|'.join(words)})(?![a-z])", re.IGNORECASE)
    found = []
    for path, text in tracked().items():
        if not any(word.lower() in small(text) for word in words):
            continue
        read = SCOPES[scope](path, text)
        lines = text.splitlines()
        for match in pattern.finditer(read):
            number = read.count("\n", 0, match.start())
            line = lines[number] if number < len(lines) else ""
            ordinary = ORDINARY.get(match[0].lower())
            if ordinary is None or not re.search(ordinary, line):
                found.append(f"{path.relative_to(ROOT)}:{number + 1}: {line.strip()[:80]}")
    assert not found, "\n".join([f'"{words[0]}" is "{now}" now:', *found])


def test_there_are_retired_words():
    assert len(rows()) > 12


def test_parts_of_identifiers_are_words():
    assert apart("may_fly mayFly") == "may fly may Fly"


def test_names_are_read_without_their_surroundings():
    python = 'toldAt = f"said {x}"  # said\n'
    assert names(Path("a.py"), python).split() == ["told", "At"]
    rust = 'let was_told = "said \\" said"; // said\n'
    assert names(Path("a.rs"), rust).split() == ["let", "was", "told", "=", ";"]
    assert names(Path("a.md"), "told") == ""


def rewrite():
    """Rewrite British spelling in all files."""
    for path, text in tracked().items():
        if american(text) != text:
            path.write_text(american(text), encoding="utf-8")
            print(path.relative_to(ROOT))


if __name__ == "__main__":
    sys.exit(rewrite())
