"""Width of the patches in which a body touches, in voxels.

The pressure under a round or pointed body changes over the width of its patch, so that a patch of
few voxels has an error of its own, whatever the walls are.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft._components import components
from voxsoft.simulation import Result

Floats = NDArray[np.float64]

#: Voxels across a contact patch from which on errors are regular. Forces of balls of 3, 5 and 8 mm
#: pressed 4 mm into a block were 3 to 32 % above those on voxels of 1.25 mm where their patches
#: were 2.1 to 2.7 voxels across, and 5 % at 3.9.
REGULAR_PATCH: Final = 4.0
#: Least share of the pressing force that counts: a quarter of it, which a patch of few voxels may
#: hide, is the 1 % that every bar has.
LEAST_SHARE: Final = 0.04


def voxels_across(result: Result) -> float | None:
    """Measure the narrowest contact patch of a body, in voxels.

    Vertices that press and are joined by triangles of the surface are a patch. Its width is that of
    the rectangle with the spread of its forces across its narrower direction; at least one voxel.

    Parameters
    ----------
    result
        A result with or without contact.

    Returns
    -------
    float or None
        Voxels across; None where nothing touches, or all that does is bonded.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> voxels_across(vs.simulate(families.cylinder(radius="20 mm", height="30 mm"))) is None
    True
    """
    field = result.contact_field
    # Bonded surfaces are as wide as the design makes them, at any size of voxels.
    bonded = sum(each.bonded for each in result.contacts)
    if field is None or bonded >= sum(each.area for each in result.contacts):
        return None
    forces = field.pressure * field.area
    pressed = np.flatnonzero(forces > 0.0)
    if not len(pressed):
        return None
    sizes = _voxel_sizes(result)
    number = np.full(len(forces), -1)
    number[pressed] = np.arange(len(pressed))
    edges = result.mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    pairs = number[edges]
    pairs = pairs[(pairs >= 0).all(axis=1)]
    patches = components(pairs[:, 0], pairs[:, 1], len(pressed))
    widths = []
    for patch in range(patches.max() + 1):
        own = pressed[patches == patch]
        if forces[own].sum() >= LEAST_SHARE * forces.sum():
            width = _width(result.positions[own], forces[own])
            widths.append(max(width / float(sizes[own].max()), 1.0))
    return min(widths, default=None)


def _width(points: Floats, forces: Floats) -> float:
    """Compute the narrower width of a patch of forces at points, m.

    A uniform pressure on a rectangle of width w has the variance w²/12 across.
    """
    apart = points - np.average(points, axis=0, weights=forces)
    spread = np.einsum("v,vi,vj->ij", forces / forces.sum(), apart, apart)
    _, narrower, _ = np.linalg.eigvalsh(spread)
    return math.sqrt(12.0 * max(float(narrower), 0.0))


def _voxel_sizes(result: Result) -> Floats:
    """Return the voxel size at each vertex, (n,), m."""
    sizes = np.full(len(result.mesh.vertices), result.mesh.voxel_size or result.design.voxel_size)
    for body in result.mesh.each_body:
        if body.mesh.voxel_size is not None:
            sizes[body.vertices] = body.mesh.voxel_size
    return sizes
