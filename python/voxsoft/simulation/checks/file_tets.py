"""Findings of a check on a body that is the tetrahedra of a file."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.mesh import Mesh
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.voxels import Cavity, Voxels


def cavities_of_tets(mesh: Mesh) -> list[Cavity]:
    """The cavities of a mesh that has no voxels: they have no cells."""
    no_runs = np.zeros((0, 4), np.int32)
    return [
        Cavity(no_runs, 0, float(each.volume), _bounds(mesh.vertices[each.triangles]), each.area)
        for each in mesh.cavities
    ]


def _bounds(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    points = corners.reshape(-1, 3)
    return np.stack([points.min(axis=0), points.max(axis=0)])


def findings_of_tets(body: Design | Voxels, mesh: Mesh) -> Iterator[Diagnostic]:
    """Warn that tetrahedra of a file give no error bar, and lattices another stiffness."""
    if isinstance(body, Design):
        yield Diagnostic(
            "warning",
            "mesh",
            f"its {len(mesh.tets):,} tetrahedra give no error bar, and the constants of a lattice "
            "are those of voxels cut into five",
            "solve meshes of two sizes and compare; or fill voxels with the file, as a shape of "
            'the kind "mesh"',
        )
