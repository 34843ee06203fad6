"""Rigid motions that no clamp stops: why there may be no equilibrium."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft.simulation.setup import Setup

#: Singular values below this part of the largest count as none. Those of real supports are ratios
#: of lengths, such as the width of a clamp over the length of the body.
NONE = 1e-6


def moves_freely(setup: Setup) -> bool:
    """Whether a component of the body has a rigid motion that no clamp stops.

    Pieces are what shares vertices; hinges between voxels on one edge are not looked at. Where
    there is a floor, a layer or a spring, which may hold a component as well, the answer is no.

    Parameters
    ----------
    setup
        The body and its clamps.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> moves_freely(Setup.of(families.beam()))
    False
    """
    if setup.design.floor is not None or setup.design.layers or setup.attached:
        return False
    held = np.zeros((len(setup.mesh.vertices), 3), dtype=bool)
    for clamp, vertices in zip(setup.design.clamps, setup.clamped, strict=True):
        held[vertices] |= [axis in clamp.axes for axis in "xyz"]
    if (sector := setup.sector) is not None:
        here = sector.vertices if setup.mesh is sector.mesh else slice(None)
        held[:, sector.axes] |= sector.on_planes[here]
    return any(_freedoms(setup.mesh.vertices[p], held[p]) > 0 for p in _joined(setup))


def _joined(setup: Setup) -> list[NDArray[np.intp]]:
    """Vertices of each component."""
    from scipy.sparse import coo_array  # slow to load
    from scipy.sparse.csgraph import connected_components

    tets, count = setup.mesh.tets, len(setup.mesh.vertices)
    pairs = tets[:, :1].repeat(3, axis=1).ravel(), tets[:, 1:].ravel()
    links = coo_array((np.ones(len(pairs[0])), pairs), shape=(count, count))
    number, labels = connected_components(links, directed=False)
    return [np.flatnonzero(labels == label) for label in range(number)]


def _freedoms(points: NDArray[np.float64], held: NDArray[np.bool_]) -> int:
    """The number of rigid motions of points, (n, 3) m, that spare their held axes, (n, 3)."""
    arms = points - points.mean(axis=0)
    arms = arms / max(float(np.abs(arms).max()), 1e-300)
    shifts = np.broadcast_to(np.eye(3), (len(points), 3, 3))
    # A turn about the axis k moves a point by eₖ × arm: one column for each axis.
    turns = np.stack([np.cross(axis, arms) for axis in np.eye(3)], axis=2)
    stopped = np.concatenate([shifts, turns], axis=2)[held]
    # Six by six, however many vertices are held.
    values = np.sqrt(np.maximum(np.linalg.eigvalsh(stopped.T @ stopped), 0.0))
    return int(np.sum(values <= NONE * max(float(values.max()), 1e-300)))
