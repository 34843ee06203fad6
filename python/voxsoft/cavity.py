"""One cavity of a mesh: its triangles and its size."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from voxsoft._arrays import frozen
from voxsoft.geometry import enclosed_volume, tet_volumes


@dataclass(frozen=True, eq=False)
class MeshCavity:
    """The part of a mesh's boundary that faces one cavity.

    Attributes
    ----------
    triangles : ndarray of int32, shape (t, 3)
        Vertex indices, pointing out of the material, that is into the cavity.
    volume : float
        Enclosed volume [m³], voids included.
    area : float
        Area of the triangles [m²].
    void_tets : ndarray of int32, shape (k, 4)
        Tets between corners of cut voxels whose volumes, with the parts below as factors, sum up
        to the volume of the cavity beyond its triangles; none by default.
    void_parts : ndarray of float64, shape (k,)
        The factor of each, of either sign.
    name : str
        Name in the design; empty where it has no name.
    body : str
        The name of the body that it is in; empty where there is only one.
    other_triangles : ndarray of int32, shape (t, 3), optional
        The surface with its bilinear faces, those of hyperelastic voxels, cut along their other
        diagonals: volume and pressure are the mean over both. Default: none is bilinear.
    """

    triangles: NDArray[np.int32] = field(repr=False)
    volume: float
    area: float
    void_tets: NDArray[np.int32] = field(
        default_factory=lambda: np.zeros((0, 4), np.int32), repr=False
    )
    void_parts: NDArray[np.float64] = field(default_factory=lambda: np.zeros(0), repr=False)
    name: str = ""
    body: str = ""
    other_triangles: NDArray[np.int32] | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        for name in ("triangles", "void_tets", "other_triangles"):
            if (array := getattr(self, name)) is not None:
                object.__setattr__(self, name, frozen(array, np.int32))
        object.__setattr__(self, "void_parts", frozen(self.void_parts, np.float64))

    def __reduce__(self) -> tuple[Any, ...]:
        return MeshCavity, tuple(getattr(self, each.name) for each in fields(self))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, MeshCavity):
            return NotImplemented
        arrays = ("triangles", "void_tets", "void_parts", "other_triangles")
        mine, its = ((each.volume, each.area, each.name, each.body) for each in (self, other))
        return mine == its and all(
            np.array_equal(getattr(self, name), getattr(other, name)) for name in arrays
        )

    __hash__ = None  # type: ignore[assignment]

    def volume_at(self, positions: NDArray[np.float64]) -> float:
        """Return the volume [m³] when the vertices have moved.

        Parameters
        ----------
        positions : ndarray, shape (n, 3)
            All vertices of the mesh now [m].

        Examples
        --------
        >>> from voxsoft.voxels import Voxels
        >>> shell = np.ones((3, 3, 3), dtype=bool)
        >>> shell[1, 1, 1] = False
        >>> mesh = Voxels.from_array(shell, voxel_size=0.01).mesh()
        >>> round(mesh.cavities[0].volume_at(2 * mesh.vertices), 12)
        8e-06
        """
        volume = sum(w * enclosed_volume(triangles, positions) for triangles, w in self.splits)
        if len(self.void_tets) == 0:
            return volume
        return volume + float(self.void_parts @ tet_volumes(positions, self.void_tets))

    @property
    def splits(self) -> tuple[tuple[NDArray[np.int32], float], ...]:
        """The ways in which its surface is cut: triangles and weight.

        Examples
        --------
        >>> from voxsoft.voxels import Voxels
        >>> shell = np.ones((3, 3, 3), dtype=bool)
        >>> shell[1, 1, 1] = False
        >>> cavity = Voxels.from_array(shell, voxel_size=0.01).mesh().cavities[0]
        >>> [weight for _, weight in cavity.splits]
        [1.0]
        """
        if self.other_triangles is None:
            return ((self.triangles, 1.0),)
        return ((self.triangles, 0.5), (self.other_triangles, 0.5))
