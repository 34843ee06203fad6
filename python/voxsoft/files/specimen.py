"""Specimen of a calibration: vertices of its best candidate, beside the measured stations."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.calibration.result import Fit
from voxsoft.errors import FileError
from voxsoft.files.atomic import write_atomically

#: File name of the specimen in the folder of a calibration, a NumPy archive.
SPECIMEN: Final = "specimen.npz"

Floats = NDArray[np.float64]
Triple = tuple[float, float, float]


def drawn_positions(fit: Fit) -> Floats:
    """Return the positions of the vertices of a fit [m], with the scale of the fit if it has one.

    A scale applies to positions from the clamp face, and to displacements from the initial
    positions.
    """
    experiment, measurement = fit.experiment, fit.experiment.measurement
    center = experiment.setup.mesh.vertices.copy()
    for axis, is_position in zip(measurement.axes, measurement.are_positions, strict=True):
        if is_position:
            center[:, axis] = experiment.station_line.foot[axis]
    drawn: Floats = center + fit.deviation.scale * (fit.deviation.positions - center)
    return drawn


def stations(fit: Fit) -> tuple[list[Triple], list[Triple]]:
    """Return measured and simulated stations as points of the design's space [m].

    A coordinate that was not measured is copied from the simulated station, so that the line
    between the two is the error.
    """
    experiment, comparison = fit.experiment, fit.deviation
    drawn = drawn_positions(fit)
    simulated = np.array([place.weights @ drawn[place.vertices] for place in experiment.places])
    measured = simulated.copy()
    short = comparison.measured - comparison.simulated
    for column, axis in enumerate(experiment.measurement.axes):
        measured[:, axis] += short[:, column]
    return _triples(measured), _triples(simulated)


def write_specimen(fit: Fit, folder: Path) -> None:
    """Write the specimen to the folder of a calibration.

    Raises
    ------
    FileError
        It cannot be written.
    """
    content = io.BytesIO()
    np.savez_compressed(content, positions=drawn_positions(fit))
    write_atomically(folder / SPECIMEN, content.getvalue())


def read_specimen(folder: Path, vertices: int) -> Floats:
    """Read the positions of the specimen [m], with a given number of vertices.

    Raises
    ------
    FileError
        There is none, or it is of another body.
    """
    file = folder / SPECIMEN
    if not file.is_file():
        raise FileError(folder.name, "holds no shape of its specimen yet")
    try:
        with np.load(file, allow_pickle=False) as content:
            positions: Floats = np.asarray(content["positions"], dtype=np.float64)
    except (OSError, ValueError, KeyError, EOFError) as error:
        raise FileError(str(file), f"is damaged: {error}") from None
    if positions.shape != (vertices, 3) or not np.isfinite(positions).all():
        raise FileError(str(file), "is not of this design", "start the calibration again")
    return positions


def _triples(points: Floats) -> list[Triple]:
    return [(float(x), float(y), float(z)) for x, y, z in points]
