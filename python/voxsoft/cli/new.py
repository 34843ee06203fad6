"""``voxsoft new``: a design file to start from."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from voxsoft.cli.exits import USAGE, errors_in_words
from voxsoft.cli.output import say


def new(
    name: Annotated[str, typer.Argument(help="Name of the design; NAME.toml is written.")],
    template: Annotated[
        str, typer.Option("--template", "-t", help="Which ready design to start from.")
    ] = "cylinder",
    folder: Annotated[Path, typer.Option("--folder", help="Where to write it.")] = Path(),
    force: Annotated[bool, typer.Option("--force", help="Replace a file that exists.")] = False,
) -> None:
    """Write a design file to start from: beam, cylinder, sphere, pneunet or gyroid-finger."""
    from voxsoft.design import families

    ready = families.FAMILIES
    if template not in ready:
        raise typer.BadParameter(f"{template!r} is not one of {', '.join(ready)}", param_hint="-t")
    path = folder / f"{name}.toml"
    if path.exists() and not force:
        say(f"{path} exists; add --force to replace it")
        raise typer.Exit(USAGE)
    with errors_in_words(json=False):
        folder.mkdir(parents=True, exist_ok=True)
        design = ready[template]()
        type(design).from_document({**design.document, "name": name}).save(path)
    say(f"wrote {path}; next: [bold]voxsoft check {path}[/bold], [bold]voxsoft run {path}[/bold]")
