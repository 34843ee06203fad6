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
#: Suffixes of files with the whole computation of a design.
COMPUTED: Final = " and ".join(s for s, form in WRITTEN.items() if form.computation is not None)


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
        typer.Option(
            "--unit",
            help=f"Unit of the numbers in {UNITLESS}, default mm; of {COMPUTED} with the units of "
            "all else: m (default), mm or um.",
        ),
    ] = None,
    voxels: Annotated[
        bool,
        typer.Option("--voxels", help="Surfaces: the faces of the voxels, not the smooth shape."),
    ] = False,
    element: Annotated[
        str | None,
        typer.Option(
            "--element", help=f"{COMPUTED}: C3D20R (default), C3D20, C3D8, C3D8I or C3D8R."
        ),
    ] = None,
    split: Annotated[
        int, typer.Option("--split", min=1, max=8, help=f"{COMPUTED}: bricks along a voxel.")
    ] = 1,
    html: Annotated[
        Path | None,
        typer.Option("--html", help="Page to write, alive in any browser without VoxSoft."),
    ] = None,
) -> None:
    """Write a design or a result as a mesh, surface, computation, scene, design, table or page."""
    from voxsoft import files
    from voxsoft.files.computations import held_in

    if target is None and html is None:
        say("name the file to write, or --html FILE")
        raise typer.Exit(USAGE)
    with errors_in_words():
        if target is not None:
            lost = files.export(
                source,
                target,
                sets or [],
                deformed=deformed,
                unit=unit,
                voxels=voxels,
                element=element,
                split=split,
            )
            form = WRITTEN[target.suffix.lower()]
            has_unit = form.kind == "surface" or form.computation is not None
            shown = f", in {plain(files.unit_of(target, unit))}" if has_unit else ""
            say(f"wrote {plain(str(target))}{shown}")
            if form.computation is not None:
                for sentence in held_in(target):
                    say(f"holds: {plain(sentence)}")
            for each in lost:
                say(f"lost: {plain(str(each))}")
        if html is not None:
            from voxsoft.studio.outputs.html import export_page

            export_page(source, html, sets or [])
            say(f"wrote {plain(str(html))}")
