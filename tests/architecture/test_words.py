"""One word for each thing, in American spelling: what docs/reference/words.md retires stays away.

python tests/architecture/test_words.py   # rewrites British spelling where it stands
"""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
THIS = Path(__file__).name

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
#: What ends in -ise, -ised, … and is spelled so in America too.
_ISE_STAYS = re.compile(
    r"(?:ra|r|no|po|prom|comprom|prec|conc|prem|surpr|adv|dev|rev|superv|telev|improv|exerc"
    r"|exc|comp|compr|disgu|gu|w|ar|appra|pra|m|dem|expert|enterpr|franch|parad|treat|merchand"
    r"|cru|cr|bru|anch|c|inc|d|l|v|pr|otherw|likew|clockw|counterclockw|pairw|piecew|stepw|elementw"
    r"|componentw|edgew|lengthw)is|(?:v|div|rev|prov|dec|prec|inv)is",
    re.IGNORECASE,
)

#: What is not ours to spell: names of files, of columns in them, of others' interfaces.
FOREIGN = re.compile(
    r"Optimising Soft Robot Designs"  # the paper's title
    r"|top_centre_uz_mm"  # a column of tests/data
    r"|`licence`|\"licence\"(?=.*(?:older|earlier))"  # a key that is still taken, and still printed
    r"|(?:\"maximise|\"centre|a\.centre)(?=[\": ])"  # wrong keys, on purpose
)
#: Files that others wrote, or that hold words on purpose.
OTHERS = re.compile(
    r"LICENSE|package-lock\.json|Cargo\.lock|\.(?:png|zip|csv|svg|vtu|stl|scene|wasm)$"
    rf"|{THIS}|docs/reference/words\.md|examples/data/"
)


def tracked():
    """The files of the project that hold our own words."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    ).stdout.splitlines()
    paths = [ROOT / name for name in listed if not OTHERS.search(name)]
    return [path for path in paths if path.is_file() and not path.is_symlink()]


def american(text):
    """The text in American spelling; what is foreign stays."""
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

    if not foreign:
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
    for path in tracked():
        text = path.read_text(encoding="utf-8")
        if american(text) == text:
            continue
        lines = zip(text.splitlines(), american(text).splitlines(), strict=True)
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


def rewrite():
    """Rewrite British spelling in all files."""
    for path in tracked():
        text = path.read_text(encoding="utf-8")
        if american(text) != text:
            path.write_text(american(text), encoding="utf-8")
            print(path.relative_to(ROOT))


if __name__ == "__main__":
    sys.exit(rewrite())
