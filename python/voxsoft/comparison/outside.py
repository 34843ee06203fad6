"""Answer of an outside code, on the vertices of the voxel mesh."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from voxsoft.comparison.bricks import BrickModel
from voxsoft.errors import SimulationError
from voxsoft.materials import Hyperelastic, Material

Floats = NDArray[np.float64]

#: Final state of an outside code: whole load, a part of it, or surfaces in each other.
OutsideStatus = Literal["ok", "not-converged", "passed-through"]


@dataclass(frozen=True, eq=False)
class OutsideAnswer:
    """Answer of an outside code to a problem on bricks.

    Attributes
    ----------
    code, version, element
        Name and version of the code, and its element.
    status
        ``ok``, ``not-converged`` where a part of the load was not reached, or ``passed-through``
        where surfaces are in each other that contact should keep apart.
    message
        The status in a sentence.
    load_factor
        Share of the loads that the answer holds for; 1 if all is well.
    displacements
        Displacements of the vertices of the voxel mesh in m, (v, 3).
    held, reactions
        Held nodes (k,) and the force of the support on each of them in N, (k, 3).
    unknowns
        Displacement components of the problem.
    seconds
        Wall-clock time of the solution.
    contacts
        The force of each object on the body in N, (3,), by its name.
    pressed
        Sum of the magnitudes of the forces between walls of the body in N; None where the body does
        not touch itself.
    """

    code: str
    version: str
    element: str
    status: OutsideStatus
    message: str
    load_factor: float
    displacements: Floats = field(repr=False)
    held: NDArray[np.int64] = field(repr=False)
    reactions: Floats = field(repr=False)
    unknowns: int
    seconds: float
    contacts: Mapping[str, Floats] = field(default_factory=dict, repr=False)
    pressed: float | None = None

    @property
    def reaction(self) -> Floats:
        """Total force of the supports in N, (3,)."""
        total: Floats = self.reactions.sum(axis=0)
        return total


def rubber(material: Material, code: str, where: str) -> tuple[str, list[float], float]:
    """Return model, constants and bulk modulus in Pa of a hyperelastic material.

    Parameters
    ----------
    material
        Any material.
    code, where
        Name of the code, and the place in the design, for the message.

    Raises
    ------
    SimulationError
        Another material, which no outside code has.

    Examples
    --------
    >>> from voxsoft.materials import Lattice
    >>> rubber(Lattice(edge=20e3, bulk=1e5), "CalculiX", "parts[0].material")
    Traceback (most recent call last):
    ...
    voxsoft.errors.SimulationError: parts[0].material: CalculiX has no "lattice" material. Try: \
compare a hyperelastic material, such as the neo-Hookean one of the same Young's modulus
    """
    if not isinstance(material, Hyperelastic):
        raise no_such_material(code, material.model, where)
    if material.mullins is not None:
        what = f"{code} is given no softening"
        raise SimulationError(where, what, "leave mullins out to compare the first loading")
    return material.model, material.constants, material.bulk


def no_such_material(code: str, model: str, where: str) -> SimulationError:
    """Make the error for a material that an outside code does not have."""
    return SimulationError(
        where,
        f'{code} has no "{model}" material',
        "compare a hyperelastic material, such as the neo-Hookean one of the same Young's modulus",
    )


def support_forces(
    model: BrickModel, held: NDArray[np.int64], inner: Floats, load_factor: float
) -> Floats:
    """Compute the forces of the supports from the inner forces at held nodes.

    Parameters
    ----------
    model
        The problem.
    held
        The nodes, (k,).
    inner
        Inner forces of the elements at those nodes in N, (k, 3).
    load_factor
        The share of the loads that acts.

    Notes
    -----
    At a node, support and loads together balance the inner forces. Pressure on faces whose nodes
    are held is counted as at rest, which is exact where all of them are held and stay.
    """
    loads = model.forces + model.weights + _pressure_at_rest(model)
    reactions: Floats = np.where(model.fixed[held], inner - load_factor * loads[held], 0.0)
    return reactions


def _pressure_at_rest(model: BrickModel) -> Floats:
    forces = np.zeros_like(model.nodes)
    for pressure in model.pressures:
        nodes = model.face_nodes(pressure.faces)
        a, b, d = (model.nodes[nodes[:, column]] for column in (0, 1, 3))
        # The corners of a face turn so that this normal points into the brick, as pressure pushes.
        push = pressure.value * np.cross(b - a, d - a)
        for column, share in enumerate(model.face_shares):
            np.add.at(forces, nodes[:, column], share * push)
    return forces
