"""``voxsoft sweep`` and ``voxsoft optimize``: many designs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer

from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.options import DesignFile, Json, Seed, Sets, Workers
from voxsoft.cli.output import print_json, say, show_table
from voxsoft.cli.progress import ProgressBar
from voxsoft.design import Design
from voxsoft.study import Study, StudyResult, TrialEvent
from voxsoft.units import format_quantity

Scheduler = Annotated[
    str | None,
    typer.Option("--scheduler", metavar="tcp://HOST:PORT", help="Run trials on a Dask cluster."),
]
Storage = Annotated[
    str | None,
    typer.Option("--storage", metavar="URL", help="An Optuna storage instead of a file."),
]
Out = Annotated[
    Path | None, typer.Option("--out", "-o", help="Study folder; default: runs/NAME-sweep.")
]


def sweep(
    design: DesignFile,
    sets: Sets = None,
    out: Out = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    storage: Storage = None,
    json: Json = False,
) -> None:
    """Solve every design of the grid that the parameters' min, max and step span.

    A study that was stopped goes on where it was; finished trials are never repeated.
    """
    _study(
        design,
        sets or [],
        out,
        "sweep",
        json=json,
        make=lambda study, tell: study.grid(workers=workers, scheduler=scheduler, progress=tell),
        total=lambda study: study.grid_size,
        storage=storage,
        seed=0,
    )


def optimize(
    design: DesignFile,
    sampler: Annotated[
        str,
        typer.Option(
            "--sampler", help="tpe, cma-es, gp, nsga-ii, nsga-iii, random, grid or genetic."
        ),
    ] = "tpe",
    budget: Annotated[int, typer.Option("--budget", min=1, help="How many trials.")] = 100,
    sets: Sets = None,
    out: Out = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    storage: Storage = None,
    seed: Seed = 0,
    json: Json = False,
) -> None:
    """Search the parameters' ranges for the best objectives of a design."""
    _study(
        design,
        sets or [],
        out,
        "optimize",
        json=json,
        make=lambda study, tell: study.optimize(
            sampler, budget, workers=workers, scheduler=scheduler, progress=tell
        ),
        total=lambda study: budget,
        storage=storage,
        seed=seed,
    )


def _study(
    path: Path,
    sets: list[str],
    out: Path | None,
    verb: str,
    *,
    json: bool,
    make: Callable[[Study, Callable[[TrialEvent], None]], StudyResult],
    total: Callable[[Study], int],
    storage: str | None,
    seed: int,
) -> None:
    from voxsoft import files

    with errors_in_words(json=json):
        design = files.load_with(path, sets)
        folder = out or Path("runs") / f"{design.name}-{verb}"
        study = Study(design, folder=folder, storage=storage, seed=seed)
        with ProgressBar("designs", total(study)) as bar:
            result = make(study, lambda event: bar.advance_to(event.done, _note(event)))
        figures = files.write_study(result, folder)
        if json:
            print_json(result.summary() | {"folder": str(folder)})
        else:
            _show(design, result)
            say(f"wrote {', '.join(str(figure) for figure in figures)}")


def _note(event: TrialEvent) -> str:
    return "" if event.best is None else f"best {event.best:.4g}"


def _show(design: Design, result: StudyResult) -> None:
    counts = ", ".join(f"{count} {status}" for status, count in result.counts.items())
    say(f"[bold]{len(result.trials)} designs[/bold]: {counts}")
    names = list(design.parameters)
    objectives = list(design.objectives)
    rows = [
        [
            str(rank),
            *(
                format_quantity(trial.parameters[n], design.parameters[n].kind)
                for n in names
                if n in trial.parameters
            ),
            *(f"{trial.objectives[o] * 1e3:.4g}" for o in objectives),
        ]
        for rank, trial in enumerate(result.ranking[:10], start=1)
    ]
    shown = [n for n in names if result.ranking and n in result.ranking[0].parameters]
    show_table("The best designs", ["rank", *shown, *(f"{o} (1e-3 SI)" for o in objectives)], rows)
