"""``voxsoft run``: one design to its state at rest, or over time."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from voxsoft.cli.exits import NOT_AT_REST, errors_in_words
from voxsoft.cli.options import DesignFile, Json, Sets
from voxsoft.cli.output import plain, print_json, quantity, say, show_table

if TYPE_CHECKING:
    from voxsoft.cli.progress import ProgressBar
    from voxsoft.design import Solver
    from voxsoft.simulation import Result


def run(
    design: DesignFile,
    sets: Sets = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Run folder; default: runs/NAME-HASH."),
    ] = None,
    solver: Annotated[str | None, typer.Option("--solver", help="xpbd (default).")] = None,
    figure: Annotated[
        bool, typer.Option("--figure", help="Also draw the deformed body, as body.png.")
    ] = False,
    json: Json = False,
) -> None:
    """Simulate a design and write a run folder.

    The folder holds design.toml (resolved), summary.json and result.vtu.
    """
    from voxsoft import files
    from voxsoft.cli.progress import ProgressBar
    from voxsoft.simulation import simulate

    with errors_in_words(json=json):
        loaded = files.load(design, assignments=sets or [])
        changes: dict[str, Any] = {} if solver is None else {"method": solver}
        with ProgressBar("percent", 100, transient=True) as bar:
            tell = _percent(bar, loaded.solver)
            result = simulate(loaded, progress=tell, **changes)
        folder = out or Path("runs") / f"{loaded.name}-{loaded.hash[:8]}"
        files.write_run(result, folder)
        if figure:
            from voxsoft.files.figures import save_figure
            from voxsoft.plot import plot_body

            save_figure(plot_body(result), folder / "body.png")
        if json:
            print_json(result.summary() | {"folder": str(folder)})
        else:
            _show(result, folder)
    if result.status != "ok":
        raise typer.Exit(NOT_AT_REST)


def _percent(bar: ProgressBar, solver: Solver) -> Callable[[int, float, float], None]:
    """Progress in percent: of the end time, or of the digits that the residual must still lose."""
    from voxsoft.simulation.rest import DEFAULT_TOLERANCE

    tolerance = solver.tolerance or DEFAULT_TOLERANCE
    largest = 0.0

    def tell(steps: int, time: float, residual: float) -> None:
        nonlocal largest
        if solver.end_time:
            share = time / solver.end_time
        else:
            # A residual falls by about the same factor in the same time.
            finite = max(residual, tolerance) if math.isfinite(residual) else largest
            largest = max(largest, finite)
            digits = math.log(largest / tolerance) if largest > tolerance else 1.0
            share = math.log(largest / finite) / digits if finite else 0.0
        bar.advance_to(round(100 * min(share, 1.0)), f"residual {residual:.1e}")

    return tell


def _show(result: Result, folder: Path) -> None:
    from voxsoft.metrics import METRICS

    color = "green" if result.status == "ok" else "red"
    say(f"[{color}]{result.status}[/{color}]: {plain(result.message)}")
    if result.probes:
        rows = (
            [name, *(f"{round(component * 1e3, 3) + 0.0:.3f}" for component in moved)]
            for name, moved in result.probes.items()
        )
        show_table("Displacement of probes (mm)", ["probe", "x", "y", "z"], rows)
    for index, (now, cavity) in enumerate(
        zip(result.cavity_volumes, result.mesh.cavities, strict=True)
    ):
        before = quantity(float(cavity.volume), "volume")
        say(f"cavity {index}: {before} grew to {quantity(now, 'volume')}")
    design = result.design
    metrics = {name: objective.metric for name, objective in design.objectives.items()}
    metrics |= {name: constraint.metric for name, constraint in design.constraints.items()}
    for name, metric in metrics.items():
        say(f"{plain(name)}: {quantity(result.metrics[name], METRICS[metric])}")
    say(f"{len(result.mesh.tets) // 5:,} voxels in {result.seconds:.2f} s")
    say(f"wrote {plain(str(folder))}")
