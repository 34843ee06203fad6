"""The assembled tangent of a body and its linear solutions, as the core hands them out."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sparse

import voxsoft as vs
from voxsoft import _core
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

#: Of central differences of forces over a step of 1e-6 of a voxel.
DIFFERENCES = 1e-6


@pytest.fixture(scope="module")
def setup() -> Setup:
    """A small column of rubber on its foot."""
    rubber = vs.NeoHookean(young=60 * kPa, poisson=0.45)
    column = vs.Box(size=(3 * mm, 2 * mm, 6 * mm))
    return Setup.of(
        vs.Design(
            name="column",
            voxel_size=1 * mm,
            parts=[vs.Part(shape=column, material=rubber)],
            clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
            loads=[vs.Gravity()],
        )
    )


def matrix_of(stiffness: _core.Stiffness) -> sparse.bsr_array:
    starts, vertices, blocks = stiffness.block_rows()
    return sparse.bsr_array((blocks, vertices, starts))


def test_matrix_is_the_slope_of_the_forces(setup: Setup) -> None:
    rest = np.asarray(setup.mesh.vertices)
    matrix = matrix_of(_core.Stiffness(setup.problem, rest))
    free = matrix.diagonal().reshape(-1, 3) > 0
    rng = np.random.default_rng(1)
    step = 1e-9 * rng.standard_normal(rest.shape) * free
    ahead, behind = (setup.problem.net_forces(rest + sign * step) for sign in (1, -1))
    slope = -0.5 * (ahead - behind)[free]
    expected = (matrix @ step.ravel()).reshape(-1, 3)[free]
    assert np.linalg.norm(slope - expected) < DIFFERENCES * np.linalg.norm(expected)
    assert not free[rest[:, 2] < 0.5 * mm].any()


def test_solution_balances_the_forces(setup: Setup) -> None:
    rest = np.asarray(setup.mesh.vertices)
    stiffness = _core.Stiffness(setup.problem, rest)
    matrix = matrix_of(stiffness)
    forces = setup.problem.net_forces(rest)
    free = matrix.diagonal().reshape(-1, 3) > 0
    found, iterations = stiffness.solve(forces, 1e-9)
    assert 0 < iterations < 60
    left = (matrix @ found.ravel()).reshape(-1, 3)[free] - forces[free]
    # The norm of the preconditioner sees soft directions more than the norm of forces does.
    assert np.linalg.norm(left) < 1e-6 * np.linalg.norm(forces[free])


def test_other_bodies_and_forces_are_refused(setup: Setup) -> None:
    rest = np.asarray(setup.mesh.vertices)
    with pytest.raises(ValueError, match="forces on 2 vertices"):
        _core.Stiffness(setup.problem, rest).solve(np.zeros((2, 3)), 1e-3)
    with pytest.raises(MemoryError):
        _core.Stiffness(setup.problem, rest, memory=10)
