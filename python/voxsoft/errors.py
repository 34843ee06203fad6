"""The exception tree: every error VoxSoft raises on purpose is a :class:`VoxSoftError`.

A message gives the place (part, shape, parameter), the value, the allowed ones and a remedy.
Errors that correspond to a standard exception inherit it too, so ``except ValueError`` works.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final, NamedTuple, Self

#: Text that somebody wrote is quoted up to this length, and whole messages are this long at most.
_LONGEST_QUOTE: Final = 120
_LONGEST: Final = 2_000


def brief(text: str) -> str:
    """Shorten a quotation in a message, or a message: a formula may have 40,000 characters.

    Examples
    --------
    >>> brief(f'in "{"1+" * 20_000}1": too long')
    'in "1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+ ... +1+1+1+1+1+1" (40,001 characters): too long'
    """
    return _cut(_QUOTED.sub(_cut_quote, text), _LONGEST, _LONGEST - 200)


def _cut_quote(match: re.Match[str]) -> str:
    if len(match[1]) <= _LONGEST_QUOTE:
        return match[0]
    return f'"{_cut(match[1], 0, 30)}" ({len(match[1]):,} characters)'


def _cut(text: str, longest: int, start: int) -> str:
    return text if len(text) <= longest else f"{text[:start]} ... {text[-12:]}"


_QUOTED: Final = re.compile(r'"([^"]*)"')


class ErrorDetail(NamedTuple):
    """One problem: the place, the value and the allowed ones, and a remedy.

    Examples
    --------
    >>> str(ErrorDetail("wall", "-2 mm is negative"))
    'wall: -2 mm is negative'
    """

    where: str
    what: str = ""
    hint: str = ""

    def __str__(self) -> str:
        message = ": ".join(part for part in (self.where, self.what) if part)
        return f"{message}. Try: {self.hint}" if self.hint else message


def details_as_data(details: Iterable[ErrorDetail]) -> list[dict[str, str]]:
    """Some details as plain data, ``"problems"`` in ``--json``.

    Examples
    --------
    >>> details_as_data([ErrorDetail("wall", "is negative")])
    [{'where': 'wall', 'what': 'is negative', 'try': ''}]
    """
    return [{"where": each.where, "what": each.what, "try": each.hint} for each in details]


class VoxSoftError(Exception):
    """Base of all errors raised by VoxSoft.

    Parameters
    ----------
    where
        The place: ``"parts[0].material"``, ``"beam.toml, line 7"``.
    what
        The value and the allowed ones.
    hint
        A remedy, in plain words; may be empty.

    Attributes
    ----------
    problems : tuple of ErrorDetail
        Everything that is wrong, where a check goes on after the first find; at least one.

    Examples
    --------
    >>> str(VoxSoftError("wall", "-2 mm is negative", "give a positive length"))
    'wall: -2 mm is negative. Try: give a positive length'
    """

    def __init__(self, where: str, what: str = "", hint: str = "") -> None:
        where, what, hint = brief(where), brief(what), brief(hint)
        self.where, self.what, self.hint = where, what, hint
        self.problems: tuple[ErrorDetail, ...] = (ErrorDetail(where, what, hint),)
        super().__init__(where, what, hint)

    @classmethod
    def listing(cls, problems: Iterable[ErrorDetail]) -> Self:
        """Make one error of several problems; its own place is that of the first.

        Examples
        --------
        >>> problems = [ErrorDetail("a", "is missing"), ErrorDetail("b", "is negative")]
        >>> print(DesignError.listing(problems))
        2 problems
          a: is missing
          b: is negative
        """
        every = tuple(ErrorDetail(*map(brief, problem)) for problem in problems)
        error = cls(*every[0])
        error.problems = every
        return error

    def __str__(self) -> str:
        if len(self.problems) == 1:
            return str(self.problems[0])
        return "\n  ".join((f"{len(self.problems)} problems", *map(str, self.problems)))


class UnitError(VoxSoftError, ValueError):
    """A missing unit, an unknown unit, or a unit of the wrong kind."""


class DesignError(VoxSoftError, ValueError):
    """A design that is not valid: unknown key, impossible size, missing clamp, ..."""


class FormulaError(DesignError):
    """A formula that cannot be read, names something unknown, or runs in a circle."""


class NoCavityError(DesignError):
    """A pressure is asked for where there is no enclosed cavity."""


class DisconnectedError(DesignError):
    """A component of the body is held by nothing."""


class ShapeError(VoxSoftError, ValueError):
    """A shape that cannot be built or sampled."""


class VoxelError(VoxSoftError, ValueError):
    """A voxel grid that cannot be made or changed as asked."""


class MeshError(VoxSoftError, ValueError):
    """A mesh that cannot be built, read or used."""


class MaterialError(VoxSoftError, ValueError):
    """An unknown material card or impossible constants."""


class MeasurementError(VoxSoftError, ValueError):
    """Measured data that cannot be used: wrong unit, NaN, too few stations."""


class SimulationError(VoxSoftError, RuntimeError):
    """A simulation that could not be set up or run."""


class OutsideCodeError(SimulationError):
    """An outside finite-element code that crashed, said nothing, or took too long."""


class StudyError(VoxSoftError, RuntimeError):
    """A study that could not be set up, stored or resumed."""


class FileError(VoxSoftError, OSError):
    """A file that is missing, unreadable, truncated or cannot be written."""

    def __str__(self) -> str:
        return VoxSoftError.__str__(self)


class OutputError(FileError):
    """A file or folder that cannot be written: no room, no permission, a file in the way."""


class StorageError(StudyError, OutputError):
    """The storage of a study that cannot be written or does not answer."""

    __str__ = VoxSoftError.__str__


class MissingPackageError(VoxSoftError, ImportError):
    """An optional package that is not installed; the message holds the pip command."""
