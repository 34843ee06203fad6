"""Surfaces of random shapes: closed, outward, and of the volumes that are simulated."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from voxsoft import Design, Part, mesh_of
from voxsoft.errors import ShapeError
from voxsoft.shapes import random_shape
from voxsoft.simulation.setup.smooth_surfaces import part_volumes, smooth_surfaces

EXTENT = 0.1
VOLUME = 5e-3
SEEDS, QUICK = 16, 3


def random_design(seed):
    """One to three overlapping parts of random shapes, on cut or full voxels."""
    rng = np.random.default_rng(seed)
    return Design(
        name=f"random-{seed}",
        voxel_size=EXTENT / int(rng.integers(5, 8)),
        fill=("fraction", "binary")[seed % 2],
        parts=[
            Part(shape=random_shape(rng), material="ecoflex-00-30")
            for _ in range(int(rng.integers(1, 4)))
        ],
    )


def assert_sound(surfaces, names, volumes):
    for number, name in names.items():
        if volumes[number - 1] == 0.0:
            assert name not in surfaces  # covered by parts before it
            continue
        body = trimesh.Trimesh(*surfaces[name], process=False)
        assert body.is_watertight
        assert body.is_winding_consistent
        assert body.volume == pytest.approx(volumes[number - 1], rel=VOLUME)


def check(seed):
    """Check the surfaces of a design, unloaded and bent, unless a shape has no voxel."""
    design = random_design(seed)
    try:
        mesh = mesh_of(design)
    except ShapeError:
        return
    count = len(design.parts)
    found = smooth_surfaces(design, mesh)
    assert_sound(found.surfaces(), found.names, part_volumes(mesh, count))
    x, y, z = mesh.vertices.T
    bent = np.stack([x + 2.0 * z**2, 1.1 * y - 0.2 * x, z + 2.0 * x * y], axis=1)
    volumes = part_volumes(replace(mesh, vertices=bent), count)
    assert_sound(found.surfaces(bent), found.names, volumes)


@pytest.mark.parametrize(
    "seed",
    [
        pytest.param(k, marks=pytest.mark.long if k < QUICK else pytest.mark.slow)
        for k in range(SEEDS)
    ],
)
def test_surfaces_of_random_shapes_are_closed_with_their_volumes(seed):
    check(seed)
