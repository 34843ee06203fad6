"""From the place that a problem names to line and columns of a text in TOML.

No parser of TOML keeps positions, so this looks for the keys in the text: enough to underline.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final, NamedTuple

from voxsoft.errors import ErrorDetail, VoxSoftError
from voxsoft.files.toml_text import line_of
from voxsoft.records import steps_of
from voxsoft.studio.protocol.events import Diagnostic

_IN_FILE: Final = re.compile(r", line (\d+)(?:, column (\d+))?")
_VALUE: Final = re.compile(r"""\s*("(?:\\.|[^"\\])*"|'[^']*'|[^,\s}\]#]+)""")


class Span(NamedTuple):
    """A stretch of one line; all three count from 1, and the end is not in it."""

    line: int
    column: int
    end: int


def span_of(text: str, path: Sequence[str | int]) -> Span:
    r"""Find the value, or else the key, that a path leads to.

    Parameters
    ----------
    text
        The text of a design.
    path
        Keys and indices.

    Returns
    -------
    Span
        Span of the innermost key that is found; the first line where none is.

    Examples
    --------
    >>> span_of('[shapes]\nbody = { kind = "box", size = 5 }', ["shapes", "body", "size"])
    Span(line=2, column=31, end=32)
    """
    lines = text.splitlines() or [""]
    depth = next((n for n in range(len(path), 0, -1) if _starts_a_line(text, path[:n])), 0)
    if depth == 0:
        # A shape names itself before its faulty entry: "difference.voxel_size".
        return span_of(text, path[1:]) if len(path) > 1 else _whole(lines, 1)
    number = line_of(text, path[:depth]) or 1
    line = lines[number - 1]
    start, end = _key(line, str(path[depth - 1]), 0) or (_indent(line), len(line.rstrip()))
    for step in path[depth:]:
        inner = _key(line, str(step), end) if isinstance(step, str) else _entry(line, step, end)
        if inner is None:
            break
        start, end = inner
    value = _VALUE.match(line, line.index("=", end) + 1) if "=" in line[end:] else None
    if value and not value.group(1).startswith(("{", "[")):
        start, end = value.span(1)
    return Span(number, start + 1, max(end, start + 1) + 1)


def diagnostics_of(error: VoxSoftError, text: str, severity: str = "error") -> list[Diagnostic]:
    """Give every problem of an error its place in the text."""
    return [_diagnostic(problem, text) for problem in error.problems]


def _diagnostic(problem: ErrorDetail, text: str) -> Diagnostic:
    lines = text.splitlines() or [""]
    if found := _IN_FILE.search(problem.where):
        number = min(int(found[1]), len(lines))
        if found[2]:
            column = max(1, int(found[2]))
            span = Span(number, column, column + 1)
        else:
            span = _whole(lines, number)
        where = ""
    else:
        span, where = span_of(text, steps_of(problem.where)), problem.where
    return Diagnostic(
        line=span.line,
        column=span.column,
        end_column=span.end,
        severity="error",
        where=where,
        what=problem.what or problem.where,
        hint=problem.hint,
    )


def _starts_a_line(text: str, path: Sequence[str | int]) -> bool:
    """Check if the last step of a path has a line of its own, and not only the tables around it."""
    line = line_of(text, path)
    return line is not None and (len(path) == 1 or line != line_of(text, path[:-1]))


def _whole(lines: Sequence[str], number: int) -> Span:
    line = lines[number - 1]
    return Span(number, _indent(line) + 1, max(len(line.rstrip()), _indent(line) + 1) + 1)


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip())


def _key(line: str, key: str, start: int) -> tuple[int, int] | None:
    pattern = re.compile(rf"""(?<![\w-])["']?({re.escape(key)})["']?\s*(?=[=.\]])""")
    found = pattern.search(line, start)
    return found.span(1) if found else None


def _entry(line: str, index: int, start: int) -> tuple[int, int] | None:
    """Find an entry of a flat list that stands in one line."""
    opening = line.find("[", start)
    if opening < 0:
        return None
    at = opening + 1
    for _ in range(index):
        found = _VALUE.match(line, at)
        comma = line.find(",", found.end() if found else at)
        if comma < 0:
            return None
        at = comma + 1
    found = _VALUE.match(line, at)
    return found.span(1) if found else None
