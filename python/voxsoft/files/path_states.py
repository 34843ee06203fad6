"""States of a path in its run folder, ``path.npz``: positions and all that fields follow from.

Fields are measured again when they are read, so that a state takes a tenth of ``result.vtu``.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.design.document.documents import with_paths_from
from voxsoft.design.document.included import placed_document
from voxsoft.errors import FileError
from voxsoft.files.atomic import replace_whole
from voxsoft.files.designs import read_document
from voxsoft.files.run_folder import read_summary
from voxsoft.files.scenes.scene import poses_in_summary
from voxsoft.files.toml_text import write_toml
from voxsoft.mesh import Mesh
from voxsoft.simulation import LoadPath
from voxsoft.simulation.setup.contact import Pose

Floats = NDArray[np.float64]

#: Name of the file in a run folder.
STATES: Final = "path.npz"
_AGAIN: Final = "run the path again"


def write_states(path: LoadPath, folder: Path) -> None:
    """Write the equilibria of a path: positions in float64, reactions and contact in float32.

    Parameters
    ----------
    path
        Path to write.
    folder
        Folder of ``path.npz``.

    Raises
    ------
    OutputError
        The file cannot be written.
    """
    arrays: dict[str, Any] = {}
    designs: list[str] = []
    for number, result in enumerate(path.results):
        arrays[f"{number}.positions"] = result.positions
        arrays[f"{number}.points.reaction"] = result.reactions.astype(np.float32)
        contact = result.contact_field
        for name, values in ({} if contact is None else contact.point_data()).items():
            arrays[f"{number}.points.{name}"] = values.astype(np.float32)
        if result.peaks is not None:
            arrays[f"{number}.peaks"] = result.peaks
        designs.append(write_toml(with_paths_from(result.design.resolved, folder)))
    content = {
        "over": path.over.key,
        "values": path.values,
        "hash": path.results[-1].design.hash,
        "designs": designs,
        "objects": [
            {name: pose.summary() for name, pose in result.objects.items()}
            for result in path.results
        ],
    }
    text = np.array(json.dumps(content))
    replace_whole(
        folder / STATES, lambda beside: np.savez_compressed(beside, content=text, **arrays)
    )


@dataclass(frozen=True, eq=False)
class PathStates:
    """States of a path, each read when it is asked for.

    Attributes
    ----------
    file
        Path of the file.
    key, values
        Changed key, and its value at each state in SI units.
    """

    file: Path
    key: str
    values: tuple[float, ...]
    _designs: tuple[str, ...] = field(repr=False)
    _objects: tuple[Mapping[str, Any], ...] = field(repr=False)

    def design(self, number: int) -> Design:
        """Return the design at a state.

        Raises
        ------
        FileError, DesignError
            The design is damaged.
        """
        document = read_document(self._designs[number], self.file.name)
        return Design.from_document(placed_document(document, self.file.parent))

    def positions(self, number: int) -> Floats:
        """Return the positions of all vertices at a state [m], (n, 3)."""
        return np.asarray(self._arrays(f"{number}.positions")["positions"], dtype=np.float64)

    def peaks(self, number: int) -> Floats | None:
        """Return the largest energy of each softening voxel by then [J/m³]; None without any."""
        found = self._arrays(f"{number}.peaks").get("peaks")
        return None if found is None else np.asarray(found, dtype=np.float64)

    def point_data(self, number: int, mesh: Mesh) -> dict[str, Floats]:
        """Return displacement, velocity, reaction and contact at the vertices, (n, ...)."""
        moved = self.positions(number) - mesh.vertices
        given = {
            name: np.asarray(values, dtype=np.float64)
            for name, values in self._arrays(f"{number}.points.").items()
        }
        return {"displacement": moved, "velocity": np.zeros_like(moved), **given}

    def poses(self, number: int) -> dict[str, Pose]:
        """Return the pose of each rigid object at a state."""
        return poses_in_summary(self.file, self._objects[number])

    def check(self, mesh: Mesh) -> None:
        """Refuse a mesh that is not that of the states.

        Raises
        ------
        FileError
            It has another number of vertices than a state.
        """
        for number in range(len(self.values)):
            if self.positions(number).shape != mesh.vertices.shape:
                what = "holds states on another mesh than that of the design beside it"
                raise FileError(str(self.file), what, _AGAIN)

    def _arrays(self, prefix: str) -> dict[str, NDArray[Any]]:
        """Read the arrays whose names begin so, by the last of their names."""
        try:
            with np.load(self.file, allow_pickle=False) as content:
                names = [name for name in content if name.startswith(prefix)]
                return {name.rpartition(".")[2]: content[name] for name in names}
        except (OSError, ValueError, KeyError, EOFError, BadZipFile) as error:
            raise _damaged(self.file, error) from None


def read_states(folder: Path) -> PathStates | None:
    """Read the states of a run folder; None where its run was no path.

    Parameters
    ----------
    folder
        The run folder.

    Raises
    ------
    FileError
        The run was a path, and its states are missing, damaged, or those of another path.
    """
    summary = read_summary(folder)
    if "path" not in summary:
        return None
    file = folder / STATES
    if not file.is_file():
        what = f"holds a path without its states, {STATES}: an older VoxSoft kept the last one"
        raise FileError(str(folder), what, _AGAIN)
    try:
        with np.load(file, allow_pickle=False) as content:
            found = json.loads(str(content["content"]))
        states = PathStates(
            file,
            str(found["over"]),
            tuple(map(float, found["values"])),
            tuple(map(str, found["designs"])),
            tuple(found["objects"]),
        )
        is_ours = found["hash"] == summary["hash"] and len(states.values) == len(summary["path"])
    except (OSError, ValueError, KeyError, TypeError, EOFError, BadZipFile) as error:
        raise _damaged(file, error) from None
    if not is_ours:
        raise FileError(str(file), "holds the states of another path", _AGAIN)
    return states


def _damaged(file: Path, error: Exception) -> FileError:
    return FileError(str(file), f"is damaged: {error!r}", _AGAIN)
