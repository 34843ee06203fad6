"""Equilibria that are known already, so that opening a design does not solve for them again."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError, VoxSoftError
from voxsoft.files.meshes import read_mesh_file
from voxsoft.mesh import Mesh
from voxsoft.simulation import Result
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.study import equilibria
from voxsoft.study.equilibria import Equilibria, Equilibrium, checksum

#: Folder of the equilibria that the studio solved for, in its own folder.
FOLDER: Final = "equilibria"
#: File in which a run leaves its body.
RESULT: Final = "result.vtu"


class Known(Protocol):
    """A store of equilibria."""

    def find(self, design_hash: str, mesh: Mesh) -> Equilibrium | None:
        """Find the equilibrium of a mesh under the loads of its design, if it is known."""
        ...


class RunState:
    """State that a run left in its folder, of its one design."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def find(self, design_hash: str, mesh: Mesh) -> Equilibrium | None:
        """Return the state, if the run left that for this mesh."""
        try:
            rest, positions = run_positions(self._folder)
        except VoxSoftError:
            return None
        same = rest.vertices.shape == mesh.vertices.shape
        if not same or not np.allclose(rest.vertices, mesh.vertices, atol=1e-9):
            return None
        return Equilibrium(positions, checksum(mesh))


def known_equilibrium(body: StudioBody, places: Sequence[Known]) -> Result | None:
    """The equilibrium of a body as it was found before; None where none is known.

    Parameters
    ----------
    body
        The body, without a hand on it.
    places
        Stores to search, one after the other.
    """
    if body.refusal is not None:
        return None
    try:
        identity = body.setup.design.hash
        for place in places:
            found = place.find(identity, body.mesh)
            result = None if found is None else found.result(body.setup)
            if result is not None:
                return result
    except VoxSoftError:  # it is solved again, and the solver reports the problem
        return None
    return None


def stored_in(folder: Path) -> list[Known]:
    """Store in which a study keeps the equilibria of its designs."""
    return [Equilibria(folder / equilibria.FOLDER)]


def run_positions(folder: Path) -> tuple[Mesh, NDArray[np.float64]]:
    """Read the mesh that a run left, and where its vertices ended [m], (n, 3).

    Raises
    ------
    FileError
        It left none, or they cannot be read.
    """
    file = folder / RESULT
    if not file.is_file():
        raise FileError(
            folder.name, "holds no result: it has not ended, or not well", "start it again"
        )
    content = read_mesh_file(file)
    moved = content.point_data.get("displacement")
    if moved is None or np.shape(moved) != content.mesh.vertices.shape:
        raise FileError(str(file), "holds no displacement", "start the run again")
    return content.mesh, content.mesh.vertices + np.asarray(moved, dtype=np.float64)
