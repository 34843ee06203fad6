"""Equilibria on disk, by the identity of each design, so that they are drawn and shown at once."""

from __future__ import annotations

import uuid
import zlib
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from voxsoft.mesh import Mesh
from voxsoft.simulation import Result

Floats = NDArray[np.float64]

#: Name of the folder of a study that holds those of its designs.
FOLDER: Final = "equilibria"
#: What the files of one folder may take together [bytes].
ROOM: Final = 256 * 1024 * 1024
_SUFFIX: Final = ".npz"


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """Where a body came to rest.

    Attributes
    ----------
    positions
        Of its vertices in m, (n, 3).
    mesh
        A checksum of the vertices at rest: the positions are those of this mesh and no other.
    """

    positions: Floats = field(repr=False)
    mesh: int

    @classmethod
    def of(cls, result: Result) -> Equilibrium:
        """Take the state of a result."""
        return cls(result.positions, checksum(result.mesh))


def checksum(mesh: Mesh) -> int:
    """A number that tells the unloaded vertices of a mesh from others."""
    return zlib.crc32(np.ascontiguousarray(mesh.vertices, dtype="<f8").tobytes())


class Equilibria:
    """A folder of equilibria that drops the oldest where it would grow too large.

    Parameters
    ----------
    folder
        Made when there is something to keep.
    room
        What its files may take together [bytes].

    Examples
    --------
    >>> import tempfile
    >>> from voxsoft.design import families
    >>> from voxsoft.simulation import simulate
    >>> result = simulate(families.beam())
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     known = Equilibria(Path(folder))
    ...     known.keep(result.design.hash, Equilibrium.of(result))
    ...     found = known.find(result.design.hash, result.mesh)
    >>> bool((found == result.positions).all())
    True
    """

    def __init__(self, folder: Path, room: int = ROOM) -> None:
        self._folder, self._room = folder, room
        self._used: int | None = None

    def keep(self, design_hash: str, equilibrium: Equilibrium) -> None:
        """Write an equilibrium down. What cannot be written costs no more than a later solution."""
        beside = self._folder / f".{uuid.uuid4().hex}{_SUFFIX}"
        with suppress(OSError):
            self._folder.mkdir(parents=True, exist_ok=True)
            try:
                with beside.open("wb") as file:
                    np.savez(file, positions=equilibrium.positions, mesh=equilibrium.mesh)
                size = beside.stat().st_size
                beside.replace(self._file(design_hash))
            finally:
                beside.unlink(missing_ok=True)
            self._used = size + (self._used if self._used is not None else self._sum())
            if self._used > self._room:
                self._make_room()

    def find(self, design_hash: str, mesh: Mesh) -> Floats | None:
        """Where the vertices of a mesh are when its design is at rest, (n, 3) in m, if known."""
        file = self._file(design_hash)
        try:
            with np.load(file, allow_pickle=False) as content:
                positions, of = content["positions"], int(content["mesh"])
        except (OSError, ValueError, KeyError, TypeError, EOFError, BadZipFile, zlib.error):
            return None
        if of != checksum(mesh) or positions.shape != mesh.vertices.shape:
            return None
        with suppress(OSError):
            file.touch()  # what is looked at is the last to go
        return np.asarray(positions, dtype=np.float64)

    def holds(self, design_hash: str) -> bool:
        """Whether there is something to be found of a design."""
        return self._file(design_hash).is_file()

    def _file(self, design_hash: str) -> Path:
        return self._folder / f"{design_hash}{_SUFFIX}"

    def _sum(self) -> int:
        return sum(file.stat().st_size for file in self._folder.glob(f"*{_SUFFIX}"))

    def _make_room(self) -> None:
        """Drop the oldest files until a tenth of the room is free."""
        files = sorted(self._folder.glob(f"*{_SUFFIX}"), key=lambda file: file.stat().st_mtime_ns)
        used = sum(file.stat().st_size for file in files)
        for file in files[:-1]:
            if used <= 0.9 * self._room:
                break
            used -= file.stat().st_size
            file.unlink(missing_ok=True)
        self._used = used
