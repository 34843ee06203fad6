"""``voxsoft calibrate``: a material from measurements."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from voxsoft._folders import folder_name
from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.options import DesignFile, Json, Seed, Sets, Workers
from voxsoft.cli.output import plain, print_json, quantity, say, show_table

if TYPE_CHECKING:
    from voxsoft.calibration import Calibration


def calibrate(
    design: DesignFile,
    data: Annotated[
        list[Path],
        typer.Argument(
            help="Measured data (CSV), one file or several; arc positions are on the lower edge.",
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
        spec = CalibrateSpec(
            design=DesignSource.of_file(design, sets or []),
            data=[MeasuredTable.of_file(path, material) for path in data],
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
        if fit.caution:
            say(f"[yellow]warning[/yellow] {plain(fit.caution)}")
