"""Surfaces of rigid objects at their poses, and their distance from a body."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.errors import DesignError
from voxsoft.mesh import Mesh
from voxsoft.records import closest
from voxsoft.simulation.setup.contact import Pose
from voxsoft.simulation.setup.distance import Surface, distances_to
from voxsoft.simulation.setup.rigid_objects import surface_of


def posed_surface(design: Design, name: str, pose: Pose | None) -> Surface:
    """Return the surface of an object of a design at a pose; at its initial one by default.

    A pose has the middle of the bounding box of the surface, and rotates about it.

    Raises
    ------
    DesignError
        No object has this name.
    """
    names = [each.name for each in design.objects]
    if name not in names:
        raise DesignError("object", f'there is no object "{name}"', closest(name, names))
    index = names.index(name)
    first = surface_of(design.objects[index], design, f"objects[{index}]")
    if pose is None:
        return first
    turned = (first.vertices - first.middle) @ np.asarray(pose.rotation).T
    return Surface(turned + np.asarray(pose.position), first.triangles)


def distance_between(mesh: Mesh, positions: NDArray[np.float64], surface: Surface) -> float:
    """Measure the smallest distance of a body and an object [m]; negative where they overlap.

    Distances are from the vertices of each to the triangles of the other, as in contact search.
    """
    body = Surface(positions, mesh.triangles.astype(np.uint32))
    own = positions[np.unique(mesh.triangles)]
    there, back = distances_to(surface, own), distances_to(body, surface.vertices)
    return float(min(there.min(), back.min()))
