"""Volume that a body displaces, and a warning where it comes out of its liquid."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design, Immersion
from voxsoft.materials import CompliantLattice, Lattice
from voxsoft.mesh import Mesh
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.units import format_quantity

#: Corners of a voxel with an odd number of steps from its first one.
_ODD: Final = np.array([1, 2, 4, 7])
_EVEN: Final = np.array([0, 3, 5, 6])


def _five(middle: NDArray[np.int_]) -> NDArray[np.int_]:
    """Return the five tets around a middle one, of positive volume, (5, 4)."""
    places = np.array([[c >> 2 & 1, c >> 1 & 1, c & 1] for c in range(8)])
    tets = [middle]
    for corner in np.setdiff1d(np.arange(8), middle):
        near = middle[np.abs(places[middle] - places[corner]).sum(axis=1) == 1]
        tets.append(np.array([corner, *near]))
    found = np.array(tets)
    volumes = np.linalg.det(places[found[:, 1:]] - places[found[:, :1]])
    found[volumes < 0.0] = found[volumes < 0.0][:, [0, 1, 3, 2]]
    return found


_EVEN_TETS: Final = _five(_EVEN)
_ODD_TETS: Final = _five(_ODD)


def filled_parts(mesh: Mesh) -> NDArray[np.float64]:
    """Return the part of each tet that is material, (m,)."""
    if mesh.fractions is None or mesh.tet_voxel is None:
        return np.ones(len(mesh.tets))
    filled: NDArray[np.float64] = mesh.fractions[mesh.tet_voxel]
    return filled


def other_tets(design: Design, mesh: Mesh) -> NDArray[np.int32]:
    """Return the tets of the other split of each voxel into five, (m, 4).

    The lattice material is its five tetrahedra: its voxels keep theirs, as do tets of a file.

    Parameters
    ----------
    design, mesh
        A design and its mesh.
    """
    if mesh.tet_voxel is None:
        return mesh.tets
    split = mesh.tets.copy()
    middle = mesh.tets.reshape(-1, 5, 4)
    corners = mesh.voxel_corners(np.arange(len(middle)))
    # The middle tet of a split has the corners of one parity: four bits of c count in (x, y, z).
    is_odd = (middle[:, :, None, :] == corners[:, _ODD][:, None, :, None]).any(axis=2)
    has_odd_middle = is_odd.all(axis=2).any(axis=1)
    materials = [design.material_of(part) for part in design.parts]
    has_tets = np.array([isinstance(each, Lattice | CompliantLattice) for each in materials])
    changes = ~has_tets[mesh.tet_part[::5].astype(np.intp) - 1]
    for odd, table in ((True, _EVEN_TETS), (False, _ODD_TETS)):
        chosen = np.flatnonzero(changes & (has_odd_middle == odd))
        rows = (5 * chosen[:, None] + np.arange(5)).ravel()
        split[rows] = corners[chosen][:, table].reshape(-1, 4)
    return split


def surfaced(design: Design, mesh: Mesh, positions: NDArray[np.float64]) -> Iterator[Diagnostic]:
    """Find loads of immersion whose liquid the body is above, which pulls at it there.

    Parameters
    ----------
    design, mesh
        The body.
    positions
        Its vertices in m, (n, 3).
    """
    top = float(positions[:, 2].max())
    for index, load in enumerate(design.loads):
        if isinstance(load, Immersion) and top - load.level > 1e-6 * float(np.ptp(mesh.vertices)):
            shown = format_quantity(float(f"{top - load.level:.3g}"), "length")
            what = f"the body is {shown} above the surface of the liquid, which pulls at it there"
            hint = "raise the level, or hold the body below it"
            yield Diagnostic("warning", f"loads[{index}].level", what, hint)
