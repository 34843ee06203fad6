"""The smooth surface of a design's shapes, as near to the voxels that are simulated as it goes."""

from __future__ import annotations

import numpy as np

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.errors import VoxSoftError
from voxsoft.shapes.tracing import trace
from voxsoft.voxels import Voxels


def pack_smooth(design: Design, voxels: Voxels, topology: int) -> bytes | None:
    """Trace the surface of all parts of a design together, and write it as the page reads it.

    Returns
    -------
    bytes or None
        None where the shapes have no surface that could be traced finely enough.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.design.discretize import voxels_of
    >>> ball = families.sphere()
    >>> packed = pack_smooth(ball, voxels_of(ball), 1)
    >>> packed is not None and packed[4]
    3
    """
    named = [
        design.shapes[part.shape] if isinstance(part.shape, str) else part.shape
        for part in design.parts
    ]
    try:
        shapes = [shape.build(design.shapes) for shape in named]
        traced = trace(shapes, voxels)
    except VoxSoftError:
        return None
    if traced is None:
        return None
    vertices, triangles, owners = traced
    return _core.pack_smooth(topology, vertices, triangles.astype(np.uint32), owners)
