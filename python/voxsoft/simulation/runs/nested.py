"""Start of statics on fine voxels from an equilibrium on voxels twice as large."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft.mesh import Mesh
from voxsoft.simulation.results.result import Result
from voxsoft.simulation.runs.symmetric_body import SectorSetup
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.start import Start

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Tolerance of vertices on the grid of the larger voxels, in halves of these: rounding.
_OFF = 1e-6


def nested(coarse: Result, setup: Setup) -> Start | None:
    """Interpolate an equilibrium to voxels half as large.

    Displacements are trilinear in the large voxels. Small voxels bulge by that as in no
    equilibrium, and their bulk modulus makes pressures of it that are far too large; the first
    Newton step begins with the pressure of the large voxel around them instead.

    Parameters
    ----------
    coarse
        An equilibrium.
    setup
        The setup to be solved: the same body, or a sector of it.

    Returns
    -------
    Start or None
        None where the small voxels do not fill the large ones, with contact, or for several bodies.
    """
    whole = setup.whole if isinstance(setup, SectorSetup) else setup
    large, small = coarse.mesh, whole.mesh
    if whole.touching is not None or large.bodies or small.bodies:
        return None
    if large.voxel_size is None or small.voxel_size is None:
        return None
    low = large.vertices.min(axis=0)
    half = large.voxel_size / 2.0
    places = (small.vertices - low) / half
    keys = np.rint(places).astype(np.int64)
    if abs(small.voxel_size - half) > _OFF * half or np.abs(places - keys).max() > _OFF:
        return None
    at = _Vertices(large, low)
    moved = np.zeros_like(small.vertices)
    for corner in np.ndindex(2, 2, 2):
        # Half way between two vertices of the grid, or on one, which then counts twice.
        found = at.find(np.where(corner, (keys + 1) // 2, keys // 2))
        if (found < 0).any():
            return None
        moved += coarse.displacements[found] / 8.0
    own = Setup(coarse.design, coarse.mesh)
    # No pressure is known where the surface leaves no large voxel around a small one.
    around = np.nan_to_num(own.problem.pressures(coarse.positions))
    parents = at.find(keys // 2)
    pressures = np.where(parents >= 0, around[parents], 0.0)
    positions = small.vertices + moved
    if isinstance(setup, SectorSetup):
        kept = setup.sector.vertices
        return Start(positions[kept] - setup.origin, pressures[kept])
    return Start(positions, pressures)


class _Vertices:
    """Vertices of a mesh of voxels by integer coordinates from a corner."""

    def __init__(self, mesh: Mesh, low: Floats) -> None:
        assert mesh.voxel_size is not None  # checked by the caller
        keys = np.rint((mesh.vertices - low) / mesh.voxel_size).astype(np.int64)
        self._shape = keys.max(axis=0) + 1
        self._numbers = np.full(tuple(self._shape), -1, dtype=np.int64)
        self._numbers[tuple(keys.T)] = np.arange(len(keys))

    def find(self, keys: Ints) -> Ints:
        """Find vertices by their coordinates, -1 where there is none."""
        inside = ((keys >= 0) & (keys < self._shape)).all(axis=1)
        found = np.full(len(keys), -1, dtype=np.int64)
        found[inside] = self._numbers[tuple(keys[inside].T)]
        return found
