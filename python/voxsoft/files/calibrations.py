"""Output files of a calibration: a material card, its record, and tables to plot."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from voxsoft._folders import folder_name
from voxsoft.calibration import Calibration
from voxsoft.files.atomic import write_atomically
from voxsoft.files.cards import save_card
from voxsoft.files.designs import FilePath
from voxsoft.files.figures import save_figure
from voxsoft.files.run_folder import make_folder, provenance, write_json
from voxsoft.files.specimen import write_specimen
from voxsoft.plot import plot_fitness, plot_profiles, plot_shape

#: TOML files in the folder of a calibration that are no cards.
NOT_CARDS: Final = frozenset({"design.toml", "job.toml"})


def write_calibration(calibration: Calibration, folder: FilePath, name: str) -> list[Path]:
    """Write a calibration to a folder, which is made if it is not there.

    The folder then holds ``NAME.toml``, the material card; ``summary.json``, everything;
    ``history.csv``, fitness and moduli for each generation, with ``fitness.png`` (the paper's
    Fig. 3); ``shapes.csv``, measured and simulated numbers at each station, with ``shape.png``
    (Fig. 4); ``specimen.npz``, the vertices of its best candidate; and ``profile.png``, the error
    along each modulus.

    Parameters
    ----------
    calibration
        Result of :func:`voxsoft.calibration.calibrate`.
    folder
        Folder to write.
    name
        Name of the material card.

    Returns
    -------
    list of pathlib.Path
        Files that were written, the card first.

    Raises
    ------
    FileError
        The folder or a file in it cannot be written.
    """
    place = make_folder(folder)
    stem = folder_name(name, "card")
    stem = f"{stem}-card" if f"{stem}.toml" in NOT_CARDS else stem
    card, summary = place / f"{stem}.toml", place / "summary.json"
    save_card(calibration.card(name), card)
    write_json(summary, calibration.summary() | provenance())
    write_specimen(calibration.fits[0], place)
    written = [card, summary]
    tables = {"history.csv": _history(calibration), "shapes.csv": _shapes(calibration)}
    for file, text in tables.items():
        write_atomically(place / file, text)
        written.append(place / file)
    written.append(save_figure(plot_fitness(calibration), place / "fitness.png"))
    written.append(save_figure(plot_shape(calibration), place / "shape.png"))
    if calibration.profiles:
        written.append(save_figure(plot_profiles(calibration), place / "profile.png"))
    return written


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
    return _csv([*head, *(_titled(name, calibration.kinds[name]) for name in moduli)], rows)


def _titled(name: str, kind: str) -> str:
    return f"{name}_Pa" if kind == "modulus" else name


def _shapes(calibration: Calibration) -> str:
    rows = (
        [
            fit.experiment.name,
            station,
            quantity,
            fit.deviation.measured[at, column],
            fit.deviation.simulated[at, column],
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
