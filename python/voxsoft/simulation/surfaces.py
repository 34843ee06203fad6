"""Surfaces from files that are not quite closed, or whose faces disagree."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.mesh import Mesh
from voxsoft.shapes import TriangleMesh
from voxsoft.shapes.base import Shape
from voxsoft.shapes.triangles import SurfaceState
from voxsoft.simulation.diagnostic import Diagnostic


def findings_of_surface(state: SurfaceState, where: str) -> list[Diagnostic]:
    """Say what is doubtful about a surface from a file."""
    found = []
    if state.turned:
        what = (
            f"{state.turned:,} triangles had their outside on the other side than their neighbors, "
            "and were turned"
        )
        hint = "look at the voxels, or unify the normals where the surface was made"
        found.append(Diagnostic("warning", where, what, hint))
    if state.holes:
        what = f"the surface {state.opening}; what is inside near it is a guess"
        hint = "look at the voxels, or close the surface where it was made"
        found.append(Diagnostic("warning", where, what, hint, state.holes[0].center))
    return found


def doubtful_surfaces(
    design: Design, mesh: Mesh | None = None, positions: NDArray[np.float64] | None = None
) -> Iterator[Diagnostic]:
    """Say what is doubtful about every surface from a file that a design uses."""
    seen = set()
    named = [(f"shapes.{name}", shape) for name, shape in design.shapes.items()]
    parts = [(f"parts[{index}].shape", part.shape) for index, part in enumerate(design.parts)]
    for where, top in [*named, *parts]:
        for shape in top.every() if isinstance(top, Shape) else ():
            if isinstance(shape, TriangleMesh) and shape.path not in seen:
                seen.add(shape.path)
                place = f"{where}.path" if shape is top else where
                yield from findings_of_surface(shape.state(), place)
