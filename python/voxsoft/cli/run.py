"""``voxsoft run``: one design to its state at rest, or over time."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from voxsoft._folders import folder_name
from voxsoft.cli.exits import FAILED, NOT_AT_REST, errors_in_words
from voxsoft.cli.options import DesignFile, Json, Sets
from voxsoft.cli.output import plain, print_json, quantity, say, show_table

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from voxsoft.comparison import ErrorBar, ErrorBars
    from voxsoft.jobs import JobOutcome
    from voxsoft.simulation import Diagnostic, LoadPath, Result


_METHODS = "auto, statics, relaxation, dynamics or xpbd; default: as the design says, else auto."

#: Numbers below this part of the largest of a column are rounding.
_ROUNDING = 1e-9

_ERRORS = "Voxels for error bars: auto, finer, coarser or off; default: as the design says."


def run(
    design: DesignFile,
    sets: Sets = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Run folder; default: runs/NAME-HASH."),
    ] = None,
    solver: Annotated[str | None, typer.Option("--solver", help=_METHODS)] = None,
    error: Annotated[str | None, typer.Option("--error", help=_ERRORS)] = None,
    accuracy: Annotated[
        str | None,
        typer.Option("--accuracy", help='The error to leave, such as "2 %": smaller voxels.'),
    ] = None,
    figure: Annotated[
        bool,
        typer.Option(
            "--figure",
            help="Also draw the deformed body, as body.png, its contacts, as contact.png, and "
            "the numbers along a path, as path.png.",
        ),
    ] = False,
    over: Annotated[
        str | None,
        typer.Option(
            "--over",
            help="Follow a path: a key, its values, a unit, how many: "
            "'loads[0].value=0..30 kPa/16', there and back 0..30..0, or 'time=0..2 s/21'.",
        ),
    ] = None,
    frequencies: Annotated[
        int,
        typer.Option(
            "--frequencies",
            min=0,
            help="How many natural frequencies of small vibrations about the equilibrium to find.",
        ),
    ] = 0,
    frames: Annotated[
        str | None,
        typer.Option(
            "--frames",
            help='Keep the moving body every "20 ms", for ParaView: voxsoft export RUN it.pvd.',
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Simulate a design and write a run folder.

    The folder holds design.toml (resolved), summary.json and result.vtu, and job.toml, with which
    `voxsoft again` repeats it.
    """
    from voxsoft import files
    from voxsoft.cli.progress import JobBar
    from voxsoft.jobs import DesignSource, RunSpec, run_job

    with errors_in_words(json=json):
        settings = {"method": solver, "error": error, "accuracy": accuracy}
        loaded = files.load(design, assignments=sets or [])
        spec = RunSpec(
            design=DesignSource.of_file(design, sets or []),
            solver={name: value for name, value in settings.items() if value is not None},
            over=over,
            figure=figure,
            frequencies=frequencies,
            frames=frames,
        )
        folder = out or Path("runs") / f"{folder_name(loaded.name)}-{loaded.hash[:8]}"
        with JobBar() as bar:
            outcome = run_job(spec, folder, bar.follow)
        if json:
            print_json(outcome.summary)
        else:
            if outcome.path is not None:
                _show_path(outcome.path, outcome.path_bars)
            _show(outcome, folder)
    for problem in outcome.unwritten:
        say(f"[red]error:[/red] {plain(str(problem))}")
    if outcome.unwritten:
        raise typer.Exit(FAILED)
    if outcome.found.status != "ok":
        raise typer.Exit(NOT_AT_REST)


def _show_path(path: LoadPath, bars: Sequence[ErrorBars]) -> None:
    """Show the numbers along a path: those the design asks for, or else displacements of probes."""
    from voxsoft.comparison.path_bars import bars_of

    design = path.design
    names = [*design.objectives, *design.constraints]
    names = names or [f"{probe}.{axis}" for probe in design.probes for axis in "xyz"]
    rows = [[path.over.value_in_words(value)] for value in path.values]
    for name in names:
        kind, values = path.columns[name]
        known = [*bars_of(name, bars), *[None] * len(values)]
        rounding = _ROUNDING * max(map(abs, values))
        for row, value, bar in zip(rows, values, known, strict=False):
            if abs(value) <= rounding:
                row.append("0")
            else:
                row.append(quantity(value, kind) if bar is None else str(bar))
    statuses = [result.status for result in path.results]
    doubtful = [status != "ok" for status in statuses]
    columns = [path.over.key, *names]
    if any(doubtful):
        columns.append("status")
        for row, status in zip(rows, statuses, strict=True):
            row.append(status)
    color = "green" if path.status == "ok" else "red"
    say(f"[{color}]{path.status}[/{color}]: {plain(path.message)}")
    show_table(f"Along {path.over.key}", columns, rows, doubtful)
    say("The last equilibrium:")


def _show(outcome: JobOutcome[Result], folder: Path) -> None:
    from voxsoft.design.chamber import name_of_cavity
    from voxsoft.metrics import METRICS

    result, bars = outcome.found, outcome.error_bars
    spoiled = any(found.severity == "error" for found in result.warnings)
    color = "red" if result.status != "ok" or spoiled else "yellow" if result.warnings else "green"
    say(f"[{color}]{result.status}[/{color}]: {plain(result.message)}")
    if result.probes:
        show_table("Displacement of probes", ["probe", "x", "y", "z"], _probe_rows(result, bars))
    for index, (now, cavity) in enumerate(
        zip(result.cavity_volumes, result.mesh.cavities, strict=True)
    ):
        before = quantity(float(cavity.volume), "volume")
        name = plain(name_of_cavity(result.mesh, index))
        bar = bars.volumes[index] if bars and bars.volumes else None
        say(f"{name}: {before} grew to {quantity(now, 'volume')}{_with(bar)}")
        pressure = bars.pressures[index] if bars and bars.pressures else None
        if pressure is not None and not pressure.is_exact:
            say(f"{name}: under {quantity(pressure.value, 'pressure')}{_with(pressure)}")
    design = result.design
    metrics = {name: objective.metric for name, objective in design.objectives.items()}
    metrics |= {name: constraint.metric for name, constraint in design.constraints.items()}
    for name, metric in metrics.items():
        bar = bars.metrics.get(name) if bars else None
        say(f"{plain(name)}: {quantity(result.metrics[name], METRICS[metric].kind)}{_with(bar)}")
    _show_factors(result, bars)
    _show_reactions(result, bars)
    for name, tendon in result.tendons.items():
        say(f"{plain(name)}: {tendon.words}{_tendon_in_words(bars, name)}")
    for supply in result.supplies:
        say(plain(supply.sentence))
    for contact in result.contacts:
        say(f"{plain(contact.sentence)}{_contact_in_words(bars, contact.of)}")
    if bars is not None:
        _show_grips(result, bars)
    _show_frequencies(outcome)
    say(_stress_line(result))
    say(_stretch_line(result))
    for found in result.warnings:
        shade = "red" if found.severity == "error" else "yellow"
        say(f"[{shade}]{found.severity}[/{shade}]: {plain(str(found))}{_place(found)}")
    say(f"{_voxels(result)} in {result.seconds:.2f} s")
    if bars is not None:
        say(_source(bars, asked=design.solver.error != "off"))
    say(f"wrote {plain(str(folder))}")


def _show_grips(result: Result, bars: ErrorBars) -> None:
    """Show how free objects are held, with error bars."""
    for each in result.design.objects:
        held = bars.objects.get(each.name, {}) if each.is_free else {}
        for key, kind in (("grip_force", "force"), ("hold_margin", "number")):
            if key in held:
                shown = quantity(held[key].value, kind)
                say(f"{plain(each.name)}: {key.replace('_', ' ')} {shown}{_with(held[key])}")


def _show_factors(result: Result, bars: ErrorBars | None) -> None:
    """Show which part of the loads a run carries where that is an answer, and its limit."""
    for name in ("load_factor", "limit_factor"):
        value: float | None = getattr(result, name)
        if value is not None and (name == "limit_factor" or value != 1.0):
            bar = getattr(bars, name) if bars else None
            say(f"{name.replace('_', ' ')}: {quantity(value, 'number')}{_with(bar)}")
    for index, snap in enumerate(result.snaps):
        bar = bars.snaps[index] if bars and bars.snaps else None
        say(f"snapped at load factor {quantity(snap, 'number')}{_with(bar)}")


def _show_frequencies(outcome: JobOutcome[Result]) -> None:
    """Show the natural frequencies that were asked for with error bars, or why there are none."""
    if outcome.modes_missing:
        say(f"[yellow]no natural frequencies: {plain(outcome.modes_missing)}[/yellow]")
    if outcome.modes is None:
        return
    known = outcome.error_bars.frequencies if outcome.error_bars else ()
    for index, value in enumerate(outcome.modes.frequencies.tolist()):
        bar = known[index] if index < len(known) else None
        say(f"natural frequency {index + 1}: {quantity(value, 'rate')}{_with(bar)}")


def _show_reactions(result: Result, bars: ErrorBars | None) -> None:
    forces = result.clamp_reactions
    if forces:
        rounding = _ROUNDING * max(abs(each) for force in forces.values() for each in force)
        rows = []
        for name, force in forces.items():
            shown = ["0" if abs(each) <= rounding else quantity(each, "force") for each in force]
            rows.append([name, *shown])
            if bars is not None and name in bars.reactions:
                rows.append(["  estimate", *map(str, bars.reactions[name])])
        show_table("Reactions of clamps", ["clamp", "x", "y", "z"], rows)


def _contact_in_words(bars: ErrorBars | None, of: tuple[str, str]) -> str:
    """Write the contact force of a pair with its errors; the sum of sizes for a body on itself."""
    from voxsoft.comparison.error_bar import vector_in_words

    found = bars.contacts.get(of) if bars else None
    if found is None:
        return ""
    if of[0] == of[1]:
        return f", estimate {found['pressed']}"
    return f", estimate {vector_in_words([found[axis] for axis in 'xyz'])}"


def _voxels(result: Result) -> str:
    """Count the voxels, and those that stayed large beside refined ones."""
    if not result.design.refine:
        tets = len(result.mesh.tets)
        return f"{tets:,} tetrahedra" if result.mesh.voxel_size is None else f"{tets // 5:,} voxels"
    from voxsoft.simulation import Setup

    setup = Setup(result.design, result.mesh)
    return f"{setup.elements:,} voxels, {setup.large_count:,} of them large,"


def _probe_rows(result: Result, bars: ErrorBars | None) -> Iterator[list[str]]:
    """Displacement of each probe on these voxels, and below it the extrapolated one, if known."""
    for name, moved in result.probes.items():
        yield [name, *(f"{round(component * 1e3, 3) + 0.0:.3f} mm" for component in moved)]
        if bars is not None and name in bars.probes:
            yield ["  estimate", *map(str, bars.probes[name])]


def _tendon_in_words(bars: ErrorBars | None, name: str) -> str:
    from voxsoft.comparison.error_bar import tendon_in_words

    if bars is None or name not in bars.tendons:
        return ""
    return f", estimate {tendon_in_words(bars.tendons[name])}"


def _with(bar: ErrorBar | None) -> str:
    return "" if bar is None else f", estimate {bar}"


def _source(bars: ErrorBars, *, asked: bool) -> str:
    """Source of the error bars; in yellow where they are missing though they were wanted."""
    sentence = plain(bars.sentence)
    doubtful = asked and (bars.missing or not bars.regular)
    return f"[yellow]{sentence}[/yellow]" if doubtful else f"{sentence} ({bars.seconds:.1f} s)"


def _stress_line(result: Result) -> str:
    largest, most = (
        quantity(result.fields.percentile("von_mises", p), "pressure") for p in (100, 99)
    )
    return f"von Mises stress: up to {largest}; 99 % of the volume up to {most}"


def _stretch_line(result: Result) -> str:
    from voxsoft.design.tested import tested_ranges

    fields = result.fields
    line = (
        f"stretch: up to {fields.percentile('max_stretch'):.3g}; "
        f"99 % of the volume up to {fields.percentile('max_stretch', 99):.3g}"
    )
    known = filter(None, tested_ranges(result.design))
    limits = dict.fromkeys(f"{tested.largest:g}" for tested in known)
    return f"{line}; tested to {', '.join(limits)}" if limits else line


def _place(found: Diagnostic) -> str:
    """Place of a diagnostic, unless its text gives it."""
    from voxsoft.simulation.diagnostic import near

    if found.at is None or "near (" in found.what:
        return ""
    return f" ({near(found.at)})"
