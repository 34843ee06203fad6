"""Compliance of a loaded body at a place."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.mesh import Mesh
from voxsoft.metrics import Place
from voxsoft.simulation.results.fields import remember
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.adjoint import adjoint_states

Floats = NDArray[np.float64]


def compliance(
    design: Design, mesh: Mesh, positions: Floats, place: Place, peaks: Floats | None = None
) -> Floats:
    """Compute the compliance at a place: its displacement under a force along x, y or z.

    With the weights ``w`` of the place on the vertices, which share the force, it is ``wᵀ K⁻¹ w``
    of the tangent ``K`` at an equilibrium: loads and contacts stay as they are there.

    Parameters
    ----------
    design, mesh
        The body.
    positions
        Its equilibrium, (n, 3), m.
    place
        The place, as vertices and weights.
    peaks
        Largest energy density that each softening voxel has had [J/m³].

    Returns
    -------
    ndarray of shape (3, 3)
        Compliance [m/N]: column by the axis of the force, row by that of the displacement.

    Raises
    ------
    SimulationError
        The tangent is singular there, or does not fit in memory.
    """
    setup = Setup(design, mesh)
    remember(setup.problem, peaks)
    return compliance_of(setup, positions, place)


def compliance_of(setup: Setup, positions: Floats, place: Place) -> Floats:
    """Compute the compliance of a prepared setup."""
    forces = np.zeros((3, *positions.shape))
    for axis in range(3):
        forces[axis, place.vertices, axis] = place.weights
    # With an unsymmetric tangent the adjoint is the transpose of the response to a force.
    moved = adjoint_states(setup.problem, positions, forces)
    return np.asarray(np.einsum("kvx,v->kx", moved[:, place.vertices], place.weights))
