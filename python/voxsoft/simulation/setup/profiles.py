"""Share of an activation in each voxel, by its profile."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import rounded
from voxsoft.design import Design
from voxsoft.design.growth import Growth
from voxsoft.design.profile import Profile
from voxsoft.errors import DesignError
from voxsoft.mesh import Mesh
from voxsoft.simulation.setup.part_voxels import PartVoxels, part_voxels

Floats = NDArray[np.float64]

#: Tolerance between a factor and that of its image, relative to the largest: rounding.
_SAME: Final = 1e-9


def shares_of(design: Design, mesh: Mesh, index: int, growth: Growth, where: str) -> Floats | None:
    """Return the share of a growth that each voxel of the mesh has.

    Parameters
    ----------
    design
        The design, with the parts of all its bodies.
    mesh
        The mesh of its voxels.
    index
        Index of the part.
    growth
        Growth of the part or of its fibers.
    where
        The activation, for errors.

    Returns
    -------
    ndarray of float64, shape (n, 4), or None
        The factor of the profile at the center of the material, and half its differences between
        the two sides of the voxel along each axis of the body; zeros for voxels of other parts.
        None where the activation has no profile.

    Raises
    ------
    DesignError
        A profile that has no value somewhere, or leaves nothing of the part.
    """
    profile = growth.profile
    if profile is None:
        return None
    shares = np.zeros((len(mesh.tets) // 5, 4))
    voxels = part_voxels(design, mesh, index)
    if voxels is None:
        what = "is for voxels, and this mesh has none"
        raise DesignError(f"{where}.profile", what, "leave it out, or run the design's own mesh")
    at_center = profile.values(voxels.centers)
    _check_finite(at_center, voxels.centers, where)
    shares[voxels.numbers, 0] = at_center
    for axis in range(3):
        half = np.zeros(3)
        half[axis] = voxels.size / 2.0
        ends = [profile.values(voxels.centers + way * half) for way in (-1.0, 1.0)]
        for values in ends:
            _check_finite(values, voxels.centers, where)
        shares[voxels.numbers, 1 + axis] = (ends[1] - ends[0]) / 2.0
    _check_left(growth, shares[voxels.numbers], voxels, where)
    return shares


def _check_finite(values: Floats, centers: Floats, where: str) -> None:
    if not np.isfinite(values).all():
        x, y, z = (rounded(1e3 * value) for value in centers[~np.isfinite(values)][0])
        what = f"has no value around ({x}, {y}, {z}) mm"
        raise DesignError(f"{where}.profile", what, "write a function that is finite in the part")


def _check_left(growth: Growth, shares: Floats, voxels: PartVoxels, where: str) -> None:
    """Refuse a share that leaves no material somewhere in a voxel."""
    spread = np.abs(shares[:, 1:]).sum(axis=1)
    for base in growth.bases:
        least = np.minimum(
            1.0 + (shares[:, 0] - spread) * (base - 1.0),
            1.0 + (shares[:, 0] + spread) * (base - 1.0),
        )
        if least.size and least.min() <= 0.0:
            worst = int(least.argmin())
            x, y, z = (rounded(1e3 * value) for value in voxels.centers[worst])
            what = (
                f"has the factor {shares[worst, 0]:.3g} at ({x}, {y}, {z}) mm: nothing would be "
                "left there"
            )
            raise DesignError(f"{where}.profile", what, "give factors that leave more than -1")


def check_profile_symmetry(design: Design, mesh: Mesh) -> None:
    """Check that profiles are their own mirror images in the planes of symmetry.

    Parameters
    ----------
    design
        A design of one body, with planes of symmetry.
    mesh
        The mesh of all its voxels.

    Raises
    ------
    DesignError
        A profile that is not symmetric.
    """
    for number, activation in enumerate(design.activations):
        growth = activation.growth
        if growth is None or growth.profile is None:
            continue
        for index, part in enumerate(design.parts):
            voxels = part_voxels(design, mesh, index) if part.label == activation.part else None
            if voxels is not None:
                _check_images(design, growth.profile, voxels, f"activations[{number}].profile")


def _check_images(design: Design, profile: Profile, voxels: PartVoxels, where: str) -> None:
    values = profile.values(voxels.centers)
    for number, plane in enumerate(design.symmetry):
        images = voxels.centers.copy()
        images[:, plane.axis] = 2.0 * plane.at - images[:, plane.axis]
        differences = np.abs(profile.values(images) - values)
        if differences.size and differences.max() > _SAME * max(1.0, np.abs(values).max()):
            x, y, z = (rounded(1e3 * c) for c in voxels.centers[int(differences.argmax())])
            raise DesignError(
                f"symmetry[{number}].plane",
                f"mirrors {where}, which has {values[int(differences.argmax())]:.3g} at ({x}, {y}, "
                f"{z}) mm, onto another value",
                "leave the plane out, or give a profile that is symmetric in it",
            )
