"""Places of a body that its clamps hold."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.design.region import Region
from voxsoft.fabrication.fields import Floats

Bools = NDArray[np.bool_]


def holds(design: Design, region: Region, points: Floats, near: float) -> Bools:
    """Return True for points (n, 3) [m] that a region holds, to within a distance [m]."""
    held = np.ones(len(points), dtype=bool)
    for axis, name in enumerate("xyz"):
        bounds = getattr(region, name)
        if bounds is not None:
            held &= (points[:, axis] >= bounds[0] - near) & (points[:, axis] <= bounds[1] + near)
    if region.center is not None and region.radius is not None:
        away = np.linalg.norm(points - np.array(region.center), axis=1)
        held &= away <= region.radius + near
    if region.shape is not None:
        shape = design.shapes[region.shape] if isinstance(region.shape, str) else region.shape
        values = shape.build(design.shapes).evaluate(np.ascontiguousarray(points))
        held &= values <= near
    return held


def clamped(design: Design, points: Floats, near: float) -> Bools:
    """Return True for points (n, 3) [m] that a clamp holds on all axes, to within a distance [m].

    A clamp that leaves an axis free stands for a plane of symmetry or a guide: nothing is fixed.
    """
    held = np.zeros(len(points), dtype=bool)
    for clamp in design.clamps:
        if clamp.axes == "xyz":
            held |= holds(design, clamp.region, points, near)
    return held
