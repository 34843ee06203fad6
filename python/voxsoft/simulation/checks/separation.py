"""Warnings of objects that were moved out of surfaces that they penetrated."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.mesh import Mesh
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.simulation.setup.contact import Touching


def separations(design: Design, mesh: Mesh, _: NDArray[np.float64]) -> Iterator[Diagnostic]:
    """Find the objects that ``separate = true`` has moved."""
    if design.contact is None or not design.contact.separate:
        return
    touching = Touching(design, mesh)
    for index, (surface, traced) in enumerate(zip(touching.surfaces, touching.traced, strict=True)):
        way = surface.middle - traced.middle
        if np.any(way != 0.0):
            x, y, z = np.round(1e3 * way, 6) + 0.0
            what = (
                f'the object "{design.objects[index].name}" was in something at rest, and was '
                f"moved out of it by ({x:.3g}, {y:.3g}, {z:.3g}) mm"
            )
            hint = "place it where it shall begin"
            yield Diagnostic("warning", f"objects[{index}]", what, hint)
