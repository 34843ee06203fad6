"""Voxels that stay large beside local refinement, and features that do not support it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design, Dielectric, Probe
from voxsoft.design.attachment import attachments_of
from voxsoft.errors import DesignError, ErrorDetail
from voxsoft.materials import Hyperelastic, Rigid
from voxsoft.simulation.places import voxel_size

if TYPE_CHECKING:
    from voxsoft.simulation.setup import Setup

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

    Parameters
    ----------
    setup
        A setup of a design with local refinement; its mesh has small voxels everywhere.

    Raises
    ------
    DesignError
        A refinement that catches nothing.
    """
    design, mesh = setup.design, setup.mesh
    count = len(mesh.tets) // 5
    corners, parts = mesh.voxel_corners(np.arange(count)), mesh.tet_part[::5]
    small = _asked_for(setup, corners, parts) | ~_may_be_large(design, mesh.fractions, parts)
    low = mesh.vertices.min(axis=0)
    keys = np.rint((mesh.vertices - low) / voxel_size(mesh)).astype(np.int64)
    groups, nodes = _cubes(keys, corners, parts)
    large = ~small[groups].any(axis=1) & ~_met(setup)[nodes].any(axis=1)
    for held in setup.clamped:
        large &= ~_held_in_part(held, nodes, len(mesh.vertices))
    return groups[large].astype(np.uint32)


def _may_be_large(
    design: Design, fractions: NDArray[np.float64] | None, parts: NDArray[np.uint8]
) -> Marks:
    """Mark the voxels that are full of rubber."""
    rubber = [isinstance(design.material_of(part), Hyperelastic) for part in design.parts]
    found = np.array([False, *rubber])[parts]
    return found if fractions is None else found & (np.abs(fractions - 1.0) < _FULL)


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


def _met(setup: Setup) -> Marks:
    """Mark the vertices of layers and springs, which must not be hanging nodes."""
    found = np.zeros(len(setup.mesh.vertices), dtype=bool)
    for layer in setup.layers:
        found[layer.all] = True
    for where, attachment in attachments_of(setup.design):
        for place in attachment.places:
            if isinstance(place, Probe):
                found[setup.place(place, where).vertices] = True
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


#: Entries of a design that local refinement does not support, and the reasons in words.
_UNKNOWN: Final = (
    ("symmetry", "solves a part of the body"),
    ("floor", "is a kind of contact"),
    ("objects", "are touched by surfaces"),
    ("contact", "is between surfaces"),
    ("supplies", "join all of a chamber's wall"),
    ("tendons", "pull at vertices on their way"),
)


def unknown_with_refinement(design: Design) -> Iterator[ErrorDetail]:
    """Find entries of a design that local refinement does not support."""
    if not design.refine:
        return
    hint = "leave it out, or write refine = 2 under [solver] for smaller voxels everywhere"
    for name, why in _UNKNOWN:
        if getattr(design, name):
            what = f"{why}, and local refinement (refine) is not known with that yet"
            yield ErrorDetail(name, what, hint)
    for index, part in enumerate(design.parts):
        material, where = design.material_of(part), f"parts[{index}].material"
        if not isinstance(material, (Hyperelastic, Rigid)):
            what = "is a spring lattice, and local refinement (refine) is known for rubber"
            yield ErrorDetail(where, what, "take a hyperelastic material, or leave refine out")
        elif isinstance(material, Hyperelastic) and material.mullins is not None:
            what = "softens, and local refinement (refine) is not known with that yet"
            yield ErrorDetail(f"{where}.mullins", what, hint)
        if any(fiber.is_wound for fiber in part.fibers):
            what = "are wound, and local refinement (refine) is not known with that yet"
            yield ErrorDetail(f"parts[{index}].fibers", what, hint)
    for index, activation in enumerate(design.activations):
        if isinstance(activation, Dielectric):
            what = "acts by a field, and local refinement (refine) is not known with that yet"
            yield ErrorDetail(f"activations[{index}]", what, hint)
        elif activation.growth is not None and activation.growth.profile is not None:
            what = (
                "differs within the part, and local refinement (refine) is not known with that yet"
            )
            yield ErrorDetail(f"activations[{index}].profile", what, hint)


def check_refinement(design: Design) -> None:
    """Raise an error where a design has entries that local refinement does not support.

    Raises
    ------
    DesignError
        Entries that are not supported, each by its name.
    """
    if found := list(unknown_with_refinement(design)):
        raise DesignError.listing(found)


def refuse_refinement(design: Design, who: str) -> None:
    """Raise an error where voxels are refined locally, which `who` does not support.

    Raises
    ------
    DesignError
        The design has local refinement.
    """
    if design.refine:
        what = f"local refinement is not known to {who} yet"
        hint = "solve the design by statics, or write refine = 2 under [solver]"
        raise DesignError("refine", what, hint)
