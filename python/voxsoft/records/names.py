"""Names: of designs and of all that they hold."""

from __future__ import annotations

import unicodedata
from typing import Annotated, Final

from pydantic import AfterValidator, StringConstraints

from voxsoft.errors import DesignError

#: Control characters, halves of surrogate pairs, and the two separators that break a line.
_REFUSED: Final = frozenset({"Cc", "Cs", "Zl", "Zp"})


def check_name(name: str) -> str:
    r"""Return a name as it is, in any script; refuse one that no file and no terminal can show.

    Examples
    --------
    >>> check_name("höhe 2")
    'höhe 2'
    >>> check_name("a\0b")
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: "a\x00b" holds a control character. Try: leave it out
    """
    if not name.isprintable() and any(map(_is_refused, name)):
        shown = repr(name)[1:-1]
        raise DesignError("", f'"{shown}" holds a control character', "leave it out")
    if name.lstrip().startswith("="):
        what = f'"{name}" starts with "=", as a formula does'
        raise DesignError("", what, "begin a name with another character")
    return name


def _is_refused(letter: str) -> bool:
    return (
        unicodedata.category(letter) in _REFUSED or letter in "\ufffe\uffff"
    )  # no XML holds these


Name = Annotated[str, StringConstraints(min_length=1, max_length=200), AfterValidator(check_name)]
