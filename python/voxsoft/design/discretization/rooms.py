"""The room in cut voxels that belongs to a cavity, as volumes of tetrahedra.

The room moves with the trilinear motion of its voxel, and counts with its own mean gradient:
``V det F`` with ``F = Σ xᵢ ⊗ ⟨∇Nᵢ⟩``, the mean over the room. To first order that is the flux
through the true surface. As the gradients sum to zero, and the determinant is alternating,

    h³ det F = Σ det(gᵢ, gⱼ, gₖ) det(xᵢ - x₀, xⱼ - x₀, xₖ - x₀),    g = h ⟨∇N⟩,

over all triples of the other corners: 35 tetrahedra, each with a part of its own.
"""

from __future__ import annotations

from itertools import combinations
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_SIGNS: Final[Floats] = np.array(
    [[2.0 * (corner >> axis & 1) - 1.0 for axis in (2, 1, 0)] for corner in range(8)]
)
_TRIPLES: Final = np.array(list(combinations(range(1, 8), 3)))

#: The corners of the tetrahedra of a room; corner c lies at (c >> 2 & 1, c >> 1 & 1, c & 1).
ROOM_TETS: Final[NDArray[np.intp]] = np.hstack(
    [np.zeros((len(_TRIPLES), 1), dtype=np.intp), _TRIPLES]
)


def room_parts(parts: Floats, means: Floats) -> Floats:
    """The part of each tetrahedron of some rooms, (k, 35).

    Parameters
    ----------
    parts
        The volume of each room in volumes of a voxel, (k,); negative for material beyond the
        voxel's own space.
    means
        The means of ξ, η, ζ, ηζ, ζξ, ξη over it, (k, 6), counted from the center of the voxel in
        halves of its edge.

    Examples
    --------
    >>> whole = room_parts(np.ones(1), np.zeros((1, 6)))
    >>> corners = (_SIGNS + 1) / 2
    >>> edges = corners[ROOM_TETS[:, 1:]] - corners[ROOM_TETS[:, :1]]
    >>> round(float((whole[0] * np.linalg.det(edges)).sum() / 6), 12)
    1.0
    """
    slopes = np.empty((len(parts), 8, 3))
    for axis in range(3):
        one, other = (axis + 1) % 3, (axis + 2) % 3
        first, second = _SIGNS[:, one], _SIGNS[:, other]
        grown = 1.0 + first * means[:, one, None] + second * means[:, other, None]
        grown += first * second * means[:, 3 + axis, None]
        slopes[:, :, axis] = 0.25 * _SIGNS[:, axis] * grown
    found: Floats = 6.0 * parts[:, None] * np.linalg.det(slopes[:, _TRIPLES])
    return found
