"""Other split of the faces of voxels into triangles.

A face of a hyperelastic voxel moves bilinearly. One of its two splits into triangles loads its
corners 1/3, 1/6, 1/3, 1/6, in a checkerboard over the whole surface; the mean of both loads each
with a quarter, and encloses exactly the volume below the bilinear face.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from voxsoft.cavity import MeshCavity
from voxsoft.design import Design
from voxsoft.materials import CompliantLattice, Lattice
from voxsoft.mesh import Mesh

Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class OtherSplit:
    """Other split of the faces of some voxels of a mesh.

    Attributes
    ----------
    mesh
        Any mesh; those that are not made of voxels have no other split.
    bilinear
        True for each voxel with bilinear faces, (v,).
    """

    mesh: Mesh
    bilinear: NDArray[np.bool_]

    @classmethod
    def of(cls, design: Design, mesh: Mesh) -> OtherSplit:
        """Return the other split of the hyperelastic voxels of a design.

        The lattice material *is* its five tetrahedra, with plane triangles for its surface: those
        keep theirs.

        Parameters
        ----------
        design, mesh
            A design and its mesh.
        """
        if mesh.tet_voxel is None:
            return cls(mesh, np.zeros(0, dtype=bool))
        materials = [design.material_of(part) for part in design.parts]
        has_tets = np.array([isinstance(each, Lattice | CompliantLattice) for each in materials])
        return cls(mesh, ~has_tets[mesh.tet_part[::5].astype(np.intp) - 1])

    def cavity(self, cavity: MeshCavity) -> MeshCavity:
        """Return a cavity of the mesh with the other split of its surface."""
        return replace(cavity, other_triangles=self.triangles(cavity.triangles))

    def triangles(self, triangles: NDArray[np.int32]) -> NDArray[np.int32]:
        """Return triangles of the surface, (t, 3), with whole faces cut the other way.

        A triangle whose face is not whole among them, or not one of a bilinear voxel, stays.
        """
        if not self.bilinear.any():
            return triangles
        count = np.int64(len(self.mesh.vertices))
        odd = self._is_apex[triangles]
        candidates = np.flatnonzero(odd.sum(axis=1) == 1)
        first = odd[candidates].argmax(axis=1)
        turned = (first[:, None] + np.arange(3)) % 3
        apex, a, b = np.take_along_axis(triangles[candidates], turned, axis=1).T
        keys = np.minimum(a, b) * count + np.maximum(a, b)
        diagonals, sums = self._faces
        at = np.searchsorted(diagonals, keys)
        at[at == len(diagonals)] = 0
        known = diagonals[at] == keys if len(diagonals) else np.zeros(len(keys), dtype=bool)
        _, inverse, counts = np.unique(keys, return_inverse=True, return_counts=True)
        whole = known & (counts[inverse] == 2)
        opposite = sums[at[whole]] - apex[whole]
        found = triangles.copy()
        found[candidates[whole]] = np.column_stack((a[whole], opposite, apex[whole]))
        return found

    @cached_property
    def _blocks(self) -> tuple[Ints, Ints, Ints]:
        """Corners of the middle tets, those of the others outside of it, and the one opposite each.

        Both are (v, 4); the corner opposite an apex is the one across the voxel.
        """
        blocks = self.mesh.tets.reshape(-1, 5, 4)[self.bilinear].astype(np.int64)
        return _corners(blocks)

    @cached_property
    def _is_apex(self) -> NDArray[np.bool_]:
        found = np.zeros(len(self.mesh.vertices), dtype=bool)
        found[self._blocks[1]] = True
        return found

    @cached_property
    def _faces(self) -> tuple[Ints, Ints]:
        """The diagonals of all faces of bilinear voxels, as keys, and the sum of the other corners.

        A face diagonal is one of one face only, which one or two voxels have.
        """
        middle, apexes, across = self._blocks
        count = np.int64(len(self.mesh.vertices))
        keys, sums = [], []
        for i, j in ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)):
            ends = np.sort(middle[:, [i, j]], axis=1)
            beside = (across != middle[:, i, None]) & (across != middle[:, j, None])
            keys.append(ends[:, 0] * count + ends[:, 1])
            sums.append(np.where(beside, apexes, 0).sum(axis=1))
        diagonals, at = np.unique(np.concatenate(keys), return_index=True)
        return diagonals, np.concatenate(sums)[at]


def with_other_split(design: Design, mesh: Mesh) -> Mesh:
    """Return the mesh with cavities that have the other split of their surface.

    Parameters
    ----------
    design, mesh
        A design and its mesh.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.design.discretization.discretize import mesh_of
    >>> ball = families.sphere()
    >>> cavity = with_other_split(ball, mesh_of(ball)).cavities[0]
    >>> cavity.other_triangles.shape == cavity.triangles.shape
    True
    """
    split = OtherSplit.of(design, mesh)
    if not split.bilinear.any():
        return mesh
    return replace(mesh, cavities=tuple(split.cavity(each) for each in mesh.cavities))


def _corners(blocks: Ints) -> tuple[Ints, Ints, Ints]:
    """Return the middle tets of blocks of five, the apexes of the others, the corners across."""
    middle = blocks[:, 0]
    is_inner = (blocks[:, 1:, :, None] == middle[:, None, None, :]).any(axis=3)
    apexes = np.where(is_inner, 0, blocks[:, 1:]).sum(axis=2)
    across = middle.sum(axis=1)[:, None] - np.where(is_inner, blocks[:, 1:], 0).sum(axis=2)
    return middle, apexes, across
