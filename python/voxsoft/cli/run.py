"""``voxsoft run``: one design to its state at rest, or over time."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from voxsoft.cli.exits import NOT_AT_REST, errors_in_words
from voxsoft.cli.options import DesignFile, Json, Sets
from voxsoft.cli.output import print_json, say, show_table
from voxsoft.simulation import Result


def run(
    design: DesignFile,
    sets: Sets = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Run folder; default: runs/NAME-HASH."),
    ] = None,
    solver: Annotated[str | None, typer.Option("--solver", help="xpbd (default).")] = None,
    json: Json = False,
) -> None:
    """Simulate a design and write a run folder.

    The folder holds design.toml (resolved), summary.json and result.vtu.
    """
    from voxsoft import files
    from voxsoft.simulation import simulate

    with errors_in_words(json=json):
        loaded = files.load_with(design, sets or [])
        changes = {} if solver is None else {"method": solver}
        result = simulate(loaded, **changes)
        folder = out or Path("runs") / f"{loaded.name}-{loaded.hash[:8]}"
        files.write_run(result, folder)
        if json:
            print_json(result.summary() | {"folder": str(folder)})
        else:
            _show(result, folder)
    if result.status != "ok":
        raise typer.Exit(NOT_AT_REST)


def _show(result: Result, folder: Path) -> None:
    color = "green" if result.status == "ok" else "red"
    say(f"[{color}]{result.status}[/{color}]: {result.message}")
    if result.probes:
        rows = (
            [name, *(f"{component * 1e3:.3f}" for component in moved)]
            for name, moved in result.probes.items()
        )
        show_table("Displacement of probes (mm)", ["probe", "x", "y", "z"], rows)
    for name in (*result.design.objectives, *result.design.constraints):
        say(f"{name} = {result.metrics[name]:.6g} (SI)")
    say(f"{len(result.mesh.tets) // 5:,} voxels in {result.seconds:.2f} s; wrote {folder}")
