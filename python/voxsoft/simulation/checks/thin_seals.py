"""Chambers whose wall has no thickness somewhere: surfaces that meet in an edge or a corner."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import counted
from voxsoft.cavity import MeshCavity
from voxsoft.design import Design
from voxsoft.mesh import Mesh
from voxsoft.simulation.diagnostic import Diagnostic, near
from voxsoft.units import format_quantity

Ints = NDArray[np.int64]

#: Tolerance of the filled fraction of a full voxel: as where voxels are refined.
_FULL = 4e-4


def thin_seals(
    design: Design | None, mesh: Mesh, positions: NDArray[np.float64] | None = None
) -> Iterator[Diagnostic]:
    """Find chambers that are sealed only along edges or at corners of voxels.

    The air inside and outside the chamber then shares vertices: between them is no wall.

    Parameters
    ----------
    design
        Not used.
    mesh
        The body; where its layers close a chamber, their rims are no seal of voxels.

    Yields
    ------
    Diagnostic
        One for each such chamber, at its first such place.

    Examples
    --------
    >>> import voxsoft as vs
    >>> room = vs.Box(size=(0.012, 0.012, 0.012), corner=(0.004, 0.004, 0.004))
    >>> notch = vs.Box(size=(0.004, 0.004, 0.008), corner=(0, 0, 0.006))
    >>> body = vs.Box(size=(0.02, 0.02, 0.02)) - room - notch
    >>> print(*thin_seals(None, vs.voxelize(body, 0.002).mesh()))  # doctest: +ELLIPSIS
    cavity 0: the chamber is sealed only along edges of voxels, 8 mm long, near (4, 4, 6) mm: ...
    """
    if not mesh.cavities:
        return
    faces = np.sort(np.asarray(mesh.triangles, dtype=np.int64), axis=1)
    for index, cavity in enumerate(mesh.cavities):
        name = cavity.name or f"cavity {index}"
        found = _seal(faces, cavity, mesh)
        if found is not None:
            yield Diagnostic("warning", name, *found)


def _seal(
    faces: Ints, cavity: MeshCavity, mesh: Mesh
) -> tuple[str, str, tuple[float, float, float]] | None:
    own = np.sort(np.asarray(cavity.triangles, dtype=np.int64), axis=1)
    count = len(mesh.vertices)
    codes, keys = (_codes(each, count) for each in (own, faces))
    # A face of the chamber that is none of the body is of a layer, which the body holds by its rim.
    of_body = np.isin(codes, keys)
    shared = np.zeros(count, dtype=bool)
    shared[own] = True
    others = np.zeros(count, dtype=bool)
    others[faces[~np.isin(keys, codes)]] = True
    shared &= others
    shared[own[~of_body]] = False
    if not shared.any():
        return None
    edges = np.unique(own[:, [0, 1, 1, 2, 0, 2]].reshape(-1, 2), axis=0)
    outer = np.unique(faces[~np.isin(keys, codes)][:, [0, 1, 1, 2, 0, 2]].reshape(-1, 2), axis=0)
    both = edges[np.isin(edges[:, 0] * count + edges[:, 1], outer[:, 0] * count + outer[:, 1])]
    both = both[shared[both].all(axis=1)]
    if len(both):
        length = float(np.linalg.norm(np.diff(mesh.vertices[both], axis=1), axis=2).sum())
        words = format_quantity(float(f"{length:.3g}"), "length")
        how, first = f"along edges of voxels, {words} long", int(both.min())
    else:
        shared &= ~_cut(mesh)
        if not shared.any():
            return None
        how = f"at {counted(int(shared.sum()), 'corner')} of voxels"
        first = int(np.flatnonzero(shared)[0])
    x, y, z = mesh.vertices[first].tolist()
    what = f"the chamber is sealed only {how}, {near((x, y, z))}: there the wall has no thickness"
    return what, "thicken the wall there by a voxel, or make the voxels smaller", (x, y, z)


def _cut(mesh: Mesh) -> NDArray[np.bool_]:
    """Mark vertices of cut voxels: the surface is not at their corners, (n,)."""
    found = np.zeros(len(mesh.vertices), dtype=bool)
    if mesh.fractions is not None and mesh.tet_voxel is not None:
        is_cut = np.abs(mesh.fractions - 1.0) > _FULL
        found[mesh.tets[is_cut[mesh.tet_voxel]]] = True
    return found


def _codes(triangles: Ints, count: int) -> Ints:
    """Number each triangle of ordered vertices."""
    a, b, c = triangles.T
    codes: Ints = (a * count + b) * count + c
    return codes
