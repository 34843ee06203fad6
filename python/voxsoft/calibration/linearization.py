"""Derivatives of the simulated measurements by the constants, by the adjoint of the equilibrium."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft.calibration.experiment import Experiment
from voxsoft.calibration.space import Space
from voxsoft.materials import Material
from voxsoft.materials.constants import with_constants
from voxsoft.simulation.compatibility import refuse
from voxsoft.simulation.derivatives.differences import derivative
from voxsoft.simulation.solving.adjoint import adjoint_states

Floats = NDArray[np.float64]


def seen_slopes(
    experiment: Experiment, space: Space, material: Material, positions: Floats
) -> Floats:
    """Differentiate the simulated numbers by the logarithms of the constants, (n, q, k), m.

    Parameters
    ----------
    experiment
        Experiment with the measured stations.
    space
        Space of the constants.
    material
        Current material.
    positions
        Equilibrium with that material, (v, 3), m.
    """
    refuse(experiment.design, "calibration along gradients")
    setup, parts = experiment.setup, len(experiment.design.parts)
    problem = setup.problem_with([material] * parts)
    axes, places = experiment.measurement.axes, experiment.places
    slopes = np.zeros((len(places), len(axes), *positions.shape))
    for station, place in enumerate(places):
        for column, axis in enumerate(axes):
            np.add.at(slopes[station, column, :, axis], place.vertices, place.weights)
    adjoints = adjoint_states(problem, positions, slopes.reshape(-1, *positions.shape))
    found = np.empty((len(places), len(axes), len(space)))
    for index, (name, value) in enumerate(space.values_of(material).items()):

        def forces(constant: float, name: str = name) -> Floats:
            varied = setup.problem_with([with_constants(material, {name: constant})] * parts)
            return varied.net_forces(positions)

        change = value * derivative(forces, value)
        along = np.tensordot(adjoints, change, axes=2)
        found[:, :, index] = along.reshape(len(places), len(axes))
    return found
