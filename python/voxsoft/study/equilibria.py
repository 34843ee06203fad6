"""Equilibria on disk, by the identity of each design, so that they are drawn and shown at once."""

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
from voxsoft.simulation.result import LARGE_RESIDUAL
from voxsoft.simulation.solved_state import SolvedState, is_given_by_positions
from voxsoft.simulation.state import result_at
from voxsoft.simulation.touching import Pose

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
    state
        What else was found, of a design whose positions do not say it: contact, supplies, what
        softened. None of other designs, whose positions are measured anew.
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
        """Read what :meth:`written` gives.

        Raises
        ------
        ValueError, KeyError, TypeError
            It is damaged.
        """
        positions = np.asarray(content["positions"], dtype=np.float64)
        state = None
        if "state" in content:
            text = np.asarray(content["state"], dtype=np.uint8).tobytes().decode()
            arrays = [content[f"array{at}"] for at in range(int(content["arrays"]))]
            state = SolvedState(text, tuple(arrays))
        return cls(positions, int(content["mesh"]), state)

    def result(self, setup: Setup) -> Result | None:
        """The equilibrium of a body as a result; None where it is not that, or not all is known.

        One that positions give is measured anew, and is none where forces do not balance under the
        loads of the design. Of others, with contact, supplies or softening, all is as it was found.

        Parameters
        ----------
        setup
            The body, on the mesh that was solved.

        Raises
        ------
        VoxSoftError
            The body cannot be solved, or what was stored is damaged or of another version.
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
        """Where the rigid objects are, by name; empty where there is none."""
        return {} if self.state is None else self.state.objects

    def written(self) -> dict[str, Any]:
        """Write it as arrays by name."""
        written: dict[str, Any] = {"positions": self.positions, "mesh": self.mesh}
        if self.state is not None:
            written["state"] = np.frombuffer(self.state.text.encode(), dtype=np.uint8)
            written["arrays"] = len(self.state.arrays)
            written |= {f"array{at}": each for at, each in enumerate(self.state.arrays)}
        return written


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
    >>> bool((found.positions == result.positions).all())
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
                    np.savez_compressed(file, **equilibrium.written())
                size = beside.stat().st_size
                beside.replace(self._file(design_hash))
            finally:
                beside.unlink(missing_ok=True)
            self._used = size + (self._used if self._used is not None else self._sum())
            if self._used > self._room:
                self._make_room()

    def find(self, design_hash: str, mesh: Mesh) -> Equilibrium | None:
        """Where the body of a mesh is at rest under the loads of its design, if that is known."""
        file = self._file(design_hash)
        try:
            with np.load(file, allow_pickle=False) as content:
                found = Equilibrium.read(content)
        except (OSError, ValueError, KeyError, TypeError, EOFError, BadZipFile, zlib.error):
            return None
        if found.mesh != checksum(mesh) or found.positions.shape != mesh.vertices.shape:
            return None
        with suppress(OSError):
            file.touch()  # what is looked at is the last to go
        return found

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
