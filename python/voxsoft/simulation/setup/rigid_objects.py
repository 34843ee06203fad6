"""Rigid objects: their traced surface, and mass and inertia of free ones."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design, Object
from voxsoft.errors import DesignError
from voxsoft.shapes import Shape, TriangleMesh, voxelize
from voxsoft.shapes.sharpening import sharpened, to_surface
from voxsoft.shapes.tracing import SAMPLES, trace
from voxsoft.simulation.setup.distance import Surface

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Solid:
    """Mass and inertia of a free object.

    Attributes
    ----------
    mass
        Mass in kg.
    center
        Center of mass, m.
    axes
        Its principal axes, unit vectors row by row, (3, 3).
    radii
        Square roots of its second moments of mass along them over its mass, m.
    """

    mass: float
    center: list[float]
    axes: list[list[float]]
    radii: list[float]

    @classmethod
    def of(cls, traced: Surface, each: Object, design: Design, shift: Floats) -> Solid:
        """Compute mass and inertia of a solid of one density.

        Parameters
        ----------
        traced
            The traced surface of its shape.
        each
            The object.
        design
            The design that has it.
        shift
            Translation from there to its position [m].
        """
        volume, first, second = _integrals(traced, each, design)
        mass = each.mass if each.density is None else each.density * volume
        assert mass is not None  # a free object has a mass or a density
        center = first / volume
        squares, columns = np.linalg.eigh(second / volume - np.outer(center, center))
        radii = np.sqrt(np.maximum(squares, 0.0))
        return cls(mass, (center + shift).tolist(), columns.T.tolist(), radii.tolist())


def _integrals(traced: Surface, each: Object, design: Design) -> tuple[float, Floats, Floats]:
    """Integrate 1, x and x ⊗ x over a solid, in m³, m⁴ and m⁵.

    Flat triangles on a round surface leave out a part that falls with the square of their size:
    triangles with all sides halved, the middles put on the surface, give it (Richardson
    extrapolation).
    """
    shape = _shape(each, design).build(design.shapes)
    step = (each.voxel_size or design.voxel_size) / SAMPLES[0]
    vertices, triangles = traced.vertices, traced.triangles.astype(np.int64)
    vertices, triangles = sharpened(shape, vertices, triangles, step)
    sides, index = np.unique(
        np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1),
        axis=0,
        return_inverse=True,
    )
    middles = to_surface(shape, vertices[sides].mean(axis=1), step)
    finer = np.concatenate([vertices, middles])
    ab, bc, ca = (len(vertices) + index.reshape(-1, 3)).T
    a, b, c = triangles.T
    quarters = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    halved = np.concatenate([np.stack(each_quarter, axis=1) for each_quarter in quarters])
    coarse, fine = _moments(vertices, triangles), _moments(finer, halved)
    rows = zip(fine, coarse, strict=True)
    volume, first, second = (np.asarray(f) + (np.asarray(f) - np.asarray(c)) / 3.0 for f, c in rows)
    return float(volume), first, second


def _moments(vertices: Floats, triangles: NDArray[np.int64]) -> tuple[float, Floats, Floats]:
    """Integrate over the tetrahedra between triangles and the origin, with sign."""
    corners = vertices[triangles]
    volumes = np.linalg.det(corners) / 6.0
    total = corners.sum(axis=1)
    first = np.einsum("t,ti->i", volumes, total) / 4.0
    second = np.einsum("t,ti,tj->ij", volumes, total, total)
    second += np.einsum("t,tki,tkj->ij", volumes, corners, corners)
    return float(volumes.sum()), first, second / 20.0


def _shape(each: Object, design: Design) -> Shape:
    return design.shapes[each.shape] if isinstance(each.shape, str) else each.shape


def surface_of(each: Object, design: Design, where: str) -> Surface:
    """Trace the surface of an object.

    Raises
    ------
    DesignError
        The surface is too large to be traced, or is that of a file and open.
    """
    shape = _shape(each, design)
    for part in shape.every(design.shapes):
        if isinstance(part, TriangleMesh) and part.state().holes:
            what = f'the object "{each.name}" has a surface that {part.state().opening}'
            hint = "close it in the program that it came from: what is inside it is a guess"
            raise DesignError(f"{where}.shape", what, hint)
    size = each.voxel_size or design.voxel_size
    # The surface is traced between the cells: where the grid lies does not move it.
    voxels = voxelize(shape, size, names=design.shapes, phase=(0.0, 0.0, 0.0))
    built = shape.build(design.shapes)
    traced = trace([built], voxels)
    if traced is None:
        what = "has too large a surface to be traced"
        raise DesignError(where, what, "give it a larger voxel_size")
    vertices, triangles, _ = traced
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    if np.einsum("ij,ij->", a, np.cross(b, c)) < 0.0:
        triangles = triangles[:, ::-1]
    return Surface(vertices, np.ascontiguousarray(triangles, dtype=np.uint32))
