"""``voxsoft check``: checks of designs and meshes."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from voxsoft.cli.exits import INVALID, USAGE, errors_in_words
from voxsoft.cli.options import Json, Sets
from voxsoft.cli.output import plain, print_json, quantity, say

if TYPE_CHECKING:
    from voxsoft.simulation import CheckReport
    from voxsoft.simulation.setup.volumes import Volume


def check(
    source: Annotated[
        Path,
        typer.Argument(
            help="A design file, a mesh, .stl .obj .vtu ..., or an array of voxels, .npy .vxa.",
            exists=True,
            dir_okay=False,
        ),
    ],
    sets: Sets = None,
    unit: Annotated[
        str | None, typer.Option("--unit", help="Unit of a mesh file's numbers: mm, cm, m, inch.")
    ] = None,
    voxel_size: Annotated[
        str | None,
        typer.Option(
            "--voxel-size", help="Voxel size for a mesh file, or side of a voxel of .npy, '2 mm'."
        ),
    ] = None,
    nested: Annotated[
        Literal["solid", "void"] | None,
        typer.Option("--nested", help="Closed shells within others in a mesh file: solid, void."),
    ] = None,
    json: Json = False,
) -> None:
    """Check a design for faults: units, components, hinges, cavities, leaks, walls, cost."""
    from voxsoft import files

    is_design = source.suffix.lower() == ".toml"
    if is_design and (unit or voxel_size or nested):
        say(
            "--unit, --voxel-size and --nested are for mesh files; for a design, use "
            "--set voxel_size='2 mm'"
        )
        raise typer.Exit(USAGE)
    if not is_design and sets:
        say("--set is for designs; a mesh file has --unit and --voxel-size")
        raise typer.Exit(USAGE)
    with errors_in_words(json=json, invalid={"valid": False}):
        if is_design:
            report = files.check_design(source, sets or [])
        else:
            report = files.check_mesh(source, unit=unit, voxel_size=voxel_size, nested=nested)
        if json:
            print_json(report.summary())
        else:
            _show(report)
    if not report.valid:
        raise typer.Exit(INVALID)


def _show(report: CheckReport) -> None:
    for finding in report.findings:
        color = "red" if finding.severity == "error" else "yellow"
        where = f" {plain(finding.where)}:" if finding.where else ""
        hint = f" Try: {plain(finding.hint)}" if finding.hint else ""
        say(f"[{color}]{finding.severity}[/{color}]{where} {plain(finding.what)}.{hint}")
    if report.file is not None:
        for line in str(report.file).splitlines():
            say(plain(line))
    if report.tets:
        _show_body(report)
    say("[green]valid[/green]" if report.valid else "[red]not valid[/red]")


def _show_body(report: CheckReport) -> None:
    voxels = f"{report.voxels:,} voxels, " if report.voxels else ""
    say(
        f"{voxels}{report.vertices:,} vertices, {report.tets:,} tetrahedra"
        + ("" if report.mass is None else f", mass {quantity(report.mass, 'mass')}")
    )
    for index, cavity in enumerate(report.cavities):
        volume, area = quantity(cavity.volume, "volume"), quantity(cavity.area, "area")
        name = report.chambers[index] if index < len(report.chambers) else ""
        called = f"chamber {name}" if name else f"cavity {index}"
        described = report.volumes.cavities.get(name or f"cavity {index}")
        shapes = "" if described is None else f" in voxels, {_beside(described)}"
        say(f"{plain(called)}: {volume}{shapes}; walls of {area}")
    for name, found in report.volumes.parts.items():
        simulated = quantity(found.simulated, "volume")
        say(f"{plain(name)}: {simulated} in voxels, {_beside(found)}")
    for name, phase in report.phases.items():
        if any(phase):
            shift = ", ".join(f"{1e3 * each:.6g}" for each in phase)
            body = f"body {plain(name)}: " if name else ""
            say(f"{body}a corner of the voxels lies at ({shift}) mm, to fit the body")
    if report.thinnest_wall:
        plural = "s" if report.thinnest_wall > 1 else ""
        say(f"thinnest wall: {report.thinnest_wall} voxel{plural}")
    took = "" if report.cost is None else f"{report.cost.sentence}; "
    say(f"one run: {took}{report.memory / 1e6:.3g} MB")


def _beside(volume: Volume) -> str:
    """List the options of the shapes beside the voxels."""
    described = quantity(volume.described, "volume")
    if not math.isfinite(volume.difference):
        return f"{described} in its shapes"
    share = "as" if abs(volume.difference) < 5e-4 else f"{volume.difference:+.1%} of"
    return f"{share} its shapes' {described}"
