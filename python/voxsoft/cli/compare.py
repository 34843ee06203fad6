"""``voxsoft compare``: a design by several solvers, an outside code and measurements."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from voxsoft._folders import folder_name
from voxsoft.cli.exits import NOT_AT_REST, errors_in_words
from voxsoft.cli.options import DesignFile, Json, Sets
from voxsoft.cli.output import plain, print_json, say, show_table

if TYPE_CHECKING:
    from voxsoft.comparison import Comparison


class OutsideName(StrEnum):
    """The outside codes, as the command line names them."""

    auto = "auto"
    calculix = "calculix"
    scikit_fem = "scikit-fem"
    none = "none"


def compare(
    design: DesignFile,
    sets: Sets = None,
    solvers: Annotated[
        str, typer.Option("--solvers", help="Solvers of our own; estimates are for the last.")
    ] = "xpbd,statics",
    outside: Annotated[
        OutsideName, typer.Option("--outside", help="An outside code; auto: all installed ones.")
    ] = OutsideName.auto,
    voxel_sizes: Annotated[
        str | None,
        typer.Option(
            "--voxel-sizes", help="Other sizes, '5 mm, 2.5 mm', or none; default: half as large."
        ),
    ] = None,
    splits: Annotated[
        str, typer.Option("--splits", help="Bricks along the edge of a voxel.")
    ] = "1,2",
    measured: Annotated[
        list[Path] | None,
        typer.Option(
            "--measured",
            help="A table or test of the real body, as for calibrate. Repeatable.",
            exists=True,
        ),
    ] = None,
    time_limit: Annotated[
        float, typer.Option("--time-limit", min=0.1, help="Seconds for each run.")
    ] = 300.0,
    output: Annotated[
        Path | None,
        typer.Option("--output", help="The report; default: runs/NAME-HASH-comparison.html."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", help="Folder of the job; default: beside the report, with its name."
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Solve a design in several ways and write a report with estimates of their errors.

    The report is one HTML file: a table, figures, run times, discretization errors. The folder
    beside it holds the data from which `voxsoft again` repeats it.
    """
    from voxsoft import files
    from voxsoft.cli.progress import JobBar
    from voxsoft.files.atomic import write_atomically
    from voxsoft.files.run_folder import make_folder
    from voxsoft.jobs import CompareSpec, DesignSource, MeasuredTable, run_job

    with errors_in_words(json=json):
        loaded = files.load(design, assignments=sets or [])
        sizes, numbers = _lengths(voxel_sizes), _numbers(splits)
        spec = CompareSpec(
            design=DesignSource.of_file(design, sets or []),
            data=[table for path in measured or [] for table in MeasuredTable.of_file(path)],
            solvers=[name.strip() for name in solvers.split(",") if name.strip()],
            outside=outside.value,
            voxel_sizes=sizes,
            splits=numbers,
            time_limit=time_limit,
        )
        name = f"{folder_name(loaded.name)}-{loaded.hash[:8]}-comparison.html"
        target = output or Path("runs") / name
        with JobBar() as bar:
            outcome = run_job(spec, out or _beside(target), bar.follow)
        make_folder(target.parent)
        write_atomically(target, outcome.written[-1].read_bytes())
        if json:
            print_json(outcome.summary | {"report": str(target)})
        else:
            _show(outcome.found, target)
    if not outcome.found.base.ok:
        raise typer.Exit(NOT_AT_REST)


def _beside(report: Path) -> Path:
    """The folder of a comparison: named like its report."""
    return report.with_suffix("") if report.suffix else report.with_name(f"{report.name}-job")


def _lengths(text: str | None) -> list[float] | None:
    from voxsoft.units import parse

    if text is None:
        return None
    if text.strip() == "none":
        return []
    return [parse(part.strip(), "length", where="--voxel-sizes") for part in text.split(",")]


def _numbers(text: str) -> list[int]:
    from voxsoft.errors import SimulationError

    try:
        return [int(part) for part in text.split(",")]
    except ValueError:
        raise SimulationError("--splits", f'"{text}" is no list of numbers', "1,2") from None


def _show(found: Comparison, target: Path) -> None:
    from voxsoft.comparison.quantities import in_words

    rows: list[list[str]] = []
    for run in found.runs:
        count = f"{run.cells:,}" if run.cells else ""
        rows.append([run.label, run.status, count, f"{run.seconds:.3g} s", run.detail])
    show_table("Runs", ["run", "status", "cells", "time", ""], rows)
    for run in found.runs:
        if not run.ok:
            say(f"[red]{plain(run.label)}:[/red] {plain(run.message)}")
    good = found.side_by_side
    head = ["quantity", *(run.label for run in good), "error"]
    rows = []
    for name in found.quantities:
        known = [run.quantities.get(name) for run in good]
        error = found.base_error(name, "split voxels") or found.base_error(name, "voxel sizes")
        kind = found.known(name).kind
        cells = [in_words(each.value, kind) if each else "" for each in known]
        # A noise far below the digits shown is zero to a reader.
        noise = error is not None and error < 1e-6 * found.known(name).scale
        shown = "" if error is None else f"± {in_words(0.0 if noise else error, kind)}"
        rows.append([name, *cells, shown])
    show_table(f"Answers; error: estimate for {found.base.label}", head, rows)
    for index, judged in enumerate(found.measured):
        for run in good:
            errors = found.errors(run, index)
            if errors is not None:
                mean, most = (in_words(float(e), "length") for e in (errors.mean(), errors.max()))
                say(plain(f"{judged.name}, {run.label}: mean error {mean}, largest {most}"))
    for warning in found.warnings:
        say(f"[yellow]warning:[/yellow] {plain(str(warning))}")
    if found.note:
        say(f"[yellow]note:[/yellow] {plain(found.note)}")
    say(f"wrote {plain(str(target))}")
