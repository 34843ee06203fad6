"""Exit codes, and how an error leaves the program."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

import typer

from voxsoft.cli.output import plain, print_json, say
from voxsoft.errors import MissingPackageError, StudyError, VoxSoftError

OK: Final = 0
USAGE: Final = 2
INVALID: Final = 3
NOT_AT_REST: Final = 4
INTERRUPTED: Final = 130


def exit_code(error: VoxSoftError) -> int:
    """2 where the call is off (a missing package, a study folder of another study), else 3."""
    return USAGE if isinstance(error, (MissingPackageError, StudyError)) else INVALID


def problems_of(error: VoxSoftError) -> list[dict[str, str]]:
    """Every problem of an error as plain data."""
    return [
        {"where": problem.where, "what": problem.what, "try": problem.hint}
        for problem in error.problems
    ]


@contextmanager
def errors_in_words(*, json: bool = False, invalid: dict[str, Any] | None = None) -> Iterator[None]:
    """Turn an error into a message on standard error, an object on standard output, and a code.

    Parameters
    ----------
    json
        Whether the command was asked for one object on standard output.
    invalid
        Keys that the object holds besides ``problems``.
    """
    try:
        yield
    except VoxSoftError as error:
        say(f"[red]error:[/red] {plain(str(error))}")
        if json:
            print_json({"status": "failed", **(invalid or {}), "problems": problems_of(error)})
        raise typer.Exit(exit_code(error)) from None
    except KeyboardInterrupt as interrupt:
        say(plain(str(interrupt)) or "stopped; files that were written before are kept")
        raise typer.Exit(INTERRUPTED) from None
    except BrokenPipeError:
        # The reader of a pipe went away (`| head`). Python would complain once more at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise typer.Exit(OK) from None
