"""Arrays of VTK's XML files: as text, in base64 and as bytes, plain and in compressed blocks."""

from __future__ import annotations

import base64
import binascii
import lzma
import re
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError

_TYPES: Final = {
    **{f"Int{bits}": f"i{bits // 8}" for bits in (8, 16, 32, 64)},
    **{f"UInt{bits}": f"u{bits // 8}" for bits in (8, 16, 32, 64)},
    **{"Float32": "f4", "Float64": "f8"},
}
_BASE64: Final = re.compile(rb"[A-Za-z0-9+/]+={0,2}")


def is_number(kind: str) -> bool:
    """Return True if a type of VTK is a number.

    Examples
    --------
    >>> is_number("Float32"), is_number("String")
    (True, False)
    """
    return kind in _TYPES


@dataclass(frozen=True)
class Coding:
    """Encoding of the arrays of a file.

    Attributes
    ----------
    where
        Name of the file, for messages.
    order
        Order of bytes, ``<`` or ``>``.
    header
        Type of the counts before an array: ``u4`` or ``u8``.
    compressor
        VTK class that compressed its blocks; empty where they are plain.
    """

    where: str
    order: str = "<"
    header: str = "u4"
    compressor: str = ""

    def numbers_of_text(self, text: str, kind: str) -> NDArray[np.generic]:
        """Return the numbers of an array in ASCII.

        Raises
        ------
        FileError
            If a word is no number of the kind.

        Examples
        --------
        >>> Coding("a.vtu").numbers_of_text("1 2  3", "Int32").tolist()
        [1, 2, 3]
        """
        try:
            return np.array(text.split(), dtype=_TYPES[kind])
        except (ValueError, OverflowError) as error:
            raise self.damaged(f"an array of {kind} has a word that is none ({error})") from None

    def numbers_of_bytes(self, content: bytes, kind: str) -> NDArray[np.generic]:
        """Return the numbers of an array that begins with its header.

        Raises
        ------
        FileError
            If the counts of the header do not fit the content, or a block cannot be unpacked.

        Examples
        --------
        >>> Coding("a.vtu").numbers_of_bytes(bytes([2, 0, 0, 0, 5, 6]), "UInt8").tolist()
        [5, 6]
        """
        data = self._unpacked(content) if self.compressor else self._plain(content)
        dtype = np.dtype(self.order + _TYPES[kind])
        if len(data) % dtype.itemsize:
            raise self.damaged(f"an array of {kind} has {len(data):,} bytes")
        return np.frombuffer(data, dtype).astype(dtype.newbyteorder("="))

    def damaged(self, what: str) -> FileError:
        """Make the error for content that contradicts its own counts."""
        return FileError(self.where, f"is damaged: {what}", "save or copy it again")

    def _counts(self, content: bytes, first: int, count: int) -> list[int]:
        dtype = np.dtype(self.order + self.header)
        found = np.frombuffer(content[first * dtype.itemsize :][: count * dtype.itemsize], dtype)
        if len(found) < count:
            raise self.damaged("an array ends within its header")
        return [int(value) for value in found]

    def _plain(self, content: bytes) -> bytes:
        start = int(self.header[1])
        (size,) = self._counts(content, 0, 1)
        if len(content) < start + size:
            raise self.damaged(f"an array of {size:,} bytes has {len(content) - start:,}")
        return content[start : start + size]

    def _unpacked(self, content: bytes) -> bytes:
        unpack = _COMPRESSORS.get(self.compressor)
        if unpack is None:
            known = ", ".join(_COMPRESSORS)
            what = f"is compressed by {self.compressor}; known are {known}"
            raise FileError(self.where, what, "save it with one of these, or without compression")
        (blocks,) = self._counts(content, 0, 1)
        if not blocks:
            return b""
        size, last = self._counts(content, 1, 2)
        place = int(self.header[1]) * (3 + blocks)
        parts = []
        for number, packed in enumerate(self._counts(content, 3, blocks)):
            # The last block is a whole one if its size is 0.
            expected = last if last and number == blocks - 1 else size
            try:
                part = unpack(content[place : place + packed], expected)
            except (
                zlib.error,
                lzma.LZMAError,
                IndexError,
                ValueError,
                EOFError,
                OverflowError,
            ) as error:
                what = f"block {number + 1} of {blocks} of an array cannot be unpacked ({error})"
                raise self.damaged(what) from None
            if len(part) != expected:
                what = f"block {number + 1} of {blocks} of an array has {len(part):,} bytes"
                raise self.damaged(f"{what} for {expected:,}")
            parts.append(part)
            place += packed
        return b"".join(parts)


def bytes_of_base64(content: bytes) -> bytes:
    r"""Decode text in base64; VTK writes headers and blocks as separate texts.

    Raises
    ------
    ValueError
        If a text has an impossible number of letters.

    Examples
    --------
    >>> bytes_of_base64(b" AQ==Ag== ")
    b'\x01\x02'
    """
    try:
        return b"".join(map(base64.b64decode, _BASE64.findall(b"".join(content.split()))))
    except binascii.Error as error:
        raise ValueError(str(error)) from None


def _lz4(packed: bytes, size: int) -> bytes:
    """Unpack a block of LZ4: runs of new bytes, each followed by a copy of earlier ones."""
    found = bytearray()
    place, end = 0, len(packed)
    while place < end:
        token = packed[place]
        length, place = _lz4_length(packed, place + 1, token >> 4)
        found += packed[place : place + length]
        place += length
        if place >= end:
            break
        distance = packed[place] | packed[place + 1] << 8
        length, place = _lz4_length(packed, place + 2, token & 15)
        start = len(found) - distance
        if not 0 <= start < len(found) or len(found) + length + 4 > size:
            raise ValueError("a copy reaches out of the block")
        run = bytes(found[start : start + length + 4])
        # A copy may overlap itself: it repeats.
        found += (run * ((length + 4) // len(run) + 1))[: length + 4]
    return bytes(found)


def _lz4_length(packed: bytes, place: int, length: int) -> tuple[int, int]:
    """Read a length, continued in further bytes if its first part is full; return also its end."""
    if length == 15:
        while packed[place] == 255:
            length += 255
            place += 1
        length += packed[place]
        place += 1
    return length, place


def _zlib(packed: bytes, size: int) -> bytes:
    # Limited to the announced size: a small block may expand to gigabytes.
    return zlib.decompressobj().decompress(packed, size + 1)


def _lzma(packed: bytes, size: int) -> bytes:
    return lzma.LZMADecompressor().decompress(packed, size + 1)


_COMPRESSORS: Final[dict[str, Callable[[bytes, int], bytes]]] = {
    "vtkZLibDataCompressor": _zlib,
    "vtkLZMADataCompressor": _lzma,
    "vtkLZ4DataCompressor": _lz4,
}
