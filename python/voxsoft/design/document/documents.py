"""Conversion of a user's input to the document that a file holds."""

from __future__ import annotations

import copy
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from voxsoft.design.document.resolution import Document, formulas
from voxsoft.design.history import with_tables
from voxsoft.materials import is_card_path

#: Keys and indices that lead to a value.
Steps = tuple[str | int, ...]

#: Names that a user may type in Python in place of the names in a file.
_WRITTEN: Final = {"schema_": "schema", "young_modulus": "young"}
#: Entries that may hold such names.
_HOLDERS: Final = frozenset({"materials", "parts", "bodies"})


def plain_document(
    source: Mapping[str, Any], dumped: Mapping[str, Any], typed: Collection[str]
) -> Document:
    """Make the document of a design with its formulas.

    Parameters
    ----------
    source
        Source of the design: for a Python call, a mix of models, SI floats and dicts.
    dumped
        The source as plain data with values in place of formulas.
    typed
        Keys of the source that were typed in Python; the others are as a file holds them.

    Examples
    --------
    >>> dumped = {"size": ["1 mm", "5 mm"]}
    >>> plain_document({"size": ["= a", 0.005]}, dumped, {"size"})
    {'size': ['= a', '5 mm']}
    """
    from_file = [key for key in source if key not in typed]
    keys = [_WRITTEN.get(key, key) for key in source] if from_file else [*dumped]
    document = {
        key: copy.deepcopy(source[key] if key in from_file else dumped[key])
        for key in keys
        if key in from_file or key in dumped
    }
    for path, formula in formulas({key: source[key] for key in source if key in typed}):
        _put(document, written_path(path), formula)
    return document


def _put(document: Any, path: tuple[str | int, ...], formula: str) -> None:  # noqa: ANN401
    *way, last = path
    here = document
    for step in way:
        here = here[step]
    here[last] = formula


def written_path(path: tuple[str | int, ...]) -> tuple[str | int, ...]:
    """Return the path in a file of an entry typed at a path in Python.

    Examples
    --------
    >>> written_path(("materials", "soft", "young_modulus"))
    ('materials', 'soft', 'young')
    """
    if path[0] not in _HOLDERS or not isinstance(path[-1], str):
        return path
    return (*path[:-1], _WRITTEN.get(path[-1], path[-1]))


def with_absolute_paths(document: Mapping[str, Any], folder: Path) -> Document:
    """Complete the relative paths of files, which are meant from the folder of the design's."""
    whole: Document = with_tables(_with_whole_meshes(document, folder), folder)
    for steps, path in [*_cards(whole, ()), *included_files(whole)]:
        # A path that is absolute already stays as it is.
        _put(whole, steps, str(folder.absolute() / path))
    return whole


def is_mesh(key: object, table: Mapping[str, Any]) -> bool:
    """Check if a table under a key names the file of a mesh: as a shape, or as the body."""
    named = table.get("kind") == "mesh" or (key == "mesh" and "kind" not in table)
    return named and isinstance(table.get("path"), str)


def _with_whole_meshes(value: Any, folder: Path, key: object = "") -> Any:  # noqa: ANN401 - a document holds anything
    if isinstance(value, list):
        return [_with_whole_meshes(entry, folder) for entry in value]
    if not isinstance(value, dict):
        return value
    table = {key: _with_whole_meshes(entry, folder, key) for key, entry in value.items()}
    if is_mesh(key, table):
        table["path"] = str(folder.absolute() / table["path"])
    return table


def file_references(document: Mapping[str, Any]) -> Iterator[tuple[Steps, str]]:
    """Find the files that a document names: meshes, cards by their path, and designs of bodies.

    Returns
    -------
    iterator of (steps, path)
        Keys and indices that lead to a path, and the path as it is written.

    Examples
    --------
    >>> part = {"shape": "body", "material": "mine.toml"}
    >>> list(file_references({"parts": [part]}))
    [(('parts', 0, 'material'), 'mine.toml')]
    """
    yield from _mesh_references(document, ())
    yield from _cards(document, ())
    yield from included_files(document)


def included_files(document: Mapping[str, Any], steps: Steps = ()) -> Iterator[tuple[Steps, str]]:
    """Find the files of designs that the bodies of a document name.

    Examples
    --------
    >>> list(included_files({"bodies": [{"name": "left", "design": "finger.toml"}]}))
    [(('bodies', 0, 'design'), 'finger.toml')]
    """
    for way, body in _tables(document, "bodies"):
        design = body.get("design")
        if isinstance(design, str):
            yield (*steps, *way, "design"), design
        elif isinstance(design, Mapping):
            yield from included_files(design, (*steps, *way, "design"))


def _cards(document: Mapping[str, Any], steps: Steps) -> Iterator[tuple[Steps, str]]:
    """Find the paths of cards, of designs within designs too."""
    for way, part in _tables(document, "parts"):
        material = part.get("material")
        if isinstance(material, str) and is_card_path(material):
            yield (*steps, *way, "material"), material
    for way, body in _tables(document, "bodies"):
        yield from _cards({"parts": body.get("parts")}, (*steps, *way))
        if isinstance(body.get("design"), Mapping):
            yield from _cards(body["design"], (*steps, *way, "design"))


def _tables(document: Mapping[str, Any], key: str) -> Iterator[tuple[Steps, Mapping[str, Any]]]:
    """The tables of a list in a document; other entries are passed over."""
    entries = document.get(key)
    for index, entry in enumerate(entries if isinstance(entries, (list, tuple)) else ()):
        if isinstance(entry, Mapping):
            yield (key, index), entry


def _mesh_references(value: object, steps: Steps) -> Iterator[tuple[Steps, str]]:
    if isinstance(value, list):
        for index, entry in enumerate(value):
            yield from _mesh_references(entry, (*steps, index))
    elif isinstance(value, Mapping):
        if is_mesh(steps[-1] if steps else "", value):
            yield (*steps, "path"), value["path"]
        for key, entry in value.items():
            yield from _mesh_references(entry, (*steps, key))


def with_path(document: Mapping[str, Any], steps: Steps, path: str) -> Document:
    """Put another path where a document names a file, see :func:`file_references`."""
    written = copy.deepcopy(dict(document))
    _put(written, steps, path)
    return written


def with_paths_from(document: Mapping[str, Any], folder: Path) -> Document:
    """Write the paths of files below a folder as seen from there, so that it can be moved.

    The inverse of :func:`with_absolute_paths`; paths that lead elsewhere stay.
    """
    written = copy.deepcopy(dict(document))
    for steps, path in file_references(written):
        if Path(path).is_relative_to(folder.absolute()):
            _put(written, steps, Path(path).relative_to(folder.absolute()).as_posix())
    return written
