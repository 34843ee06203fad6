"""``voxsoft sweep`` and ``voxsoft optimize``: many designs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from voxsoft._folders import folder_name
from voxsoft._worker_server import start_early
from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.options import DesignFile, Json, Seed, Sets, Workers
from voxsoft.cli.output import plain, print_json, quantity, say, show_table

if TYPE_CHECKING:
    from voxsoft.comparison import Confirmation, Estimate
    from voxsoft.design import Design
    from voxsoft.study import StudyResult

#: Number of the best designs listed.
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
AlongPath = Annotated[
    str | None,
    typer.Option(
        "--over",
        metavar="KEY=RANGE",
        help="Follow each design along a path: 'loads[0].value=0..30 kPa/8'.",
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
    over: AlongPath = None,
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
        {"sampler": "grid", "workers": workers, "over": over, "confirm": confirm},
        scheduler=scheduler,
        storage=storage,
        json=json,
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
    budget: Annotated[int, typer.Option("--budget", min=1, help="Number of trials.")] = 100,
    sets: Sets = None,
    out: Out = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    storage: Storage = None,
    seed: Seed = 0,
    over: AlongPath = None,
    confirm: Confirm = 0,
    json: Json = False,
) -> None:
    """Search the parameters' ranges for the best objectives of a design.

    A search that was stopped goes on where it was, and one with a larger budget goes further.
    """
    search = {
        "sampler": sampler,
        "budget": None if sampler == "grid" else budget,
        "seed": seed,
        "workers": workers,
        "over": over,
        "confirm": confirm,
    }
    _study(
        design,
        sets or [],
        out,
        "optimize",
        search,
        scheduler=scheduler,
        storage=storage,
        json=json,
    )


def _study(
    path: Path,
    sets: list[str],
    out: Path | None,
    verb: str,
    search: dict[str, Any],
    *,
    scheduler: str | None,
    storage: str | None,
    json: bool,
) -> None:
    if scheduler is None and path.is_file():
        start_early()
    from voxsoft import files
    from voxsoft.cli.progress import JobBar
    from voxsoft.jobs import DesignSource, StudySpec, run_job
    from voxsoft.study.plateau import below_voxels
    from voxsoft.study.space import space_of

    with errors_in_words(json=json):
        design = files.load(path, assignments=sets)
        spec = StudySpec(design=DesignSource.of_file(path, sets), **search)
        for doubt in below_voxels(design, space_of(design)):
            say(f"[yellow]warning:[/yellow] {plain(str(doubt))}")
        folder = out or Path("runs") / f"{folder_name(design.name)}-{verb}"
        with JobBar() as bar:
            outcome = run_job(spec, folder, bar.follow, scheduler=scheduler, storage=storage)
        result = outcome.found
        if outcome.earlier:
            new = len(result.trials) - outcome.earlier
            say(f"{outcome.earlier} designs were solved before and not again; {new} are new")
        if json:
            print_json(outcome.summary)
            return
        _show(design, result)
        if outcome.confirmed is not None:
            _show_confirmation(design, result, outcome.confirmed)
        names = ", ".join(file.name for file in outcome.written)
        say(f"wrote {plain(str(folder))}: {names}")


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


def _show(design: Design, result: StudyResult) -> None:
    from voxsoft.metrics import METRICS

    reasons = {trial.status: trial.message for trial in reversed(result.trials)}
    found = {status: count for status, count in result.counts.items() if count}
    counts = ", ".join(f"{count} {status}" for status, count in found.items())
    distinct = f", {result.distinct} distinct" if result.distinct < result.counts["ok"] else ""
    say(f"[bold]{len(result.trials)} designs[/bold]: {counts}{distinct}")
    for status in found:
        if status != "ok":
            say(f"[yellow]{status}[/yellow], for instance: {plain(reasons[status])}")
    doubtful = [trial for trial in result.trials if trial.status == "ok" and trial.warnings]
    if doubtful:
        warned = f"{len(doubtful)} of {result.counts['ok']} ok have warnings"
        say(f"[yellow]{warned}[/yellow], for instance: {plain(doubtful[0].warnings[0])}")
    for doubt in result.warnings:
        say(f"[yellow]warning:[/yellow] {plain(str(doubt))}")
    if not result.ranking:
        say("[red]no design is at rest within the constraints[/red]")
        return
    best = result.ranking[:LISTED]
    columns = [("rank", [str(rank) for rank in result.ranks[:LISTED]])]
    for name in result.parameters:
        values = [trial.parameters[name] for trial in best]
        columns.append(_column(name, values, design.parameters[name].kind))
    for name, objective in design.objectives.items():
        values = [trial.objectives[name] for trial in best]
        columns.append(_column(name, values, METRICS[objective.metric].kind))
    for name, constraint in design.constraints.items():
        values = [trial.metrics.get(name, float("nan")) for trial in best]
        columns.append(_column(name, values, METRICS[constraint.metric].kind))
    first, objective = next(iter(design.objectives.items()))
    title = f"The best designs (to {objective.direction} {first})"
    show_table(
        title,
        [head for head, _ in columns],
        zip(*(cells for _, cells in columns), strict=True),
        doubtful=[bool(trial.warnings) for trial in best],
    )
    for name, (low, high) in result.plateau.items():
        kind = design.parameters[name].kind
        ends = f"from {quantity(low, kind)} to {quantity(high, kind)}"
        say(f"the best is one body for {plain(name)} {ends}")
    if len(design.objectives) > 1:
        numbers = ", ".join(str(trial.number) for trial in result.pareto_front)
        say(f"on the Pareto front: designs {numbers}")
    for rank, trial in zip(result.ranks, best, strict=False):
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
