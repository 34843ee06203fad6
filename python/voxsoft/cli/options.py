"""Options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

DesignFile = Annotated[
    Path,
    typer.Argument(
        help="A design file (TOML).", exists=True, dir_okay=False, readable=True, metavar="DESIGN"
    ),
]
Sets = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="Set a parameter (radius='20 mm') or any key (parts.0.material=...). Repeatable.",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print one object with SI numbers.")]
Seed = Annotated[int, typer.Option("--seed", help="Seed of everything random.")]
Workers = Annotated[
    int | None,
    typer.Option("--workers", min=1, help="Processes or threads; default: one for each core."),
]
