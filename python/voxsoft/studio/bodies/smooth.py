"""The smooth surface of a design's shapes, as near to the voxels that are simulated as it goes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.discretization.cut_cells import built_parts
from voxsoft.errors import VoxSoftError
from voxsoft.shapes.tracing import trace
from voxsoft.voxels import Voxels


def pack_smooth(design: Design, voxels: Mapping[str, Voxels], topology: int) -> bytes | None:
    """Trace the surface of all parts of each body together, and write it as the page reads it.

    Parameters
    ----------
    design
        The design.
    voxels
        Voxels of each body by its name; of a design without bodies, by an empty one.
    topology
        The number of the picture that it belongs to.

    Returns
    -------
    bytes or None
        None where the shapes have no surface that could be traced finely enough, or the body is the
        mesh of a file.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.design.discretization.discretize import voxels_of
    >>> ball = families.sphere()
    >>> packed = pack_smooth(ball, {"": voxels_of(ball)}, 1)
    >>> packed is not None and packed[4]
    3
    """
    if not voxels:
        return None  # the surface of a file's mesh is drawn as it is
    design = design.assembled
    names = [part.body or "" for part in design.parts]
    poses = {body.name: body.pose for body in design.bodies}
    vertices, triangles, owners = [], [], []
    count = 0
    for name, own in voxels.items():
        try:
            traced = trace(built_parts(design.alone(name)), own)
        except VoxSoftError:
            return None
        if traced is None:
            return None
        rotation, position = poses.get(name, (np.eye(3), np.zeros(3)))
        vertices.append(traced[0] @ rotation.T + position)
        triangles.append(traced[1] + count)
        numbers = np.array([i for i, of in enumerate(names) if of == name], dtype=np.uint8)
        owners.append(numbers[traced[2]])
        count += len(traced[0])
    corners = np.concatenate(triangles).astype(np.uint32)
    return _core.pack_smooth(topology, np.concatenate(vertices), corners, np.concatenate(owners))
