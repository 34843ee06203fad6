"""Surfaces from files: not quite closed, with inconsistent faces, or with nested shells."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import counted
from voxsoft.design import Design
from voxsoft.mesh import Mesh
from voxsoft.shapes import TriangleMesh
from voxsoft.shapes.base import Shape
from voxsoft.shapes.nesting import Nest
from voxsoft.shapes.triangles import SurfaceState
from voxsoft.simulation.diagnostic import Diagnostic, near
from voxsoft.units import format_quantity


def findings_of_surface(state: SurfaceState, where: str) -> list[Diagnostic]:
    """Find faults of a surface from a file."""
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
    if state.doubled:
        what = f"{state.doubled:,} faces occur twice with opposite sense; the body was taken once"
        hint = "leave one copy of it where the surface was made"
        found.append(Diagnostic("warning", where, what, hint))
    if state.nest.inverted:
        what = (
            f"{state.nest.inverted:,} of {counted(state.nest.shells, 'closed shell')} faced inward "
            "beside others that do not, and were turned outward"
        )
        hint = "look at the voxels, or unify the normals where the surface was made"
        found.append(Diagnostic("warning", where, what, hint))
    if state.nest.alike and state.nested is None:
        found.append(_doubt_of_nest(state.nest, where))
    return found


def _doubt_of_nest(nest: Nest, where: str) -> Diagnostic:
    solid, hollow = (
        format_quantity(float(f"{volume:.3g}"), "volume") for volume in (nest.solid, nest.hollow)
    )
    number = "a closed shell lies" if nest.alike == 1 else f"{nest.alike:,} closed shells lie"
    what = (
        f"{number} within another of the same sense, {near(nest.center)}, and is not a chamber: "
        f"solid {solid}, hollow {hollow}"
    )
    hint = 'say nested = "void" for a chamber, or nested = "solid" where that is meant'
    return Diagnostic("warning", where, what, hint, nest.center)


def doubtful_surfaces(
    design: Design, mesh: Mesh | None = None, positions: NDArray[np.float64] | None = None
) -> Iterator[Diagnostic]:
    """Find faults of every surface from a file that a design uses."""
    seen = set()
    named = [(f"shapes.{name}", shape) for name, shape in design.shapes.items()]
    parts = [(f"parts[{index}].shape", part.shape) for index, part in enumerate(design.parts)]
    objects = [(f"objects[{index}].shape", each.shape) for index, each in enumerate(design.objects)]
    for where, top in [*named, *parts, *objects]:
        for shape in top.every() if isinstance(top, Shape) else ():
            if isinstance(shape, TriangleMesh) and shape not in seen:
                seen.add(shape)
                place = f"{where}.path" if shape is top else where
                yield from findings_of_surface(shape.state(), place)
