"""Designs within designs: read from the file that a body names, and never outside its folder."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from voxsoft.design.document.documents import included_files, with_absolute_paths
from voxsoft.design.document.resolution import Document
from voxsoft.errors import DesignError, ErrorDetail, VoxSoftError
from voxsoft.records import place, steps_of

if TYPE_CHECKING:
    from voxsoft.design.model import Design

_LARGEST: Final = 10_000_000  # bytes; a design is a page of text

#: The files that are being read now, each named by the one before.
_reading: ContextVar[tuple[Path, ...]] = ContextVar("reading", default=())


def inner_design(
    design: str | Mapping[str, Any] | Design,
    values: Mapping[str, object] | None = None,
    *,
    from_file: bool = True,
) -> Design:
    """Make the design of a body.

    Parameters
    ----------
    design
        The absolute path of a file, the table of a design, or a design.
    values
        New values of its parameters.
    from_file
        True if numbers in a table need their units.

    Raises
    ------
    DesignError
        With places as seen from the body: ``design`` for a file that cannot be used, ``set.wall``
        for a value.
    """
    from voxsoft.design.model import Design

    if isinstance(design, str):
        found = _read(Path(design))
    elif isinstance(design, Mapping):
        return Design.from_document(design, from_file=from_file)
    else:
        found = design
    if not values:
        return found
    try:
        return found.with_parameters(**values)  # type: ignore[arg-type]
    except VoxSoftError as error:
        raise _at(error, "set", found.name, known=values) from None


def placed_document(document: Mapping[str, Any], folder: Path) -> Document:
    """Complete the relative paths of a document that was read from a file in a folder.

    Raises
    ------
    DesignError
        It names the file of a design that is not in that folder.
    """
    refuse_outside(document, folder)
    return with_absolute_paths(document, folder)


def refuse_outside(document: Mapping[str, Any], folder: Path) -> None:
    """Refuse a document that names the file of a design outside of its folder.

    A design that came from a stranger reads nothing that did not come with it.

    Raises
    ------
    DesignError
        Listing every such file.
    """
    if problems := list(_outside(document, folder)):
        raise DesignError.listing(problems)


def is_outside(path: str, folder: Path) -> bool:
    """Check if a path, as seen from a folder, leads out of it, also by a link."""
    return not Path(folder, path).resolve().is_relative_to(folder.resolve())


def _outside(document: Mapping[str, Any], folder: Path) -> Iterator[ErrorDetail]:
    """Find design files that a document names and that are not in its folder.

    A design that came from a stranger reads nothing that did not come with it.
    """
    for steps, path in included_files(document):
        if is_outside(path, folder):
            what = f'"{path}" is outside of the folder of the design'
            hint = "copy the file beside the design, and name it there"
            yield ErrorDetail(place(steps), what, hint)


def _read(path: Path) -> Design:
    from voxsoft.design.model import Design

    file, before = path.resolve(), _reading.get()
    if file in before:
        chain = [each.name for each in (*before[before.index(file) :], file)]
        what = f"a design includes itself: {' → '.join(chain)}"
        raise DesignError("design", what, "leave one of these bodies out")
    text = _text(path)
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise DesignError("design", f"{path.name} is not TOML: {error}") from None
    except (RecursionError, ValueError) as error:
        raise DesignError("design", f"{path.name} cannot be read: {error}") from None
    token = _reading.set((*before, file))
    try:
        return Design.from_document(placed_document(document, path.parent))
    except VoxSoftError as error:
        raise _at(error, "design", path.name) from None
    finally:
        _reading.reset(token)


def _text(path: Path) -> str:
    try:
        with path.open("rb") as stream:
            content = stream.read(_LARGEST + 1)
        text = content.decode("utf-8-sig")
    except FileNotFoundError:
        what, hint = (
            f'there is no file "{path}"',
            "check the path; it begins at the design's folder",
        )
        raise DesignError("design", what, hint) from None
    except UnicodeDecodeError:
        raise DesignError("design", f"{path.name} is not text in UTF-8") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise DesignError("design", f'"{path}" cannot be read: {reason}') from None
    if len(content) > _LARGEST:
        raise DesignError("design", f"{path.name} is larger than 10 MB", "take a smaller one")
    return text


def _at(
    error: VoxSoftError, key: str, name: str, known: Mapping[str, object] | None = None
) -> DesignError:
    """Move problems to a key of the body; those of a value to that value."""
    problems = []
    for problem in error.problems:
        steps = [str(step) for step in steps_of(problem.where)]
        value = next((step for step in steps[:2] if step in (known or ())), None)
        if value is not None:
            what = problem.what.replace("of this design", f'of "{name}"')
            problems.append(ErrorDetail(f"{key}.{value}", what, problem.hint))
        else:
            inner = f"{name}: {problem.where}: " if problem.where else f"{name}: "
            problems.append(ErrorDetail(key, f"{inner}{problem.what}", problem.hint))
    return DesignError.listing(problems)
