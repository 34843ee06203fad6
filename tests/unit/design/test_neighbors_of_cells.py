"""Neighbors and turns of cells beside those of SciPy, which a plain run does not load."""

import numpy as np
from scipy.ndimage import maximum_filter, minimum_filter
from scipy.spatial.transform import Rotation

from voxsoft.design.discretization.cut_cells import around
from voxsoft.design.discretization.cut_surfaces import rotation_vectors


def test_extremes_around_cells():
    rng = np.random.default_rng(0)
    for _ in range(20):
        cells = rng.integers(0, 3, size=rng.integers(1, 9, 3)).astype(np.uint8)
        for extreme, expected in ((np.minimum, minimum_filter), (np.maximum, maximum_filter)):
            found = cells
            for axis in range(3):
                found = around(found, axis, extreme)
            assert np.array_equal(found, expected(cells, size=3, mode="constant", cval=0))


def test_rotation_vectors_of_any_turn():
    rng = np.random.default_rng(0)
    turns = Rotation.random(1000, random_state=1).as_matrix()
    small = Rotation.from_rotvec(1e-6 * rng.normal(size=(100, 3))).as_matrix()
    halves = Rotation.from_rotvec(np.pi * np.eye(3)).as_matrix()
    matrices = np.concatenate([turns, small, halves, np.eye(3)[None]])
    expected = Rotation.from_matrix(matrices).as_rotvec()
    # Rounding of a few operations on numbers up to π.
    assert np.abs(rotation_vectors(matrices) - expected).max() < 1e-14
