"""Tables as text: separator, preamble, decimal commas and separators of thousands.

Every reader of a table goes through here: curves of coupons, stations of a calibration, logs.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

from voxsoft.errors import MeasurementError

#: Largest number of characters of a table.
LARGEST_TEXT: Final = 50_000_000
#: Number of lines in which a header is looked for: machines write some lines above it.
PREAMBLE: Final = 60

_POINT: Final = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_COMMA: Final = re.compile(r"[+-]?(?:\d+,\d*|,\d+)(?:[eE][+-]?\d+)?")
_GROUPS: Final = {
    ",": re.compile(r"[+-]?[1-9]\d{0,2}(?:,\d{3})+(?:\.\d*)?"),
    ".": re.compile(r"[+-]?[1-9]\d{0,2}(?:\.\d{3})+(?:,\d*)?"),
}
#: Spaces of all widths, and the Swiss apostrophe, between groups of three digits.
_SPACED: Final = re.compile(r"(?<=\d)[ \u00a0\u2009\u202f'\u2019](?=\d{3}(?:\D|$))")
#: Line of two or more numbers with nothing but spaces between them.
_BY_SPACES: Final = re.compile(rf" *{_POINT.pattern}(?: +{_POINT.pattern})+ *")
_LETTERS: Final = set("µμ°²³·±–—€’“”")


class TextRow(NamedTuple):
    """A line of a table: its number, counted from 1, and its cells without outer spaces."""

    line: int
    cells: tuple[str, ...]

    def cell(self, at: int) -> str:
        """Return a cell by its index; lines may end early."""
        return self.cells[at] if at < len(self.cells) else ""

    @property
    def filled(self) -> tuple[str, ...]:
        """Cells that are not empty."""
        return tuple(cell for cell in self.cells if cell)

    @property
    def is_blank(self) -> bool:
        """True if all cells are empty."""
        return not self.filled


@dataclass(frozen=True)
class TextTable:
    """Lines of a table that are neither blank nor comments.

    Attributes
    ----------
    name
        Name in errors: that of the file.
    separator
        ``","``, ``";"``, a tab, or a space, which stands for any number of them.
    rows
        Lines with any cell.
    comments
        Lines that begin with ``#``, without it.
    """

    name: str
    separator: str
    rows: tuple[TextRow, ...]
    comments: tuple[str, ...]

    @classmethod
    def of(cls, text: str, name: str) -> TextTable:
        r"""Split a text into cells.

        Raises
        ------
        MeasurementError
            No text, one that is too large, or no line with a cell.

        Examples
        --------
        >>> table = TextTable.of("# me\nBatch 7\n\nx;y\n1,5;2\n", "t.csv")
        >>> table.separator, table.comments, table.rows[-1]
        (';', ('me',), TextRow(line=5, cells=('1,5', '2')))
        """
        if len(text) > LARGEST_TEXT or "\0" in text:
            raise MeasurementError(name, "is not a text file", "save the table as CSV")
        numbered = list(enumerate(text.removeprefix("\ufeff").splitlines(), start=1))
        comments = [line.lstrip("# ").rstrip() for _, line in numbered if line.startswith("#")]
        lines = [(at, line) for at, line in numbered if line.strip() and line[0] != "#"]
        # Lines above the header may have none; with decimal commas, the separator is in all lines.
        separator = max(";\t,", key=lambda each: sum(each in line for _, line in lines[:100]))
        if sum(bool(_BY_SPACES.fullmatch(line)) for _, line in lines[: 2 * PREAMBLE]) > 1:
            separator = " "
        rows = [TextRow(at, _cells(line, separator, f"{name}, line {at}")) for at, line in lines]
        return cls(
            name,
            separator,
            tuple(row for row in rows if not row.is_blank),
            tuple(comment for comment in comments if comment),
        )

    def likely_header(self, is_unit: Callable[[str], bool]) -> int:
        """Return the index of the most likely header: the row above the numbers and their units."""
        numbers = next((n for n, row in enumerate(self.rows) if all(map(is_number, row.cells))), 0)
        if not numbers:
            return self._header_of_mixed(is_unit)
        above = [n for n in range(numbers) if not all(map(is_unit, self.rows[n].cells))]
        return above[-1] if above else 0

    def _header_of_mixed(self, is_unit: Callable[[str], bool]) -> int:
        """Find the header where each line holds some text, such as a date or a state.

        It has a name for about all cells of the last lines, no number, and some number below.
        """
        width = max((len(row.filled) for row in self.rows[-20:]), default=0)
        for at, row in enumerate(self.rows[:PREAMBLE]):
            below = [
                each for each in self.rows[at + 1 : at + 3] if not all(map(is_unit, each.cells))
            ]
            named = len(row.filled) >= max(width - 1, 1) and not any(map(is_number, row.filled))
            if named and below and any(map(is_number, below[0].filled)):
                return at
        return 0

    def check_lengths(self, header: int) -> None:
        """Refuse lines with filled cells beyond the header's: decimal commas between commas.

        Raises
        ------
        MeasurementError
            Such a line.
        """
        width = len(self.rows[header].cells)
        for row in self.rows[header + 1 :]:
            if any(row.cells[width:]):
                raise MeasurementError(
                    f"{self.name}, line {row.line}",
                    f"has {len(row.cells)} cells; there are {width} columns",
                    "use decimal points, or semicolons between columns",
                )

    def numbers(self, rows: Sequence[TextRow], at: Sequence[int]) -> NumberForm:
        """Find how the numbers of some columns are written; see :class:`NumberForm`."""
        cells = (row.cell(index) for row in rows for index in at)
        return NumberForm.of(cells, self.name, columns_by_comma=self.separator == ",")


@dataclass(frozen=True)
class NumberForm:
    """Form of the numbers in some columns: the mark before decimals, and that of thousands.

    Attributes
    ----------
    decimal
        ``"."`` or ``","``.
    thousands
        The other of the two where it stands between groups of three digits; else empty.
    """

    decimal: str = "."
    thousands: str = ""

    @classmethod
    def of(cls, cells: Iterable[str], name: str, *, columns_by_comma: bool) -> NumberForm:
        """Find the form by all cells of the columns together.

        A comma stands for decimals if any cell has another number of digits after it than three,
        or begins with zero; else for thousands where any cell has a decimal point besides, or
        where commas part the columns. In between nothing decides: ``"1,500"`` alone is read as 1.5
        in tables with semicolons or tabs, as programs of Europe write them, and refused otherwise.

        Raises
        ------
        MeasurementError
            Decimal commas beside decimal points, or nothing that tells which a comma is.

        Examples
        --------
        >>> NumberForm.of(["0,5", "1.234,5"], "t", columns_by_comma=False)
        NumberForm(decimal=',', thousands='.')
        >>> NumberForm.of(["0.5", "1,234.5"], "t", columns_by_comma=True)
        NumberForm(decimal='.', thousands=',')
        """
        decimal_comma = decimal_point = group_comma = group_point = ""
        both_comma = both_point = ""
        for raw in cells:
            cell = _joined(raw)
            if "," not in cell and "." not in cell:
                continue
            if _GROUPS[","].fullmatch(cell):
                both_comma = both_comma or (cell if "." in cell else "")
                group_comma = group_comma or cell
            elif _COMMA.fullmatch(cell):
                decimal_comma = decimal_comma or cell
            elif _GROUPS["."].fullmatch(cell):
                both_point = both_point or (cell if "," in cell else "")
                group_point = group_point or cell
            elif _POINT.fullmatch(cell):
                decimal_point = decimal_point or cell
        point = decimal_point or both_comma
        comma = decimal_comma or both_point
        if point and comma:
            what = f'"{comma}" has a decimal comma and "{point}" a decimal point'
            raise MeasurementError(name, what, "write all numbers alike")
        if comma:
            return cls(",", "." if group_point else "")
        if not group_comma:
            return cls()
        if point or group_point:
            return cls(".", ",")
        if columns_by_comma:
            what = f'"{group_comma}" may be {group_comma.replace(",", "")} or '
            what += group_comma.replace(",", ".", 1)
            raise MeasurementError(name, what, "write numbers without commas")
        return cls(",", "")

    def read(self, cell: str) -> float:
        """Return a number.

        Raises
        ------
        ValueError
            The cell holds no number of this form.
        """
        text = _joined(cell)
        if self.thousands and _GROUPS[self.thousands].fullmatch(text):
            text = text.replace(self.thousands, "")
        if self.decimal == "," and "," in text:
            if "." in text:
                raise ValueError(cell)
            text = text.replace(",", ".")
        if "_" in text:  # Python takes 1_000 for a number
            raise ValueError(cell)
        return float(text)


def is_number(cell: str) -> bool:
    """Return True for a number in any form, and for an empty cell."""
    text = _joined(cell)
    forms = (_POINT, _COMMA, *_GROUPS.values())
    return not text or any(form.fullmatch(text) for form in forms)


def decoded(content: bytes, name: str) -> str:
    """Return the text of a file: UTF-8, UTF-16 with its mark, or that of Windows in Europe.

    Raises
    ------
    MeasurementError
        Bytes that are no text.

    Examples
    --------
    >>> decoded("Prüfzeit;Kraft".encode("cp1252"), "t.csv")
    'Prüfzeit;Kraft'
    """
    marked = content[:2] in (b"\xff\xfe", b"\xfe\xff")
    codings = ["utf-16"] if marked else ["utf-8-sig", "cp1252"]
    for coding in codings:
        try:
            text = content.decode(coding)
        except UnicodeDecodeError:
            continue
        if coding != "cp1252" or _looks_written(text):
            return text
    raise MeasurementError(name, "is not text in UTF-8", "save the table as CSV")


def _looks_written(text: str) -> bool:
    """Return True for letters and signs of Europe alone: binary files hold other ones too."""
    rare = {each for each in text if not (" " <= each <= "~" or each in "\r\n\t\f")}
    return all((ord(each) > 160 and each.isalpha()) or each in _LETTERS for each in rare)


def _joined(cell: str) -> str:
    """Return a cell without spaces between groups of three digits."""
    if cell.isascii() and " " not in cell and "'" not in cell:
        return cell
    return _SPACED.sub("", cell)


def _cells(line: str, separator: str, where: str) -> tuple[str, ...]:
    if separator == " ":
        # A unit in brackets belongs to the word before it.
        return tuple(word.replace("\0", " ") for word in re.sub(r" +(?=[(\[])", "\0", line).split())
    if '"' not in line:
        return tuple(map(str.strip, line.split(separator)))
    try:
        return tuple(cell.strip() for cell in next(csv.reader([line], delimiter=separator)))
    except csv.Error as error:
        raise MeasurementError(where, f"is not a table: {error}", "save it as CSV") from None
