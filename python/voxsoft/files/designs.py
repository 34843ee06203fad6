"""Design files: reading and writing of designs as TOML."""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Final

from voxsoft.design import Design, set_values
from voxsoft.design.document.included import is_outside, placed_document
from voxsoft.errors import DesignError, ErrorDetail, FileError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.toml_text import line_of, write_toml
from voxsoft.records import steps_of
from voxsoft.shapes.cad_files import HINT, WHAT, is_cad_file

if TYPE_CHECKING:
    from voxsoft.design.document.resolution import Document

LARGEST_FILE: Final = 10_000_000  # bytes; a design is a page of text

FilePath = str | os.PathLike[str]


def load(path: FilePath, *, assignments: Iterable[str] = (), **parameters: float | str) -> Design:
    r"""Read a design from a TOML file.

    Parameters
    ----------
    path
        Path of the file.
    assignments
        Changes ``key=value`` in the form of the command line (:func:`voxsoft.design.set_values`).
    **parameters
        New values of parameters: text with a unit, or numbers in SI units.

    Returns
    -------
    Design
        The design; relative paths in it start at the file's folder.

    Raises
    ------
    FileError
        The file cannot be read, or is not TOML.
    DesignError
        The design is not valid; every problem is listed with its line.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "broken.toml"
    >>> _ = file.write_text('name = "a"\nvoxel_size = "5 kPa"\n[[parts]]\nshape = 1')
    >>> try:
    ...     load(file)
    ... except DesignError as error:
    ...     print(error.problems[0].where, "·", error.problems[0].what)
    broken.toml, line 2, voxel_size · "5 kPa" is a pressure; expected a length
    """
    text = read_text(path)
    document = read_document(text, Path(path).name)
    _refuse_card(document, path)
    try:
        changed = set_values(document, assignments)
        return Design.from_document(placed_document(changed, Path(path).parent), parameters)
    except DesignError as error:
        raise type(error).listing(_with_lines(error.problems, text, Path(path).name)) from None


def _refuse_card(document: Document, path: FilePath) -> None:
    if isinstance(document.get("material"), dict) and "parts" not in document:
        raise DesignError(
            Path(path).name,
            "is a material card, not a design",
            f'look at it with `voxsoft material show`, or write material = "{path}" in a design',
        )


def save(design: Design, path: FilePath, *, resolved: bool = False) -> None:
    """Write a design to a TOML file, atomically.

    Designs of bodies whose files are outside the folder, from which they could not be read again,
    are embedded.

    Parameters
    ----------
    design
        The design.
    path
        Path of the file; it is replaced if it exists.
    resolved
        True to write values in place of formulas.

    Raises
    ------
    FileError
        The file cannot be written.
    """
    document = design.resolved if resolved else _movable(design, Path(path).parent)
    write_atomically(path, write_toml(document))


def _movable(design: Design, folder: Path) -> Document:
    """Make the document of a design, with designs of bodies from outside a folder as tables."""
    document = design.document
    for table, body in zip(document.get("bodies", ()), design.bodies, strict=True):
        if isinstance(body.design, Design):
            table["design"] = _movable(body.design, folder)
        elif body.design is not None and is_outside(body.design, folder):
            assert body.included is not None  # it has a design
            table["design"] = _movable(body.included, folder)
    return document


def read_text(path: FilePath) -> str:
    """Read a text file of at most 10 MB as UTF-8.

    Raises
    ------
    FileError
        A missing, unreadable, too large or binary file, or a CAD model.
    """
    file = Path(path)
    if is_cad_file(file.name):
        raise FileError(str(path), WHAT, HINT)
    try:
        with file.open("rb") as stream:
            content = stream.read(LARGEST_FILE + 1)
    except FileNotFoundError:
        raise FileError(str(path), "there is no such file", "check the path") from None
    except IsADirectoryError:
        raise FileError(str(path), "is a folder", "name the file in it") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise FileError(str(path), f"cannot be read: {reason}") from None
    if len(content) > LARGEST_FILE:
        raise FileError(file.name, "is larger than 10 MB, too large for a design")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        where = f"{file.name}, line {line}"
        raise FileError(where, "is not text in UTF-8", "save the file as UTF-8 text") from None


def read_document(text: str, name: str) -> Document:
    """Read TOML text; `name` is the file name for errors.

    Raises
    ------
    FileError
        The text is not TOML, with line and column.
    """
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        where, what = _position(str(error), text, name)
        raise FileError(where, what, "check quotes, brackets and commas near it") from None
    except RecursionError:
        raise FileError(name, "nests brackets too deep for a design") from None
    except ValueError as error:  # numbers of thousands of digits, impossible dates
        raise FileError(name, f"holds a value that cannot be read: {error}") from None


_AT: Final = re.compile(r"\s*\(at (?:line (\d+), column (\d+)|end of document)\)$")


def _position(message: str, text: str, name: str) -> tuple[str, str]:
    """Move the position out of the parser's message to its front."""
    match = _AT.search(message)
    what = _AT.sub("", message)
    what = f"is not TOML: {what[:1].lower()}{what[1:]}"
    if match and match.group(1):
        return f"{name}, line {match.group(1)}, column {match.group(2)}", what
    lines = text.splitlines() or [""]
    where = f"{name}, line {len(lines)}, column {len(lines[-1]) + 1}"
    return where, f"{what}; the file ends too early"


def _with_lines(problems: Iterable[ErrorDetail], text: str, name: str) -> Iterator[ErrorDetail]:
    """Add the line of each problem, in the order of the lines."""
    found = [(line_of(text, steps_of(problem.where)) or 0, problem) for problem in problems]
    for line, problem in sorted(found, key=lambda pair: pair[0]):
        where = f"{name}, line {line}" if line else name
        yield ErrorDetail(f"{where}, {problem.where}" if problem.where else where, *problem[1:])
