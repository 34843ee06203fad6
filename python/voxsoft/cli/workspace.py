"""``voxsoft workspace``: where a place of a robot can be."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from voxsoft._folders import folder_name
from voxsoft.cli.exits import NOT_AT_REST, errors_in_words
from voxsoft.cli.options import DesignFile, Json, Sets
from voxsoft.cli.output import plain, print_json, quantity, say, show_table

if TYPE_CHECKING:
    from voxsoft.comparison import ErrorBars
    from voxsoft.simulation import Workspace


def workspace(
    design: DesignFile,
    probe: Annotated[str, typer.Option("--probe", help="The place, a probe of the design.")],
    over: Annotated[
        list[str],
        typer.Option(
            "--over",
            metavar="KEY=RANGE",
            help="Drives, as for run: 'left=0..6 N/7'. Once to three times; the last "
            "changes fastest.",
        ),
    ],
    sets: Sets = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Folder; default: runs/NAME-workspace.")
    ] = None,
    error: Annotated[
        str | None,
        typer.Option(
            "--error",
            help="Voxels for error bars: auto, finer, coarser or off; default: as the design says.",
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Find the positions that a place of a robot reaches, over a grid of its drives.

    The folder holds workspace.csv and workspace.png. The table is written after each line of the
    grid, so that finished lines stay when it is interrupted.
    """
    from voxsoft import files
    from voxsoft.cli.progress import ProgressBar
    from voxsoft.comparison import line_error
    from voxsoft.simulation import workspace as find

    errors: list[float] = []
    bars: list[ErrorBars] = []
    with errors_in_words(json=json):
        loaded = files.load(design, assignments=sets or [])
        folder = out or Path("runs") / f"{folder_name(loaded.name)}-workspace"
        with ProgressBar("lines", 1) as bar:

            def line(found: Workspace) -> None:
                files.write_workspace(found, folder, figure=False)
                of_line, whole = line_error(found.paths[-1], probe)
                errors.append(of_line)
                bars.append(whole)
                bar.set_total(math.prod(found.shape[:-1]))
                bar.advance_to(len(found.paths))

            settings: dict[str, Any] = {} if error is None else {"error": error}
            found = find(loaded, probe, over, line=line, **settings)
        files.write_workspace(found, folder)
        # A line whose error is not known leaves that of the whole unknown.
        worst = math.nan if any(map(math.isnan, errors)) else max(errors)
        if json:
            print_json(_summary(found, worst))
        else:
            _show(found, worst, bars[errors.index(worst)] if worst in errors else bars[-1], folder)
    if found.missing:
        raise typer.Exit(NOT_AT_REST)


def _summary(found: Workspace, error: float) -> dict[str, Any]:
    return {
        "probe": found.probe,
        "drives": {drive.key: list(drive.values) for drive in found.drives},
        "points": found.points.tolist(),
        "missing": found.missing,
        "error": None if math.isnan(error) else error,
        found.size_kind: found.size,
        "hull_volume": found.hull_volume,
    }


def _show(found: Workspace, error: float, bars: ErrorBars, folder: Path) -> None:
    count = math.prod(found.shape)
    color = "red" if found.missing else "yellow" if math.isnan(error) else "green"
    lost = f", {found.missing} of them without an equilibrium" if found.missing else ""
    say(f"[{color}]{plain(found.probe)} at {count} places{lost}[/{color}]")
    for path in found.paths:
        if path.status != "ok":
            say(f"[red]{path.status}[/red]: {plain(path.message)}")
    rows = [
        [name, quantity(low, "length"), quantity(high, "length")]
        for name, (low, high) in zip("xyz", found.extents, strict=True)
    ]
    show_table("Where it can be", ["", "from", "to"], rows)
    if math.isnan(error):
        say(plain(bars.sentence))
    else:
        say(f"each place within {quantity(error, 'length')}: {plain(bars.sentence)}")
    say(f"{found.size_kind} of the net: {quantity(found.size, found.size_kind)}")
    if found.hull_volume > 0.0:
        say(f"convex hull: {quantity(found.hull_volume, 'volume')}")
    say(f"wrote {folder}")
