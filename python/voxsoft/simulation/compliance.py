"""How soft a loaded body is at a place."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.mesh import Mesh
from voxsoft.metrics import Place
from voxsoft.simulation.adjoint import adjoint_states
from voxsoft.simulation.fields import remember
from voxsoft.simulation.setup import Setup

Floats = NDArray[np.float64]


def compliance(
    design: Design, mesh: Mesh, positions: Floats, place: Place, peaks: Floats | None = None
) -> Floats:
    """How a force along x, y or z, shared by a place as its weights say, moves it.

    With the weights ``w`` of the place on the vertices it is ``wᵀ K⁻¹ w``, of the tangent ``K`` at
    an equilibrium: loads, and what touches, stay as they are there.

    Parameters
    ----------
    design, mesh
        The body.
    positions
        Its equilibrium, (n, 3), m.
    place
        Where.
    peaks
        What voxels that soften remember.

    Returns
    -------
    ndarray of shape (3, 3)
        In m/N: column by the axis of the force, row by that of the displacement.

    Raises
    ------
    SimulationError
        The tangent is singular there, or does not fit in memory.
    """
    setup = Setup(design, mesh)
    remember(setup.problem, peaks)
    return compliance_of(setup, positions, place)


def compliance_of(setup: Setup, positions: Floats, place: Place) -> Floats:
    """The same of a setup."""
    forces = np.zeros((3, *positions.shape))
    for axis in range(3):
        forces[axis, place.vertices, axis] = place.weights
    # Of a tangent that is not symmetric the adjoint is the transpose of what a force does.
    moved = adjoint_states(setup.problem, positions, forces)
    return np.asarray(np.einsum("kvx,v->kx", moved[:, place.vertices], place.weights))
