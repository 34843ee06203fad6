"""Exit codes, and how an error leaves the program."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

import typer

from voxsoft.cli.output import plain, print_json, say
from voxsoft.errors import (
    MissingPackageError,
    OutputError,
    OutsideCodeError,
    StudyError,
    VoxSoftError,
    details_as_data,
)

OK: Final = 0
USAGE: Final = 2
INVALID: Final = 3
NOT_AT_REST: Final = 4
FAILED: Final = 5
DIFFERS: Final = 6
INTERRUPTED: Final = 130

#: The codes of all commands, as the documentation has them.
MEANINGS: Final = {
    OK: "done",
    USAGE: "the command was used in a wrong way, or needs a package that is not installed",
    INVALID: "the design, mesh or data is not valid; nothing was solved",
    NOT_AT_REST: "the run did not come to rest, or diverged",
    FAILED: "the machine failed: a file cannot be written, memory is short, a storage or an "
    "outside code does not answer; finished work is kept, and summary.json of a run is written "
    "before all other files",
    DIFFERS: "a job that was repeated has other results than its folder",
    INTERRUPTED: "stopped by Ctrl-C; finished work is kept",
}

#: Exit codes by the kind of error, the first that fits; INVALID for all others.
_CODES: Final[tuple[tuple[type[BaseException], int], ...]] = (
    (OutputError, FAILED),
    (OutsideCodeError, FAILED),
    (MissingPackageError, USAGE),
    (StudyError, USAGE),
    (VoxSoftError, INVALID),
    (OSError, FAILED),
    (MemoryError, FAILED),
)


def exit_code(error: BaseException) -> int:
    """The code of an error, whatever the command.

    Examples
    --------
    >>> from voxsoft.errors import DesignError
    >>> exit_code(OutputError("a.vtu", "no room")), exit_code(DesignError("wall", "is negative"))
    (5, 3)
    """
    return next(code for kind, code in _CODES if isinstance(error, kind))


def problems_of(error: VoxSoftError) -> list[dict[str, str]]:
    """Every problem of an error as plain data."""
    return details_as_data(error.problems)


@contextmanager
def errors_in_words(*, json: bool = False, invalid: dict[str, Any] | None = None) -> Iterator[None]:
    """Turn an error into a message on standard error, an object on standard output, and a code.

    Parameters
    ----------
    json
        True if the command was asked for one object on standard output.
    invalid
        Keys that the object holds besides ``problems``.
    """
    try:
        yield
    except VoxSoftError as error:
        raise _leave(error, json, invalid) from None
    except KeyboardInterrupt as interrupt:
        say(plain(str(interrupt)) or "stopped; files that were written before are kept")
        raise typer.Exit(INTERRUPTED) from None
    except BrokenPipeError:
        # The reader of a pipe went away (`| head`). Python would complain once more at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise typer.Exit(OK) from None
    except MemoryError as error:
        reported = OutputError(
            "memory", "is short", "make the voxels larger, or start fewer workers"
        )
        raise _leave(reported, json, invalid) from error
    except OSError as error:
        reported = OutputError(str(error.filename or "a file"), error.strerror or str(error))
        raise _leave(reported, json, invalid) from error


def _leave(error: VoxSoftError, json: bool, invalid: dict[str, Any] | None) -> typer.Exit:
    """Report an error, and return the exception that ends the program."""
    say(f"[red]error:[/red] {plain(str(error))}")
    if json:
        print_json({"status": "failed", **(invalid or {}), "problems": problems_of(error)})
    return typer.Exit(exit_code(error))
