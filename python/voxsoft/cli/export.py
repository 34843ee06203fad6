"""``voxsoft export``: a design, or the result of a run, in another program's format."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Final

import typer

from voxsoft.cli.exits import USAGE, errors_in_words
from voxsoft.cli.options import Sets
from voxsoft.cli.output import plain, say
from voxsoft.formats.registry import WRITTEN

#: Suffixes of files that do not state their unit.
UNITLESS: Final = " and ".join(suffix for suffix, form in WRITTEN.items() if form.unit is None)


def export(
    source: Annotated[
        Path, typer.Argument(help="A design file or a run folder.", exists=True, readable=True)
    ],
    target: Annotated[
        Path | None,
        typer.Argument(help=f"File to write: {' '.join(WRITTEN)}"),
    ] = None,
    sets: Sets = None,
    deformed: Annotated[
        bool, typer.Option("--deformed", help="The shape under load (run folders only).")
    ] = False,
    unit: Annotated[
        str | None,
        typer.Option("--unit", help=f"Unit of the numbers in {UNITLESS} files; default: mm."),
    ] = None,
    voxels: Annotated[
        bool,
        typer.Option("--voxels", help="Surfaces: the faces of the voxels, not the smooth shape."),
    ] = False,
    html: Annotated[
        Path | None,
        typer.Option("--html", help="Page to write, alive in any browser without VoxSoft."),
    ] = None,
) -> None:
    """Write a design or a result as a mesh, surface, voxel array, scene, design, table or page."""
    from voxsoft import files

    if target is None and html is None:
        say("name the file to write, or --html FILE")
        raise typer.Exit(USAGE)
    with errors_in_words():
        if target is not None:
            lost = files.export(
                source, target, sets or [], deformed=deformed, unit=unit, voxels=voxels
            )
            has_unit = WRITTEN[target.suffix.lower()].kind == "surface"
            shown = f", in {plain(files.unit_of(target, unit))}" if has_unit else ""
            say(f"wrote {plain(str(target))}{shown}")
            for each in lost:
                say(f"lost: {plain(str(each))}")
        if html is not None:
            from voxsoft.studio.outputs.html import export_page

            export_page(source, html, sets or [])
            say(f"wrote {plain(str(html))}")
