"""From a path to the contents of the file, the reader chosen by the name's suffix."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Final

from voxsoft.errors import FileError
from voxsoft.formats import abaqus, by_meshio, gmsh
from voxsoft.formats.contents import Contents

#: Own readers by suffix, before meshio.
READERS: Final[dict[str, Callable[[Path], Contents]]] = {".inp": abaqus.read, ".msh": gmsh.read}

#: Formats of meshio that are drawings.
_DRAWINGS: Final = {".svg", ".wkt"}


@cache
def known_suffixes() -> tuple[str, ...]:
    """Return the endings of the files that can be read: own readers and those of meshio.

    Examples
    --------
    >>> {".stl", ".obj", ".ply", ".off", ".mesh", ".msh", ".vtu"} <= set(known_suffixes())
    True
    """
    import meshio

    return tuple(sorted({*READERS, *meshio.extension_to_filetypes} - _DRAWINGS))


def read_contents(path: Path) -> Contents:
    """Return all that a mesh file holds.

    Raises
    ------
    FileError
        If the file is missing, of an unknown suffix, cut short, or written against its format.

    Examples
    --------
    >>> read_contents(Path("no-such-file.msh"))
    Traceback (most recent call last):
        ...
    voxsoft.errors.FileError: no-such-file.msh: no such file
    """
    suffix = path.suffix.lower()
    if suffix not in known_suffixes():
        what = f"unknown format {path.suffix!r}; allowed are {', '.join(known_suffixes())}"
        raise FileError(str(path), what)
    if not path.is_file():
        raise FileError(str(path), "no such file")
    if suffix == ".msh" and b"$MeshFormat" not in path.read_bytes()[:4096]:
        return by_meshio.read(path)  # ANSYS and others use the suffix too
    return READERS.get(suffix, by_meshio.read)(path)
