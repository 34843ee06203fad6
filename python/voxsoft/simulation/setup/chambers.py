"""Named chambers of a design as cavities of its mesh."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.cavity import MeshCavity
from voxsoft.design import Chamber, Design
from voxsoft.errors import DesignError, ErrorDetail, NoCavityError
from voxsoft.mesh import Mesh
from voxsoft.metrics import Target
from voxsoft.shapes import Shape
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.simulation.loads import readings
from voxsoft.simulation.setup.missing_cavity import why_no_cavity
from voxsoft.simulation.setup.places import inside_region, is_named, voxel_size
from voxsoft.units import format_quantity

Floats = NDArray[np.float64]

#: Relative difference of volumes up to which cavities may swap indices when a parameter changes.
ALIKE: Final = 0.1


def with_chamber_names(design: Design, mesh: Mesh) -> Mesh:
    """Give the cavities of a mesh the names of the design's chambers.

    Parameters
    ----------
    design
        The design with its chambers; :func:`check_chambers` reports those that are left out.
    mesh
        Its mesh, with the chambers that layers close.
    """
    if not design.chambers:
        return mesh
    names, _ = _named_cavities(design, mesh)
    cavities = [replace(each, name=names.get(i, "")) for i, each in enumerate(mesh.cavities)]
    return replace(mesh, cavities=tuple(cavities))


def check_chambers(design: Design, mesh: Mesh) -> None:
    """Check that every named chamber is a cavity of its own.

    Raises
    ------
    NoCavityError
        A chamber that is no cavity, with the nearest cavity.
    DesignError
        Two names for one cavity, or a region that holds several.
    """
    _, errors = _named_cavities(design, mesh)
    if errors and not mesh.cavities:
        why, hint = why_no_cavity(design, mesh)
        what = f"there is no enclosed cavity to name: {why}"
        raise NoCavityError.listing(
            ErrorDetail(f"chambers.{name}", what, hint) for name in design.chambers
        )
    if errors:
        missing = any(isinstance(error, NoCavityError) for error in errors)
        kind = NoCavityError if missing else DesignError
        raise kind.listing(problem for error in errors for problem in error.problems)


def _named_cavities(design: Design, mesh: Mesh) -> tuple[dict[int, str], list[DesignError]]:
    """Return names of cavities by index, and the errors of the other chambers."""
    names: dict[int, str] = {}
    errors: list[DesignError] = []
    for name, chamber in design.chambers.items():
        where = f"chambers.{name}"
        try:
            index = _cavity_of(chamber, mesh, design.shapes, where)
        except DesignError as error:
            errors.append(error)
            continue
        if index in names:
            what = f'is the same cavity as "{names[index]}"'
            errors.append(DesignError(where, what, "keep one name, or move one of the places"))
        else:
            names[index] = name
    return names, errors


def center_of(cavity: MeshCavity, mesh: Mesh) -> Floats:
    """The center of a cavity's unloaded air, (3,), m."""
    corners = mesh.vertices[cavity.triangles]
    origin = corners.reshape(-1, 3).mean(axis=0)
    a, b, c = (corners - origin).transpose(1, 0, 2)
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c))  # six times, of tets to the origin
    center: Floats = origin + (volumes @ (a + b + c)) / (4.0 * volumes.sum())
    return center


def ambiguous_indices(design: Design, mesh: Mesh) -> Iterator[Diagnostic]:
    """Warn of cavities chosen by an index where others have almost the same volume.

    Parameters
    ----------
    design, mesh
        A design and its mesh, with names.
    """
    volumes = [float(cavity.volume) for cavity in mesh.cavities]
    for where, index in indices_used(design):
        if index >= len(volumes):
            continue
        alike = [
            other
            for other, volume in enumerate(volumes)
            if other != index and abs(volume - volumes[index]) <= ALIKE * volumes[index]
        ]
        if not alike:
            continue
        others = ", ".join(str(other) for other in alike)
        center = center_of(mesh.cavities[index], mesh)
        x, y, z = (float(value) for value in center)
        point = ", ".join(f'"{format_quantity(float(f"{v:.3g}"), "length")}"' for v in (x, y, z))
        yield Diagnostic(
            "warning",
            where,
            f"is {index}, and cavities are counted by their volume: {others} "
            f"{'is' if len(alike) == 1 else 'are'} within {ALIKE:.0%} of it, so that a small "
            "change of the shape may mean another one",
            f"name it by its place: [chambers] NAME = {{ point = [{point}] }}",
            (x, y, z),
        )


def indices_used(design: Design) -> list[tuple[str, int]]:
    """List the places in a design that choose a cavity by its index, and the index."""
    targets: dict[str, Mapping[str, Target]] = {
        "objectives": design.objectives,
        "constraints": design.constraints,
    }
    found: list[tuple[str, str | int | None]] = [
        (f"loads[{number}].cavity", load.cavity) for number, load in enumerate(readings(design))
    ]
    for table, entries in targets.items():
        found += [(f"{table}.{name}.cavity", each.cavity) for name, each in entries.items()]
    for number, supply in enumerate(design.supplies):
        found += [(f"supplies[{number}].chamber", choice) for choice in supply.choices]
    for number, connection in enumerate(design.connections):
        found += [(f"connections[{number}].chambers", each) for each in connection.chambers]
    return [(where, choice) for where, choice in found if isinstance(choice, int)]


def _cavity_of(chamber: Chamber, mesh: Mesh, shapes: Mapping[str, Shape], where: str) -> int:
    if not mesh.cavities:
        what = "there is no enclosed cavity to name"
        raise NoCavityError(where, what, "`voxsoft check` shows where a chamber leaks")
    own = next((body for body in mesh.bodies if body.name == chamber.body), None)
    if own is not None and not any(each.body == own.name for each in mesh.cavities):
        what = f'there is no enclosed cavity in the body "{own.name}" to name'
        raise NoCavityError(where, what, "`voxsoft check` shows where a chamber leaks")
    if chamber.point is not None:
        point = np.asarray(chamber.point)
        return _around(point if own is None else own.placed(point), mesh, where)
    shares = [_share_inside(chamber, cavity, mesh, shapes) for cavity in mesh.cavities]
    held = [index for index, share in enumerate(shares) if share > 0.5]
    if len(held) > 1:
        what = f"the region holds {len(held)} cavities"
        raise DesignError(where, what, "make it smaller, or give a point in one of them")
    if not held:
        raise NoCavityError(
            where,
            f"the region holds no cavity; {_listed(mesh)}",
            "widen it until most of the chamber's wall is in it, or give a point in the chamber",
        )
    return held[0]


def _around(point: Floats, mesh: Mesh, where: str) -> int:
    """Return the cavity that contains a point, or else the only one within half a voxel."""
    gaps = [_distance(point, mesh.vertices[cavity.triangles]) for cavity in mesh.cavities]
    nearest, *others = sorted(range(len(gaps)), key=gaps.__getitem__)
    reach = 0.5 * voxel_size(mesh)
    if gaps[nearest] < 0.0 or (
        gaps[nearest] <= reach and all(gaps[other] > reach for other in others)
    ):
        return nearest
    shown = _shown(point)
    gap = format_quantity(float(f"{gaps[nearest]:.3g}"), "length")
    raise NoCavityError(
        where,
        f"the point ({shown}) is in no cavity; the nearest is {gap} away, around "
        f"({_shown(center_of(mesh.cavities[nearest], mesh))})",
        "move the point into the air of the chamber",
    )


def _distance(point: Floats, corners: Floats) -> float:
    """Measure the distance of a point from a closed surface [m], negative inside."""
    import igl

    points, faces = corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3)
    nearest, winding = igl.AABB(), igl.FastWindingNumberBVH()
    nearest.init(points, faces)
    winding.init(points, faces)
    square, _, _ = nearest.squared_distance(points, faces, point[None])
    is_inside = abs(np.atleast_1d(winding.winding_number(point[None]))[0]) > 0.5
    return float(np.sqrt(np.atleast_1d(square)[0])) * (-1.0 if is_inside else 1.0)


def _share_inside(
    chamber: Chamber, cavity: MeshCavity, mesh: Mesh, shapes: Mapping[str, Shape]
) -> float:
    if chamber.body not in (None, cavity.body):
        return 0.0
    corners = mesh.vertices[cavity.triangles]
    reach = 0.5 * voxel_size(mesh)
    for body in mesh.bodies:
        if body.name == cavity.body:
            reach = 0.5 * voxel_size(body.mesh)
            if chamber.body is not None:
                corners = body.own(corners)
    a, b, c = corners.transpose(1, 0, 2)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    held = inside_region(chamber, corners.mean(axis=1), shapes, reach)
    held &= is_named(chamber, mesh)[cavity.triangles].all(axis=1)
    return float(areas[held].sum() / areas.sum())


def _listed(mesh: Mesh) -> str:
    centers = ", ".join(f"({_shown(center_of(cavity, mesh))})" for cavity in mesh.cavities[:5])
    count = len(mesh.cavities)
    return f"there {'is 1' if count == 1 else f'are {count}'}, around {centers}"


def _shown(point: Floats) -> str:
    return ", ".join(format_quantity(float(f"{v:.3g}"), "length") for v in point)
