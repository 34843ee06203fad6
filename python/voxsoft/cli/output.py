"""Output of words and numbers: people read standard error, programs read standard output."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console


@cache
def console() -> Console:
    """The console for people, for tables and progress bars."""
    from rich.console import Console

    # No emoji: names such as `:x:` are shown as they are.
    return Console(stderr=True, highlight=False, emoji=False)


def say(message: str) -> None:
    """Write a line for people (rich markup is understood; see :func:`plain`)."""
    console().print(message, soft_wrap=True)


def plain(text: str) -> str:
    r"""Keep rich from reading brackets such as ``parts[0]`` as markup.

    Examples
    --------
    >>> plain("[red]")
    '\\[red]'
    """
    from rich.markup import escape

    return escape(text)


def print_json(value: Mapping[str, Any]) -> None:
    """Write one object to standard output; numbers that are not finite become null."""
    json.dump(_finite(value), sys.stdout, indent=2, ensure_ascii=True)
    sys.stdout.write("\n")
    sys.stdout.flush()


def show_table(
    title: str,
    columns: Sequence[str],
    rows: Iterable[Sequence[str]],
    doubtful: Sequence[bool] = (),
) -> None:
    """Write a table for people: the first column left, the others right, doubtful rows yellow."""
    from rich.table import Table

    table = Table(title=plain(title), title_justify="left", title_style="bold")
    for index, column in enumerate(columns):
        table.add_column(plain(column), justify="left" if index == 0 else "right")
    for index, row in enumerate(rows):
        doubt = index < len(doubtful) and doubtful[index]
        table.add_row(*map(plain, row), style="yellow" if doubt else None)
    console().print(table)


def quantity(value: float, kind: str) -> str:
    """Write an SI number with a unit that suits its size, to four digits.

    Examples
    --------
    >>> quantity(0.0123456, "length")
    '12.35 mm'
    >>> quantity(0.146800, "angle")
    '8.411 deg'
    """
    from voxsoft.units import format_quantity

    if kind == "angle":  # which a design reads back in radians or degrees, whichever is shorter
        return f"{math.degrees(value):.4g} deg"
    return format_quantity(float(f"{value:.4g}"), kind)


def _finite(value: object) -> object:
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, Mapping):
        return {str(key): _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return value
