"""Equilibria of a path on disk while it is followed: an interrupted job loses none of them."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, Final
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.files.atomic import replace_whole
from voxsoft.files.run_folder import make_folder
from voxsoft.files.toml_text import write_toml
from voxsoft.simulation import Over, Result
from voxsoft.simulation.runs.solved_state import SolvedState

#: Name of the folder beside the table that holds them until the path is finished.
FOLDER: Final = "path-equilibria"


class KeptPath:
    """Equilibria that a path has found so far, in a folder.

    Parameters
    ----------
    folder
        Folder of the job.
    design, over
        Design and values of the path: equilibria of any other path are not read.

    Examples
    --------
    >>> import tempfile
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> design = families.beam()
    >>> over = Over.read("loads[0].value=0..1 N/2")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     kept = KeptPath(Path(folder), design, over)
    ...     kept.keep(0, vs.simulate(design))
    ...     len(kept.read())
    1
    """

    def __init__(self, folder: Path, design: Design, over: Over) -> None:
        self._folder = folder / FOLDER
        values = ", ".join(map(repr, over.values))
        described = f"{write_toml(design.resolved)}\n{over.key}: {values}"
        self._key = hashlib.sha256(described.encode()).hexdigest()

    def keep(self, number: int, result: Result, creep: NDArray[np.float64] | None = None) -> None:
        """Write the equilibrium at a value, counted from 0.

        The viscous stress of a creep, `creep`, is kept at the last equilibrium alone.

        Raises
        ------
        OutputError
            It cannot be written.
        """
        state = SolvedState.of(result)
        arrays = {f"array{at}": each for at, each in enumerate(state.arrays)}
        content: dict[str, Any] = {"key": self._key, "state": state.text, **arrays}
        make_folder(self._folder)
        if creep is not None:
            # Before the equilibrium, so that a job that is killed between them has the last one's.
            row: dict[str, Any] = {"key": self._key, "creep": creep}
            replace_whole(self._creep_file(number), lambda beside: np.savez(beside, **row))
        replace_whole(
            self._file(number),
            lambda beside: np.savez(beside, positions=result.positions, **content),
        )
        if creep is not None and number > 0:
            self._creep_file(number - 1).unlink(missing_ok=True)

    def read(self) -> list[tuple[NDArray[np.float64], SolvedState]]:
        """Read positions and states of the equilibria from the first value on, without a gap.

        An equilibrium that cannot be read, or is of another path, ends them.
        """
        return list(self._read())

    def _read(self) -> Iterator[tuple[NDArray[np.float64], SolvedState]]:
        number = 0
        while self._file(number).exists():
            found = None
            with (
                suppress(OSError, ValueError, KeyError, EOFError, BadZipFile),
                np.load(self._file(number), allow_pickle=False) as content,
            ):
                if str(content["key"]) == self._key:
                    count = sum(name.startswith("array") for name in content)
                    arrays = tuple(content[f"array{at}"] for at in range(count))
                    state = SolvedState(str(content["state"]), arrays)
                    found = np.asarray(content["positions"]), state
            if found is None:
                return
            yield found
            number += 1

    def read_creep(self, number: int) -> NDArray[np.float64] | None:
        """Read the viscous stress at an equilibrium; None if it was not kept or cannot be read."""
        with (
            suppress(OSError, ValueError, KeyError, EOFError, BadZipFile),
            np.load(self._creep_file(number), allow_pickle=False) as content,
        ):
            if str(content["key"]) == self._key:
                return np.asarray(content["creep"], dtype=np.float64)
        return None

    def clear(self) -> None:
        """Remove all equilibria: the path is finished, and a repeated job begins anew."""
        shutil.rmtree(self._folder, ignore_errors=True)

    def _file(self, number: int) -> Path:
        return self._folder / f"{number:04}.npz"

    def _creep_file(self, number: int) -> Path:
        return self._folder / f"creep-{number:04}.npz"
