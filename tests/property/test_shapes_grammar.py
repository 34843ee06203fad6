"""Random designs from the grammar: no crash, no hang, and the exact classification."""

import numpy as np
import pytest

from voxsoft.errors import ShapeError
from voxsoft.shapes import KINDS, inside, random_shape, voxelize


def kinds_in(shape):
    operands = getattr(shape, "of", ())
    inner = operands if isinstance(operands, tuple) else (operands,)
    return {shape.kind}.union(*map(kinds_in, inner))


def centers(voxel_size, cells, origin):
    index = np.stack(np.meshgrid(*map(np.arange, cells), indexing="ij"), axis=-1)
    return (np.array(origin) + (index + 0.5) * voxel_size).reshape(-1, 3)


def assert_becomes_voxels(seed):
    try:
        voxels = voxelize(random_shape(seed), 0.006)
    except ShapeError as error:
        assert "empty" in str(error), f"seed {seed}: {error}"  # noqa: PT017
    else:
        assert voxels.count > 0


@pytest.mark.long
@pytest.mark.parametrize("block", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_random_shapes_become_voxels(block):
    for seed in range(100 * block, 100 * block + 100):
        assert_becomes_voxels(seed)


@pytest.mark.slow
@pytest.mark.parametrize("block", range(2, 100))
def test_many_more_random_shapes_become_voxels(block):
    for seed in range(100 * block, 100 * block + 100):
        assert_becomes_voxels(seed)


def test_the_grammar_covers_every_kind_that_needs_no_file_or_code():
    found = set().union(*(kinds_in(random_shape(seed)) for seed in range(2000)))
    assert found == set(KINDS) - {"mesh", "function"}


@pytest.mark.long
@pytest.mark.parametrize(
    "seed", [pytest.param(n, marks=[pytest.mark.slow] * (n >= 20)) for n in range(60)]
)
def test_cells_are_those_of_a_float64_evaluation(seed):
    shape = random_shape(seed)
    voxel_size, cells, origin = 0.1 / 34, (34, 35, 33), (-0.05, -0.05, -0.05)
    values = shape.evaluate(centers(voxel_size, cells, origin))
    expected = values < -1e-9 * voxel_size
    assert np.array_equal(inside(shape, voxel_size, cells, origin).ravel(), expected)


@pytest.mark.parametrize("seed", range(60, 100))
def test_bounds_contain_every_inside_point(seed):
    shape = random_shape(seed)
    points = np.random.default_rng(seed).uniform(-0.06, 0.06, (5_000, 3))
    found = points[shape.evaluate(points) < 0]
    low, high = shape.bounds()
    assert (found >= np.array(low) - 1e-9).all()
    assert (found <= np.array(high) + 1e-9).all()
