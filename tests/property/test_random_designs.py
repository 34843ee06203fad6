"""Designs of random shapes: voxels, mesh and checks never crash, and every mesh is sound."""

import numpy as np
import pytest

from voxsoft import Clamp, Design, Gravity, Part, Region, check, mesh_of, voxels_of
from voxsoft.errors import ShapeError
from voxsoft.shapes import random_shape

# The grammar's shapes lie in a cube of 2 x 50 mm: 6 to 14 voxels across.
EXTENT = 0.1
COARSEST, FINEST = 6, 14
BLOCK = 100
SECONDS_PER_BLOCK = 240
#: Designs of the quick test; those of all blocks are tried with the slow ones.
QUICK = 4


def random_design(seed):
    """One or two overlapping parts of random shapes, held at the lower half, under gravity."""
    rng = np.random.default_rng(seed)
    return Design(
        name=f"random-{seed}",
        voxel_size=EXTENT / int(rng.integers(COARSEST, FINEST + 1)),
        parts=[
            Part(shape=random_shape(rng), material=material)
            for material in ("ecoflex-00-30-lattice", "ecoflex-00-50-lattice")[: rng.integers(1, 3)]
        ],
        clamps=[Clamp(region=Region(z=("-inf", 0)))],
        loads=[Gravity()],
    )


def middles(points):
    """Points as a set of keys on the lattice of half voxels."""
    return set(map(tuple, np.rint(points).astype(int).tolist()))


def hinge_edges(voxels):
    """Middles of the lattice edges that are the only contact of two cells, in half voxels."""
    pairs = np.array([h.cells for h in voxels.hinges if h.contact == "edge"]).reshape(-1, 2, 3)
    corner = 2 * np.asarray(voxels.origin) / voxels.voxel_size
    return middles(corner + pairs.sum(axis=1) + 1)


def nonmanifold_edges(mesh):
    """Middles of the edges with four or more triangles, in half voxels."""
    ends = mesh.vertices[np.array(mesh.quality.nonmanifold_edges, int).reshape(-1, 2)]
    return middles(2 * ends.mean(axis=1) / mesh.voxel_size)


def assert_sound(voxels, mesh):
    quality = mesh.quality
    assert quality.conforming
    assert quality.smallest_tet > 0
    assert quality.watertight
    assert len(mesh.tets) == 5 * voxels.count
    # Sums of up to 15,000 tets in float64.
    assert np.isclose(quality.volume, voxels.count * voxels.voxel_size**3, rtol=1e-12)
    assert np.isclose(mesh.surface_volume, quality.volume, rtol=1e-9)
    assert nonmanifold_edges(mesh) == hinge_edges(voxels)
    assert np.allclose([c.volume for c in mesh.cavities], [c.volume for c in voxels.cavities])


def meshed(seed):
    """Check one design; return its voxel count, or 0 where a part has no voxel."""
    design = random_design(seed)
    report = check(design)
    try:
        voxels = voxels_of(design)
    except ShapeError as error:
        assert "empty" in str(error)  # noqa: PT017
        assert not report.valid
        assert any("empty" in finding.what for finding in report.findings)
        return 0
    assert_sound(voxels, mesh_of(design))
    assert report.voxels == voxels.count
    # A design that cannot be solved has no mass.
    assert report.mass > 0 if report.valid else report.mass is None
    assert not any(finding.where == "mesh" for finding in report.findings)
    return voxels.count


def mesh_all(seeds):
    counts = []
    for seed in seeds:
        try:
            counts.append(meshed(seed))
        except Exception as error:
            error.add_note(f"seed {seed}")
            raise
    return counts


@pytest.mark.long
def test_random_designs_become_sound_meshes():
    counts = mesh_all(range(QUICK))
    # An empty part is a valid find, but a block of them would test nothing.
    assert np.count_nonzero(counts) > QUICK / 2


@pytest.mark.slow
@pytest.mark.timeout(SECONDS_PER_BLOCK)
@pytest.mark.parametrize("block", range(100))
def test_many_more_random_designs_become_sound_meshes(block):
    counts = mesh_all(range(BLOCK * block, BLOCK * (block + 1)))
    assert np.count_nonzero(counts) > BLOCK / 2


def test_the_designs_are_those_of_their_seeds():
    assert random_design(7).hash == random_design(7).hash
    assert random_design(7).hash != random_design(8).hash
