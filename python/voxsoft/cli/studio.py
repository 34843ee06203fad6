"""``voxsoft studio``: the page in the browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.output import say


def studio(
    source: Annotated[
        Path | None,
        typer.Argument(help="A design file, or a run folder.", exists=True, readable=True),
    ] = None,
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Only print the address.")
    ] = False,
    port: Annotated[
        int,
        typer.Option(
            "--port",
            min=0,
            max=65535,
            help="Port of the server; 0: that of the last time if it is free, or any free one.",
        ),
    ] = 0,
    runs: Annotated[Path, typer.Option("--runs", help="Folder of runs and studies.")] = Path(
        "runs"
    ),
) -> None:
    """Open the studio: see, edit, run, calibrate and optimize designs in the browser.

    It listens on this machine only, and the address holds a token that no one else knows. Ctrl-C
    ends it; changes that were not saved are there at the next start, and tabs that are still open
    come back to it.
    """
    say("Starting the studio…")  # before its imports, which take seconds on a busy machine
    from voxsoft.studio.server.process import StudioServer

    def ready(address: str) -> None:
        # On a line of standard output by itself, for programs that start the studio.
        typer.echo(address)
        say("The studio is at this address. Ctrl-C ends it.")
        if not no_browser:
            import webbrowser

            webbrowser.open(address)

    with errors_in_words():
        StudioServer(source, runs=runs, port=port).run_and_exit(ready)
