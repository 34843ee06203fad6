"""Where words and numbers go: people read standard error, programs read standard output."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.table import Table

_people = Console(stderr=True, highlight=False)


def say(message: str) -> None:
    """Write a line for people (rich markup is understood)."""
    _people.print(message, soft_wrap=True)


def console() -> Console:
    """The console for people, for tables and progress bars."""
    return _people


def print_json(value: Mapping[str, Any]) -> None:
    """Write one object to standard output; numbers that are not finite become null."""
    json.dump(_finite(value), sys.stdout, indent=2, ensure_ascii=False)
    sys.stdout.write("\n")


def show_table(title: str, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Write a table for people: the first column left, the others right."""
    table = Table(title=title, title_justify="left", title_style="bold")
    for index, column in enumerate(columns):
        table.add_column(column, justify="left" if index == 0 else "right")
    for row in rows:
        table.add_row(*row)
    _people.print(table)


def _finite(value: object) -> object:
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, Mapping):
        return {str(key): _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return value
