"""Mass, inertia and surface of rigid objects beside closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import trimesh

import voxsoft as vs
from voxsoft.design import Object, families
from voxsoft.shapes import Shape
from voxsoft.shapes.sharpening import sharpened
from voxsoft.simulation.setup.distance import Surface
from voxsoft.simulation.setup.rigid_objects import Solid, surface_of

#: Volume in m³ and second moments over it in m², of each shape.
SOLIDS: dict[str, tuple[Shape, float, tuple[float, float, float]]] = {
    "cube": (vs.Box(size=(0.02,) * 3), 8e-6, (0.02**2 / 12,) * 3),
    "plate": (
        vs.Box(size=(0.03, 0.02, 0.004), corner=(0.0013, 0.0007, 0)),
        2.4e-6,
        (0.004**2 / 12, 0.02**2 / 12, 0.03**2 / 12),
    ),
    "turned cube": (vs.Box(size=(0.02,) * 3).rotate(0.7, (1, 2, 3)), 8e-6, (0.02**2 / 12,) * 3),
    "ball": (vs.Sphere(radius=0.01), 4 / 3 * math.pi * 1e-6, (0.01**2 / 5,) * 3),
    "can": (
        vs.Cylinder(radius=0.01, height=0.02),
        math.pi * 2e-6,
        (0.01**2 / 4, 0.01**2 / 4, 0.02**2 / 12),
    ),
}


def object_of(shape: Shape, **more: Any) -> Object:
    return Object(name="thing", shape=shape, motion="free", density=500.0, **more)


def sharp(shape: Shape, size: float) -> Surface:
    traced = surface_of(object_of(shape, voxel_size=size), families.beam(), "objects[0]")
    triangles = traced.triangles.astype(np.int64)
    vertices, triangles = sharpened(shape.build(), traced.vertices, triangles, size / 3)
    return Surface(vertices, triangles.astype(np.uint32))


@pytest.mark.parametrize("size", [0.002, pytest.param(0.0013, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", SOLIDS)
def test_mass_and_inertia_are_those_of_the_shape(name: str, size: float):
    shape, volume, squares = SOLIDS[name]
    thing, design = object_of(shape, voxel_size=size), families.beam()
    surface = surface_of(thing, design, "objects[0]")
    shift = np.array([1.0, -2.0, 3.0])
    solid = Solid.of(surface, thing, design, shift)
    # Flat faces are exact. Along the rim of the can a twelfth of a step of roundness is left,
    # beside a radius of a dozen steps.
    close = 1e-9 if name not in ("ball", "can") else 1e-4 if name == "ball" else 1e-3
    assert solid.mass == pytest.approx(500.0 * volume, rel=close)
    assert np.sort(np.square(solid.radii)) == pytest.approx(np.sort(squares), rel=2 * close)
    middle = np.mean(shape.bounds(), axis=0)
    assert np.array(solid.center) - shift == pytest.approx(middle, abs=1e-3 * close)


@pytest.mark.long
@pytest.mark.parametrize("size", [0.002, 0.0013])
def test_edges_and_corners_stay_sharp_and_the_surface_closed(size: float):
    notch = vs.Box(size=(0.02,) * 3, corner=(0.0107, 0.0093, 0))
    shapes = [shape for shape, _, _ in SOLIDS.values()] + [vs.Box(size=(0.02,) * 3) - notch]
    for shape in shapes:
        surface = sharp(shape, size)
        body = trimesh.Trimesh(surface.vertices, surface.triangles, process=False)
        assert body.is_watertight
        assert body.is_winding_consistent
        assert body.euler_number == 2
        assert body.volume > 0.0
        off = np.abs(shape.build().evaluate(surface.vertices)).max()
        assert off < 0.01 * size
    corners = np.array(np.meshgrid(*[[0, 0.02]] * 3)).reshape(3, -1).T
    cube = sharp(SOLIDS["cube"][0], size)
    gaps = np.linalg.norm(cube.vertices[:, None] - corners, axis=-1).min(axis=0)
    assert gaps == pytest.approx(0.0, abs=1e-9)
