"""``voxsoft calibrate``: a material from measurements."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from voxsoft._folders import folder_name
from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.options import DesignFile, Json, Seed, Sets, Workers
from voxsoft.cli.output import plain, print_json, quantity, say, show_table

if TYPE_CHECKING:
    from voxsoft.calibration import Calibration
    from voxsoft.jobs import MeasuredTable


def calibrate(
    design: DesignFile,
    data: Annotated[
        list[Path],
        typer.Argument(
            help="Tables of stations (CSV) or tests (TOML), one file or several.",
            exists=True,
            dir_okay=False,
        ),
    ],
    method: Annotated[
        str,
        typer.Option(
            "--method", help="genetic (the paper's), gradient, cma-es, or an Optuna sampler."
        ),
    ] = "genetic",
    material: Annotated[
        str | None, typer.Option("--material", help="Which material, where a file holds several.")
    ] = None,
    line: Annotated[
        str | None,
        typer.Option(
            "--line",
            help="Line of arc positions: lower-edge, centerline or upper-edge. Asked for if left "
            "out, and lower-edge where nobody answers.",
        ),
    ] = None,
    free_scale: Annotated[
        bool, typer.Option("--free-scale", help="Fit one scale factor of the data as well.")
    ] = False,
    sets: Sets = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Folder; default: runs/NAME-calibration.")
    ] = None,
    name: Annotated[
        str | None, typer.Option("--name", help="Name of the material card; default: the data's.")
    ] = None,
    generations: Annotated[int, typer.Option("--generations", min=1)] = 50,
    population: Annotated[int, typer.Option("--population", min=4)] = 30,
    workers: Workers = None,
    seed: Seed = 0,
    json: Json = False,
) -> None:
    """Fit the design's material to measurements and write a material card with its report."""
    from voxsoft import files
    from voxsoft.cli.progress import JobBar
    from voxsoft.jobs import CalibrateSpec, DesignSource, MeasuredTable, run_job

    with errors_in_words(json=json):
        loaded = files.load(design, assignments=sets or [])
        tables = [table for path in data for table in MeasuredTable.of_file(path, material)]
        spec = CalibrateSpec(
            design=DesignSource.of_file(design, sets or []),
            data=_on_a_line(tables, line, asks=not json and sys.stdin.isatty()),
            method=method,
            free_scale=free_scale,
            generations=generations,
            population=population,
            workers=workers,
            seed=seed,
            card=name,
        )
        folder = out or Path("runs") / f"{folder_name(loaded.name)}-calibration"
        with JobBar() as bar:
            outcome = run_job(spec, folder, bar.follow)
        if json:
            print_json(outcome.summary)
        else:
            _show(outcome.found)
            names = ", ".join(file.name for file in outcome.written)
            say(f"wrote {plain(str(folder))}: {names}")


def _on_a_line(tables: list[MeasuredTable], line: str | None, *, asks: bool) -> list[MeasuredTable]:
    """Return the tables with the line of their arc positions, that a person is asked for."""
    seen = [table.read() for table in tables]
    along = [each.arcs is not None and (line or each.line is None) for each in seen]
    if not any(along) or (line is None and not asks):
        return tables
    if line is None:
        names = ", ".join(t.name for t, is_open in zip(tables, along, strict=True) if is_open)
        say(f"{plain(names)}: arc positions, and no line of the body on which they were marked")
        line = typer.prompt("lower-edge, centerline or upper-edge", default="lower-edge")
    return [
        table.on_line(line) if is_open else table
        for table, is_open in zip(tables, along, strict=True)
    ]


def _show(answer: Calibration) -> None:
    mean, largest = (quantity(error, "length") for error in (answer.mean_error, answer.max_error))
    say(f"mean error {mean}, largest {largest}, fitness {answer.fitness:.4f}")
    if answer.free_scale:
        scales = answer.scale if isinstance(answer.scale, list) else [answer.scale]
        say(f"scale of the simulated shape: {', '.join(f'{scale:.4f}' for scale in scales)}")
    sentences = {profile.name: profile.sentence for profile in answer.profiles}
    rows = [
        [name, quantity(value, answer.kinds[name]), sentences.get(name, "not asked")]
        for name, value in answer.parameters.items()
    ]
    show_table("Parameters", ["name", "value", "what the data say"], rows)
    for fit in answer.fits:
        if fit.experiment.measurement.arcs is not None:
            where = fit.experiment.line.replace("-", " ")
            say(f"{plain(fit.experiment.name)}: arc positions are on the {where}")
    for warning in answer.warnings:
        say(f"[yellow]warning[/yellow] {plain(warning)}")
