"""``voxsoft sweep`` and ``voxsoft optimize``: many designs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.options import DesignFile, Json, Seed, Sets, Workers
from voxsoft.cli.output import plain, print_json, quantity, say, show_table

if TYPE_CHECKING:
    from voxsoft.design import Design
    from voxsoft.study import Study, StudyResult, TrialEvent

    Evaluate = Callable[[Study, Callable[[TrialEvent], None]], StudyResult]

#: How many of the best designs are listed.
LISTED = 10

Scheduler = Annotated[
    str | None,
    typer.Option("--scheduler", metavar="tcp://HOST:PORT", help="Run trials on a Dask cluster."),
]
Storage = Annotated[
    str | None,
    typer.Option("--storage", metavar="URL", help="An Optuna storage instead of a file."),
]
Out = Annotated[
    Path | None, typer.Option("--out", "-o", help="Study folder; default: runs/NAME-VERB.")
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
        evaluate=lambda study, tell: study.grid(
            workers=workers, scheduler=scheduler, progress=tell
        ),
        total=lambda study: study.grid_size,
        storage=storage,
        seed=0,
    )


def optimize(
    design: DesignFile,
    sampler: Annotated[
        str,
        typer.Option(
            "--sampler",
            help="tpe, cma-es, gp, nsga-ii, nsga-iii, random, grid, genetic or gradient.",
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
    """Search the parameters' ranges for the best objectives of a design.

    A search that was stopped goes on where it was, and one with a larger budget goes further.
    """
    _study(
        design,
        sets or [],
        out,
        "optimize",
        json=json,
        evaluate=lambda study, tell: study.optimize(
            sampler, budget, workers=workers, scheduler=scheduler, progress=tell
        ),
        total=lambda study: study.grid_size if sampler == "grid" else budget,
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
    evaluate: Evaluate,
    total: Callable[[Study], int],
    storage: str | None,
    seed: int,
) -> None:
    from voxsoft import files
    from voxsoft.cli.progress import ProgressBar
    from voxsoft.simulation import check_targets
    from voxsoft.study import Study

    with errors_in_words(json=json):
        design = files.load(path, assignments=sets)
        # A target that cannot be measured would fail every trial.
        check_targets(design)
        folder = out or Path("runs") / f"{design.name}-{verb}"
        study = Study(design, folder=folder, storage=storage, seed=seed)
        new: list[TrialEvent] = []
        with ProgressBar("designs", total(study)) as bar:

            def tell(event: TrialEvent) -> None:
                new.append(event)
                bar.advance_to(event.done, _note(design, event))

            result = evaluate(study, tell)
        earlier = len(result.trials) - len(new)
        if earlier:
            say(f"{earlier} designs were solved before and not again; {len(new)} are new")
        written = files.write_study(result, folder)
        if json:
            print_json(result.summary() | {"folder": str(folder)})
        else:
            _show(design, result)
            names = ", ".join(file.name for file in written)
            say(f"wrote {plain(str(folder))}: {names}")


def _note(design: Design, event: TrialEvent) -> str:
    if event.best is None:
        return ""
    first = next(iter(design.objectives))
    return f"best {first} {_objective(design, first, event.best)}"


def _show(design: Design, result: StudyResult) -> None:
    from voxsoft.metrics import METRICS

    reasons = {trial.status: trial.message for trial in reversed(result.trials)}
    found = {status: count for status, count in result.counts.items() if count}
    counts = ", ".join(f"{count} {status}" for status, count in found.items())
    say(f"[bold]{len(result.trials)} designs[/bold]: {counts}")
    for status in found:
        if status != "ok":
            say(f"[yellow]{status}[/yellow], for instance: {plain(reasons[status])}")
    if not result.ranking:
        say("[red]no design is at rest within the constraints[/red]")
        return
    best = result.ranking[:LISTED]
    columns = [("rank", [str(rank) for rank in range(1, len(best) + 1)])]
    for name in result.parameters:
        values = [trial.parameters[name] for trial in best]
        columns.append(_column(name, values, design.parameters[name].kind))
    for name, objective in design.objectives.items():
        values = [trial.objectives[name] for trial in best]
        columns.append(_column(name, values, METRICS[objective.metric]))
    first, objective = next(iter(design.objectives.items()))
    title = f"The best designs (to {objective.direction} {first})"
    show_table(
        title, [head for head, _ in columns], zip(*(cells for _, cells in columns), strict=True)
    )


def _column(name: str, values: list[float], kind: str) -> tuple[str, list[str]]:
    """The head of a column with its unit, and its cells."""
    from voxsoft.plot.quantities import scale_for

    scale = scale_for(values, kind)
    return scale.label(name), [f"{value * scale.factor:.4g}" for value in values]


def _objective(design: Design, name: str, value: float) -> str:
    from voxsoft.metrics import METRICS

    return quantity(value, METRICS[design.objectives[name].metric])
