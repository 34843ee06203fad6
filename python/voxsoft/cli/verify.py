"""``voxsoft verify``: the scoreboard of measured robots."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.options import Json
from voxsoft.cli.output import plain, print_json, quantity, say

if TYPE_CHECKING:
    from voxsoft.scoreboard import Scoreboard

_FAILED = 4


def verify(
    cases: Annotated[
        list[str] | None, typer.Argument(help="Names of cases; default: all of the folder.")
    ] = None,
    folder: Annotated[Path, typer.Option("--folder", help="Folder of the cases' scripts.")] = Path(
        "examples/validation"
    ),
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Folder for scores.csv and scores.png.")
    ] = None,
    scores: Annotated[
        Path | None,
        typer.Option("--scores", help="Score the predictions of a CSV file instead of running."),
    ] = None,
    json: Json = False,
) -> None:
    """Predict measured robots, and count how many measurements lie in their 90 % intervals.

    The interval of each number combines the uncertainty of material, geometry, voxels and
    repeated measurements.
    """
    from voxsoft.scoreboard import predictions_in, read_scores

    with errors_in_words(json=json):
        if scores is not None:
            board = read_scores(scores)
        else:
            board = predictions_in(folder, cases or [], _announce)
        if out is not None:
            _write(board, out)
        if json:
            print_json(board.summary())
        else:
            _show(board)
            if out is not None:
                say(f"wrote {plain(str(out))}")
    if board.failed:
        raise typer.Exit(_FAILED)


def _announce(name: str, number: int, count: int) -> None:
    say(f"{number + 1} of {count}: {plain(name)} …")


def _write(board: Scoreboard, folder: Path) -> None:
    from voxsoft.files.atomic import write_atomically
    from voxsoft.files.figures import save_figure
    from voxsoft.files.run_folder import make_folder
    from voxsoft.plot import plot_scoreboard

    made = make_folder(folder)
    write_atomically(made / "scores.csv", board.csv())
    save_figure(plot_scoreboard(board), made / "scores.png")


def _show(board: Scoreboard) -> None:
    for each in board.predictions:
        mark = "[green]inside [/green]" if each.inside else "[red]outside[/red]"
        measured, predicted, half = (
            quantity(float(f"{number:.4g}"), each.kind)
            for number in (each.measured, each.predicted, each.half_width)
        )
        name = plain(f"{each.case}: {each.name}")
        say(f"{mark} {name}: measured {measured}, predicted {predicted} ± {half}")
    for case in board.cases:
        own = board.of(case)
        inside = sum(each.inside for each in own.predictions)
        count = len(own.predictions)
        say(f"{plain(case)}: {inside} of {count} inside, mean width {100 * own.width:.0f} %")
    for name, why in board.failed.items():
        say(f"[red]{plain(name)}[/red]: {plain(why)}")
    if board.predictions:
        share, width = 100 * board.coverage, 100 * board.width
        say(f"{share:.0f} % of {len(board.predictions)} inside, mean width {width:.0f} %")
