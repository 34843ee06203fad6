"""Things that print short: a few lines for a reader, one for a list, the same in a notebook."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape


class Shown:
    """Base of objects printed as lines of their own, the first of them alone in a list.

    Examples
    --------
    >>> class Answer(Shown):
    ...     def _lines(self):
    ...         yield from ("ok: at rest", "top: 4 mm")
    >>> print(Answer())
    ok: at rest
      top: 4 mm
    >>> [Answer()]
    [<Answer ok: at rest>]
    """

    def _lines(self) -> Iterator[str]:
        """Lines to show, most important first."""
        raise NotImplementedError

    def __str__(self) -> str:
        return "\n  ".join(self._lines())

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {next(self._lines())}>"

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"


def counted(number: int, noun: str) -> str:
    """Write a number of things.

    Examples
    --------
    >>> counted(1, "probe"), counted(1472, "voxel")
    ('1 probe', '1,472 voxels')
    """
    return f"{number:,} {noun}{'' if number == 1 else 's'}"


def shortened(lines: list[str], most: int = 12) -> list[str]:
    """Leave the end of a long list out, and say so.

    Examples
    --------
    >>> shortened(["a", "b", "c", "d"], most=2)
    ['a', 'b', '... and 2 more']
    """
    rest = len(lines) - most
    return lines if rest <= 0 else [*lines[:most], f"... and {rest:,} more"]


def rounded(value: float) -> float:
    """Round to the four digits that a glance takes in; the rounding error of a zero becomes zero.

    Examples
    --------
    >>> rounded(0.0044281), rounded(-1e-19)
    (0.004428, 0.0)
    """
    return float(f"{value:.4g}") if abs(value) > 1e-15 else 0.0
