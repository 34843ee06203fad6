"""Reaction forces and moments of supports: of each clamp, and of all supports in a region."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design, Region
from voxsoft.design.clamp import clamp_names
from voxsoft.mesh import Mesh
from voxsoft.simulation.setup.places import on_the_body, vertices_in

Floats = NDArray[np.float64]
#: A force in N along x, y and z.
Force = tuple[float, float, float]


def clamped_vertices(
    design: Design, mesh: Mesh, points: Floats | None = None
) -> list[NDArray[np.uint32]]:
    """Find the vertices of each clamp; errors as for :func:`vertices_in`.

    Parameters
    ----------
    design, mesh
        The body.
    points
        Positions of the vertices for this test, from :func:`on_the_body`; default: computed here.
    """
    points = on_the_body(design, mesh) if points is None else points
    return [
        vertices_in(clamp.region, mesh, design.shapes, f"clamps[{index}].region", points)
        for index, clamp in enumerate(design.clamps)
    ]


def clamp_reactions(
    design: Design, clamped: Sequence[NDArray[np.uint32]], reactions: Floats
) -> dict[str, Force]:
    """Compute the reaction force of each clamp on the body, by its name.

    Parameters
    ----------
    design, clamped, reactions
        See :func:`forces_of_clamps`.
    """
    found = forces_of_clamps(design, clamped, reactions)
    return {name: force_of(forces) for name, forces in found.items()}


def forces_of_clamps(
    design: Design, clamped: Sequence[NDArray[np.uint32]], reactions: Floats
) -> dict[str, Floats]:
    """Divide the reaction forces on all vertices among the clamps, (n, 3) by name.

    The last of several clamps that hold the same axis of a vertex prescribes its position, and has
    its reaction: all of them together count each force once.

    Parameters
    ----------
    design
        The design with the clamps.
    clamped
        Vertices of each clamp.
    reactions
        Reaction forces on all vertices, (n, 3), N.
    """
    decides = np.full(reactions.shape, -1)
    for number, (clamp, vertices) in enumerate(zip(design.clamps, clamped, strict=True)):
        held = np.array(["xyz".index(axis) for axis in clamp.axes])
        decides[np.ix_(vertices, held)] = number
    return {
        name: np.where(decides == number, reactions, 0.0)
        for number, name in enumerate(clamp_names(design.clamps))
    }


def reaction_in(design: Design, mesh: Mesh, region: Region, reactions: Floats) -> Force:
    """Compute the reaction force of all supports of the vertices in a region.

    Parameters
    ----------
    design, mesh
        The body.
    region
        A region of the unloaded body.
    reactions
        Reaction forces on all vertices, (n, 3), N.

    Raises
    ------
    DesignError
        The region catches nothing.
    """
    points = on_the_body(design, mesh)
    return force_of(reactions[vertices_in(region, mesh, design.shapes, "region", points)])


def support_moment(
    design: Design,
    mesh: Mesh,
    positions: Floats,
    reactions: Floats,
    about: Force,
    *,
    clamp: str | None = None,
    region: Region | None = None,
) -> Force:
    """Compute the moment of the clamps on the body about a point, N m.

    Parameters
    ----------
    design, mesh
        The body.
    positions
        Vertices where the forces act, (n, 3), m.
    reactions
        Reaction forces on all vertices, (n, 3), N.
    about
        The point, m.
    clamp, region
        Name of the only clamp that counts, or a region of the unloaded body; default: all.

    Raises
    ------
    DesignError
        The region catches nothing.
    """
    forces = reactions
    if clamp is not None:
        forces = forces_of_clamps(design, clamped_vertices(design, mesh), reactions)[clamp]
    if region is not None:
        points = on_the_body(design, mesh)
        caught = vertices_in(region, mesh, design.shapes, "region", points)
        forces, positions = forces[caught], positions[caught]
    return force_of(np.cross(positions - np.asarray(about), forces))


def force_of(forces: Floats) -> Force:
    """Sum forces on vertices, (k, 3), N; or moments, N m."""
    x, y, z = forces.sum(axis=0).tolist()
    return x, y, z
