"""Folder of a workspace: ``workspace.csv`` and ``workspace.png``."""

from __future__ import annotations

from pathlib import Path

from voxsoft.files.atomic import write_atomically
from voxsoft.files.figures import save_figure
from voxsoft.files.run_folder import csv_text, make_folder
from voxsoft.plot import plot_workspace
from voxsoft.simulation import Workspace


def write_workspace(found: Workspace, folder: Path, *, figure: bool = True) -> list[Path]:
    """Write the drives and the place at each of their values, in SI units; NaN where it is lost.

    Parameters
    ----------
    found
        Workspace, also while it is computed.
    folder
        Folder of the files; it is made.
    figure
        True to draw its picture as well.
    """
    rows = found.table()
    written = [make_folder(folder) / "workspace.csv"]
    write_atomically(written[0], csv_text(rows[0], (row.values() for row in rows)))
    if figure:
        written.append(save_figure(plot_workspace(found), folder / "workspace.png"))
    return written
