"""Forces of a uniform magnetic field on parts that are hard magnets."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.errors import DesignError
from voxsoft.mesh import Mesh
from voxsoft.simulation.loads.actions import Vertices

Floats = NDArray[np.float64]

#: Permeability of vacuum in N/A² (CODATA 2018; 4π·1e-7 to nine digits).
VACUUM_PERMEABILITY: Final = 1.25663706212e-6


def magnet_forces(design: Design, mesh: Mesh, field: Floats, where: str) -> tuple[Vertices, Floats]:
    """Return the forces of a uniform field on the vertices of the parts that have a remanence.

    A hard magnet of remanence Bʳ stores −(F Bʳ)·B/μ₀ for each undeformed volume in a field B
    (Zhao et al. 2019, doi:10.1016/j.jmps.2018.10.008). This is linear in the positions: vertex a
    feels the dead force (B/μ₀) ∫ Bʳ·∇Nₐ dV, whatever the shape that the body takes. The integral
    of the trilinear Nₐ over the material of a voxel is exact by its moments, also where the surface
    cuts it.

    Parameters
    ----------
    design
        The design whose parts have the remanence.
    mesh
        Its voxels.
    field
        Flux density B, (3,), T.
    where
        The place of the load, for messages.

    Returns
    -------
    vertices : ndarray of uint32, shape (v,)
        Vertices of the magnets.
    forces : ndarray of float64, shape (v, 3)
        Force on each of them, N; their sum is zero.

    Raises
    ------
    DesignError
        No part with voxels has a remanence, or the field or a remanence points out of a plane of
        symmetry.

    Examples
    --------
    >>> import numpy as np
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> beam = families.beam()
    >>> part = beam.parts[0].replace(remanence=("0.1 T", 0, 0))
    >>> beam = beam.replace(parts=[part])
    >>> vertices, forces = magnet_forces(beam, vs.mesh_of(beam), np.array([0, 0, 0.02]), "loads[0]")
    >>> bool(abs(forces.sum(axis=0)).max() < 1e-12)
    True
    """
    _check_symmetry(design, field, where)
    slopes = np.zeros(len(mesh.vertices))
    touched = np.zeros(len(mesh.vertices), dtype=bool)
    for index, part in enumerate(design.parts):
        if part.remanence is None or not any(part.remanence):
            continue
        for body in mesh.each_body:
            # Parts of a body alone are numbered within it; those of the joined mesh, in the design.
            tets = slice(body.first_tet, body.first_tet + len(body.mesh.tets))
            numbers = np.flatnonzero(mesh.tet_part[tets][::5] == index + 1)
            corners, gradients = body.mesh.voxel_gradients(numbers)
            corners = corners + body.first_vertex
            np.add.at(slopes, corners, gradients @ np.asarray(part.remanence))
            touched[corners] = True
    if not touched.any():
        raise DesignError(
            where,
            "a magnetic field acts on hard magnets, and no part of the mesh has a remanence",
            'give one to a part: remanence = ["100 mT", 0, 0]',
        )
    vertices = np.flatnonzero(touched).astype(np.uint32)
    return vertices, np.outer(slopes[vertices], field / VACUUM_PERMEABILITY)


def _check_symmetry(design: Design, field: Floats, where: str) -> None:
    """Refuse a field or remanence across a plane of symmetry: its sides would not mirror."""
    for plane in design.symmetry:
        what = f"points across the plane of symmetry of {plane.plane}"
        hint = "leave this plane out, or turn field and remanence into it"
        if field[plane.axis]:
            raise DesignError(f"{where}.value", what, hint)
        for index, part in enumerate(design.parts):
            if part.remanence is not None and part.remanence[plane.axis]:
                raise DesignError(f"parts[{index}].remanence", what, hint)
