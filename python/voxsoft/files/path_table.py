"""Table of a path: ``path.csv``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from voxsoft.comparison.error_bar import ErrorBars
from voxsoft.comparison.path_bars import bars_of
from voxsoft.files.atomic import write_atomically
from voxsoft.files.run_folder import csv_text
from voxsoft.simulation import LoadPath


def write_path(path: LoadPath, bars: Sequence[ErrorBars], folder: Path) -> Path:
    """Write every number along a path in SI units, with estimate and error where these are known.

    Parameters
    ----------
    path
        Path to write.
    bars
        Error bars of the path, or none yet.
    folder
        Folder of ``path.csv``.
    """
    header, columns = [path.over.key], [list(path.values)]
    for name, (_, values) in path.columns.items():
        header.append(name)
        columns.append(list(values))
        known = list(bars_of(name, bars))
        if any(bar is not None for bar in known):
            blank = float("nan")
            header += [f"{name}.estimate", f"{name}.error"]
            columns += [
                [blank if bar is None else bar.estimate for bar in known],
                [blank if bar is None else bar.error for bar in known],
            ]
    target = folder / "path.csv"
    write_atomically(target, csv_text(header, zip(*columns, strict=True)))
    return target
