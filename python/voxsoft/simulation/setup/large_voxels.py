"""Voxels that stay large beside local refinement."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design, Probe
from voxsoft.design.attachment import attachments_of
from voxsoft.design.refinement import TIMES_AS_SMALL
from voxsoft.errors import DesignError
from voxsoft.materials import Hyperelastic, Rigid
from voxsoft.simulation.features import has_feature
from voxsoft.simulation.setup.contact import has_contact
from voxsoft.simulation.setup.fluids import has_supplies
from voxsoft.simulation.setup.growth import parts_of
from voxsoft.simulation.setup.places import voxel_size
from voxsoft.simulation.setup.symmetry.sector import Sector

if TYPE_CHECKING:
    from voxsoft.simulation.setup.setup import Setup

Ints = NDArray[np.int64]
Marks = NDArray[np.bool_]

#: Tolerance of the filled fraction of a full voxel: one at the face of a box on the grid loses
#: 1/3072 where its fill is measured. The core asks for the same.
_FULL: Final = 4e-4

#: The vertices of a large voxel, by halves of its edge, and those among them that are its corners.
_NODES: Final = np.indices((3, 3, 3)).reshape(3, -1).T
_CORNERS: Final = np.flatnonzero((_NODES != 1).all(axis=1))


def large_voxels(setup: Setup) -> NDArray[np.uint32]:
    """Find the voxels that stay large: groups of eight voxels of the mesh, (g, 8).

    Voxels stay small where something other than their rubber acts: at surfaces that may touch, at
    chambers with gas or liquid of their own, on the way of tendons, in parts that are wound, swell
    unevenly or are dielectric, and in all of a body that softens.

    Parameters
    ----------
    setup
        A setup of a design with local refinement; its mesh has small voxels everywhere.

    Returns
    -------
    numpy.ndarray
        With planes of symmetry, those of the solved sector alone.

    Raises
    ------
    DesignError
        A refinement that catches nothing.
    """
    design, mesh = setup.design, setup.mesh
    if has_feature(design, "softening"):
        return np.zeros((0, 8), np.uint32)
    count = len(mesh.tets) // 5
    corners, parts = mesh.voxel_corners(np.arange(count)), mesh.tet_part[::5]
    full = _may_be_large(design, mesh.fractions, parts)
    groups, nodes = _cubes(_keys(setup), corners, parts)
    small = _asked_for(setup, corners, parts) | ~full
    if setup.sector is not None:
        small = _folded(setup.sector, small, corners)
    large = ~small[groups].any(axis=1) & ~_met(setup, corners, parts)[nodes].any(axis=1)
    for held in setup.clamped:
        large &= ~_held_in_part(held, nodes, len(mesh.vertices))
    if setup.sector is not None:
        large &= setup.sector.inside(nodes)
    return groups[large].astype(np.uint32)


def _keys(setup: Setup) -> Ints:
    """Number the vertices along the grid of small voxels, that of each body apart, (n, 3).

    Planes of symmetry through a single body have even numbers, so that no large voxel crosses them.
    """
    mesh = setup.mesh
    keys = np.empty(mesh.vertices.shape, dtype=np.int64)
    first = np.zeros(3, dtype=np.int64)
    for body in mesh.each_body:
        own, size = body.mesh.vertices, voxel_size(body.mesh)
        low = own.min(axis=0)
        steps = np.rint((own - low) / size).astype(np.int64)
        if not mesh.bodies:
            for plane in setup.design.symmetry:
                first[plane.axis] = round((plane.at - low[plane.axis]) / size) % 2
        keys[body.vertices] = steps + first
        first[0] += 2 * (int(steps[:, 0].max()) // 2 + 1)
    return keys


def _folded(sector: Sector, small: Marks, corners: NDArray[np.int32]) -> Marks:
    """Mark the voxels with an image among marked ones as well."""
    images = np.sort(sector.source[corners], axis=1)
    _, same = np.unique(images, axis=0, return_inverse=True)
    found: Marks = np.isin(same, same[small])
    return found


def _may_be_large(
    design: Design, fractions: NDArray[np.float64] | None, parts: NDArray[np.uint8]
) -> Marks:
    """Mark the voxels that are full of rubber, the same everywhere in its part."""
    other = _uneven_parts(design)
    rubber = [
        isinstance(design.material_of(part), Hyperelastic) and index not in other
        for index, part in enumerate(design.parts)
    ]
    found = np.array([False, *rubber])[parts]
    return found if fractions is None else found & (np.abs(fractions - 1.0) < _FULL)


def _uneven_parts(design: Design) -> set[int]:
    """Find the parts that differ from voxel to voxel: wound, grown unevenly, or in a field."""
    found = {
        index
        for index, part in enumerate(design.parts)
        if any(fiber.is_wound for fiber in part.fibers)
    }
    for number, activation in enumerate(design.activations):
        growth = activation.growth
        if growth is None or growth.profile is not None:
            found.update(parts_of(design, activation, f"activations[{number}].part"))
    return found


def _asked_for(setup: Setup, corners: NDArray[np.int32], parts: NDArray[np.uint8]) -> Marks:
    """Mark the voxels that are to be small."""
    design, mesh = setup.design, setup.mesh
    labels = np.array(["", *(part.label for part in design.parts)])
    found = np.zeros(len(corners), dtype=bool)
    for index, refinement in enumerate(design.refine):
        own: Marks = np.full(len(corners), fill_value=True)
        if refinement.region is not None:
            where = f"refine[{index}].region"
            caught = np.zeros(len(mesh.vertices), dtype=bool)
            caught[setup.vertices_in(refinement.region, where)] = True
            own = np.asarray(caught[corners].any(axis=1))
        if refinement.part is not None:
            own = np.logical_and(own, labels[parts] == refinement.part)
        if not own.any():
            what = "catches no voxel"
            raise DesignError(f"refine[{index}]", what, "widen the region, or leave the part out")
        found |= own
    return found


def _met(setup: Setup, corners: NDArray[np.int32], parts: NDArray[np.uint8]) -> Marks:
    """Mark the vertices that must not be hanging nodes: something other than rubber acts there."""
    design, mesh = setup.design, setup.mesh
    found = np.zeros(len(mesh.vertices), dtype=bool)
    for layer in setup.layers:
        found[layer.all] = True
    for where, attachment in attachments_of(design):
        for place in attachment.places:
            if isinstance(place, Probe):
                found[setup.place(place, where).vertices] = True
    for tendon in setup.tendons:
        for point in tendon.places:
            found[np.array(point.get("vertices", ()), dtype=np.int64)] = True
    for sheet in setup.dielectrics:
        found[sheet.corners] = True
    springs = [not isinstance(design.material_of(p), (Hyperelastic, Rigid)) for p in design.parts]
    found[corners[np.array([False, *springs])[parts]]] = True
    if design.floor is not None or has_contact(design):
        at_surface = np.zeros(len(mesh.vertices), dtype=bool)
        at_surface[mesh.triangles] = True
        found[corners[at_surface[corners].any(axis=1)]] = True
    if has_supplies(design):
        for cavity in mesh.cavities:
            found[cavity.triangles] = True
    return found


def _cubes(
    keys: Ints, corners: NDArray[np.int32], parts: NDArray[np.uint8]
) -> tuple[Ints, NDArray[np.int32]]:
    """Find eight voxels of one part that fill a cube of the large grid, (g, 8), and its vertices.

    The vertices are (g, 27), in the order of :data:`_NODES`.
    """
    low = keys[corners[:, 0]]
    large, place = low // 2, low % 2 @ np.array([4, 2, 1])
    shape = large.max(axis=0) + 1
    cube = np.ravel_multi_index(tuple(large.T), tuple(shape))
    order = np.lexsort((place, cube))
    _, first, counts = np.unique(cube[order], return_index=True, return_counts=True)
    groups = order[first[counts == 8][:, None] + np.arange(8)]
    alike = (parts[groups] == parts[groups[:, :1]]).all(axis=1)
    groups = groups[alike]
    nodes = np.empty((len(groups), len(_NODES)), dtype=np.int32)
    for number, node in enumerate(_NODES):
        # Along each axis the middle vertex is the lower corner of the upper voxel.
        voxel = (node > 0) @ np.array([4, 2, 1])
        corner = (node == 2) @ np.array([4, 2, 1])
        nodes[:, number] = corners[groups[:, voxel], corner]
    return groups, nodes


def _held_in_part(held: NDArray[np.uint32], nodes: NDArray[np.int32], vertices: int) -> Marks:
    """Mark the cubes with a held vertex between corners that are not all held, (g,)."""
    marks = np.zeros(vertices, dtype=bool)
    marks[held] = True
    caught = marks[nodes]
    found = np.zeros(len(nodes), dtype=bool)
    for number, node in enumerate(_NODES):
        leads = [c for c in _CORNERS if ((node == 1) | (_NODES[c] == node)).all()]
        found |= caught[:, number] & ~caught[:, leads].all(axis=1)
    return found


def evenly_small(design: Design, refine: int) -> Design:
    """Return a design with small voxels everywhere, for uses that take voxels of one size.

    Parameters
    ----------
    design
        The design; itself without local refinement.
    refine
        Number of parts that its voxels are cut into along each axis, where they stay large.
    """
    if not design.refine:
        return design
    solver = design.solver.replace(refine=TIMES_AS_SMALL * refine)
    return design.replace(refine=(), solver=solver)
