"""Cursor in a legacy file of VTK, from which words and numbers are read, as text or binary."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError

_TYPES: Final = {
    **{"unsigned_char": "u1", "char": "i1", "signed_char": "i1", "unsigned_short": "u2"},
    **{"short": "i2", "unsigned_int": "u4", "int": "i4", "unsigned_long": "u8", "long": "i8"},
    **{"float": "f4", "double": "f8", "vtktypeint64": "i8", "vtktypeuint64": "u8"},
    **{"vtktypeint32": "i4", "vtktypeuint32": "u4", "vtktypeint16": "i2", "vtktypeuint16": "u2"},
    **{"vtktypeint8": "i1", "vtktypeuint8": "u1", "long_long": "i8", "unsigned_long_long": "u8"},
    # Written as integers of 4 bytes.
    "vtkidtype": "i4",
}


class Cursor:
    r"""Position in a file.

    Parameters
    ----------
    where
        Name of the file, for messages.
    data
        Content of the file.
    place
        Position to begin at.

    Examples
    --------
    >>> cursor = Cursor("a.vtk", b"POINTS 1 float\n0 0\n 7\n", 0)
    >>> cursor.words(), cursor.numbers(3, "float").tolist()
    (['POINTS', '1', 'float'], [0.0, 0.0, 7.0])
    """

    def __init__(self, where: str, data: bytes, place: int) -> None:
        self.where, self.data, self.place = where, data, place
        self.is_binary = False

    def words(self) -> list[str]:
        """Return the words of the next line that has any; none at the end."""
        while self.place < len(self.data):
            if words := self._line().split():
                return words
        return []

    def peek(self) -> str:
        """Return the first word of the next line that has any, without moving."""
        place = self.place
        words = self.words()
        self.place = place
        return words[0] if words else ""

    def _line(self) -> str:
        end = self.data.find(b"\n", self.place)
        end = len(self.data) if end < 0 else end
        line = self.data[self.place : end].decode("utf-8", "replace")
        self.place = end + 1
        return line

    def skip_to_blank(self) -> None:
        """Move behind the next blank line."""
        while self.place < len(self.data) and self._line().strip():
            pass

    def numbers(self, count: int, kind: str) -> NDArray[np.generic]:
        """Return numbers of one type of VTK.

        Raises
        ------
        FileError
            If the file ends before, the type is not known, or a word is no number.
        """
        name = kind.lower()
        if name not in _TYPES and name != "bit":
            raise self.wrong(f"numbers of type {kind!r} are not known")
        if count < 0:
            raise self.wrong(f"a count is {count}")
        if self.is_binary:
            return self._bits(count) if name == "bit" else self._binary(count, _TYPES[name])
        words: list[bytes] = []
        while len(words) < count and self.place < len(self.data):
            end = self.data.find(b"\n", self.place)
            end = len(self.data) if end < 0 else end
            words += self.data[self.place : end].split()
            self.place = end + 1
        if len(words) < count:
            raise self._cut_short(count, len(words))
        if len(words) > count:
            raise self.wrong(f"{len(words):,} numbers stand where {count:,} are counted")
        try:
            return np.array(words, dtype=_TYPES.get(name, "u1")) if words else np.empty(0)
        except (ValueError, OverflowError) as error:
            raise self.wrong(f"of {count:,} numbers one is no {kind} ({error})") from None

    def _binary(self, count: int, type_: str) -> NDArray[np.generic]:
        dtype = np.dtype(f">{type_}")
        size = count * dtype.itemsize
        content = self.data[self.place : self.place + size]
        if len(content) < size:
            raise self._cut_short(count, len(content) // dtype.itemsize)
        self.place += size
        return np.frombuffer(content, dtype).astype(dtype.newbyteorder("="))

    def _bits(self, count: int) -> NDArray[np.generic]:
        return np.unpackbits(self._binary((count + 7) // 8, "u1").astype(np.uint8))[:count]

    def skip_texts(self, count: int) -> None:
        """Move behind texts: lines, or in binary each behind its length."""
        for _ in range(count):
            if not self.is_binary:
                self._line()
                continue
            # The two highest bits of the first byte give the number of bytes of the length.
            first = int(self._binary(1, "u1")[0])
            more = {3: 0, 2: 1, 1: 3, 0: 7}[first >> 6]
            length = first & 63
            for byte in self._binary(more, "u1").tolist():
                length = length << 8 | byte
            self._binary(length, "u1")

    def parsed(self, words: list[str], kind: Callable[[str], Any], count: int) -> tuple[Any, ...]:
        """Return words as numbers.

        Raises
        ------
        FileError
            If there are too few, or one is no number.
        """
        try:
            found = tuple(kind(word) for word in words)
        except ValueError:
            found = ()
        if len(found) < count:
            raise self.wrong(f"{' '.join(words)!r} is not {count} numbers")
        return found

    def named(self, word: str) -> str:
        """Return a name as it was before its encoding as one word."""
        return unquote(word)

    def wrong(self, what: str, hint: str = "") -> FileError:
        """Make an error with the current line, or the byte of a binary file."""
        if self.is_binary:
            return FileError(f"{self.where}, byte {self.place:,}", what, hint)
        line = self.data.count(b"\n", 0, max(0, self.place - 1)) + 1
        return FileError(f"{self.where}, line {line:,}", what, hint)

    def _cut_short(self, count: int, found: int) -> FileError:
        what = f"is cut short: it ends after {found:,} of {count:,} numbers"
        return FileError(self.where, what, "save or copy it again")
