"""Overlaps of a designed body, with its layers and cut voxels, and warnings of them."""

from __future__ import annotations

import hashlib
import weakref
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.design.discretization.cut_cells import built_parts
from voxsoft.mesh import Mesh
from voxsoft.simulation.checks.penetration import (
    FILM,
    FLOOR,
    Overlap,
    Penetration,
    find_penetration,
    point,
)
from voxsoft.simulation.diagnostic import Diagnostic, near
from voxsoft.simulation.setup.contact import keeps_apart
from voxsoft.simulation.setup.layers import all_layer_triangles
from voxsoft.simulation.setup.places import voxel_size
from voxsoft.simulation.setup.skin import touches_with_skin

#: Largest apparent penetration of surfaces that contact keeps apart, in voxels. Contact meets the
#: faces as they warp, and overlaps are found with two triangles for each, from which bulging faces
#: differ by some hundredths. Distances of shapes from the faces of the voxels are those of the
#: unloaded body, up to 0.9 voxels, which strains of a quarter change by as much. Surfaces that pass
#: through a wall are deeper.
TOUCHING: Final = 0.25

Floats = NDArray[np.float64]

#: Depths below this part of a voxel are left out: solvers leave positions at rest open by about as
#: much (a residual of 1e-6 of the load moves a body by 1e-6 of its displacement, which is of the
#: size of a voxel or more), and surfaces that merely touch then overlap by it.
NEGLIGIBLE: Final = 1e-6


def penetration_of(design: Design, mesh: Mesh, positions: Floats) -> Penetration:
    """Find where the body of a design overlaps itself, its films or its floor.

    Overlaps are those of :func:`find_penetration`. Where voxels are cut, and where a body touches
    with its smooth surface, the surface that counts is that of the shapes, carried along by the
    voxels. Surfaces that contact keeps apart overlap if they are more than :data:`TOUCHING` deep.
    Positions that are not finite overlap nothing: the status of a result reports them.

    Parameters
    ----------
    design, mesh
        The body.
    positions
        Its vertices in m, (n, 3).
    """
    if not np.isfinite(positions).all():
        return Penetration()
    # The metrics, the record and the warnings of a result all need the same penetration.
    digest = hashlib.blake2b(np.ascontiguousarray(positions).tobytes()).digest()
    for known_design, known_mesh, known_digest, found in _latest:
        if known_design() is design and known_mesh() is mesh and known_digest == digest:
            return found
    membranes = None
    if any(layer.seal for layer in design.layers):
        layers = all_layer_triangles(design, mesh)
        membranes = np.concatenate([layer.spanning for layer in layers])
    floor = None if design.floor is None else design.floor.z
    found = find_penetration(mesh, positions, membranes=membranes, floor=floor)
    smooth = any(
        touches_with_skin(design, design.alone(body.name), body.mesh) for body in mesh.each_body
    )
    if mesh.fractions is not None or smooth:
        found = _of_shapes(design, mesh, positions, found)
    if keeps_apart(design):
        found = _beyond_contact(design, mesh, found, smooth)
    _latest[:] = [(weakref.ref(design), weakref.ref(mesh), digest, found)]
    return found


_latest: list[
    tuple[weakref.ReferenceType[Design], weakref.ReferenceType[Mesh], bytes, Penetration]
] = []


def overlap_warnings(design: Design, mesh: Mesh, positions: Floats) -> Iterator[Diagnostic]:
    """Warn of overlaps of a body with itself or its floor (a check of :data:`CHECKS`).

    One warning for each two parts that overlap, the deepest first.
    """
    least = NEGLIGIBLE * voxel_size(mesh)
    groups: dict[tuple[bool, frozenset[int]], list[Overlap]] = {}
    for overlap in penetration_of(design, mesh, positions).overlaps:
        if overlap.inverted or overlap.depth > least:
            groups.setdefault((overlap.inverted, frozenset(overlap.parts)), []).append(overlap)
    for (inverted, _), reported in groups.items():
        deepest = reported[0]
        where, what = _turned(design, deepest) if inverted else overlapping(design, deepest)
        what += f" {near(deepest.at_rest)}"
        if len(reported) > 1:
            what += f" and at {len(reported) - 1} more place{'s' if len(reported) > 2 else ''}"
        hint = "lower the load"
        if not inverted and keeps_apart(design):
            what += "; contact has not kept them apart"
            hint += ", or take smaller voxels or shorter steps"
        elif not inverted:
            what += "; contact is not simulated"
            hint += ", or leave more room there"
        yield Diagnostic("warning", where, what, hint, deepest.at_rest)


def overlapping(design: Design, overlap: Overlap) -> tuple[str, str]:
    """Describe the parts that overlap, and the depth."""
    by = f"by {overlap.depth * 1e3:.2g} mm"
    names = [part_name(design, part) for part in overlap.parts]
    if overlap.parts[1] == FLOOR:
        return names[0], f"is below the floor {by}"
    if names[0] == names[1]:
        return names[0], f"walls overlap {by}"
    return " and ".join(names), f"overlap {by}"


def _turned(design: Design, overlap: Overlap) -> tuple[str, str]:
    return part_name(design, overlap.parts[0]), "the surface is turned inside out"


def part_name(design: Design, part: int) -> str:
    """Return the name of a part in messages, counted from 1."""
    if part == FLOOR:
        return "floor"
    if part == FILM:
        return "layer"
    found = design.parts[part - 1]
    if found.name is not None:
        return found.name
    return found.shape if isinstance(found.shape, str) else f"parts[{part - 1}]"


def _beyond_contact(design: Design, mesh: Mesh, found: Penetration, smooth: bool) -> Penetration:
    """Keep overlaps that surfaces in contact, `smooth` or not, do not explain."""
    most = TOUCHING * voxel_size(mesh)
    kept = []
    for index, overlap in enumerate(found.overlaps):
        if smooth and overlap.parts[1] == FLOOR:
            # Its lowest vertex may be that far outside of the shapes, which the floor meets.
            outside = float(_distances(design, mesh, np.array([overlap.at_rest]))[0])
            beyond = overlap.depth - max(outside, 0.0)
        else:
            beyond = overlap.depth
        if overlap.inverted or beyond > most:
            kept.append((index, replace(overlap, depth=beyond)))
    return _kept(found, kept)


def _kept(found: Penetration, kept: list[tuple[int, Overlap]]) -> Penetration:
    """Select overlaps by their numbers, the deepest first."""
    kept = sorted(kept, key=lambda entry: -entry[1].depth)
    renumbered = {index: number for number, (index, _) in enumerate(kept)}
    covered = [[v, t, renumbered[r]] for v, t, r in found.covered.tolist() if r in renumbered]
    rows = np.array(covered, dtype=np.int32).reshape(-1, 3)
    return Penetration(tuple(overlap for _, overlap in kept), found.pairs, rows)


def _of_shapes(design: Design, mesh: Mesh, positions: Floats, found: Penetration) -> Penetration:
    """Correct overlaps of voxels to those of the shapes within cut voxels.

    Two points coincide at an overlap: one of the surface of the voxels, outside the shapes by a
    distance, and one inside by another, both unloaded. The shapes overlap by the second less the
    first.
    """
    if not found.overlaps:
        return found
    vertices, tets, numbers = found.covered.T
    surface = mesh.vertices[vertices]
    inside = _rest_places(mesh, positions, positions[vertices], tets)
    ends = [(overlap.at_rest, overlap.against) for overlap in found.overlaps]
    first = np.concatenate([surface, [start for start, _ in ends]])
    second = np.concatenate([inside, [end for _, end in ends]])
    now = np.concatenate([positions[vertices], [overlap.at_now for overlap in found.overlaps]])
    owner = np.concatenate([numbers, np.arange(len(ends))])
    depths = -_distances(design, mesh, first) - _distances(design, mesh, second)
    kept: list[tuple[int, Overlap]] = []
    for index, overlap in enumerate(found.overlaps):
        if overlap.inverted or overlap.parts[1] == FLOOR:
            kept.append((index, overlap))
            continue
        mine = np.flatnonzero(owner == index)
        best = int(mine[np.argmax(depths[mine])])
        if depths[best] > 0.0:
            moved = replace(
                overlap,
                depth=float(depths[best]),
                at_rest=point(first[best]),
                against=point(second[best]),
                at_now=point(now[best]),
            )
            kept.append((index, moved))
    return _kept(found, kept)


def _rest_places(mesh: Mesh, positions: Floats, points: Floats, tets: NDArray[np.int32]) -> Floats:
    """Map points in deformed tetrahedra to the unloaded body, (c, 3)."""
    corners = mesh.tets[tets]
    now, rest = positions[corners], mesh.vertices[corners]
    frames = np.swapaxes(now[:, 1:] - now[:, :1], 1, 2)
    inner = np.linalg.solve(frames, (points - now[:, 0])[..., None])
    before: Floats = rest[:, 0] + (np.swapaxes(rest[:, 1:] - rest[:, :1], 1, 2) @ inner)[..., 0]
    return before


def _distances(design: Design, mesh: Mesh, points: Floats) -> Floats:
    """Estimate signed distances from the shapes to first order: negative inside, (c,)."""
    if mesh.bodies:
        # Points are at the surface of their body or in it, and bodies are apart: it is the nearest.
        each = ((body, design.alone(body.name)) for body in mesh.bodies)
        found = [_distances(own, body.mesh, body.own(points)) for body, own in each]
        nearest: Floats = np.min(found, axis=0)
        return nearest
    shapes = built_parts(design)
    step = 0.01 * voxel_size(mesh)
    around = np.concatenate([np.zeros((1, 3)), step * np.eye(3), -step * np.eye(3)])
    levels = np.min(
        [shape.evaluate((points[:, None] + around).reshape(-1, 3)) for shape in shapes], axis=0
    ).reshape(-1, 7)
    slope = np.linalg.norm(levels[:, 1:4] - levels[:, 4:], axis=1) / (2.0 * step)
    distances: Floats = levels[:, 0] / np.maximum(slope, 1e-6)
    return distances
