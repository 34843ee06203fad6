"""``voxsoft calibrate``: a material from measurements."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from voxsoft._folders import folder_name
from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.options import DesignFile, Json, Seed, Sets, Workers
from voxsoft.cli.output import plain, print_json, quantity, say, show_table

if TYPE_CHECKING:
    from voxsoft.calibration import Calibration, CalibrationEvent


def calibrate(
    design: DesignFile,
    data: Annotated[
        list[Path],
        typer.Argument(
            help="Measured data (CSV), one file or several.", exists=True, dir_okay=False
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
    from voxsoft.calibration import Experiment, Measurement
    from voxsoft.calibration import calibrate as fit
    from voxsoft.cli.progress import ProgressBar

    with errors_in_words(json=json):
        loaded = files.load(design, assignments=sets or [])
        experiments = [Experiment(loaded, Measurement.read(path, select=material)) for path in data]
        with ProgressBar("generations", generations) as bar:
            answer = fit(
                experiments,
                method=method,
                free_scale=free_scale,
                generations=generations,
                population=population,
                workers=workers,
                seed=seed,
                progress=lambda event: bar.advance_to(*_standing(event, generations)),
            )
        folder = out or Path("runs") / f"{folder_name(loaded.name)}-calibration"
        written = files.write_calibration(answer, folder, name or _card_name(material, data[0]))
        if json:
            print_json(answer.summary() | {"folder": str(folder)})
        else:
            _show(answer)
            say(f"wrote {plain(str(folder))}: {', '.join(file.name for file in written)}")


def _card_name(material: str | None, data: Path) -> str:
    """A name that a design can write: lower case, letters, digits and hyphens."""
    return re.sub(r"[^a-z0-9]+", "-", (material or data.stem).lower()).strip("-") or "material"


def _standing(event: CalibrationEvent, generations: int) -> tuple[int, str]:
    done = event.done if event.stage == "search" else generations
    return done, f"{event.stage}, mean error {quantity(event.mean_error, 'length')}"


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
