"""Rigid objects: their traced surface, and the mass and inertia of those that are free."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voxsoft.design import Design, Object
from voxsoft.errors import DesignError
from voxsoft.shapes import TriangleMesh, voxelize
from voxsoft.shapes.tracing import trace
from voxsoft.simulation.apart import Surface


@dataclass(frozen=True)
class Solid:
    """What a free object answers to forces with.

    Attributes
    ----------
    mass
        In kg.
    center
        Of mass, m.
    axes
        Its principal axes, unit vectors row by row, (3, 3).
    radii
        The roots of its second moments of mass along them over its mass, m.
    """

    mass: float
    center: list[float]
    axes: list[list[float]]
    radii: list[float]

    @classmethod
    def of(cls, surface: Surface, each: Object) -> Solid:
        """A solid of one density with a closed surface."""
        import trimesh

        solid = trimesh.Trimesh(surface.vertices, surface.triangles, process=False)
        volume = float(solid.volume)
        # The moment of inertia about an axis is the second moment along the other two.
        inertia = np.asarray(solid.moment_inertia) / volume
        second = np.trace(inertia) / 2.0 * np.eye(3) - inertia
        squares, columns = np.linalg.eigh(second)
        density = each.density
        mass = each.mass if density is None else density * volume
        assert mass is not None  # a free object has a mass or a density
        center = np.asarray(solid.center_mass).tolist()
        return cls(mass, center, columns.T.tolist(), np.sqrt(squares).tolist())


def surface_of(each: Object, design: Design, where: str) -> Surface:
    """Trace the surface of an object.

    Raises
    ------
    DesignError
        It has none that could be traced, or a file's that is open.
    """
    shape = design.shapes[each.shape] if isinstance(each.shape, str) else each.shape
    for part in shape.every(design.shapes):
        if isinstance(part, TriangleMesh) and part.state().holes:
            what = f'the object "{each.name}" has a surface that {part.state().opening}'
            hint = "close it in the program that it came from: what is inside it is a guess"
            raise DesignError(f"{where}.shape", what, hint)
    size = each.voxel_size or design.voxel_size
    voxels = voxelize(shape, size, names=design.shapes)
    traced = trace([shape.build(design.shapes)], voxels)
    if traced is None:
        what = "has too large a surface to be traced"
        raise DesignError(where, what, "give it a larger voxel_size")
    vertices, triangles, _ = traced
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    if np.einsum("ij,ij->", a, np.cross(b, c)) < 0.0:
        triangles = triangles[:, ::-1]
    return Surface(vertices, np.ascontiguousarray(triangles, dtype=np.uint32))
