"""What a calibration leaves behind: a material card, its record, and tables to plot."""

from __future__ import annotations

import csv
import io
import json
import os
from collections.abc import Iterable, Sequence
from pathlib import Path

from voxsoft.calibration import Calibration
from voxsoft.errors import FileError
from voxsoft.files.cards import save_card
from voxsoft.files.designs import FilePath, write_whole


def write_calibration(calibration: Calibration, folder: FilePath, name: str) -> Path:
    """Write a calibration to a folder, which is made if it is not there.

    The folder then holds ``NAME.toml``, the material card; ``summary.json``, everything;
    ``history.csv``, fitness and moduli for each generation (the paper's Fig. 3); and
    ``shapes.csv``, measured and simulated numbers at each station (Fig. 4).

    Parameters
    ----------
    calibration
        What :func:`voxsoft.calibration.calibrate` returned.
    folder
        Where to write.
    name
        Name of the material card.

    Returns
    -------
    pathlib.Path
        The card.

    Raises
    ------
    FileError
        The folder or a file in it cannot be written.
    """
    place = Path(folder)
    try:
        place.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(os.fspath(folder), f"cannot be made: {error.strerror}") from None
    card = place / f"{name}.toml"
    save_card(calibration.card(name), card)
    write_whole(place / "summary.json", json.dumps(calibration.summary(), indent=1) + "\n")
    write_whole(place / "history.csv", _history(calibration))
    write_whole(place / "shapes.csv", _shapes(calibration))
    return card


def _history(calibration: Calibration) -> str:
    moduli = list(calibration.parameters)
    rows = (
        [
            index,
            generation.best_fitness,
            generation.mean_fitness,
            generation.best_error,
            *(generation.parameters[name] for name in moduli),
        ]
        for index, generation in enumerate(calibration.history)
    )
    head = ["generation", "best_fitness", "mean_fitness", "best_error_m"]
    return _csv([*head, *(f"{name}_Pa" for name in moduli)], rows)


def _shapes(calibration: Calibration) -> str:
    rows = (
        [
            fit.experiment.name,
            station,
            quantity,
            fit.comparison.measured[at, column],
            fit.comparison.simulated[at, column],
        ]
        for fit in calibration.fits
        for at, station in enumerate(fit.experiment.measurement.station_names)
        for column, quantity in enumerate(fit.experiment.measurement.quantities)
    )
    return _csv(["experiment", "station", "quantity", "measured_m", "simulated_m"], rows)


def _csv(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(rows)
    return text.getvalue()
