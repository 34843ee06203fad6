"""Start of the search for an equilibrium."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Start(NamedTuple):
    """Positions of the vertices of a body, and the pressures in its hyperelastic voxels.

    Attributes
    ----------
    positions
        Vertex positions in m, (n, 3).
    pressures
        Pressures in Pa, positive in tension, on the vertices at the lowest corners of voxels, (n,).
        None for those that the positions have.
    """

    positions: NDArray[np.float64]
    pressures: NDArray[np.float64] | None = None
