"""``voxsoft new``: a design file to start from."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from voxsoft.cli.exits import USAGE, errors_in_words
from voxsoft.cli.output import plain, say


def new(
    name: Annotated[str, typer.Argument(help="Name of the design; NAME.toml is written.")],
    template: Annotated[
        str | None,
        typer.Option(
            "--template",
            "-t",
            help="Start from: beam, cylinder (the default), finger, pneunet or sphere.",
        ),
    ] = None,
    feature: Annotated[
        str,
        typer.Option(
            "--feature",
            help="Start from a ready feature instead: bellows, chamber-row, finger or fold.",
        ),
    ] = "",
    folder: Annotated[Path, typer.Option("--folder", help="Folder of the new file.")] = Path(),
    force: Annotated[bool, typer.Option("--force", help="Replace a file that exists.")] = False,
) -> None:
    """Write a commented design file to start from."""
    from voxsoft import files
    from voxsoft.design import families

    if template and feature:
        raise typer.BadParameter("starts from one of the two", param_hint="--template, --feature")
    template = template or "cylinder"
    if template not in families.FAMILIES:
        known = ", ".join(families.FAMILIES)
        raise typer.BadParameter(f"{template!r} is not one of {known}", param_hint="--template")
    name = name.removesuffix(".toml")
    path = folder / f"{name}.toml"
    if path.name != f"{name}.toml":
        raise typer.BadParameter("holds a folder; name that with --folder", param_hint="NAME")
    if path.exists() and not force:
        say(f"{plain(str(path))} exists; add --force to replace it")
        raise typer.Exit(USAGE)
    with errors_in_words():
        if feature:
            files.write_feature(feature, path, name=name)
        else:
            files.write_family(template, path, name=name)
    shown = plain(str(path))
    say(
        f"wrote {shown}; next: [bold]voxsoft check {shown}[/bold], [bold]voxsoft run {shown}[/bold]"
    )
