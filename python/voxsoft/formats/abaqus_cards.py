"""Cards of Abaqus and CalculiX input: keyword lines with their parameters and data."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from voxsoft.errors import FileError

#: Largest depth of included files, before a cycle is assumed.
_DEEPEST: Final = 20


@dataclass
class Card:
    """Keyword line with the data that follow it.

    Attributes
    ----------
    name
        Keyword in capitals without its star and blanks: ``SOLIDSECTION``.
    parameters
        Values by name in capitals; an empty text for one without a value.
    where
        File and line.
    data
        Fields of each data line, stripped.
    """

    name: str
    parameters: dict[str, str]
    where: str
    data: list[list[str]] = field(default_factory=list)

    def get(self, parameter: str) -> str:
        """Return a parameter's value, an empty text where it is missing."""
        return self.parameters.get(parameter, "")

    def numbers(self, row: list[str]) -> list[float]:
        """Return the fields of a data line as numbers; empty fields are 0."""
        try:
            # Fortran writes exponents by D.
            return [float(each.upper().replace("D", "E") or 0) for each in row]
        except ValueError:
            what = f"*{self.name} has {', '.join(row)!r}; expected numbers"
            raise FileError(self.where, what) from None

    def labels(self, row: list[str]) -> list[int]:
        """Return the fields of a data line as labels, empty ones left out."""
        try:
            return [int(each) for each in row if each]
        except ValueError:
            what = f"*{self.name} has {', '.join(row)!r}; expected whole numbers"
            raise FileError(self.where, what) from None


def cards_of(path: Path, depth: int = 0) -> Iterator[Card]:
    """Yield the cards of a file, with those of included files in their place.

    Raises
    ------
    FileError
        If an included file is missing, or data come before the first card.
    """
    card: Card | None = None
    for where, line in _lines(path):
        if line.startswith("*"):
            if card is not None:
                yield from _whole(card, path, depth)
            card = _card(line, where)
        elif card is None:
            raise FileError(where, f"begins with {line[:40]!r}; expected a card, such as *NODE")
        else:
            card.data.append([each.strip() for each in line.rstrip(",").split(",")])
    if card is not None:
        yield from _whole(card, path, depth)


def _lines(path: Path) -> Iterator[tuple[str, str]]:
    """Yield lines that are no comments, with their positions; continued keyword lines as one."""
    with path.open(encoding="utf-8", errors="replace") as file:
        begun, place = "", ""
        for number, raw in enumerate(file, start=1):
            line = raw.strip()
            if not line or line.startswith("**"):
                continue
            if begun:
                line, begun = begun + line, ""
            else:
                place = f"{path}, line {number}"
            if line.startswith("*") and line.endswith(","):
                begun = line
            else:
                yield place, line
        if begun:
            yield place, begun.rstrip(",")


def _card(line: str, where: str) -> Card:
    first, *rest = re.findall(r'(?:"[^"]*"|[^,])+', line)
    parameters = {}
    for each in rest:
        name, _, value = each.partition("=")
        parameters[re.sub(r"\s", "", name).upper()] = value.strip().strip('"')
    return Card(re.sub(r"[\s*]", "", first).upper(), parameters, where)


def _whole(card: Card, path: Path, depth: int) -> Iterator[Card]:
    """Yield the card with the data of its own file; for ``*INCLUDE`` the cards of that file."""
    named = card.get("INPUT")
    if not named:
        yield card
        return
    file = path.parent / named
    # A deck from elsewhere reads files of its own folder only.
    if not file.resolve().is_relative_to(path.parent.resolve()):
        what = f"*{card.name} names {named}, which is outside of the deck's folder"
        raise FileError(card.where, what, "put it beside the file")
    if not file.is_file():
        hint = "put it beside the file, or paste its lines in"
        raise FileError(card.where, f"*{card.name} names {named}, which is missing", hint)
    if depth >= _DEEPEST:
        raise FileError(card.where, f"*{card.name}: files include each other in a circle")
    if card.name == "INCLUDE":
        yield from cards_of(file, depth + 1)
        return
    card.data += [[each.strip() for each in line.split(",")] for _, line in _lines(file)]
    yield card
