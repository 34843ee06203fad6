"""Connected sets of cells of a grid."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Region:
    """A connected set of cells.

    Attributes
    ----------
    runs : ndarray of int, shape (r, 4)
        The cells as runs along z: ``(i, j, first k, last k)``, in C order. A compact form for
        regions of millions of cells.
    count : int
        Number of cells.
    volume : float
        Volume of the cells [m³].
    bounds : ndarray, shape (2, 3)
        Lower and upper corner of the bounding box [m].
    """

    runs: NDArray[np.int32] = field(repr=False)
    count: int
    volume: float
    bounds: NDArray[np.float64] = field(repr=False)

    @property
    def cells(self) -> NDArray[np.int32]:
        """Array indices (i, j, k) of the cells, shape (count, 3), in C order.

        Examples
        --------
        >>> from voxsoft.voxels import Voxels
        >>> piece = Voxels.from_array([[[1, 1], [0, 1]]], voxel_size=0.005).components()[0]
        >>> piece.cells.tolist()
        [[0, 0, 0], [0, 0, 1], [0, 1, 1]]
        """
        lengths = self.runs[:, 3] - self.runs[:, 2] + 1
        ij = np.repeat(self.runs[:, :2], lengths, axis=0)
        # Within a run k counts up from its first cell.
        starts = np.repeat(np.cumsum(lengths) - lengths, lengths)
        k = np.arange(self.count) - starts + np.repeat(self.runs[:, 2], lengths)
        return np.column_stack((ij, k)).astype(np.int32)


@dataclass(frozen=True, eq=False)
class Cavity(Region):
    """An empty region that no path through faces connects with the outside.

    Attributes
    ----------
    area : float
        Area of the faces it shares with filled cells [m²].
    """

    area: float


def region_fields(
    runs: NDArray[np.uint32], count: int, voxel_size: float, origin: NDArray[np.float64]
) -> tuple[NDArray[np.int32], int, float, NDArray[np.float64]]:
    """Return the fields of a :class:`Region` from its runs in the core's form."""
    signed = runs.astype(np.int32)
    signed.setflags(write=False)
    lower = signed[:, [0, 1, 2]].min(axis=0)
    upper = signed[:, [0, 1, 3]].max(axis=0) + 1
    bounds = origin + voxel_size * np.stack((lower, upper))
    bounds.setflags(write=False)
    return signed, count, count * voxel_size**3, bounds
