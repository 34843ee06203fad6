"""``voxsoft calibrate``: a material from measurements."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from voxsoft.calibration import Calibration, CalibrationEvent
from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.options import DesignFile, Json, Seed, Sets, Workers
from voxsoft.cli.output import print_json, say, show_table
from voxsoft.cli.progress import ProgressBar


def calibrate(
    design: DesignFile,
    data: Annotated[
        list[Path],
        typer.Argument(
            help="Measured data (CSV), one file or several.", exists=True, dir_okay=False
        ),
    ],
    method: Annotated[
        str, typer.Option("--method", help="genetic (the paper's), cma-es, or an Optuna sampler.")
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
    name: Annotated[str | None, typer.Option("--name", help="Name of the material card.")] = None,
    generations: Annotated[int, typer.Option("--generations", min=1)] = 50,
    population: Annotated[int, typer.Option("--population", min=4)] = 30,
    workers: Workers = None,
    seed: Seed = 0,
    json: Json = False,
) -> None:
    """Fit the lattice material to measurements and write a material card with its report."""
    from voxsoft import files
    from voxsoft.calibration import Experiment, Measurement
    from voxsoft.calibration import calibrate as fit
    from voxsoft.files.calibrations import write_calibration

    with errors_in_words(json=json):
        loaded = files.load_with(design, sets or [])
        experiments = [Experiment(loaded, Measurement.read(path, select=material)) for path in data]
        with ProgressBar("evaluations", generations * population) as bar:
            answer = fit(
                experiments,
                method=method,
                free_scale=free_scale,
                generations=generations,
                population=population,
                workers=workers,
                seed=seed,
                progress=lambda event: bar.advance_to(event.evaluations, _note(event)),
            )
        folder = out or Path("runs") / f"{loaded.name}-calibration"
        write_calibration(answer, folder, name or data[0].stem)
        if json:
            print_json(answer.summary() | {"folder": str(folder)})
        else:
            _show(answer)
            say(f"wrote {folder}")


def _note(event: CalibrationEvent) -> str:
    return f"mean error {event.mean_error * 1e3:.2f} mm"


def _show(answer: Calibration) -> None:
    say(f"mean error {answer.mean_error * 1e3:.2f} mm, largest {answer.max_error * 1e3:.2f} mm")
    rows = [
        [profile.name, f"{profile.best / 1e3:.3f} kPa", profile.sentence]
        for profile in answer.profiles
    ]
    show_table("Parameters", ["name", "value", "identifiable"], rows)
