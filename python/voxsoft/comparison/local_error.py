"""Local error indicator: an estimate of the discretization error in each voxel."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft.materials import Rigid
from voxsoft.simulation import Result
from voxsoft.simulation.setup.places import voxel_size

Floats = NDArray[np.float64]

#: Position of each corner of a voxel along each axis, -1 or 1, in the order of the mesh's corners.
_ENDS = 2.0 * np.indices((2, 2, 2)).reshape(3, -1).T - 1.0


def local_errors(result: Result) -> Floats:
    """Estimate the error of each voxel's strain, as an energy.

    The strain in the middle of a voxel is compared with the strain at its corners, which is the
    mean of all voxels of the same part around each (Zienkiewicz and Zhu 1987,
    doi 10.1002/nme.1620240206). Bending within a single voxel is no error: a plate of one voxel
    has no neighbors across.

    Parameters
    ----------
    result
        Run of a design without ``refine``.

    Returns
    -------
    numpy.ndarray
        Error energy in J, (n,), for the voxels in the order of the mesh; zero in rigid ones. Only
        ratios have a meaning.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> beam = families.beam(length="40 mm").with_values("parts.0.material=ecoflex-00-30")
    >>> result = vs.simulate(beam)
    >>> errors = local_errors(result)
    >>> corners = result.mesh.voxel_corners([int(errors.argmax())])
    >>> float(result.mesh.vertices[corners, 0].min()) < 0.015  # beside the clamp
    True
    """
    mesh, design = result.mesh, result.design
    size = np.concatenate(
        [np.full(len(body.mesh.tets) // 5, voxel_size(body.mesh)) for body in mesh.each_body]
    )
    corners = mesh.voxel_corners(np.arange(len(mesh.tets) // 5))
    strains = _strains(result.positions[corners], size)
    parts = mesh.tet_part[::5]
    found = np.zeros(len(corners))
    for number, part in enumerate(design.parts, start=1):
        own = np.flatnonzero(parts == number)
        material = design.material_of(part)
        if isinstance(material, Rigid) or own.size == 0:
            continue
        smooth = _means_at_corners(strains[own], corners[own], len(mesh.vertices))
        off = smooth - strains[own][:, None]
        stiffness = material.young(float(size[own[0]])) * size[own] ** 3
        found[own] = stiffness * (off**2).sum(axis=(2, 3)).mean(axis=1)
    if mesh.fractions is not None:
        found *= np.abs(mesh.fractions)
    return found


def _strains(positions: Floats, size: Floats) -> Floats:
    """Green's strain in the middle of voxels, (n, 3, 3), whose corners are at `positions` in m.

    It is in the frame of the body, however that is turned.
    """
    gradients = np.einsum("nci,cj->nij", positions, _ENDS) / (4.0 * size[:, None, None])
    strains: Floats = 0.5 * (np.einsum("nki,nkj->nij", gradients, gradients) - np.eye(3))
    return strains


def _means_at_corners(strains: Floats, corners: NDArray[np.int32], vertices: int) -> Floats:
    """The mean strain of all voxels at each corner of each, (n, 8, 3, 3)."""
    count = np.bincount(corners.ravel(), minlength=vertices)
    flat = strains.reshape(-1, 9)
    sums = np.stack(
        [
            np.bincount(corners.ravel(), np.repeat(flat[:, k], 8), minlength=vertices)
            for k in range(9)
        ],
        axis=1,
    )
    means = sums / np.maximum(count, 1)[:, None]
    return means[corners].reshape(len(corners), 8, 3, 3)
