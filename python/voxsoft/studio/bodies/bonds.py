"""Bonds between surfaces, as the page marks them on the unloaded body."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import VoxSoftError
from voxsoft.simulation import Setup
from voxsoft.simulation.setup.distance import Surface, distances_to
from voxsoft.studio.protocol import events

#: Start of the search for the facing surface before a triangle, in reaches of a bond.
_AHEAD: Final = 0.1
#: Points of a bond that are drawn.
_SHOWN_POINTS: Final = 400


def bonds_of(setup: Setup) -> list[events.BodyBond]:
    """The bonds of a design, with points of the first surface where it meets the second.

    Parameters
    ----------
    setup
        Setup of a design with or without contact.

    Returns
    -------
    list
        One entry for each bond; none where surfaces are in each other, a finding of the check.
    """
    touching = setup.touching
    if touching is None or not touching.bonds:
        return []
    try:
        floor = [] if touching.floor is None else [touching.floor]
        surfaces = [*touching.bodies, *touching.surfaces, *floor]
    except VoxSoftError:
        return []
    found = []
    for bond in touching.bonds:
        first, second = (surfaces[number] for number in bond.of)
        near = _meeting(first, second, touching.reach * (1.0 + 1e-6))
        step = max(1, len(near) // _SHOWN_POINTS)
        a, b = (touching.names[number] for number in bond.of)
        shown = near[::step][:_SHOWN_POINTS]
        found.append(
            events.BodyBond(
                of=(a, b),
                strength=bond.strength if np.isfinite(bond.strength) else None,
                points=[(float(x), float(y), float(z)) for x, y, z in shown],
            )
        )
    return found


def _meeting(first: Surface, second: Surface, reach: float) -> NDArray[np.float64]:
    """The middles of triangles within reach [m] of another surface that look at it, (n, 3)."""
    count = len(first.vertices)
    middles = first.just_inside(0.0)[count:]
    way = _AHEAD * reach
    ahead = first.just_inside(-way)[count:]
    here = distances_to(second, middles)
    nearer = here - distances_to(second, ahead) > way / 2.0
    return middles[(np.abs(here) <= reach) & nearer]
