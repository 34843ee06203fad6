"""``voxsoft export``: a design, or the result of a run, in another program's format."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.options import Sets
from voxsoft.cli.output import plain, say


def export(
    source: Annotated[
        Path, typer.Argument(help="A design file or a run folder.", exists=True, readable=True)
    ],
    target: Annotated[
        Path, typer.Argument(help="File to write: .vtu .msh .inp .stl .obj .npy .toml .csv")
    ],
    sets: Sets = None,
    deformed: Annotated[
        bool, typer.Option("--deformed", help="The shape under load (run folders only).")
    ] = False,
    unit: Annotated[
        str, typer.Option("--unit", help="Unit of the numbers in .stl and .obj files.")
    ] = "m",
) -> None:
    """Write a design or a result as a mesh, surface, voxel array, resolved design or table."""
    from voxsoft import files

    with errors_in_words():
        files.export(source, target, sets or [], deformed=deformed, unit=unit)
    say(f"wrote {plain(str(target))}")
