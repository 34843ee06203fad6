"""Component or magnitude of a vector as a metric."""

from __future__ import annotations

import numpy as np

from voxsoft.errors import SimulationError
from voxsoft.metrics.definition import Floats, Target


def component(vector: Floats, target: Target) -> float:
    """Return the component that a target asks for, or the magnitude."""
    if target.axis is None:
        return float(np.linalg.norm(vector))
    return float(vector["xyz".index(target.axis)])


def direction(vector: Floats, target: Target) -> Floats:
    """Differentiate the component or the magnitude by the vector, (3,).

    Raises
    ------
    SimulationError
        The magnitude of zero has none.
    """
    if target.axis is not None:
        axis: Floats = np.eye(3)["xyz".index(target.axis)]
        return axis
    length = float(np.linalg.norm(vector))
    if length == 0.0:
        raise SimulationError(
            target.metric,
            "is zero, where a magnitude has no derivative",
            "name an axis, or load the body",
        )
    unit: Floats = vector / length
    return unit
