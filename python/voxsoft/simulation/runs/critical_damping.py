"""Damping that keeps the slowest mode of a held body from swinging."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from voxsoft.errors import VoxSoftError
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.adjoint import adjoint_states

#: Frequency below which a body is not held, rad/s: rounding, of periods of an hour.
_FREE: Final = 1e-3


def critical_damping(setup: Setup) -> float | None:
    """Estimate twice the lowest natural frequency of the unloaded body, 1/s.

    Rayleigh's method: for the deflection ``u`` under a uniform acceleration, with the masses ``M``
    and the forces ``f = M e``, the square of the frequency is at most ``u·f / u·M u``, and mostly
    nearer than 1 % to it for the softest direction.

    Parameters
    ----------
    setup
        The body.

    Returns
    -------
    float or None
        None for a body that is not held, or with objects that move freely: damping of all motion
        would keep these from falling.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.simulation import modes, simulate
    >>> setup = Setup.of(families.beam().replace(loads=[]))
    >>> slowest = modes(simulate(setup, method="statics"), 1).frequencies[0]
    >>> bool(abs(critical_damping(setup) / (4.0 * np.pi * slowest) - 1.0) < 0.02)
    True
    """
    design, mesh = setup.design, setup.mesh
    if any(each.motion == "free" for each in design.objects):
        return None
    drives = ("loads", "supplies", "connections", "tendons", "activations", "objects")
    without: dict[str, Any] = {
        **dict.fromkeys(drives, ()),
        "contact": None,
        "objectives": {},
        "constraints": {},
    }
    try:
        problem = Setup(design.replace(**without), mesh).problem
        masses = problem.masses
        forces = np.array([np.outer(masses, axis) for axis in np.eye(3)])
        moves = adjoint_states(problem, mesh.vertices, forces)
    except VoxSoftError:
        return None
    squares = [
        float(np.vdot(move, force) / (masses @ np.sum(move**2, axis=1)))
        for move, force in zip(moves, forces, strict=True)
    ]
    lowest = min(squares)
    return 2.0 * float(np.sqrt(lowest)) if lowest > _FREE**2 else None
