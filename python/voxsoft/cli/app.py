"""The commands joined into one program."""

from __future__ import annotations

from importlib.metadata import version
from typing import Annotated

import typer

from voxsoft.cli.again import again
from voxsoft.cli.calibrate import calibrate
from voxsoft.cli.check import check
from voxsoft.cli.compare import compare
from voxsoft.cli.export import export
from voxsoft.cli.make import make
from voxsoft.cli.material import material
from voxsoft.cli.mesh import mesh
from voxsoft.cli.new import new
from voxsoft.cli.refine import refine
from voxsoft.cli.respond import respond
from voxsoft.cli.run import run
from voxsoft.cli.studio import studio
from voxsoft.cli.study import optimize, sweep
from voxsoft.cli.verify import verify
from voxsoft.cli.workspace import workspace

app = typer.Typer(
    name="voxsoft",
    help="Describe, mesh, simulate, calibrate and optimize soft robots.",
    epilog="Exit codes: 0 done, 2 wrong call, 3 invalid input, 4 not at rest, 5 the machine failed "
    "(disk, memory), 6 repeated with other results, 130 interrupted.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_show_locals=False,
)
_COMMANDS = (
    *(new, check, mesh, run, refine, workspace, respond, calibrate, sweep, optimize),
    *(compare, verify, again, export, make, studio),
)
for command in _COMMANDS:
    app.command()(command)
app.add_typer(material)


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"voxsoft {version('voxsoft')}")
        raise typer.Exit


@app.callback()
def _program(
    show_version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version."
        ),
    ] = False,
) -> None:
    """Describe, mesh, simulate, calibrate and optimize soft robots."""


def main() -> None:
    """Run the command line."""
    app()
