"""``voxsoft sweep`` and ``voxsoft optimize``: many designs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from voxsoft._folders import folder_name
from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.options import DesignFile, Json, Seed, Sets, Workers
from voxsoft.cli.output import plain, print_json, quantity, say, show_table

if TYPE_CHECKING:
    from voxsoft.comparison import Confirmation, Estimate
    from voxsoft.design import Design
    from voxsoft.study import Study, StudyResult, TrialEvent

    Evaluate = Callable[[Study, Callable[[TrialEvent], None]], StudyResult]

#: How many of the best designs are listed.
LISTED = 10

Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler", metavar="ADDRESS", help="Run trials on a Dask cluster, tls://HOST:PORT."
    ),
]
Storage = Annotated[
    str | None,
    typer.Option("--storage", metavar="URL", help="An Optuna storage instead of a file."),
]
Confirm = Annotated[
    int,
    typer.Option(
        "--confirm",
        min=0,
        metavar="N",
        help="Solve the best N designs again, as rubber and on finer voxels, with error bars.",
    ),
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
    confirm: Confirm = 0,
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
        confirm=confirm,
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
    confirm: Confirm = 0,
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
        confirm=confirm,
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
    confirm: int,
) -> None:
    from voxsoft import files
    from voxsoft.cli.progress import ProgressBar
    from voxsoft.simulation import check_solver, check_targets
    from voxsoft.study import Study

    with errors_in_words(json=json):
        design = files.load(path, assignments=sets)
        # A target that cannot be measured, or a setting that is not used, would fail every trial.
        check_targets(design)
        check_solver(design)
        folder = out or Path("runs") / f"{folder_name(design.name)}-{verb}"
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
        if not json:
            _show(design, result)
        confirmed = _confirmed(design, result, confirm) if confirm and result.ranking else None
        if confirmed is not None:
            written = [*written, files.write_confirmation(confirmed, folder)]
        if json:
            more = {} if confirmed is None else {"confirmed": confirmed.summary()}
            print_json(result.summary() | more | {"folder": str(folder)})
        else:
            if confirmed is not None:
                _show_confirmation(design, result, confirmed)
            names = ", ".join(file.name for file in written)
            say(f"wrote {plain(str(folder))}: {names}")


def _confirmed(design: Design, result: StudyResult, count: int) -> Confirmation:
    from voxsoft.cli.progress import ProgressBar
    from voxsoft.comparison import confirm

    with ProgressBar("solving the best again", 2 * count, transient=True) as bar:
        return confirm(
            design, result, count=count, progress=lambda done, total: bar.advance_to(done, "")
        )


def _show_confirmation(design: Design, result: StudyResult, found: Confirmation) -> None:
    from voxsoft.metrics import METRICS
    from voxsoft.plot.quantities import scale_for

    kind = METRICS[design.objectives[found.objective].metric].kind
    scale = scale_for([row.trial.objectives[found.objective] for row in found.designs], kind)
    columns = [("rank", [str(rank) for rank in range(1, len(found.designs) + 1)])]
    for name in result.parameters:
        values = [row.trial.parameters[name] for row in found.designs]
        columns.append(_column(name, values, design.parameters[name].kind))
    before = [
        f"{scale.factor * row.trial.objectives[found.objective]:.4g}" for row in found.designs
    ]
    after = [
        plain(row.message) if row.estimate is None else _with_error(row.estimate, scale.factor)
        for row in found.designs
    ]
    columns += [(scale.label("study"), before), (scale.label("again"), after)]
    rubber = ", ".join(f"{new} in place of {old}" for old, new in found.materials.items())
    size = quantity(found.voxel_sizes[-1], "length")
    title = f"Solved again on voxels of {size}" + (f", {rubber}" if rubber else "")
    show_table(
        title, [head for head, _ in columns], zip(*(cells for _, cells in columns), strict=True)
    )
    for row in found.designs:
        for warning in row.warnings:
            say(f"[yellow]warning[/yellow], design {row.trial.number}: {plain(warning)}")
    say(f"confirmed: {plain(found.sentence)}")


def _note(design: Design, event: TrialEvent) -> str:
    if event.best is None:
        return ""
    first = next(iter(design.objectives))
    doubtful = ", doubtful" if event.doubts else ""
    return f"best {first} {_objective(design, first, event.best)}{doubtful}"


def _show(design: Design, result: StudyResult) -> None:
    from voxsoft.metrics import METRICS

    reasons = {trial.status: trial.message for trial in reversed(result.trials)}
    found = {status: count for status, count in result.counts.items() if count}
    counts = ", ".join(f"{count} {status}" for status, count in found.items())
    say(f"[bold]{len(result.trials)} designs[/bold]: {counts}")
    for status in found:
        if status != "ok":
            say(f"[yellow]{status}[/yellow], for instance: {plain(reasons[status])}")
    doubtful = [trial for trial in result.trials if trial.status == "ok" and trial.warnings]
    if doubtful:
        told = f"{len(doubtful)} of {result.counts['ok']} ok have warnings"
        say(f"[yellow]{told}[/yellow], for instance: {plain(doubtful[0].warnings[0])}")
    for doubt in result.warnings:
        say(f"[yellow]warning:[/yellow] {plain(str(doubt))}")
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
        columns.append(_column(name, values, METRICS[objective.metric].kind))
    first, objective = next(iter(design.objectives.items()))
    title = f"The best designs (to {objective.direction} {first})"
    show_table(
        title,
        [head for head, _ in columns],
        zip(*(cells for _, cells in columns), strict=True),
        doubtful=[bool(trial.warnings) for trial in best],
    )
    for rank, trial in enumerate(best, start=1):
        if trial.warnings:
            more = f" (and {len(trial.warnings) - 1} more)" if len(trial.warnings) > 1 else ""
            say(f"[yellow]warning[/yellow]: rank {rank}: {plain(trial.warnings[0])}{more}")


def _with_error(estimate: Estimate, factor: float) -> str:
    return f"{factor * estimate.values[-1]:.4g} ± {factor * estimate.error:.2g}"


def _column(name: str, values: list[float], kind: str) -> tuple[str, list[str]]:
    """The head of a column with its unit, and its cells."""
    from voxsoft.plot.quantities import scale_for

    scale = scale_for(values, kind)
    return scale.label(name), [f"{value * scale.factor:.4g}" for value in values]


def _objective(design: Design, name: str, value: float) -> str:
    from voxsoft.metrics import METRICS

    return quantity(value, METRICS[design.objectives[name].metric].kind)
