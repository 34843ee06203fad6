"""Adjoint states of metrics at an equilibrium."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft._memory import memory_limit
from voxsoft.errors import SimulationError
from voxsoft.simulation.solving.equilibrium import too_large_a_tangent

Floats = NDArray[np.float64]


def adjoint_states(problem: _core.Problem, positions: Floats, slopes: Floats) -> Floats:
    """Solve ``Kᵀ μ = ∂J/∂x`` for several metrics with one factorization, (k, n, 3) → (k, n, 3).

    Parameters
    ----------
    problem
        The mechanical problem with its tangent ``K``.
    positions
        Its equilibrium, (n, 3), m.
    slopes
        Derivatives of the metrics by the positions.

    Raises
    ------
    SimulationError
        The tangent is singular, or does not fit in memory.
    """
    with readable_errors(len(positions)):
        return _core.adjoint(problem, positions, slopes, memory=memory_limit())


@contextmanager
def readable_errors(vertices: int) -> Iterator[None]:
    """Translate the core's errors into messages for a body of so many vertices."""
    try:
        yield
    except MemoryError as error:
        (needed,) = error.args
        raise SimulationError(
            "gradient", too_large_a_tangent(vertices, needed), "use larger voxels"
        ) from None
    except ArithmeticError as error:
        raise SimulationError(
            "gradient", str(error), "hold the body better, or go a little back from the limit"
        ) from None
