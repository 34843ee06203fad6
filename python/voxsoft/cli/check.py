"""``voxsoft check``: a doctor for designs and meshes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from voxsoft.cli.exits import INVALID, errors_in_words
from voxsoft.cli.options import Json, Sets
from voxsoft.cli.output import print_json, say
from voxsoft.simulation import CheckReport


def check(
    source: Annotated[
        Path,
        typer.Argument(help="A design file, or a triangle or tetrahedral mesh.", exists=True),
    ],
    sets: Sets = None,
    unit: Annotated[
        str | None, typer.Option("--unit", help="Unit of a mesh file's numbers: mm, cm, m, inch.")
    ] = None,
    voxel_size: Annotated[
        str | None, typer.Option("--voxel-size", help="Voxel size for a mesh file, '2 mm'.")
    ] = None,
    json: Json = False,
) -> None:
    """Look for what would go wrong: units, pieces, hinges, cavities, leaks, walls, mass, cost."""
    from voxsoft import files

    with errors_in_words(json=json, invalid={"valid": False}):
        if source.suffix.lower() == ".toml":
            report = files.check_design(source, sets or [])
        else:
            report = files.check_mesh(source, unit=unit, voxel_size=voxel_size)
        if json:
            print_json(report.summary())
        else:
            _show(report)
    if not report.valid:
        raise typer.Exit(INVALID)


def _show(report: CheckReport) -> None:
    for finding in report.findings:
        color = "red" if finding.severity == "error" else "yellow"
        where, text = (part.replace("[", r"\[") for part in (finding.where, finding.what))
        say(f"[{color}]{finding.severity}[/{color}] {where}: {text}. Try: {finding.hint}")
    say(
        f"{report.voxels:,} voxels, {report.vertices:,} vertices, {report.tets:,} tetrahedra, "
        f"mass {report.mass * 1e3:.4g} g"
    )
    for index, cavity in enumerate(report.cavities):
        say(f"cavity {index}: {cavity.volume * 1e6:.4g} mL, {cavity.area * 1e6:.4g} mm²")
    if report.thinnest_wall:
        say(f"thinnest wall: {report.thinnest_wall} voxels")
    say(f"one run to rest: about {report.seconds:.2g} s and {report.memory / 1e6:.3g} MB")
    say("[green]valid[/green]" if report.valid else "[red]not valid[/red]")
