"""Equilibria on disk, by the hash of each design, so that they are drawn and shown at once."""

from __future__ import annotations

import uuid
import zlib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final, Self
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from voxsoft.mesh import Mesh
from voxsoft.simulation import Result, Setup
from voxsoft.simulation.results.result import LARGE_RESIDUAL
from voxsoft.simulation.runs.solved_state import SolvedState, is_given_by_positions
from voxsoft.simulation.runs.state import result_at
from voxsoft.simulation.setup.contact import Pose

Floats = NDArray[np.float64]

#: Name of the folder in a study's folder that holds the equilibria of its designs.
FOLDER: Final = "equilibria"
#: Largest total size of the files of one folder [bytes].
ROOM: Final = 256 * 1024 * 1024
_SUFFIX: Final = ".npz"


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """Equilibrium of a body.

    Attributes
    ----------
    positions
        Positions of its vertices in m, (n, 3).
    mesh
        Checksum of the vertices at rest: the positions are those of this mesh and no other.
    state
        Further state of a design that positions do not determine: contact, supplies, softening.
        None for other designs, whose results are computed anew from the positions.
    """

    positions: Floats = field(repr=False)
    mesh: int
    state: SolvedState | None = field(default=None, repr=False)

    @classmethod
    def of(cls, result: Result) -> Self:
        """Take the state of a result."""
        state = None if is_given_by_positions(result.design) else SolvedState.of(result)
        return cls(result.positions, checksum(result.mesh), state)

    @classmethod
    def read(cls, content: Mapping[str, NDArray[Any]]) -> Self:
        """Read the arrays of :meth:`written`.

        Raises
        ------
        ValueError, KeyError, TypeError
            The content is damaged.
        """
        positions = np.asarray(content["positions"], dtype=np.float64)
        state = None
        if "state" in content:
            text = np.asarray(content["state"], dtype=np.uint8).tobytes().decode()
            arrays = [content[f"array{at}"] for at in range(int(content["arrays"]))]
            state = SolvedState(text, tuple(arrays))
        return cls(positions, int(content["mesh"]), state)

    def result(self, setup: Setup) -> Result | None:
        """Make a result of the equilibrium; None if it is not that of the body, or is incomplete.

        An equilibrium that positions determine is measured anew, and is none if forces do not
        balance under the loads of the design. Others, with contact, supplies or softening, are read
        as stored.

        Parameters
        ----------
        setup
            The body, on the mesh that was solved.

        Raises
        ------
        VoxSoftError
            The body cannot be solved, or the stored state is damaged or of another version.
        """
        if is_given_by_positions(setup.design):
            message = "at rest, as it was solved before"
            measured = result_at(setup, self.positions, status="ok", message=message)
            return measured if measured.residual <= LARGE_RESIDUAL else None
        if self.state is None:
            return None
        found = self.state.result(setup, self.positions)
        return replace(found, message=f"{found.message}, as it was solved before")

    @property
    def objects(self) -> Mapping[str, Pose]:
        """Poses of the rigid objects, by name; empty without any."""
        return {} if self.state is None else self.state.objects

    def written(self) -> dict[str, Any]:
        """Write the equilibrium as arrays by name."""
        written: dict[str, Any] = {"positions": self.positions, "mesh": self.mesh}
        if self.state is not None:
            written["state"] = np.frombuffer(self.state.text.encode(), dtype=np.uint8)
            written["arrays"] = len(self.state.arrays)
            written |= {f"array{at}": each for at, each in enumerate(self.state.arrays)}
        return written


def checksum(mesh: Mesh) -> int:
    """Compute a number that identifies the unloaded vertices of a mesh."""
    return zlib.crc32(np.ascontiguousarray(mesh.vertices, dtype="<f8").tobytes())


class Equilibria:
    """A folder of equilibria that drops the oldest where it would grow too large.

    Parameters
    ----------
    folder
        Folder, made when the first equilibrium is kept.
    room
        Largest total size of its files [bytes].

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
    >>> bool((found.positions == result.positions).all())
    True
    """

    def __init__(self, folder: Path, room: int = ROOM) -> None:
        self._folder, self._room = folder, room
        self._used: int | None = None

    def keep(self, design_hash: str, equilibrium: Equilibrium) -> None:
        """Write an equilibrium to disk; a failed write only costs a later solution."""
        beside = self._folder / f".{uuid.uuid4().hex}{_SUFFIX}"
        with suppress(OSError):
            self._folder.mkdir(parents=True, exist_ok=True)
            try:
                with beside.open("wb") as file:
                    np.savez_compressed(file, **equilibrium.written())
                size = beside.stat().st_size
                beside.replace(self._file(design_hash))
            finally:
                beside.unlink(missing_ok=True)
            self._used = size + (self._used if self._used is not None else self._sum())
            if self._used > self._room:
                self._make_room()

    def find(self, design_hash: str, mesh: Mesh) -> Equilibrium | None:
        """Return the equilibrium of a design on a mesh, or None if it is not stored."""
        file = self._file(design_hash)
        try:
            with np.load(file, allow_pickle=False) as content:
                found = Equilibrium.read(content)
        except (OSError, ValueError, KeyError, TypeError, EOFError, BadZipFile, zlib.error):
            return None
        if found.mesh != checksum(mesh) or found.positions.shape != mesh.vertices.shape:
            return None
        with suppress(OSError):
            file.touch()  # a file that was read is the last to go
        return found

    def holds(self, design_hash: str) -> bool:
        """Return True if a file of a design is stored."""
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
