"""``voxsoft again``: the job of a folder once more, and whether its results are the same."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from voxsoft.cli.exits import DIFFERS, errors_in_words
from voxsoft.cli.options import Json
from voxsoft.cli.output import plain, print_json, say

if TYPE_CHECKING:
    from voxsoft.jobs import Repetition

#: Number of differences listed.
LISTED = 10


def again(
    folder: Annotated[
        Path,
        typer.Argument(
            help="The folder of a run, study, calibration or comparison.",
            exists=True,
            file_okay=False,
            metavar="FOLDER",
        ),
    ],
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="The new folder; default: FOLDER-again."),
    ] = None,
    json: Json = False,
) -> None:
    """Repeat the job of a folder and say whether the results are the same to the bit.

    The folder itself is not changed, and may have been moved since. Times do not count.
    """
    from voxsoft import jobs
    from voxsoft.cli.progress import JobBar

    with errors_in_words(json=json):
        with JobBar() as bar:
            found = jobs.again(folder, out, bar.follow)
        if json:
            print_json(found.summary())
        else:
            _show(found)
    if not found.same:
        raise typer.Exit(DIFFERS)


def _show(found: Repetition) -> None:
    say(plain(found.outcome.sentence))
    say(f"wrote {plain(str(found.outcome.folder))}")
    if found.same:
        say(f"[green]the same to the bit[/green] as {plain(str(found.folder))}")
        return
    for each in found.differences[:LISTED]:
        say(f"[red]differs[/red]: {plain(str(each))}")
    left = len(found.differences) - LISTED
    if left > 0:
        say(f"[red]differs[/red]: and {left} more")
    for reason in found.reasons:
        say(f"[yellow]note:[/yellow] {plain(reason)}")
