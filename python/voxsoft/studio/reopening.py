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
from voxsoft.simulation.fluids import has_supplies
from voxsoft.simulation.result import LARGE_RESIDUAL
from voxsoft.simulation.softening import softening_parts
from voxsoft.simulation.state import result_at
from voxsoft.simulation.touching import has_contact
from voxsoft.studio.body import StudioBody
from voxsoft.study import equilibria
from voxsoft.study.equilibria import Equilibria

#: Where the studio keeps those that it solved for, in its own folder.
FOLDER: Final = "equilibria"
#: What a run leaves of its body.
RESULT: Final = "result.vtu"


class Known(Protocol):
    """Where equilibria are stored."""

    def find(self, design_hash: str, mesh: Mesh) -> NDArray[np.float64] | None:
        """Where the vertices of a mesh are when its design is at rest, (n, 3) in m, if known."""
        ...


class RunState:
    """What a run left in its folder: the state of the one design that it is about."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def find(self, design_hash: str, mesh: Mesh) -> NDArray[np.float64] | None:
        """Where the vertices are, (n, 3) in m, if the run left them for this mesh."""
        try:
            rest, positions = run_positions(self._folder)
        except VoxSoftError:
            return None
        same = rest.vertices.shape == mesh.vertices.shape
        return positions if same and np.allclose(rest.vertices, mesh.vertices, atol=1e-9) else None


def is_given_by_positions(body: StudioBody) -> bool:
    """Whether the places of all vertices say all of an equilibrium.

    Objects have poses of their own, supplies have what they gave, and a material that softens
    remembers how far it was stretched: such designs are solved again.
    """
    design = body.setup.design
    softens = next(softening_parts(design), None) is not None
    return not (has_contact(design) or has_supplies(design) or softens)


def known_equilibrium(body: StudioBody, places: Sequence[Known]) -> Result | None:
    """The equilibrium of a body as it was found before, measured anew; None where none is known.

    A state whose forces do not balance under the loads of the design is none.

    Parameters
    ----------
    body
        The body, without a hand on it.
    places
        Where to look, one after the other.
    """
    if body.refusal is not None or not is_given_by_positions(body):
        return None
    try:
        identity = body.setup.design.hash
        for place in places:
            positions = place.find(identity, body.mesh)
            if positions is None:
                continue
            message = "at rest, as it was solved before"
            found = result_at(body.setup, positions, status="ok", message=message)
            if found.residual <= LARGE_RESIDUAL:
                return found
    except VoxSoftError:  # it is solved, which says what is wrong
        return None
    return None


def stored_in(folder: Path) -> list[Known]:
    """Where a study keeps the equilibria of its designs."""
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
