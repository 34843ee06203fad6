"""Study folders: table, summary and figures beside the stored trials."""

from __future__ import annotations

import os
from importlib.util import find_spec
from pathlib import Path

from voxsoft.comparison import Confirmation
from voxsoft.files.atomic import write_atomically
from voxsoft.files.figures import save_figure
from voxsoft.files.run_folder import make_folder, provenance, write_json
from voxsoft.plot import plot_history, plot_pareto, plot_paths, plot_scatter
from voxsoft.study import StudyResult


def write_study(result: StudyResult, folder: str | os.PathLike[str]) -> list[Path]:
    """Write the results of a study: ``table.csv``, ``summary.json`` and figures.

    Parameters
    ----------
    result
        Result of the study so far.
    folder
        Folder to write; made if it does not exist, files in it are replaced.

    Returns
    -------
    list of Path
        The files that were written: the table (also as ``table.parquet`` where pyarrow is
        installed), ``paths.csv`` and ``paths.png`` of a study along a path, the summary,
        ``scatter.png`` and ``history.png``, and ``pareto.png`` for
        two or more objectives. Figures need at least one finished trial.

    Raises
    ------
    FileError
        The folder cannot be written.
    """
    folder = make_folder(folder)
    table = folder / "table.csv"
    write_atomically(table, result.table().to_csv(index=False))
    written = [table]
    if find_spec("pyarrow") is not None:
        result.to_parquet(folder / "table.parquet")
        written.append(folder / "table.parquet")
    if result.over is not None and any(trial.path for trial in result.trials):
        paths = folder / "paths.csv"
        write_atomically(paths, result.paths().to_csv(index=False))
        written.append(paths)
        written.append(save_figure(plot_paths(result), folder / "paths.png"))
    summary = folder / "summary.json"
    write_json(summary, result.summary() | {"name": result.name, **provenance()})
    written.append(summary)
    if result.trials:
        written.append(save_figure(plot_scatter(result), folder / "scatter.png"))
        written.append(save_figure(plot_history(result), folder / "history.png"))
    if result.ranking and len(result.objectives) > 1:
        written.append(save_figure(plot_pareto(result), folder / "pareto.png"))
    return written


def write_confirmation(found: Confirmation, folder: str | os.PathLike[str]) -> Path:
    """Write the confirmation of the best designs, as ``confirmed.json``.

    Raises
    ------
    FileError
        The folder cannot be written.
    """
    file = make_folder(folder) / "confirmed.json"
    write_json(file, found.summary() | provenance())
    return file
